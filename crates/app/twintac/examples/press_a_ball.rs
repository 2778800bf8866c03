//! Presses a ball into PhysTac and reads eight pressures.
#![allow(clippy::print_stdout)] // programs print

use twintac::{Error, Gel, Press, Pressed, Sensor};

/// Prints a line for each taxel.
pub fn main() -> Result<(), Error> {
    let sensor = Sensor::phystac()?;
    let ball = Press::with("sphere-25").at_mm(-4.0, 4.0).depth_mm(1.0);
    let pressed = Gel::of(&sensor).press(&ball)?;
    for (taxel, pressure_kpa) in sensor.taxels().zip(pressed.readings_kpa()) {
        println!("{taxel} {pressure_kpa:6.2} kPa, {}", Pressed::PROVENANCE);
    }
    Ok(())
}
