//! Bosch's BMP384, BMP388 and BMP390.
//!
//! Source: data sheet BMP390 (DS002-07, rev 1.7) and Bosch's own BMP3_SensorAPI. That API clamps
//! its result to the ends of the range. This driver does not, so that a pressure out of range is
//! visible.

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;

use super::data::{ChipData, Cost, Speed};
use super::driver::{Command, Conversion, Driver, Progress};
use crate::conversion::{Counts, Sample};
use crate::error::Error;
use crate::line::{Line, u24_le};

const IDENTITY: u8 = 0x00;
const ERRORS: u8 = 0x02;
/// Status, then pressure and temperature, three bytes each, least significant byte first.
const STATUS: u8 = 0x03;
const POWER: u8 = 0x1B;
const OVERSAMPLING: u8 = 0x1C;
const CALIBRATION: u8 = 0x31;
const COMMAND: u8 = 0x7E;

const RESET: u8 = 0xB6;
/// Wait after a reset, µs.
const RESET_US: u32 = 3000;
/// Bit of [`ERRORS`]: the chip does not work.
const FATAL: u8 = 0x01;
/// Bits of [`STATUS`]: a new pressure and a new temperature.
const READY: u8 = 0x60;
/// Value of [`POWER`]: one measurement of pressure and temperature.
const FORCED: u8 = 0x13;
/// The value that is read if nothing was measured.
const NOTHING: u32 = 0x80_0000;

pub(super) const DATA_384: ChipData = data("BMP384", 0x50);
pub(super) const DATA_388: ChipData = data("BMP388", 0x50);
pub(super) const DATA_390: ChipData = data("BMP390", 0x60);

const SPEEDS: &[Speed] = &[
    // Each with the number of temperature samples that the data sheet recommends.
    Speed::new(1, 5700, Some(3.7), 0o00),
    Speed::new(2, 7960, Some(2.7), 0o01),
    Speed::new(4, 12_480, Some(2.0), 0o02),
    Speed::new(8, 21_530, Some(1.6), 0o03),
    Speed::new(16, 41_890, Some(1.2), 0o14),
    Speed::new(32, 78_090, Some(0.9), 0o15),
];

const fn data(name: &'static str, identity: u8) -> ChipData {
    ChipData {
        name,
        addresses: &[0x76, 0x77],
        range_pa: [30_000.0, 125_000.0],
        speeds: SPEEDS,
        usual_samples: Some(1),
        knows_its_scale: true,
        identity,
        cost: Cost {
            command: 4,
            collect_clocks: Cost::read_clocks(7),
            is_temperature_apart: false,
        },
    }
}

/// A BMP3 in forced mode: one measurement for each command.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bmp3 {
    data: &'static ChipData,
    speed: Speed,
    calibration: Calibration,
    pressure: u32,
    temperature: u32,
}

impl Driver for Bmp3 {
    async fn start<I: I2c, D: DelayNs>(
        data: &'static ChipData,
        speed: Option<Speed>,
        line: &mut Line<'_, I, D>,
    ) -> Result<Self, Error<I::Error>> {
        line.identify(IDENTITY, data.identity).await?;
        line.reset(&[COMMAND, RESET]).await?;
        line.pause_us(RESET_US).await;
        let [errors] = line.read(ERRORS).await?;
        let calibration = Calibration::of(line.read(CALIBRATION).await?);
        let Some(calibration) = calibration.filter(|_| errors & FATAL == 0) else {
            return Err(Error::Uncalibrated);
        };
        Ok(Self {
            data,
            speed: speed.unwrap_or(data.speeds[0]),
            calibration,
            pressure: 0,
            temperature: 0,
        })
    }

    fn command(&self, conversion: Conversion) -> Option<Command> {
        // Pairs of a register and its value.
        let bytes = [OVERSAMPLING, self.speed.code, POWER, FORCED];
        (conversion == Conversion::Pressure).then(|| Command::new(bytes, self.speed.conversion_us))
    }

    async fn collect<I: I2c, D: DelayNs>(
        &mut self,
        _: Conversion,
        line: &mut Line<'_, I, D>,
    ) -> Result<Progress, Error<I::Error>> {
        let [status, p0, p1, p2, t0, t1, t2] = line.read(STATUS).await?;
        if status & READY != READY {
            return Ok(Progress::Converting);
        }
        self.pressure = u24_le([p0, p1, p2]);
        self.temperature = u24_le([t0, t1, t2]);
        match self.pressure {
            NOTHING => Err(Error::ConversionStuck),
            _ => Ok(Progress::Done),
        }
    }

    fn sample(&self) -> Sample {
        let (pressure_pa, temperature_c) = self.calibration.compensate(self.pressure, self.temperature);
        let [_, counts @ ..] = self.pressure.to_be_bytes();
        Sample::scaled(
            Counts::from_be_bytes(counts),
            pressure_pa as f32,
            temperature_c as f32,
            self.data.range_pa,
        )
    }
}

/// The calibration of a part: the data sheet's parameters, scaled.
#[derive(Clone, Copy, Debug)]
struct Calibration {
    t: [f64; 3],
    p: [f64; 11],
}

impl Calibration {
    /// `None` if the calibration memory was never written.
    fn of(bytes: [u8; 21]) -> Option<Self> {
        if bytes == [0; 21] || bytes == [0xFF; 21] {
            return None;
        }
        let u16_at = |at: usize| f64::from(u16::from_le_bytes([bytes[at], bytes[at + 1]]));
        let i16_at = |at: usize| f64::from(i16::from_le_bytes([bytes[at], bytes[at + 1]]));
        let i8_at = |at: usize| f64::from(bytes[at].cast_signed());
        let two_to = |power: u32| (1_u128 << power) as f64;
        Some(Self {
            t: [
                u16_at(0) * two_to(8),
                u16_at(2) / two_to(30),
                i8_at(4) / two_to(48),
            ],
            p: [
                (i16_at(5) - 16_384.0) / two_to(20),
                (i16_at(7) - 16_384.0) / two_to(29),
                i8_at(9) / two_to(32),
                i8_at(10) / two_to(37),
                u16_at(11) * two_to(3),
                u16_at(13) / two_to(6),
                i8_at(15) / two_to(8),
                i8_at(16) / two_to(15),
                i16_at(17) / two_to(48),
                i8_at(19) / two_to(48),
                i8_at(20) / two_to(65),
            ],
        })
    }

    /// Pressure, Pa, and temperature, °C.
    fn compensate(&self, pressure: u32, temperature: u32) -> (f64, f64) {
        let [t1, t2, t3] = self.t;
        let [p1, p2, p3, p4, p5, p6, p7, p8, p9, p10, p11] = self.p;
        let from_t1 = f64::from(temperature) - t1;
        let t = from_t1 * (t2 + from_t1 * t3);
        let up = f64::from(pressure);
        let offset = p5 + t * (p6 + t * (p7 + t * p8));
        let slope = p1 + t * (p2 + t * (p3 + t * p4));
        (offset + up * (slope + up * (p9 + p10 * t + up * p11)), t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// NVM of a real BMP390 (from the tests of the crate `bmp390`), and the values that Bosch's
    /// sensor API computes.
    const NVM: [u8; 21] = [
        0x98, 0x6C, 0xA9, 0x4A, 0xF9, 0xE3, 0x1C, 0x61, 0x16, 0x06, 0x01, 0x51, 0x4A, 0xDE, 0x5D, 0x03, 0xFA,
        0xF9, 0x0E, 0x06, 0xF5,
    ];

    #[test]
    fn a_real_parts_reading() {
        let calibration = Calibration::of(NVM).unwrap();
        let (pressure_pa, temperature_c) =
            calibration.compensate(u24_le([0xCB, 0xB3, 0x6B]), u24_le([0xD1, 0xBA, 0x82]));
        assert!((pressure_pa - 98_370.566).abs() < 1e-3, "{pressure_pa}");
        assert!((temperature_c - 25.770_745).abs() < 1e-6, "{temperature_c}");
    }

    #[test]
    fn golden_bytes() {
        let driver = Bmp3 {
            data: &DATA_390,
            speed: DATA_390.speeds[4],
            calibration: Calibration::of(NVM).unwrap(),
            pressure: 0,
            temperature: 0,
        };
        let command = driver.command(Conversion::Pressure).unwrap();
        assert_eq!(command.bytes(), [0x1C, 0x0C, 0x1B, 0x13]);
        assert!(Calibration::of([0xFF; 21]).is_none());
    }
}
