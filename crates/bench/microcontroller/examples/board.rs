//! An emulated board at the end of a pseudo-terminal:
//! `cargo run --release -p twintac-microcontroller --example board -- [CHIP] [faults]`.
//!
//! It prints the name of its port, and runs until Ctrl-C. A ball taps on the sensor once in four
//! seconds. With `faults`, a chip fails for 3 s every 20 s, and between these failures the bus
//! hangs until it is freed.

#![allow(clippy::print_stdout)] // says where it is

use std::error::Error;
use std::io::{ErrorKind, Read, Write};
use std::time::Duration;

use phystac::Chip;
use serialport::{SerialPort, TTYPort};
use twintac_emulate::{FaultKind, Hertz, LabClock, Moment, Physics, ScheduledFault, Sensed};
use twintac_microcontroller::{Microcontroller, Setup};
use twintac_rig::TcpPose;

/// A ball that moves up and down by itself.
struct Taps(Hertz);

impl Physics for Taps {
    fn at(&mut self, tool: &TcpPose, time_s: f64) -> Sensed {
        let mut tapping = *tool;
        tapping.position_mm.z += 1.0 - 1.5 * (std::f64::consts::TAU * time_s / 4.0).sin();
        self.0.at(&tapping, time_s)
    }
}

/// The faults of ten minutes.
fn faults() -> Vec<ScheduledFault> {
    let every_20_s = (0..30).map(|turn| 20.0 * f64::from(turn));
    let both = every_20_s.flat_map(|from_s| {
        let away = ScheduledFault {
            what: FaultKind::NoAcknowledge { channel: Some(3) },
            begins: Moment::TimeS(from_s + 5.0),
            lasts: Some(Moment::TimeS(3.0)),
        };
        let stuck = ScheduledFault {
            what: FaultKind::StuckBus { channel: None },
            begins: Moment::TimeS(from_s + 12.0),
            lasts: None,
        };
        [away, stuck]
    });
    both.collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let names: Vec<&String> = words.iter().filter(|word| *word != "faults").collect();
    let name = names.first().map_or("MS5837-30BA", |name| name.as_str());
    let chip =
        Chip::named(name).ok_or_else(|| format!("`{name}` is no chip: see docs/guides/hardware.md"))?;
    let mut setup = Setup::of(chip);
    if names.len() < words.len() {
        setup.faults = faults();
    }
    let mut board = Microcontroller::new(LabClock::real(), Taps(Hertz::default()), &setup)?;
    let (mut port, mut computer) = TTYPort::pair()?;
    computer.set_exclusive(false)?; // so that another program can open it
    port.set_timeout(Duration::from_millis(1))?;
    let path = computer.name().ok_or("the pseudo-terminal has no name")?;
    println!("an emulated board with eight {chip} is at {path}: in another terminal");
    println!("twintac stream --serial {path} --line firmware/lines/packets-8.toml --format csv");
    let mut heard = [0; 256];
    loop {
        if port.bytes_to_read()? > 0 {
            let n = port.read(&mut heard)?;
            board.hear(&heard[..n]);
        }
        let (_, bytes) = board.round();
        match port.write_all(&bytes) {
            Err(error) if error.kind() != ErrorKind::TimedOut => return Err(error.into()),
            _ => {} // if nobody reads, what does not fit is lost; frame numbers show it
        }
    }
}
