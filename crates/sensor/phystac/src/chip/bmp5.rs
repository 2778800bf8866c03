//! Bosch's BMP581 and BMP585.
//!
//! Source: Bosch's own BMP5_SensorAPI. The chips compensate by themselves.

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;

use super::data::{ChipData, Cost, Speed};
use super::driver::{Command, Conversion, Driver, Progress};
use crate::conversion::{Counts, Sample};
use crate::error::Error;
use crate::line::{Line, signed, u24_le};

const IDENTITY: u8 = 0x01;
const INTERRUPT_SOURCE: u8 = 0x15;
/// Temperature, then pressure, three bytes each, least significant byte first.
const DATA_REGISTER: u8 = 0x1D;
/// Reading clears it. The next register is the status.
const INTERRUPT_STATUS: u8 = 0x27;
/// Oversampling. The next register is the mode.
const OVERSAMPLING: u8 = 0x36;
const COMMAND: u8 = 0x7E;

const RESET: u8 = 0xB6;
/// Wait after power-on, µs.
const RESET_US: u32 = 10_000;
/// Bit of [`INTERRUPT_SOURCE`] and [`INTERRUPT_STATUS`]: new data.
const DATA_READY: u8 = 0x01;
/// Bit of [`INTERRUPT_STATUS`]: the chip was powered on or reset.
const WOKE_UP: u8 = 0x10;
/// Bits of the status: the calibration memory is ready; it has an error.
const MEMORY_READY: u8 = 0x02;
const MEMORY_BROKEN: u8 = 0x04;
/// Bit of [`OVERSAMPLING`]: pressure is measured.
const WITH_PRESSURE: u8 = 0x40;
/// Value of the mode: one measurement, never in deep standby.
const FORCED: u8 = 0x82;
/// The value that is read if nothing was measured.
const NOTHING: u32 = 0x7F_FFFF;

pub(super) const DATA_581: ChipData = data("BMP581", 0x50);
pub(super) const DATA_585: ChipData = data("BMP585", 0x51);

const SPEEDS: &[Speed] = &[
    Speed::new(1, 4200, None, 0),
    Speed::new(2, 5200, None, 1),
    Speed::new(4, 7200, None, 2),
    Speed::new(8, 11_200, None, 3),
];

const fn data(name: &'static str, identity: u8) -> ChipData {
    ChipData {
        name,
        addresses: &[0x46, 0x47],
        range_pa: [30_000.0, 125_000.0],
        // Conversion times are not published. These are the times from which on the chip is asked;
        // with one sample it measures 240 times per second.
        speeds: SPEEDS,
        usual_samples: Some(1),
        knows_its_scale: true,
        identity,
        cost: Cost {
            command: 3,
            collect_clocks: Cost::read_clocks(1) + Cost::read_clocks(6),
            is_temperature_apart: false,
        },
    }
}

/// A BMP5 in forced mode: one measurement for each command.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bmp5 {
    data: &'static ChipData,
    speed: Speed,
    pressure: [u8; 3],
    temperature: [u8; 3],
}

impl Driver for Bmp5 {
    async fn start<I: I2c, D: DelayNs>(
        data: &'static ChipData,
        speed: Option<Speed>,
        line: &mut Line<'_, I, D>,
    ) -> Result<Self, Error<I::Error>> {
        line.identify(IDENTITY, data.identity).await?;
        line.reset(&[COMMAND, RESET]).await?; // not acknowledged
        line.pause_us(RESET_US).await;
        let [interrupts, status] = line.read(INTERRUPT_STATUS).await?;
        if interrupts & WOKE_UP == 0 {
            return Err(Error::ConversionStuck); // the chip does not follow the command
        }
        if status & (MEMORY_READY | MEMORY_BROKEN) != MEMORY_READY {
            return Err(Error::Uncalibrated);
        }
        line.write(&[INTERRUPT_SOURCE, DATA_READY]).await?;
        Ok(Self {
            data,
            speed: speed.unwrap_or(data.speeds[0]),
            pressure: [0; 3],
            temperature: [0; 3],
        })
    }

    fn command(&self, conversion: Conversion) -> Option<Command> {
        let bytes = [OVERSAMPLING, WITH_PRESSURE | self.speed.code << 3, FORCED];
        (conversion == Conversion::Pressure).then(|| Command::new(bytes, self.speed.conversion_us))
    }

    async fn collect<I: I2c, D: DelayNs>(
        &mut self,
        _: Conversion,
        line: &mut Line<'_, I, D>,
    ) -> Result<Progress, Error<I::Error>> {
        // The flag is read first: data that are read before it may be older.
        let [interrupts] = line.read(INTERRUPT_STATUS).await?;
        if interrupts & WOKE_UP != 0 {
            return Err(Error::Restarted);
        }
        if interrupts & DATA_READY == 0 {
            return Ok(Progress::Converting);
        }
        let [t0, t1, t2, p0, p1, p2] = line.read(DATA_REGISTER).await?;
        self.temperature = [t0, t1, t2];
        self.pressure = [p0, p1, p2];
        match u24_le(self.pressure) {
            NOTHING => Err(Error::ConversionStuck),
            _ => Ok(Progress::Done),
        }
    }

    fn sample(&self) -> Sample {
        let [low, middle, high] = self.pressure;
        let temperature_c = signed(u24_le(self.temperature), 24) as f32 / 65_536.0;
        let pressure_pa = u24_le(self.pressure) as f32 / 64.0;
        let counts = Counts::from_be_bytes([high, middle, low]);
        Sample::scaled(counts, pressure_pa, temperature_c, self.data.range_pa)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::conversion::Pressure;

    #[test]
    fn golden_bytes() {
        let driver = Bmp5 {
            data: &DATA_585,
            speed: DATA_585.speeds[2],
            pressure: [0x40, 0xF3, 0x62],
            temperature: [0x00, 0x00, 0x19],
        };
        assert_eq!(
            driver.command(Conversion::Pressure).unwrap().bytes(),
            [0x36, 0x50, 0x82]
        );
        let sample = driver.sample();
        assert_eq!(
            (sample.pressure, sample.temperature_c),
            (Pressure::Pascal(101_325.0), 25.0)
        );
        let frost = Bmp5 {
            temperature: [0x00, 0x80, 0xFF],
            ..driver
        };
        assert_eq!(frost.sample().temperature_c, -0.5);
    }
}
