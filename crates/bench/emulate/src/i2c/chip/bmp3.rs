//! The BMP384, BMP388 and BMP390: data sheet DS002-07, rev 1.7. FIFO, filter, interrupts and the
//! normal mode are not emulated.

use super::analog::{Analog, Conversion, counts_of};
use super::emulated_chip::{EmulatedChip, Make};
use super::felt::Now;

const IDENTITY: usize = 0x00;
const STATUS: usize = 0x03;
const PRESSURE: usize = 0x04;
const TEMPERATURE: usize = 0x07;
const EVENT: usize = 0x10;
const POWER: usize = 0x1B;
const OVERSAMPLING: usize = 0x1C;
const CALIBRATION: usize = 0x31;
const COMMAND: usize = 0x7E;

const READY_FOR_COMMANDS: u8 = 0x10;
const READY_PRESSURE: u8 = 0x20;
const READY_TEMPERATURE: u8 = 0x40;
/// Noise by the code of the samples, Pa rms, without the filter.
const NOISE_PA: [f64; 6] = [3.7, 2.7, 2.0, 1.6, 1.2, 0.9];

/// Content of a real BMP390 from register 0x31 on (from the tests of the crate `bmp390`).
const A_PART: [u8; 21] = [
    0x98, 0x6C, 0xA9, 0x4A, 0xF9, 0xE3, 0x1C, 0x61, 0x16, 0x06, 0x01, 0x51, 0x4A, 0xDE, 0x5D, 0x03, 0xFA,
    0xF9, 0x0E, 0x06, 0xF5,
];

/// A BMP3.
#[derive(Debug)]
pub(super) struct Bmp3 {
    analog: Analog,
    identity: u8,
    /// The factory calibration.
    calibration: [u8; 21],
    registers: [u8; 0x80],
    register: usize,
    /// Whether the next byte that is written is a register.
    is_register: bool,
    conversion: Option<Conversion<()>>,
}

impl Bmp3 {
    pub(super) fn new(mut make: Make<'_>, identity: u8) -> Self {
        let mut calibration = A_PART;
        let zero = f64::from(u16::from_le_bytes([A_PART[11], A_PART[12]]));
        let zero = make.analog.about(zero, 0.003).round() as u16;
        [calibration[11], calibration[12]] = zero.to_le_bytes();
        let mut chip = Self {
            analog: make.analog,
            identity,
            calibration,
            registers: [0; 0x80],
            register: 0,
            is_register: false,
            conversion: None,
        };
        chip.wake_up();
        chip
    }

    fn temperature_c(&self, counts: f64) -> f64 {
        let c = &self.calibration;
        let t1 = f64::from(u16::from_le_bytes([c[0], c[1]])) * 256.0;
        let t2 = f64::from(u16::from_le_bytes([c[2], c[3]])) / 2_f64.powi(30);
        let t3 = f64::from(c[4].cast_signed()) / 2_f64.powi(48);
        t2 * (counts - t1) + t3 * (counts - t1).powi(2)
    }

    fn pressure_pa(&self, counts: f64, t: f64) -> f64 {
        let c = &self.calibration;
        let word = |at: usize| f64::from(i16::from_le_bytes([c[at], c[at + 1]]));
        let unsigned = |at: usize| f64::from(u16::from_le_bytes([c[at], c[at + 1]]));
        let byte = |at: usize| f64::from(c[at].cast_signed());
        let over = |number: f64, power: i32| number / 2_f64.powi(power);
        let (p1, p2) = (over(word(5) - 16_384.0, 20), over(word(7) - 16_384.0, 29));
        let (p3, p4) = (over(byte(9), 32), over(byte(10), 37));
        let (p5, p6) = (over(unsigned(11), -3), over(unsigned(13), 6));
        let (p7, p8) = (over(byte(15), 8), over(byte(16), 15));
        let (p9, p10, p11) = (over(word(17), 48), over(byte(19), 48), over(byte(20), 65));
        let out1 = p5 + p6 * t + p7 * t.powi(2) + p8 * t.powi(3);
        let out2 = counts * (p1 + p2 * t + p3 * t.powi(2) + p4 * t.powi(3));
        out1 + out2 + counts.powi(2) * (p9 + p10 * t) + counts.powi(3) * p11
    }

    /// Codes of the samples, of pressure and temperature.
    fn codes(&self) -> (u8, u8) {
        let both = self.registers[OVERSAMPLING];
        ((both & 7).min(5), (both >> 3 & 7).min(5))
    }

    /// Data sheet, section 3.9.2.
    fn usual_s(&self) -> f64 {
        let (pressure, temperature) = self.codes();
        let time = |first: f64, code: u8| first + 2020.0 * f64::from(1_u8 << code);
        1e-6 * (234.0 + time(392.0, pressure) + time(163.0, temperature))
    }
}

impl EmulatedChip for Bmp3 {
    fn wake_up(&mut self) {
        self.registers = [0; 0x80];
        self.registers[IDENTITY] = self.identity;
        self.registers[STATUS] = READY_FOR_COMMANDS;
        self.registers[EVENT] = 1;
        self.registers[PRESSURE + 2] = 0x80;
        self.registers[TEMPERATURE + 2] = 0x80;
        self.registers[OVERSAMPLING] = 0x02;
        self.registers[CALIBRATION..CALIBRATION + 21].copy_from_slice(&self.calibration);
        self.conversion = None;
    }

    fn point(&mut self, byte: u8, _: u64) {
        self.register = usize::from(byte & 0x7F);
        self.is_register = false;
    }

    /// Pairs of a register and its byte.
    fn write(&mut self, byte: u8, now_ns: u64) {
        if std::mem::replace(&mut self.is_register, true) {
            self.point(byte, now_ns);
            return;
        }
        match self.register {
            COMMAND if byte == 0xB6 => self.wake_up(),
            POWER => {
                self.registers[POWER] = byte;
                if byte & 0x33 == 0x13 {
                    self.registers[STATUS] &= !(READY_PRESSURE | READY_TEMPERATURE);
                    self.conversion = Some(self.analog.begin((), self.usual_s(), now_ns));
                }
            }
            register @ 0x15..=0x1F => self.registers[register] = byte,
            _ => {}
        }
    }

    fn read(&mut self) -> u8 {
        let register = self.register;
        let byte = self.registers[register];
        match register {
            0x04..=0x06 => self.registers[STATUS] &= !READY_PRESSURE,
            0x07..=0x09 => self.registers[STATUS] &= !READY_TEMPERATURE,
            EVENT => self.registers[EVENT] = 0,
            _ => {}
        }
        self.register = (register + 1) % 0x80;
        byte
    }

    fn settle(&mut self, now: &Now<'_>) {
        let Some(conversion) = self.analog.ended(&mut self.conversion, now) else {
            return;
        };
        let noise_pa = NOISE_PA[usize::from(self.codes().0)];
        let felt = self.analog.measure(&conversion, noise_pa, now);
        let most = (1 << 24) - 1;
        let temperature = counts_of(felt.temperature_c, 0, most, |counts| self.temperature_c(counts));
        let t = self.temperature_c(temperature as f64);
        let pressure = counts_of(felt.pressure_pa, 0, most, |counts| self.pressure_pa(counts, t));
        self.registers[PRESSURE..TEMPERATURE].copy_from_slice(&(pressure as u32).to_le_bytes()[..3]);
        self.registers[TEMPERATURE..TEMPERATURE + 3]
            .copy_from_slice(&(temperature as u32).to_le_bytes()[..3]);
        self.registers[STATUS] |= READY_PRESSURE | READY_TEMPERATURE;
        self.registers[POWER] &= !0x30; // in sleep mode again
    }

    fn conversion_s(&self) -> f64 {
        self.analog.time_s(self.usual_s())
    }

    fn lose_calibration(&mut self) {
        self.calibration = [0xFF; 21];
        self.registers[CALIBRATION..CALIBRATION + 21].copy_from_slice(&self.calibration);
    }
}
