//! TE's MS5837-30BA and MS5837-02BA.
//!
//! Source: data sheets MS5837-30BA (REV C2, 12/2019) and MS5837-02BA (REV A8, 12/2019). The chip
//! has no busy flag: only the elapsed time says that a conversion has ended. A result that is read
//! too early is zero.

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;

use super::data::{ChipData, Cost, Speed};
use super::driver::{Command, Conversion, Driver, Progress};
use crate::conversion::{Counts, Sample};
use crate::error::Error;
use crate::line::{Line, u24_be};

const RESET: u8 = 0x1E;
/// The first of the seven words of the PROM, two bytes each.
const PROM: u8 = 0xA0;
const CONVERT_PRESSURE: u8 = 0x40;
const CONVERT_TEMPERATURE: u8 = 0x50;
const READ: u8 = 0x00;
/// Time to load the PROM after a reset, µs. The data sheets give no number; public drivers wait 3
/// to 10 ms.
const RESET_US: u32 = 10_000;

const COST: Cost = Cost {
    command: 1,
    collect_clocks: Cost::read_clocks(3),
    is_temperature_apart: true,
};

pub(super) const DATA_30BA: ChipData = ChipData {
    name: "MS5837-30BA",
    addresses: &[0x76],
    range_pa: [0.0, 3_000_000.0],
    speeds: &[
        Speed::new(256, 600, Some(157.0), 0),
        Speed::new(512, 1170, Some(84.0), 2),
        Speed::new(1024, 2280, Some(54.0), 4),
        Speed::new(2048, 4540, Some(38.0), 6),
        Speed::new(4096, 9040, Some(28.0), 8),
        Speed::new(8192, 18_080, Some(20.0), 10),
    ],
    usual_samples: Some(2048),
    knows_its_scale: true,
    identity: 0x1A,
    cost: COST,
};

pub(super) const DATA_02BA: ChipData = ChipData {
    name: "MS5837-02BA",
    addresses: &[0x76],
    range_pa: [1000.0, 200_000.0], // the converter's linear range; specified for 30 to 120 kPa
    speeds: &[
        Speed::new(256, 560, Some(11.0), 0),
        Speed::new(512, 1100, Some(6.2), 2),
        Speed::new(1024, 2170, Some(3.9), 4),
        Speed::new(2048, 4320, Some(2.8), 6),
        Speed::new(4096, 8610, Some(2.1), 8),
        Speed::new(8192, 17_200, Some(1.6), 10),
    ],
    usual_samples: Some(2048),
    knows_its_scale: true,
    identity: 0x15,
    cost: COST,
};

/// Sensitivities that parts of the model have. They identify the model if word 0 names neither
/// model.
const SENSITIVITIES_30BA: core::ops::Range<u16> = 26_000..37_000;
const SENSITIVITIES_02BA: core::ops::Range<u16> = 37_000..49_000;

/// An MS5837: it converts pressure and temperature one after the other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Ms5837 {
    data: &'static ChipData,
    speed: Speed,
    calibration: Calibration,
    pressure: u32,
    temperature: u32,
}

impl Driver for Ms5837 {
    async fn start<I: I2c, D: DelayNs>(
        data: &'static ChipData,
        speed: Option<Speed>,
        line: &mut Line<'_, I, D>,
    ) -> Result<Self, Error<I::Error>> {
        line.write(&[RESET]).await?;
        line.pause_us(RESET_US).await;
        let mut prom = [0; 7];
        for (index, word) in prom.iter_mut().enumerate() {
            *word = u16::from_be_bytes(line.read(PROM + 2 * index as u8).await?);
        }
        let calibration = Calibration::of(prom, data.name == DATA_30BA.name).ok_or(Error::Uncalibrated)?;
        if !is_model(prom, data) {
            let [_, found] = (prom[0] >> 5 & 0x7F).to_be_bytes();
            return Err(Error::WrongChip { found });
        }
        let mut driver = Self {
            data,
            speed: speed.unwrap_or(data.speeds[0]),
            calibration,
            pressure: 0,
            temperature: 0,
        };
        // The first pressure needs a temperature.
        if let Some(command) = driver.command(Conversion::Temperature) {
            line.write(command.bytes()).await?;
            line.pause_us(command.conversion_us.unwrap_or_default()).await;
            driver.collect(Conversion::Temperature, line).await?;
        }
        Ok(driver)
    }

    fn command(&self, conversion: Conversion) -> Option<Command> {
        let first = match conversion {
            Conversion::Pressure => CONVERT_PRESSURE,
            Conversion::Temperature => CONVERT_TEMPERATURE,
        };
        Some(Command::new([first + self.speed.code], self.speed.conversion_us))
    }

    async fn collect<I: I2c, D: DelayNs>(
        &mut self,
        conversion: Conversion,
        line: &mut Line<'_, I, D>,
    ) -> Result<Progress, Error<I::Error>> {
        let counts = u24_be(line.read(READ).await?);
        if counts == 0 {
            return Err(Error::ConversionStuck); // read too early, or twice, or after a loss of power
        }
        match conversion {
            Conversion::Pressure => self.pressure = counts,
            Conversion::Temperature => self.temperature = counts,
        }
        Ok(Progress::Done)
    }

    fn sample(&self) -> Sample {
        let (pressure_pa, temperature_c) = self.calibration.compensate(self.pressure, self.temperature);
        let [_, counts @ ..] = self.pressure.to_be_bytes();
        Sample::scaled(
            Counts::from_be_bytes(counts),
            pressure_pa,
            temperature_c,
            self.data.range_pa,
        )
    }
}

/// Whether the PROM belongs to this model, by the product number, or else by the sensitivity.
fn is_model(prom: [u16; 7], data: &ChipData) -> bool {
    let (ours, others) = match data.name == DATA_30BA.name {
        true => (DATA_30BA.identity, SENSITIVITIES_02BA),
        false => (DATA_02BA.identity, SENSITIVITIES_30BA),
    };
    prom[0] >> 5 & 0x7F == u16::from(ours) || !others.contains(&prom[1])
}

/// The calibration of a part: words 1 to 6 of its PROM.
#[derive(Clone, Copy, Debug)]
struct Calibration {
    is_30_bar: bool,
    /// C1 to C6.
    c: [i64; 6],
}

impl Calibration {
    /// `None` if the words fail their CRC.
    fn of(prom: [u16; 7], is_30_bar: bool) -> Option<Self> {
        let [first, words @ ..] = prom;
        let is_empty = words == [0; 6]; // whose CRC is correct
        (crc4(prom) == first >> 12 && !is_empty).then(|| Self {
            is_30_bar,
            c: words.map(i64::from),
        })
    }

    /// Pressure, Pa, and temperature, °C, with the data sheets' second-order compensation, without
    /// their last division, which would round.
    fn compensate(&self, pressure: u32, temperature: u32) -> (f32, f32) {
        let [c1, c2, c3, c4, c5, c6] = self.c;
        let difference = i64::from(temperature) - (c5 << 8);
        let first_order = 2000 + ((difference * c6) >> 23);
        let squared = difference * difference;
        let cold = first_order - 2000;
        let (colder, offset, sensitivity) = if self.is_30_bar {
            let offset = (c2 << 16) + ((c4 * difference) >> 7);
            let sensitivity = (c1 << 15) + ((c3 * difference) >> 8);
            let (mut less_offset, mut less_sensitivity) = match cold < 0 {
                true => ((3 * cold * cold) >> 1, (5 * cold * cold) >> 3),
                false => ((cold * cold) >> 4, 0),
            };
            if first_order < -1500 {
                let frost = first_order + 1500;
                less_offset += 7 * frost * frost;
                less_sensitivity += 4 * frost * frost;
            }
            let colder = match cold < 0 {
                true => (3 * squared) >> 33,
                false => (2 * squared) >> 37,
            };
            (colder, offset - less_offset, sensitivity - less_sensitivity)
        } else {
            let offset = (c2 << 17) + ((c4 * difference) >> 6);
            let sensitivity = (c1 << 16) + ((c3 * difference) >> 7);
            match cold < 0 {
                true => (
                    (11 * squared) >> 35,
                    offset - ((31 * cold * cold) >> 3),
                    sensitivity - ((63 * cold * cold) >> 5),
                ),
                false => (0, offset, sensitivity),
            }
        };
        let pressure = ((i64::from(pressure) * sensitivity) >> 21) - offset;
        let pa_per_unit = if self.is_30_bar {
            10.0 / 8192.0
        } else {
            1.0 / 32_768.0
        };
        let temperature = first_order - colder;
        ((pressure as f64 * pa_per_unit) as f32, temperature as f32 / 100.0)
    }
}

/// The CRC of the PROM's words. The field of word 0 that holds the CRC counts as zero.
fn crc4(prom: [u16; 7]) -> u16 {
    let mut words = [0; 8];
    words[..7].copy_from_slice(&prom);
    words[0] &= 0x0FFF;
    let mut remainder: u16 = 0;
    for word in words {
        for byte in word.to_be_bytes() {
            remainder ^= u16::from(byte);
            for _ in 0..8 {
                let carries = remainder & 0x8000 != 0;
                remainder <<= 1;
                if carries {
                    remainder ^= 0x3000;
                }
            }
        }
    }
    remainder >> 12
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The examples of the data sheets.
    const PROM_30BA: [u16; 7] = [0x9340, 34_982, 36_352, 20_328, 22_354, 26_646, 26_146];
    const PROM_02BA: [u16; 7] = [0x52A0, 46_372, 43_981, 29_059, 27_842, 31_553, 28_165];

    #[test]
    fn the_data_sheets_examples() {
        let calibration = Calibration::of(PROM_30BA, true).unwrap();
        let (pressure_pa, temperature_c) = calibration.compensate(4_958_179, 6_815_414);
        assert!((pressure_pa - 399_980.0).abs() < 10.0, "{pressure_pa}"); // 3999.8 mbar
        assert_eq!(temperature_c, 19.81);
        let calibration = Calibration::of(PROM_02BA, false).unwrap();
        let (pressure_pa, temperature_c) = calibration.compensate(6_465_444, 8_077_636);
        assert!((pressure_pa - 110_002.0).abs() < 1.0, "{pressure_pa}"); // 1100.02 mbar
        assert_eq!(temperature_c, 20.0);
    }

    #[test]
    fn a_flipped_bit_fails_the_check_and_so_does_an_empty_prom() {
        for prom in [PROM_30BA, PROM_02BA] {
            for (word, bit) in (0..7).flat_map(|word| (0..16).map(move |bit| (word, bit))) {
                let mut flipped = prom;
                flipped[word] ^= 1 << bit;
                assert!(Calibration::of(flipped, true).is_none(), "word {word}, bit {bit}");
            }
        }
        assert!(Calibration::of([0; 7], true).is_none());
        assert!(Calibration::of([0xFFFF; 7], true).is_none());
    }

    #[test]
    fn models_are_told_apart() {
        assert!(is_model(PROM_30BA, &DATA_30BA) && is_model(PROM_02BA, &DATA_02BA));
        assert!(!is_model(PROM_30BA, &DATA_02BA) && !is_model(PROM_02BA, &DATA_30BA));
        let mut nameless = PROM_30BA;
        nameless[0] = 0;
        assert!(is_model(nameless, &DATA_30BA) && !is_model(nameless, &DATA_02BA));
    }
}
