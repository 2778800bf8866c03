//! The MPL3115A2: data sheet Rev 3.0, 12/2013. Its FIFO, its interrupts and its altimeter are not
//! emulated.

use super::analog::{Analog, Conversion};
use super::emulated_chip::{EmulatedChip, Make};
use super::felt::Now;

const STATUS: usize = 0x00;
const PRESSURE: usize = 0x01;
const TEMPERATURE: usize = 0x04;
const WHO_AM_I: usize = 0x0C;
const DATA_EVENTS: usize = 0x13;
const CONTROL: usize = 0x26;

const ONE_SHOT: u8 = 0x02;
const RESET: u8 = 0x04;
/// Minimum times by the code of the samples, s.
const TIMES_S: [f64; 8] = [6e-3, 10e-3, 18e-3, 34e-3, 66e-3, 130e-3, 258e-3, 512e-3];

/// An MPL3115A2.
#[derive(Debug)]
pub(super) struct Mpl3115a2 {
    analog: Analog,
    registers: [u8; 0x2E],
    register: usize,
    /// End of the time in which it does not respond after a reset, ns.
    resting_until_ns: u64,
    /// Whether it has measured since power-up. Its first measurement is wrong.
    has_measured: bool,
    conversion: Option<Conversion<u8>>,
    now_ns: u64,
}

impl Mpl3115a2 {
    pub(super) fn new(make: Make<'_>) -> Self {
        let mut chip = Self {
            analog: make.analog,
            registers: [0; 0x2E],
            register: 0,
            resting_until_ns: 0,
            has_measured: false,
            conversion: None,
            now_ns: 0,
        };
        chip.wake_up();
        chip
    }

    fn code(&self) -> usize {
        usize::from(self.registers[CONTROL] >> 3 & 0b111)
    }
}

impl EmulatedChip for Mpl3115a2 {
    fn wake_up(&mut self) {
        self.registers = [0; 0x2E];
        self.registers[WHO_AM_I] = 0xC4;
        self.has_measured = false;
        self.conversion = None;
    }

    fn point(&mut self, byte: u8, _: u64) {
        self.register = usize::from(byte);
    }

    fn write(&mut self, byte: u8, now_ns: u64) {
        match self.register {
            CONTROL if byte & RESET != 0 => {
                self.wake_up();
                self.resting_until_ns = now_ns + 5_000_000;
            }
            CONTROL => {
                let was_told = self.registers[CONTROL] & ONE_SHOT != 0;
                self.registers[CONTROL] = byte;
                if byte & ONE_SHOT != 0 && !was_told {
                    self.conversion = Some(self.analog.begin(byte, TIMES_S[self.code()], now_ns));
                }
            }
            DATA_EVENTS => self.registers[DATA_EVENTS] = byte & 7,
            _ => {}
        }
        self.register += 1;
    }

    fn read(&mut self) -> u8 {
        let byte = self.registers.get(self.register).copied().unwrap_or(0);
        match self.register {
            0x03 => self.registers[STATUS] &= !0x4C,
            0x05 => self.registers[STATUS] &= !0x2A,
            _ => {}
        }
        self.register += 1;
        byte
    }

    /// Without a repeated START a read returns the status, whatever register was written.
    fn stop(&mut self) {
        self.register = STATUS;
    }

    fn acknowledges(&self) -> bool {
        self.now_ns >= self.resting_until_ns
    }

    fn settle(&mut self, now: &Now<'_>) {
        self.now_ns = now.ns;
        let Some(conversion) = self.analog.ended(&mut self.conversion, now) else {
            return;
        };
        let noise_pa = 19.0 / 2_f64.powf(0.5 * self.code() as f64);
        let mut felt = self.analog.measure(&conversion, noise_pa, now);
        if !std::mem::replace(&mut self.has_measured, true) {
            felt.pressure_pa -= 2000.0;
        }
        let pressure = (64.0 * felt.pressure_pa)
            .round()
            .clamp(0.0, f64::from((1 << 24) - 1)) as u32;
        self.registers[PRESSURE..TEMPERATURE].copy_from_slice(&pressure.to_be_bytes()[1..]);
        let temperature = (256.0 * felt.temperature_c).round() as i16 & !0xF; // twelve bits
        self.registers[TEMPERATURE..TEMPERATURE + 2].copy_from_slice(&temperature.to_be_bytes());
        if self.registers[DATA_EVENTS] & 3 == 3 {
            self.registers[STATUS] |= 0x0E;
        }
        self.registers[CONTROL] &= !ONE_SHOT;
    }

    fn conversion_s(&self) -> f64 {
        self.analog.time_s(TIMES_S[self.code()])
    }
}
