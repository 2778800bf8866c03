//! Sources of a sensor's frames.

use std::fmt;
use std::path::PathBuf;

use clap::Args;
use twintac_live::Origin;
use twintac_source::Known;

/// A sensor that sends frames, or a replacement for one.
#[derive(Args, Debug)]
pub(crate) struct Wire {
    /// I²C bus of the sensor, such as /dev/i2c-1 (Linux).
    #[arg(long, value_name = "PATH", group = "source")]
    bus: Option<PathBuf>,
    /// Serial port to which a microcontroller writes frames, such as /dev/ttyACM0; `twintac ports`
    /// lists the ports.
    #[arg(long, value_name = "PORT", group = "source", requires = "line")]
    serial: Option<String>,
    /// Address at which frames arrive as datagrams, such as 0.0.0.0:9000.
    #[arg(long, value_name = "ADDRESS", group = "source", requires = "line")]
    udp: Option<String>,
    /// Description of the frames on the serial line or in datagrams (TOML).
    #[arg(long, value_name = "FILE", conflicts_with_all = ["bus", "lab", "replay"], requires = "source")]
    line: Option<PathBuf>,
    /// Log (MCAP) that is replayed at its own pace.
    #[arg(long, value_name = "FILE", group = "source")]
    replay: Option<PathBuf>,
    /// Use the emulated sensor, pressed by a slow motion.
    #[arg(long, group = "source")]
    lab: bool,
    /// Counts per Pa of the barometers, confirmed by a person who knows the parts [default: the
    /// value of the sensor description].
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u16).range(1..), requires = "source")]
    scale: Option<u16>,
    /// Altitude of the sensor, m; the scale is checked against the pressure of free air there
    /// [default: anything up to 2000].
    #[arg(
        long,
        value_name = "M",
        conflicts_with = "lab",
        allow_negative_numbers = true,
        requires = "source"
    )]
    altitude_m: Option<f32>,
}

impl Wire {
    /// The named source; `None` if none was named.
    pub(crate) fn origin(&self) -> Option<Origin> {
        let line = self.line.clone().unwrap_or_default();
        if let Some(bus) = &self.bus {
            Some(Origin::Bus(bus.clone()))
        } else if let Some(port) = self.serial.clone() {
            Some(Origin::Serial { port, line })
        } else if let Some(address) = self.udp.clone() {
            Some(Origin::Udp { address, line })
        } else if let Some(log) = &self.replay {
            Some(Origin::Log(log.clone()))
        } else {
            self.lab.then_some(Origin::Emulated)
        }
    }

    /// What a person states about the barometers.
    pub(crate) fn known(&self) -> Known {
        Known {
            counts_per_pa: self.scale,
            altitude_m: self.altitude_m,
        }
    }
}

impl fmt::Display for Wire {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.origin() {
            Some(Origin::Bus(path) | Origin::Log(path)) => path.display().fmt(f),
            Some(Origin::Serial { port: place, .. } | Origin::Udp { address: place, .. }) => place.fmt(f),
            Some(Origin::Emulated) => "the lab".fmt(f),
            None => Ok(()),
        }
    }
}
