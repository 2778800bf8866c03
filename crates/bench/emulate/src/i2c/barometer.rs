//! The CPS135B.

use super::BarometerSettings;
use twintac_random::{RandomStream, normal, stream};

use crate::clock::nanoseconds;
use crate::{Sensed, Workcell};

const STATUS: u8 = 0x02;
const DATA: u8 = 0x06;
const DATA_END: u8 = 0x0A;
const COMMAND: u8 = 0x30;
const CONFIGURATIONS: u8 = 0xA5;
const CONFIGURATIONS_END: u8 = 0xA7;

/// Bit of [`STATUS`]: a sample has not been read yet.
const READY: u8 = 0x01;
/// Bit of [`COMMAND`]: convert; clears itself at the end.
const CONVERT: u8 = 0x08;
/// Codes in the lowest three bits of [`COMMAND`].
const TEMPERATURE: u8 = 0b000;
const PRESSURE: u8 = 0b001;
const BOTH: u8 = 0b010;
const PERIODIC: u8 = 0b011;
const BURN: u8 = 0b100;
/// Unit of the time between periodic conversions, in the upper four bits of [`COMMAND`], ns.
const SLEEP_NS: u64 = 62_500_000;

/// One barometer on one channel.
#[derive(Debug)]
pub(super) struct Barometer {
    channel: usize,
    settings: BarometerSettings,
    /// This part's time, relative to others'.
    slowness: f64,
    random: RandomStream,
    /// Whether its one-time memory was burned: it answers no more.
    is_burned: bool,
    /// The next byte written is the register's number.
    is_addressed: bool,
    register: u8,
    command: u8,
    status: u8,
    configurations: [u8; 3],
    data: [u8; 5],
    conversion: Option<Conversion>,
}

#[derive(Clone, Copy, Debug)]
struct Conversion {
    begun_ns: u64,
    ends_ns: u64,
    code: u8,
}

impl Barometer {
    pub(super) fn new(channel: usize, settings: BarometerSettings, seed: u64) -> Self {
        let mut random = stream(seed, &format!("barometer {channel}"));
        let slowness = 1.0 + normal(&mut random, settings.conversion_spread).clamp(-0.5, 0.5);
        Self {
            channel,
            settings,
            slowness,
            random,
            is_burned: false,
            is_addressed: false,
            register: 0,
            command: 0,
            status: 0,
            configurations: [0, settings.pressure_configuration, 0],
            data: [0; 5],
            conversion: None,
        }
    }

    /// Loses power and gets it back: what is in registers is gone.
    pub(super) fn wake_up(&mut self) {
        self.command = 0;
        self.status = 0;
        self.configurations = [0, self.settings.pressure_configuration, 0];
        self.data = [0; 5];
        self.conversion = None;
    }

    pub(super) fn acknowledges(&self) -> bool {
        !self.is_burned
    }

    /// Its address was on the bus, for writing or reading.
    pub(super) fn address(&mut self, for_writing: bool) {
        self.is_addressed = for_writing;
    }

    pub(super) fn write(&mut self, byte: u8, now_ns: u64) {
        if std::mem::take(&mut self.is_addressed) {
            self.register = byte;
            return;
        }
        match self.register {
            COMMAND => self.begin(byte, now_ns),
            register @ CONFIGURATIONS..=CONFIGURATIONS_END => {
                self.configurations[usize::from(register - CONFIGURATIONS)] = byte;
            }
            _ => {} // cannot be written
        }
        self.register = self.register.wrapping_add(1);
    }

    pub(super) fn read(&mut self) -> u8 {
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

    /// Ends the conversions that have ended by now, unless none does.
    pub(super) fn settle(&mut self, now_ns: u64, workcell: &Workcell, is_endless: bool) {
        while let Some(conversion) = self.conversion
            && conversion.ends_ns <= now_ns
            && !is_endless
        {
            // A conversion averages: what it finds is closest to what was half-way.
            let half_ns = conversion.begun_ns.midpoint(conversion.ends_ns);
            self.store(&workcell.at_ns(half_ns).sensed, conversion.code);
            self.conversion = None;
            if conversion.code == PERIODIC {
                let sleeps_ns = SLEEP_NS * u64::from(self.command >> 4);
                self.convert(PERIODIC, conversion.ends_ns + sleeps_ns);
            } else {
                self.command &= !CONVERT;
            }
        }
    }

    /// Carries a command out. One that comes during a conversion begins it anew.
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
        self.conversion = Some(Conversion {
            begun_ns,
            ends_ns: begun_ns + nanoseconds(self.conversion_s()).max(1),
            code,
        });
    }

    /// How long it takes for a conversion, s.
    pub(super) fn conversion_s(&self) -> f64 {
        let BarometerSettings {
            conversion_s,
            conversion_s_per_1024,
            ..
        } = self.settings;
        let more_s = conversion_s_per_1024 * (self.samples() / 1024.0 - 1.0);
        self.slowness * (conversion_s + more_s)
    }

    fn store(&mut self, sensed: &Sensed, code: u8) {
        let deviation_pa = self.settings.noise_pa * (1024.0 / self.samples()).sqrt();
        let noise_pa = normal(&mut self.random, deviation_pa);
        let [p0, p1, p2, t0, t1] = &mut self.data;
        if code != TEMPERATURE {
            let pressure_pa = 1000.0 * sensed.taxel_pressures_kpa[self.channel] + noise_pa;
            [_, *p0, *p1, *p2] = self.settings.counts(pressure_pa).to_be_bytes();
        }
        if code != PRESSURE {
            let temperature = (256.0 * sensed.temperature_c).round() as i16; // held at its ends
            [*t0, *t1] = temperature.to_be_bytes();
        }
        self.status |= READY;
    }

    /// How many samples make a pressure.
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
