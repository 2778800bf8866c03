//! The MS5837-30BA and -02BA: data sheets REV C2 and REV A8, 12/2019.

use super::analog::{Analog, Conversion, counts_of};
use super::emulated_chip::{EmulatedChip, Make};
use super::felt::Now;

const RESET: u8 = 0x1E;
const READ: u8 = 0x00;
/// Codes of conversions. The lower bits are twice the code of the samples.
const PRESSURE: u8 = 0x40;
const TEMPERATURE: u8 = 0x50;

/// By the code of the samples: typical times, s, and noise, Pa rms.
const TIMES_S: [f64; 6] = [0.54e-3, 1.06e-3, 2.08e-3, 4.13e-3, 8.22e-3, 16.44e-3];
const NOISE_30BA_PA: [f64; 6] = [157.0, 84.0, 54.0, 38.0, 28.0, 20.0];
const NOISE_02BA_PA: [f64; 6] = [11.0, 6.2, 3.9, 2.8, 2.1, 1.6];

/// An MS5837.
#[derive(Debug)]
pub(super) struct Ms5837 {
    analog: Analog,
    is_30_bar: bool,
    /// The factory calibration.
    prom: [u16; 7],
    /// Whether a reset has loaded the PROM.
    is_loaded: bool,
    /// The bytes that are still to be read.
    answer: Vec<u8>,
    result: u32,
    conversion: Option<Conversion<u8>>,
}

impl Ms5837 {
    pub(super) fn new(mut make: Make<'_>, is_30_bar: bool) -> Self {
        // The coefficients of the data sheets' examples, with a spread between parts.
        let (product, words) = match is_30_bar {
            true => (
                0x0340,
                [34_982.0, 36_352.0, 20_328.0, 22_354.0, 26_646.0, 26_146.0],
            ),
            false => (
                0x02A0,
                [46_372.0, 43_981.0, 29_059.0, 27_842.0, 31_553.0, 28_165.0],
            ),
        };
        let mut prom = [product, 0, 0, 0, 0, 0, 0];
        for (word, usual) in prom[1..].iter_mut().zip(words) {
            *word = make.analog.about(usual, 0.003).round() as u16;
        }
        prom[0] |= check(prom) << 12;
        Self {
            analog: make.analog,
            is_30_bar,
            prom,
            is_loaded: false,
            answer: Vec::new(),
            result: 0,
            conversion: None,
        }
    }

    /// Temperature, °C, from the converter's counts.
    fn temperature_c(&self, counts: f64) -> f64 {
        self.second_order(counts).0
    }

    fn pressure_pa(&self, counts: f64, temperature: f64) -> f64 {
        let (_, offset, sensitivity) = self.second_order(temperature);
        let raw = counts * sensitivity / 2_f64.powi(21) - offset;
        if self.is_30_bar {
            10.0 * raw / 2_f64.powi(13)
        } else {
            raw / 2_f64.powi(15)
        }
    }

    /// Temperature, °C, offset and sensitivity.
    fn second_order(&self, counts: f64) -> (f64, f64, f64) {
        let [_, c1, c2, c3, c4, c5, c6] = self.prom.map(f64::from);
        let two = |power: i32| 2_f64.powi(power);
        let dt = counts - c5 * two(8);
        let temp = 2000.0 + dt * c6 / two(23);
        let below = temp - 2000.0;
        let (ti, offset, sensitivity) = if self.is_30_bar {
            let (offset, sensitivity) = (c2 * two(16) + c4 * dt / two(7), c1 * two(15) + c3 * dt / two(8));
            if below < 0.0 {
                let frost = (-1500.0 - temp).max(0.0).powi(2);
                let (off, sens) = (
                    1.5 * below * below + 7.0 * frost,
                    0.625 * below * below + 4.0 * frost,
                );
                (3.0 * dt * dt / two(33), offset - off, sensitivity - sens)
            } else {
                (
                    2.0 * dt * dt / two(37),
                    offset - below * below / 16.0,
                    sensitivity,
                )
            }
        } else {
            let (offset, sensitivity) = (c2 * two(17) + c4 * dt / two(6), c1 * two(16) + c3 * dt / two(7));
            if below < 0.0 {
                let (off, sens) = (31.0 * below * below / 8.0, 63.0 * below * below / 32.0);
                (11.0 * dt * dt / two(35), offset - off, sensitivity - sens)
            } else {
                (0.0, offset, sensitivity)
            }
        };
        ((temp - ti) / 100.0, offset, sensitivity)
    }
}

impl EmulatedChip for Ms5837 {
    fn wake_up(&mut self) {
        self.is_loaded = false;
        self.result = 0;
        self.conversion = None;
        self.answer.clear();
    }

    fn point(&mut self, byte: u8, now_ns: u64) {
        self.answer.clear();
        let spoiled = self.conversion.is_some();
        match byte {
            RESET => {
                self.wake_up();
                self.is_loaded = true;
            }
            0xA0..=0xAC if byte.is_multiple_of(2) => {
                let word = self.prom[usize::from(byte - 0xA0) / 2];
                self.answer
                    .extend((if self.is_loaded { word } else { 0 }).to_be_bytes());
            }
            PRESSURE..=0x4A | TEMPERATURE..=0x5A if byte.is_multiple_of(2) => {
                // A conversion command during another conversion spoils the result.
                let code = usize::from(byte & 0x0F) / 2;
                self.result = 0;
                let begun = self.analog.begin(byte, TIMES_S[code], now_ns);
                self.conversion = (!spoiled && self.is_loaded).then_some(begun);
            }
            READ => {
                // A read that comes too early returns zero and loses the result. A second read
                // returns zero.
                self.conversion = None;
                let [_, bytes @ ..] = std::mem::take(&mut self.result).to_be_bytes();
                self.answer.extend(bytes);
            }
            _ => {}
        }
        self.answer.reverse();
    }

    fn write(&mut self, _: u8, _: u64) {}

    fn read(&mut self) -> u8 {
        self.answer.pop().unwrap_or(0)
    }

    fn settle(&mut self, now: &Now<'_>) {
        let Some(conversion) = self.analog.ended(&mut self.conversion, now) else {
            return;
        };
        let code = usize::from(conversion.what & 0x0F) / 2;
        let noise_pa = if self.is_30_bar {
            NOISE_30BA_PA
        } else {
            NOISE_02BA_PA
        }[code];
        let felt = self.analog.measure(&conversion, noise_pa, now);
        let most = (1 << 24) - 1;
        let temperature = counts_of(felt.temperature_c, 1, most, |counts| self.temperature_c(counts));
        self.result = match conversion.what & 0xF0 {
            TEMPERATURE => temperature as u32,
            _ => counts_of(felt.pressure_pa, 1, most, |counts| {
                self.pressure_pa(counts, temperature as f64)
            }) as u32,
        };
    }

    fn conversion_s(&self) -> f64 {
        self.analog.time_s(TIMES_S[0])
    }

    fn lose_calibration(&mut self) {
        self.prom[3] ^= 0x0100;
    }
}

/// The checksum of the PROM: a remainder of four bits, over 16 bytes.
fn check(prom: [u16; 7]) -> u16 {
    let words = prom
        .iter()
        .enumerate()
        .map(|(index, word)| if index == 0 { word & 0x0FFF } else { *word });
    let bytes = words.chain([0]).flat_map(u16::to_be_bytes);
    let remainder = bytes.fold(0_u16, |remainder, byte| {
        (0..8).fold(remainder ^ u16::from(byte), |bits, _| match bits & 0x8000 {
            0 => bits << 1,
            _ => bits << 1 ^ 0x3000,
        })
    });
    remainder >> 12
}
