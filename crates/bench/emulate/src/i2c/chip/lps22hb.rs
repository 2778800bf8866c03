//! The LPS22HB: ST's driver lps22hb-pid. FIFO, filter, interrupts and the continuous modes are not
//! emulated.

use super::analog::{Analog, Conversion};
use super::emulated_chip::{EmulatedChip, Make};
use super::felt::Now;

const WHO_AM_I: usize = 0x0F;
const CONTROL_1: usize = 0x10;
const CONTROL_2: usize = 0x11;
const STATUS: usize = 0x27;
const PRESSURE: usize = 0x28;
const TEMPERATURE: usize = 0x2B;

const ONE_SHOT: u8 = 0x01;
const COUNTS_UP: u8 = 0x10;
/// Not published. It measures at most 75 times a second.
const CONVERSION_S: f64 = 12.5e-3;

/// An LPS22HB.
#[derive(Debug)]
pub(super) struct Lps22hb {
    analog: Analog,
    registers: [u8; 0x40],
    register: usize,
    conversion: Option<Conversion<()>>,
}

impl Lps22hb {
    pub(super) fn new(make: Make<'_>) -> Self {
        let mut chip = Self {
            analog: make.analog,
            registers: [0; 0x40],
            register: 0,
            conversion: None,
        };
        chip.wake_up();
        chip
    }

    fn go_on(&mut self) {
        if self.registers[CONTROL_2] & COUNTS_UP != 0 {
            self.register = (self.register + 1) % 0x40;
        }
    }
}

impl EmulatedChip for Lps22hb {
    fn wake_up(&mut self) {
        self.registers = [0; 0x40];
        self.registers[WHO_AM_I] = 0xB1;
        self.registers[CONTROL_2] = COUNTS_UP;
        self.conversion = None;
    }

    fn point(&mut self, byte: u8, _: u64) {
        self.register = usize::from(byte & 0x3F);
    }

    fn write(&mut self, byte: u8, now_ns: u64) {
        match self.register {
            CONTROL_2 if byte & 0x04 != 0 => self.wake_up(),
            CONTROL_2 => {
                self.registers[CONTROL_2] = byte;
                if byte & ONE_SHOT != 0 {
                    self.conversion = Some(self.analog.begin((), CONVERSION_S, now_ns));
                }
            }
            CONTROL_1 => self.registers[CONTROL_1] = byte,
            _ => {}
        }
        self.go_on();
    }

    fn read(&mut self) -> u8 {
        let byte = self.registers[self.register];
        match self.register {
            0x2A => self.registers[STATUS] &= !0x11,
            0x2C => self.registers[STATUS] &= !0x22,
            _ => {}
        }
        self.go_on();
        byte
    }

    fn settle(&mut self, now: &Now<'_>) {
        let Some(conversion) = self.analog.ended(&mut self.conversion, now) else {
            return;
        };
        let felt = self.analog.measure(&conversion, 0.75, now);
        let limit = f64::from(1 << 23);
        let pressure = (40.96 * felt.pressure_pa).round().clamp(-limit, limit - 1.0) as i32;
        self.registers[PRESSURE..TEMPERATURE].copy_from_slice(&pressure.to_le_bytes()[..3]);
        let temperature = (100.0 * felt.temperature_c).round() as i16;
        self.registers[TEMPERATURE..TEMPERATURE + 2].copy_from_slice(&temperature.to_le_bytes());
        self.registers[STATUS] |= 0x03;
        self.registers[CONTROL_2] &= !ONE_SHOT;
    }

    fn conversion_s(&self) -> f64 {
        self.analog.time_s(CONVERSION_S)
    }
}
