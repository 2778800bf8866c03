//! ST's LPS22HB.
//!
//! Source: ST's own driver, lps22hb-pid. The chip compensates by itself.

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;

use super::data::{ChipData, Cost, Speed};
use super::driver::{Command, Conversion, Driver, Progress};
use crate::conversion::{Counts, Sample};
use crate::error::Error;
use crate::line::{Line, signed, u24_le};

const WHO_AM_I: u8 = 0x0F;
/// Rate and data update. The next register starts a measurement.
const CONTROL_1: u8 = 0x10;
const CONTROL_2: u8 = 0x11;
/// Status, pressure (3 bytes), temperature (2 bytes); least significant byte first.
const STATUS: u8 = 0x27;

/// Bits of [`CONTROL_1`]: the bytes of one measurement stay together; no periodic measurements.
const BLOCKS: u8 = 0x02;
/// Bit of [`CONTROL_2`].
const ONE_SHOT: u8 = 0x01;
const RESET: u8 = 0x04;
const COUNTS_UP: u8 = 0x10;
/// Bits of [`STATUS`]: a new pressure and a new temperature.
const READY: u8 = 0x03;
/// Wait after a reset, µs.
const RESET_US: u32 = 2000;

pub(super) const DATA: ChipData = ChipData {
    name: "LPS22HB",
    addresses: &[0x5C, 0x5D],
    range_pa: [26_000.0, 126_000.0],
    // The time from which on the chip is asked: it measures at most 75 times per second.
    speeds: &[Speed::new(1, 13_300, Some(0.75), 0)],
    usual_samples: Some(1),
    knows_its_scale: true,
    identity: 0xB1,
    cost: Cost {
        command: 3,
        collect_clocks: Cost::read_clocks(6),
        is_temperature_apart: false,
    },
};

/// An LPS22HB: one measurement for each command.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lps22hb {
    speed: Speed,
    data: [u8; 5],
}

impl Driver for Lps22hb {
    async fn start<I: I2c, D: DelayNs>(
        data: &'static ChipData,
        speed: Option<Speed>,
        line: &mut Line<'_, I, D>,
    ) -> Result<Self, Error<I::Error>> {
        line.identify(WHO_AM_I, data.identity).await?;
        line.reset(&[CONTROL_2, RESET]).await?;
        line.pause_us(RESET_US).await;
        Ok(Self {
            speed: speed.unwrap_or(data.speeds[0]),
            data: [0; 5],
        })
    }

    fn command(&self, conversion: Conversion) -> Option<Command> {
        let bytes = [CONTROL_1, BLOCKS, COUNTS_UP | ONE_SHOT];
        (conversion == Conversion::Pressure).then(|| Command::new(bytes, self.speed.conversion_us))
    }

    async fn collect<I: I2c, D: DelayNs>(
        &mut self,
        _: Conversion,
        line: &mut Line<'_, I, D>,
    ) -> Result<Progress, Error<I::Error>> {
        let [status, data @ ..] = line.read::<6>(STATUS).await?;
        if status & READY != READY {
            return Ok(Progress::Converting);
        }
        self.data = data;
        Ok(Progress::Done)
    }

    fn sample(&self) -> Sample {
        let [low, middle, high, temperature @ ..] = self.data;
        let counts = Counts::from_be_bytes([high, middle, low]);
        let pressure_pa = signed(u24_le([low, middle, high]), 24) as f32 * (100.0 / 4096.0);
        let temperature_c = f32::from(i16::from_le_bytes(temperature)) / 100.0;
        Sample::scaled(counts, pressure_pa, temperature_c, DATA.range_pa)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conversion::Pressure;

    #[test]
    fn golden_bytes() {
        let driver = Lps22hb {
            speed: DATA.speeds[0],
            data: [0x00, 0x54, 0x3F, 0xC4, 0x09],
        };
        assert_eq!(
            driver.command(Conversion::Pressure).unwrap().bytes(),
            [0x10, 0x02, 0x11]
        );
        let sample = driver.sample();
        assert_eq!(
            (sample.pressure, sample.temperature_c),
            (Pressure::Pascal(101_325.0), 25.0)
        );
    }
}
