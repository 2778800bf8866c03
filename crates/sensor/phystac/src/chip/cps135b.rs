//! Consensic's CPS135B.
//!
//! Its data sheet is not public. The register map is the one that CFSensor's XGZP6847D and
//! XGZP6897D (data sheet V2.5) and NOVOSENSE's NSA2300 share.

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;

use super::data::{ChipData, Cost, Speed};
use super::driver::{Command, Conversion, Driver, Progress};
use crate::conversion::{Counts, Pressure, Sample};
use crate::error::Error;
use crate::line::Line;

/// Pressure, 3 bytes, then temperature, 2 bytes; most significant byte first.
const DATA_REGISTER: u8 = 0x06;
/// The command, and the flag that a conversion is in progress.
const COMMAND: u8 = 0x30;
/// Input swap, factory gain, and in the lowest three bits the oversampling of the pressure.
const PRESSURE_CONFIGURATION: u8 = 0xA6;
const OVERSAMPLING_BITS: u8 = 0b111;

/// Starts one conversion of temperature, then pressure. Command code 100 would burn the part's
/// one-time programmable memory: no code here can produce it.
const TRIGGER: [u8; 2] = [COMMAND, 0b0000_1010];
/// `Sco` of [`COMMAND`]: a conversion is in progress. The chip clears it at the end.
const CONVERTING: u8 = 0b0000_1000;

pub(super) const DATA: ChipData = ChipData {
    name: "CPS135B",
    addresses: &[0x6D],
    range_pa: [0.0, 1_500_000.0],
    speeds: &[
        speed(256, 0b100),
        speed(512, 0b101),
        speed(1024, 0b000),
        speed(2048, 0b001),
        speed(4096, 0b010),
        speed(8192, 0b011),
        speed(16_384, 0b110),
        speed(32_768, 0b111),
    ],
    usual_samples: None, // as set in the factory
    knows_its_scale: false,
    identity: 0,
    cost: Cost {
        command: 2,
        collect_clocks: Cost::read_clocks(1) + Cost::read_clocks(5),
        is_temperature_apart: false,
    },
};

const fn speed(samples: u16, code: u8) -> Speed {
    Speed {
        samples,
        conversion_us: None,
        noise_pa: None,
        code,
    }
}

/// A CPS135B: it converts once for each command, and sleeps otherwise.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cps135b {
    sample: Sample,
}

impl Driver for Cps135b {
    async fn start<I: I2c, D: DelayNs>(
        _: &'static ChipData,
        speed: Option<Speed>,
        line: &mut Line<'_, I, D>,
    ) -> Result<Self, Error<I::Error>> {
        let driver = Self {
            sample: Sample {
                counts: Counts::from_be_bytes([0; 3]),
                pressure: Pressure::Unscaled,
                temperature_c: 0.0,
            },
        };
        while driver.is_busy(line).await? {
            line.wait().await?;
        }
        if let Some(speed) = speed {
            let [configuration] = line.read(PRESSURE_CONFIGURATION).await?;
            let wrote = configured(configuration, speed.code);
            line.write(&[PRESSURE_CONFIGURATION, wrote]).await?;
            let [found] = line.read(PRESSURE_CONFIGURATION).await?;
            if found != wrote {
                return Err(Error::OversamplingRefused { wrote, found });
            }
        }
        Ok(driver)
    }

    fn command(&self, conversion: Conversion) -> Option<Command> {
        (conversion == Conversion::Pressure).then(|| Command::new(TRIGGER, None))
    }

    async fn is_busy<I: I2c, D: DelayNs>(&self, line: &mut Line<'_, I, D>) -> Result<bool, Error<I::Error>> {
        let [command] = line.read(COMMAND).await?;
        Ok(command & CONVERTING != 0)
    }

    async fn collect<I: I2c, D: DelayNs>(
        &mut self,
        _: Conversion,
        line: &mut Line<'_, I, D>,
    ) -> Result<Progress, Error<I::Error>> {
        if self.is_busy(line).await? {
            return Ok(Progress::Converting);
        }
        let data = line.read(DATA_REGISTER).await?;
        self.sample = sample(data).ok_or(Error::ConversionStuck)?;
        Ok(Progress::Done)
    }

    fn sample(&self) -> Sample {
        self.sample
    }
}

/// The value of [`PRESSURE_CONFIGURATION`] for an oversampling. The upper bits are set in the
/// factory and kept.
const fn configured(configuration: u8, code: u8) -> u8 {
    configuration & !OVERSAMPLING_BITS | code
}

/// The sample in the five bytes read from [`DATA_REGISTER`]. `None` if all are zero: a part holds
/// zeros after power-on until its first conversion.
///
/// A pressure of 0 counts at exactly 0 °C would look the same, but free air does not read 0.
fn sample(data: [u8; 5]) -> Option<Sample> {
    let [high, middle, low, temperature @ ..] = data;
    (data != [0; 5]).then(|| Sample {
        counts: Counts::from_be_bytes([high, middle, low]),
        pressure: Pressure::Unscaled,
        temperature_c: f32::from(i16::from_be_bytes(temperature)) / 256.0,
    })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    #[test]
    fn golden_bytes() {
        assert_eq!(TRIGGER, [0x30, 0x0A]);
        let sample = sample([0x31, 0x79, 0x80, 0x19, 0x80]).unwrap();
        assert_eq!(sample.counts.unsigned(), 3_242_368);
        assert_eq!(sample.temperature_c, 25.5);
    }

    proptest! {
        #[test]
        fn oversampling_keeps_the_factorys_bits(configuration: u8, code in 0_u8..8) {
            let written = configured(configuration, code);
            prop_assert_eq!(written & 7, code);
            prop_assert_eq!(written & !7, configuration & !7);
        }

        #[test]
        fn any_five_bytes_but_zeros_are_a_sample(data: [u8; 5]) {
            let Some(sample) = sample(data) else {
                prop_assert_eq!(data, [0; 5]);
                return Ok(());
            };
            let [a, b, c, d, e] = data;
            prop_assert_eq!(sample.counts.unsigned(), u32::from_be_bytes([0, a, b, c]));
            prop_assert_eq!(sample.temperature_c * 256.0, f32::from(i16::from_be_bytes([d, e])));
        }
    }
}
