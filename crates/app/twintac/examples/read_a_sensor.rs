//! Reads an emulated PhysTac, or yours: `cargo run --example read_a_sensor -- /dev/i2c-1 8`, where
//! 8 is its number of counts per Pa.
#![allow(clippy::print_stdout)] // programs print

use twintac::{Error, Reader, Sensor};

/// Number of frames: about three seconds. The emulated ball presses after the first second.
const FRAMES: usize = 350;

fn main() -> Result<(), Error> {
    let mut arguments = std::env::args().skip(1);
    let counts_per_pa = |text: String| text.parse().ok();
    read(
        arguments.next().as_deref(),
        arguments.next().and_then(counts_per_pa),
    )
}

/// Prints the reading of each taxel above its untouched value.
pub fn read(bus: Option<&str>, counts_per_pa: Option<u16>) -> Result<(), Error> {
    let sensor = Sensor::phystac()?;
    let mut reader = match bus {
        Some(bus) => Reader::open(bus, &sensor, counts_per_pa)?,
        None => Reader::emulated(&sensor)?,
    };
    for _ in 0..FRAMES {
        let reading = reader.read()?;
        print!("{:7.3} s, {}, kPa:", reading.time_s, reader.provenance());
        for reading_kpa in reading.readings_kpa {
            print!(" {:6.2}", reading_kpa.unwrap_or(f64::NAN));
        }
        println!();
    }
    Ok(())
}
