//! NXP's MPL3115A2, in its barometer mode.
//!
//! Source: data sheet MPL3115A2 (Rev 3.0, 12/2013). The chip compensates by itself. It must be read
//! with a repeated START.

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;

use super::data::{ChipData, Cost, Speed};
use super::driver::{Command, Conversion, Driver, Progress};
use crate::conversion::{Counts, Sample};
use crate::error::Error;
use crate::line::{Line, u24_be};

/// Status, pressure (3 bytes), temperature (2 bytes); most significant byte first.
const STATUS: u8 = 0x00;
const WHO_AM_I: u8 = 0x0C;
const DATA_EVENTS: u8 = 0x13;
const CONTROL: u8 = 0x26;

/// Bits of [`CONTROL`].
const ONE_SHOT: u8 = 0x02;
const RESET: u8 = 0x04;
/// Bit of [`STATUS`]: a new pressure.
const PRESSURE_READY: u8 = 0x04;
/// Value of [`DATA_EVENTS`]: new pressures and temperatures set flags.
const ALL_EVENTS: u8 = 0x07;

/// Wait after a reset, µs: the value of Linux's driver.
const RESET_US: u32 = 50_000;
/// Time from standby to the first valid sample at one sample per pressure, µs.
const TURN_ON_US: u32 = 60_000;

pub(super) const DATA: ChipData = ChipData {
    name: "MPL3115A2",
    addresses: &[0x60],
    range_pa: [20_000.0, 110_000.0],
    speeds: &[
        Speed::new(1, 6000, Some(19.0), 0),
        Speed::new(2, 10_000, None, 1),
        Speed::new(4, 18_000, None, 2),
        Speed::new(8, 34_000, None, 3),
        Speed::new(16, 66_000, None, 4),
        Speed::new(32, 130_000, None, 5),
        Speed::new(64, 258_000, None, 6),
        Speed::new(128, 512_000, Some(1.5), 7),
    ],
    usual_samples: Some(1),
    knows_its_scale: true,
    identity: 0xC4,
    cost: Cost {
        command: 2,
        collect_clocks: Cost::read_clocks(1) + Cost::read_clocks(6),
        is_temperature_apart: false,
    },
};

/// An MPL3115A2: one measurement for each command.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Mpl3115a2 {
    speed: Speed,
    data: [u8; 5],
}

impl Driver for Mpl3115a2 {
    async fn start<I: I2c, D: DelayNs>(
        data: &'static ChipData,
        speed: Option<Speed>,
        line: &mut Line<'_, I, D>,
    ) -> Result<Self, Error<I::Error>> {
        line.identify(WHO_AM_I, data.identity).await?;
        line.reset(&[CONTROL, RESET]).await?; // the reset includes its bus interface, so it may not acknowledge
        line.pause_us(RESET_US).await;
        line.write(&[DATA_EVENTS, ALL_EVENTS]).await?;
        let driver = Self {
            speed: speed.unwrap_or(data.speeds[0]),
            data: [0; 5],
        };
        // The first measurement is wrong and is discarded.
        line.write(&driver.control_bytes()).await?;
        line.pause_us(TURN_ON_US.max(driver.speed.conversion_us.unwrap_or_default()))
            .await;
        while driver.is_busy(line).await? {
            line.wait().await?;
        }
        line.read::<6>(STATUS).await?;
        Ok(driver)
    }

    fn command(&self, conversion: Conversion) -> Option<Command> {
        let command = || Command::new(self.control_bytes(), self.speed.conversion_us);
        (conversion == Conversion::Pressure).then(command)
    }

    async fn is_busy<I: I2c, D: DelayNs>(&self, line: &mut Line<'_, I, D>) -> Result<bool, Error<I::Error>> {
        let [control] = line.read(CONTROL).await?;
        Ok(control & ONE_SHOT != 0)
    }

    async fn collect<I: I2c, D: DelayNs>(
        &mut self,
        _: Conversion,
        line: &mut Line<'_, I, D>,
    ) -> Result<Progress, Error<I::Error>> {
        if self.is_busy(line).await? {
            return Ok(Progress::Converting);
        }
        let [status, data @ ..] = line.read::<6>(STATUS).await?;
        if status & PRESSURE_READY == 0 {
            return Err(Error::Restarted); // the flags are enabled at the start; without them the chip has lost its settings
        }
        self.data = data;
        Ok(Progress::Done)
    }

    fn sample(&self) -> Sample {
        let [high, middle, low, temperature @ ..] = self.data;
        let pressure = [high, middle, low];
        let temperature_c = f32::from(i16::from_be_bytes(temperature)) / 256.0;
        let pressure_pa = u24_be(pressure) as f32 / 64.0;
        Sample::scaled(
            Counts::from_be_bytes(pressure),
            pressure_pa,
            temperature_c,
            DATA.range_pa,
        )
    }
}

impl Mpl3115a2 {
    /// One measurement in standby, in barometer mode.
    const fn control_bytes(&self) -> [u8; 2] {
        [CONTROL, self.speed.code << 3 | ONE_SHOT]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conversion::Pressure;

    #[test]
    fn golden_bytes() {
        let driver = Mpl3115a2 {
            speed: DATA.speeds[4],
            data: [0x62, 0xF3, 0x40, 0x19, 0x80],
        };
        assert_eq!(
            driver.command(Conversion::Pressure).unwrap().bytes(),
            [0x26, 0x22]
        );
        assert_eq!(driver.command(Conversion::Temperature), None);
        let sample = driver.sample();
        assert_eq!(
            (sample.pressure, sample.temperature_c),
            (Pressure::Pascal(101_325.0), 25.5)
        );
    }
}
