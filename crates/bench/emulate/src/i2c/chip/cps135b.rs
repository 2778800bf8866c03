//! The CPS135B.
//!
//! Its data sheet is not public. The registers are those that CFSensor's XGZP6847D and XGZP6897D
//! (data sheet V2.5) and NOVOSENSE's NSA2300 have in common. What none of these documents states is
//! a guess, and is a setting in [`BarometerSettings`] where possible.

use super::analog::{Analog, Conversion};
use super::emulated_chip::{EmulatedChip, Make};
use super::felt::{Felt, Now};
use crate::i2c::barometer_settings::BarometerSettings;

const STATUS: u8 = 0x02;
const DATA: u8 = 0x06;
const DATA_END: u8 = 0x0A;
const COMMAND: u8 = 0x30;
const CONFIGURATIONS: u8 = 0xA5;
const CONFIGURATIONS_END: u8 = 0xA7;

/// Bit of [`STATUS`]: a sample has not been read yet.
const READY: u8 = 0x01;
/// Bit of [`COMMAND`]: convert. It clears itself at the end of the conversion.
const CONVERT: u8 = 0x08;
/// Codes in the lowest three bits of [`COMMAND`].
const TEMPERATURE: u8 = 0b000;
const PRESSURE: u8 = 0b001;
const BOTH: u8 = 0b010;
const PERIODIC: u8 = 0b011;
const BURN: u8 = 0b100;
/// Unit of the time between periodic conversions, in the upper four bits of [`COMMAND`], ns.
const SLEEP_NS: u64 = 62_500_000;

/// A CPS135B.
#[derive(Debug)]
pub(super) struct Cps135b {
    analog: Analog,
    settings: BarometerSettings,
    /// Whether its one-time memory was burned. It then does not answer any more.
    is_burned: bool,
    register: u8,
    command: u8,
    status: u8,
    configurations: [u8; 3],
    data: [u8; 5],
    /// The conversion under way, with the code of its command.
    conversion: Option<Conversion<u8>>,
}

impl Cps135b {
    pub(super) fn new(make: Make<'_>) -> Self {
        let settings = *make.settings;
        Self {
            analog: make.analog,
            settings,
            is_burned: false,
            register: 0,
            command: 0,
            status: 0,
            configurations: [0, settings.pressure_configuration, 0],
            data: [0; 5],
            conversion: None,
        }
    }

    /// Carries out a command. A command during a conversion begins the conversion again.
    fn begin(&mut self, command: u8, now_ns: u64) {
        let code = command & 0b111;
        self.command = command;
        self.conversion = None;
        match code {
            BURN => self.is_burned = true,
            TEMPERATURE | PRESSURE | BOTH | PERIODIC if command & CONVERT != 0 => self.convert(code, now_ns),
            _ => self.command &= !CONVERT,
        }
    }

    fn convert(&mut self, code: u8, begun_ns: u64) {
        self.conversion = Some(self.analog.begin(code, self.usual_s(), begun_ns));
    }

    /// Conversion time of a usual part, s.
    fn usual_s(&self) -> f64 {
        let BarometerSettings {
            conversion_s,
            conversion_s_per_1024,
            ..
        } = self.settings;
        conversion_s + conversion_s_per_1024 * (self.samples() / 1024.0 - 1.0)
    }

    fn store(&mut self, felt: Felt, code: u8) {
        let [p0, p1, p2, t0, t1] = &mut self.data;
        if code != TEMPERATURE {
            [_, *p0, *p1, *p2] = self.settings.counts(felt.pressure_pa).to_be_bytes();
        }
        if code != PRESSURE {
            let temperature = (256.0 * felt.temperature_c).round() as i16; // clamped to the range of 16 bits
            [*t0, *t1] = temperature.to_be_bytes();
        }
        self.status |= READY;
    }

    /// Number of samples of a pressure.
    fn samples(&self) -> f64 {
        match self.configurations[1] & 0b111 {
            0b000 => 1024.0,
            0b001 => 2048.0,
            0b010 => 4096.0,
            0b011 => 8192.0,
            0b100 => 256.0,
            0b101 => 512.0,
            0b110 => 16_384.0,
            _ => 32_768.0,
        }
    }
}

impl EmulatedChip for Cps135b {
    fn wake_up(&mut self) {
        self.command = 0;
        self.status = 0;
        self.configurations = [0, self.settings.pressure_configuration, 0];
        self.data = [0; 5];
        self.conversion = None;
    }

    fn acknowledges(&self) -> bool {
        !self.is_burned
    }

    fn point(&mut self, byte: u8, _: u64) {
        self.register = byte;
    }

    fn write(&mut self, byte: u8, now_ns: u64) {
        match self.register {
            COMMAND => self.begin(byte, now_ns),
            register @ CONFIGURATIONS..=CONFIGURATIONS_END => {
                self.configurations[usize::from(register - CONFIGURATIONS)] = byte;
            }
            _ => {} // read-only
        }
        self.register = self.register.wrapping_add(1);
    }

    fn read(&mut self) -> u8 {
        let byte = match self.register {
            STATUS => self.status,
            register @ DATA..=DATA_END => {
                self.status &= !READY;
                self.data[usize::from(register - DATA)]
            }
            COMMAND => self.command,
            register @ CONFIGURATIONS..=CONFIGURATIONS_END => {
                self.configurations[usize::from(register - CONFIGURATIONS)]
            }
            _ => 0,
        };
        self.register = self.register.wrapping_add(1);
        byte
    }

    fn settle(&mut self, now: &Now<'_>) {
        while let Some(conversion) = self.analog.ended(&mut self.conversion, now) {
            let noise_pa = self.settings.noise_pa * (1024.0 / self.samples()).sqrt();
            let felt = self.analog.measure(&conversion, noise_pa, now);
            self.store(felt, conversion.what);
            if conversion.what == PERIODIC {
                let sleeps_ns = SLEEP_NS * u64::from(self.command >> 4);
                self.convert(PERIODIC, conversion.ends_ns + sleeps_ns);
            } else {
                self.command &= !CONVERT;
            }
        }
    }

    fn conversion_s(&self) -> f64 {
        self.analog.time_s(self.usual_s())
    }
}
