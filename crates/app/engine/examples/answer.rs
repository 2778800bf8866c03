//! Answers requests, one JSON text a line, with one JSON text a line. Its arguments are files that
//! it stores first. A test compares the answers of the WebAssembly module with these.

use std::io::{BufRead, Write};

use twintac_engine::Engine;

fn main() -> std::io::Result<()> {
    let mut engine = Engine::default();
    for path in std::env::args().skip(1) {
        engine.keep(&path, &std::fs::read(&path)?);
    }
    for request in std::io::stdin().lock().lines() {
        writeln!(std::io::stdout(), "{}", engine.answer(&request?, &[]))?;
    }
    Ok(())
}
