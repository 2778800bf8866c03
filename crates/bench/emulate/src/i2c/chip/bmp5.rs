//! The BMP581 and BMP585: Bosch's BMP5_SensorAPI. FIFO, filter and all modes except the forced mode
//! are not emulated.

use super::analog::{Analog, Conversion};
use super::emulated_chip::{EmulatedChip, Make};
use super::felt::Now;

const IDENTITY: usize = 0x01;
const INTERRUPT_SOURCE: usize = 0x15;
const TEMPERATURE: usize = 0x1D;
const PRESSURE: usize = 0x20;
const INTERRUPT_STATUS: usize = 0x27;
const STATUS: usize = 0x28;
const OVERSAMPLING: usize = 0x36;
const MODE: usize = 0x37;
const COMMAND: usize = 0x7E;

const DATA_READY: u8 = 0x01;
const WOKE_UP: u8 = 0x10;
/// How long it does not respond after a reset, ns.
const DEAF_NS: u64 = 2_000_000;

/// A BMP5.
#[derive(Debug)]
pub(super) struct Bmp5 {
    analog: Analog,
    identity: u8,
    /// Whether the memory of its calibration is broken.
    is_broken: bool,
    registers: [u8; 0x80],
    register: usize,
    deaf_until_ns: u64,
    now_ns: u64,
    conversion: Option<Conversion<()>>,
}

impl Bmp5 {
    pub(super) fn new(make: Make<'_>, identity: u8) -> Self {
        let mut chip = Self {
            analog: make.analog,
            identity,
            is_broken: false,
            registers: [0; 0x80],
            register: 0,
            deaf_until_ns: 0,
            now_ns: 0,
            conversion: None,
        };
        chip.wake_up();
        chip
    }

    /// Not published. With one sample it measures at most 240 times a second.
    fn usual_s(&self) -> f64 {
        let code = self.registers[OVERSAMPLING] >> 3 & 7;
        3.1e-3 + 1e-3 * f64::from(1_u8 << code)
    }
}

impl EmulatedChip for Bmp5 {
    fn wake_up(&mut self) {
        self.registers = [0; 0x80];
        self.registers[IDENTITY] = self.identity;
        self.registers[TEMPERATURE..PRESSURE].copy_from_slice(&[0xFF, 0xFF, 0x7F]);
        self.registers[PRESSURE..PRESSURE + 3].copy_from_slice(&[0xFF, 0xFF, 0x7F]);
        self.registers[INTERRUPT_STATUS] = WOKE_UP;
        self.registers[STATUS] = if self.is_broken { 0x06 } else { 0x02 };
        self.registers[MODE] = 0x70;
        self.conversion = None;
    }

    fn point(&mut self, byte: u8, _: u64) {
        self.register = usize::from(byte & 0x7F);
    }

    fn write(&mut self, byte: u8, now_ns: u64) {
        match self.register {
            COMMAND if byte == 0xB6 => {
                self.wake_up();
                self.deaf_until_ns = now_ns + DEAF_NS;
            }
            MODE => {
                self.registers[MODE] = byte;
                if byte & 3 == 2 {
                    self.conversion = Some(self.analog.begin((), self.usual_s(), now_ns));
                }
            }
            register @ (INTERRUPT_SOURCE | 0x30..=0x36) => self.registers[register] = byte,
            _ => {}
        }
        self.register = (self.register + 1) % 0x80;
    }

    fn read(&mut self) -> u8 {
        let register = self.register;
        let byte = self.registers[register];
        if register == INTERRUPT_STATUS {
            self.registers[INTERRUPT_STATUS] = 0;
        }
        self.register = (register + 1) % 0x80;
        byte
    }

    fn acknowledges(&self) -> bool {
        self.now_ns >= self.deaf_until_ns
    }

    fn settle(&mut self, now: &Now<'_>) {
        self.now_ns = now.ns;
        let Some(conversion) = self.analog.ended(&mut self.conversion, now) else {
            return;
        };
        let felt = self.analog.measure(&conversion, 0.1, now);
        let temperature = (65_536.0 * felt.temperature_c).round() as i32;
        self.registers[TEMPERATURE..PRESSURE].copy_from_slice(&temperature.to_le_bytes()[..3]);
        if self.registers[OVERSAMPLING] & 0x40 != 0 {
            let pressure = (64.0 * felt.pressure_pa)
                .round()
                .clamp(0.0, f64::from((1 << 24) - 1)) as u32;
            self.registers[PRESSURE..PRESSURE + 3].copy_from_slice(&pressure.to_le_bytes()[..3]);
        }
        self.registers[INTERRUPT_STATUS] |= self.registers[INTERRUPT_SOURCE] & DATA_READY;
        self.registers[MODE] &= !3; // in standby again
    }

    fn conversion_s(&self) -> f64 {
        self.analog.time_s(self.usual_s())
    }

    fn lose_calibration(&mut self) {
        self.is_broken = true;
        self.registers[STATUS] = 0x06;
    }
}
