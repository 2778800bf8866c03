//! Answers requests, one JSON text a line, with one JSON text a line. A test compares the answers
//! of the WebAssembly module with these.

use std::io::{BufRead, Write};

use twintac_engine::Engine;

fn main() -> std::io::Result<()> {
    let mut engine = Engine::default();
    for request in std::io::stdin().lock().lines() {
        writeln!(std::io::stdout(), "{}", engine.answer(&request?, &[]))?;
    }
    Ok(())
}
