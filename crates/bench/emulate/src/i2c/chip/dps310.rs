//! The DPS310: Infineon's driver DPS310-Pressure-Sensor. FIFO, interrupts and the background modes
//! are not emulated.

use super::analog::{Analog, Conversion, counts_of};
use super::emulated_chip::{EmulatedChip, Make};
use super::felt::Now;

const PRESSURE: usize = 0x00;
const TEMPERATURE: usize = 0x03;
const PRESSURE_CONFIGURATION: usize = 0x06;
const TEMPERATURE_CONFIGURATION: usize = 0x07;
const MEASURE: usize = 0x08;
const CONFIGURATION: usize = 0x09;
const RESET: usize = 0x0C;
const IDENTITY: usize = 0x0D;
const COEFFICIENTS: usize = 0x10;
const THERMOMETER: usize = 0x28;
const FUSES: usize = 0x32;

/// Scale factors of results by the code of the number of samples.
const SCALES: [f64; 8] = [
    524_288.0,
    1_572_864.0,
    3_670_016.0,
    7_864_320.0,
    253_952.0,
    516_096.0,
    1_040_384.0,
    2_088_960.0,
];
/// Content of a real part from register 0x10 on, published in a report on Infineon's driver.
const A_PART: [u8; 18] = [
    0x0D, 0xEE, 0xD7, 0x13, 0x7D, 0x8F, 0x24, 0x0C, 0xF7, 0x09, 0x05, 0xA4, 0xDA, 0x1B, 0x00, 0x6F, 0xFA,
    0xF7,
];
/// The same coefficients as numbers: c0, c1, c00, c10, c01, c11, c20, c21, c30.
const ITS_COEFFICIENTS: [f64; 9] = [
    222.0, -297.0, 79_832.0, -56_308.0, -2295.0, 1444.0, -9701.0, 111.0, -1289.0,
];
/// Time from power-up until the coefficients can be read, ns.
const WAKING_NS: u64 = 40_000_000;

/// A DPS310.
#[derive(Debug)]
pub(super) struct Dps310 {
    analog: Analog,
    coefficients: [u8; 18],
    registers: [u8; 0x40],
    register: usize,
    awake_from_ns: Option<u64>,
    conversion: Option<Conversion<u8>>,
}

impl Dps310 {
    pub(super) fn new(make: Make<'_>) -> Self {
        let mut chip = Self {
            analog: make.analog,
            coefficients: A_PART,
            registers: [0; 0x40],
            register: 0,
            awake_from_ns: Some(0),
            conversion: None,
        };
        chip.wake_up();
        chip
    }

    fn pressure_pa(scaled: f64, temperature: f64) -> f64 {
        let [_, _, c00, c10, c01, c11, c20, c21, c30] = ITS_COEFFICIENTS;
        c00 + scaled * (c10 + scaled * (c20 + scaled * c30))
            + temperature * c01
            + temperature * scaled * (c11 + scaled * c21)
    }

    fn code(&self, register: usize) -> usize {
        usize::from(self.registers[register] & 7)
    }

    fn usual_s(&self, measured: u8) -> f64 {
        let register = if measured == 1 {
            PRESSURE_CONFIGURATION
        } else {
            TEMPERATURE_CONFIGURATION
        };
        1e-3 * (2.0 + 1.6 * f64::from(1_u8 << self.code(register)))
    }
}

impl EmulatedChip for Dps310 {
    fn wake_up(&mut self) {
        self.registers = [0; 0x40];
        self.registers[IDENTITY] = 0x10;
        self.registers[FUSES] = 0x02;
        self.registers[THERMOMETER] = 0x80;
        self.awake_from_ns = None;
        self.conversion = None;
    }

    fn point(&mut self, byte: u8, _: u64) {
        self.register = usize::from(byte & 0x3F);
    }

    fn write(&mut self, byte: u8, now_ns: u64) {
        match self.register {
            RESET if byte & 0x0F == 0b1001 => {
                self.wake_up();
                self.awake_from_ns = Some(now_ns + WAKING_NS);
            }
            MEASURE => {
                let measured = byte & 7;
                self.registers[MEASURE] = self.registers[MEASURE] & 0xC0 | measured;
                if matches!(measured, 1 | 2) {
                    self.conversion = Some(self.analog.begin(measured, self.usual_s(measured), now_ns));
                }
            }
            register @ (PRESSURE_CONFIGURATION | TEMPERATURE_CONFIGURATION | CONFIGURATION) => {
                self.registers[register] = byte;
            }
            _ => {}
        }
        self.register = (self.register + 1) % 0x40;
    }

    fn read(&mut self) -> u8 {
        let register = self.register;
        let byte = self.registers[register];
        match register {
            0x02 => self.registers[MEASURE] &= !0x10,
            0x05 => self.registers[MEASURE] &= !0x20,
            _ => {}
        }
        self.register = (register + 1) % 0x40;
        byte
    }

    fn settle(&mut self, now: &Now<'_>) {
        let awake_from_ns = *self.awake_from_ns.get_or_insert(now.ns + WAKING_NS);
        if now.ns >= awake_from_ns && self.registers[MEASURE] & 0xC0 == 0 {
            self.registers[MEASURE] |= 0xC0;
            self.registers[COEFFICIENTS..COEFFICIENTS + 18].copy_from_slice(&self.coefficients);
        }
        let Some(conversion) = self.analog.ended(&mut self.conversion, now) else {
            return;
        };
        let code = self.code(PRESSURE_CONFIGURATION);
        let felt = self
            .analog
            .measure(&conversion, 2.5 / 2_f64.powf(0.5 * code as f64), now);
        let [c0, c1, ..] = ITS_COEFFICIENTS;
        let limit = 1 << 23;
        // The thermometer that was not used for calibration reads another temperature.
        let is_its_own =
            self.registers[TEMPERATURE_CONFIGURATION] & 0x80 == self.registers[THERMOMETER] & 0x80;
        let shown_c = felt.temperature_c - if is_its_own { 0.0 } else { 2.57 };
        if conversion.what == 2 {
            let scale = SCALES[self.code(TEMPERATURE_CONFIGURATION)];
            let counts = counts_of(shown_c, -limit, limit - 1, |counts| {
                0.5 * c0 + c1 * counts / scale
            });
            self.registers[TEMPERATURE..PRESSURE_CONFIGURATION]
                .copy_from_slice(&(counts as i32).to_be_bytes()[1..]);
            self.registers[MEASURE] |= 0x20;
        } else {
            let scale = SCALES[code];
            let scaled_temperature = (felt.temperature_c - 0.5 * c0) / c1;
            let pressure_of = |counts: f64| Self::pressure_pa(counts / scale, scaled_temperature);
            let mut counts = counts_of(felt.pressure_pa, -limit, limit - 1, pressure_of);
            if code > 3 && self.registers[CONFIGURATION] & 0x04 == 0 {
                counts = counts << 40 >> 40; // without the shift bit the sum overflows 24 bits
            }
            self.registers[PRESSURE..TEMPERATURE].copy_from_slice(&(counts as i32).to_be_bytes()[1..]);
            self.registers[MEASURE] |= 0x10;
        }
        self.registers[MEASURE] &= !7;
    }

    fn conversion_s(&self) -> f64 {
        self.analog.time_s(self.usual_s(1))
    }

    fn lose_calibration(&mut self) {
        self.coefficients = [0; 18];
        self.registers[COEFFICIENTS..COEFFICIENTS + 18].fill(0);
    }
}
