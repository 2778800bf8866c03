//! Writes the KiCad project of a description: `write_board DESCRIPTION CHIP VARIANT FOLDER`.

#![allow(clippy::print_stdout)] // says what was written

use std::path::Path;

use twintac_board::Board;
use twintac_sensor::Sensor;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let given: Vec<String> = std::env::args().skip(1).collect();
    let [description, chip, variant, folder] = given.as_slice() else {
        return Err("give a description, a chip, a name and a folder".into());
    };
    let board = Board::design(variant, &Sensor::read(description)?, chip)?;
    for (file, text) in board.files() {
        let path = Path::new(folder).join(file);
        if let Some(parent) = path.parent() {
            std::fs::create_dir_all(parent)?;
        }
        std::fs::write(&path, text)?;
    }
    println!("{folder}");
    Ok(())
}
