//! Infineon's DPS310.
//!
//! Source: Infineon's own driver, DPS310-Pressure-Sensor. Linux's driver differs in the bits of
//! register 0x09; this driver follows Infineon's.

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;

use super::data::{ChipData, Cost, Speed};
use super::driver::{Command, Conversion, Driver, Progress};
use crate::conversion::{Counts, Sample};
use crate::error::Error;
use crate::line::{Line, signed, u24_be};

/// Pressure and temperature, three bytes each, most significant byte first; then the two registers
/// below.
const DATA_REGISTER: u8 = 0x00;
const PRESSURE_CONFIGURATION: u8 = 0x06;
const TEMPERATURE_CONFIGURATION: u8 = 0x07;
const MEASURE: u8 = 0x08;
const CONFIGURATION: u8 = 0x09;
const RESET_REGISTER: u8 = 0x0C;
const IDENTITY: u8 = 0x0D;
const COEFFICIENTS: u8 = 0x10;
/// Highest bit: which of its two thermometers the chip was calibrated with.
const THERMOMETER: u8 = 0x28;
/// Bit 1: whether the thermometer's setting was loaded.
const FUSES: u8 = 0x32;

const RESET: u8 = 0b1001;
/// Wait after a reset, µs. The coefficients are available after at most 40 ms.
const RESET_US: u32 = 50_000;
/// Bits of [`MEASURE`]: coefficients and sensor are ready.
const WOKE_UP: u8 = 0xC0;
const TEMPERATURE_READY: u8 = 0x20;
const PRESSURE_READY: u8 = 0x10;
/// What the chip measures now; 0: nothing.
const MEASURING: u8 = 0x07;
const MEASURE_PRESSURE: u8 = 1;
const MEASURE_TEMPERATURE: u8 = 2;
/// Bits of [`CONFIGURATION`]: sums of more than eight samples are shifted to fit.
const PRESSURE_SHIFT: u8 = 0x04;
/// The lowest code of samples that needs the shift.
const SHIFTED: u8 = 4;

/// Divisor of a measurement, by the code of samples.
const SCALES: [f32; 8] = [
    524_288.0,
    1_572_864.0,
    3_670_016.0,
    7_864_320.0,
    253_952.0,
    516_096.0,
    1_040_384.0,
    2_088_960.0,
];
/// Conversion time of a temperature of one sample, µs.
const TEMPERATURE_US: u32 = 3600;

pub(super) const DATA: ChipData = ChipData {
    name: "DPS310",
    addresses: &[0x77, 0x76],
    range_pa: [30_000.0, 120_000.0],
    speeds: &[
        Speed::new(1, 3600, None, 0),
        Speed::new(2, 5200, None, 1),
        Speed::new(4, 8400, None, 2),
        Speed::new(8, 14_800, None, 3),
        Speed::new(16, 27_600, None, 4),
        Speed::new(32, 53_200, None, 5),
        Speed::new(64, 104_400, Some(0.5), 6),
        Speed::new(128, 206_800, None, 7),
    ],
    usual_samples: Some(2),
    knows_its_scale: true,
    identity: 0x10,
    cost: Cost {
        command: 2,
        collect_clocks: Cost::read_clocks(1) + Cost::read_clocks(8),
        is_temperature_apart: true,
    },
};

/// A DPS310: it measures pressure and temperature one after the other.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Dps310 {
    speed: Speed,
    coefficients: Coefficients,
    /// Expected content of the two configuration registers.
    configuration: [u8; 2],
    pressure: [u8; 3],
    temperature: [u8; 3],
}

impl Driver for Dps310 {
    async fn start<I: I2c, D: DelayNs>(
        data: &'static ChipData,
        speed: Option<Speed>,
        line: &mut Line<'_, I, D>,
    ) -> Result<Self, Error<I::Error>> {
        line.identify(IDENTITY, data.identity).await?;
        line.reset(&[RESET_REGISTER, RESET]).await?;
        line.pause_us(RESET_US).await;
        let [woke_up] = line.read(MEASURE).await?;
        if woke_up & WOKE_UP != WOKE_UP {
            return Err(Error::ConversionStuck);
        }
        let coefficients = Coefficients::of(line.read(COEFFICIENTS).await?).ok_or(Error::Uncalibrated)?;
        let [fuses] = line.read(FUSES).await?;
        if fuses & 2 == 0 {
            // Without these writes some parts read 60 °C (Infineon's driver).
            for write in [
                [0x0E, 0xA5],
                [0x0F, 0x96],
                [0x62, 0x02],
                [0x0E, 0x00],
                [0x0F, 0x00],
            ] {
                line.write(&write).await?;
            }
        }
        let [thermometer] = line.read(THERMOMETER).await?;
        let speed = speed.unwrap_or(data.speeds[0]);
        let shift = if speed.code >= SHIFTED { PRESSURE_SHIFT } else { 0 };
        let configuration = [speed.code, thermometer & 0x80];
        line.write(&[PRESSURE_CONFIGURATION, configuration[0]]).await?;
        line.write(&[TEMPERATURE_CONFIGURATION, configuration[1]]).await?;
        line.write(&[CONFIGURATION, shift]).await?;
        let mut driver = Self {
            speed,
            coefficients,
            configuration,
            pressure: [0; 3],
            temperature: [0; 3],
        };
        // The first pressure needs a temperature.
        line.write(&[MEASURE, MEASURE_TEMPERATURE]).await?;
        line.pause_us(TEMPERATURE_US).await;
        while driver.collect(Conversion::Temperature, line).await? == Progress::Converting {
            line.wait().await?;
        }
        Ok(driver)
    }

    fn command(&self, conversion: Conversion) -> Option<Command> {
        Some(match conversion {
            Conversion::Pressure => Command::new([MEASURE, MEASURE_PRESSURE], self.speed.conversion_us),
            Conversion::Temperature => Command::new([MEASURE, MEASURE_TEMPERATURE], Some(TEMPERATURE_US)),
        })
    }

    async fn collect<I: I2c, D: DelayNs>(
        &mut self,
        conversion: Conversion,
        line: &mut Line<'_, I, D>,
    ) -> Result<Progress, Error<I::Error>> {
        // The flags are read first: reading the data clears them.
        let [measure] = line.read(MEASURE).await?;
        let ready = match conversion {
            Conversion::Pressure => PRESSURE_READY,
            Conversion::Temperature => TEMPERATURE_READY,
        };
        if measure & ready == 0 {
            return match measure & MEASURING {
                0 => Err(Error::Restarted), // no measurement was commanded since its start
                _ => Ok(Progress::Converting),
            };
        }
        let [p0, p1, p2, t0, t1, t2, configuration @ ..] = line.read::<8>(DATA_REGISTER).await?;
        if configuration != self.configuration {
            return Err(Error::Restarted); // its values have another scale
        }
        match conversion {
            Conversion::Pressure => self.pressure = [p0, p1, p2],
            Conversion::Temperature => self.temperature = [t0, t1, t2],
        }
        Ok(Progress::Done)
    }

    fn sample(&self) -> Sample {
        let scaled = |bytes: [u8; 3], code: u8| signed(u24_be(bytes), 24) as f32 / SCALES[usize::from(code)];
        let (pressure_pa, temperature_c) = self.coefficients.compensate(
            scaled(self.pressure, self.speed.code),
            scaled(self.temperature, 0),
        );
        Sample::scaled(
            Counts::from_be_bytes(self.pressure),
            pressure_pa,
            temperature_c,
            DATA.range_pa,
        )
    }
}

/// The calibration of a part.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Coefficients {
    c0: f32,
    c1: f32,
    c00: f32,
    c10: f32,
    c01: f32,
    c11: f32,
    c20: f32,
    c21: f32,
    c30: f32,
}

impl Coefficients {
    /// From a bit string, most significant bit first. `None` if the coefficients were never
    /// written.
    fn of(bytes: [u8; 18]) -> Option<Self> {
        if bytes == [0; 18] || bytes == [0xFF; 18] {
            return None;
        }
        let mut at = 0;
        let mut next = |bits: u32| {
            let mut number = 0;
            for bit in at..at + bits as usize {
                number = number << 1 | u32::from(bytes[bit / 8] >> (7 - bit % 8) & 1);
            }
            at += bits as usize;
            signed(number, bits) as f32
        };
        Some(Self {
            c0: next(12),
            c1: next(12),
            c00: next(20),
            c10: next(20),
            c01: next(16),
            c11: next(16),
            c20: next(16),
            c21: next(16),
            c30: next(16),
        })
    }

    /// Pressure, Pa, and temperature, °C.
    fn compensate(&self, pressure: f32, temperature: f32) -> (f32, f32) {
        let Self {
            c0,
            c1,
            c00,
            c10,
            c01,
            c11,
            c20,
            c21,
            c30,
        } = *self;
        let (p, t) = (pressure, temperature);
        let pressure_pa = c00 + p * (c10 + p * (c20 + p * c30)) + t * c01 + t * p * (c11 + p * c21);
        (pressure_pa, 0.5 * c0 + c1 * t)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Coefficients of a part, published in an issue report on Infineon's driver.
    const BYTES: [u8; 18] = [
        0x0D, 0xEE, 0xD7, 0x13, 0x7D, 0x8F, 0x24, 0x0C, 0xF7, 0x09, 0x05, 0xA4, 0xDA, 0x1B, 0x00, 0x6F, 0xFA,
        0xF7,
    ];

    #[test]
    fn a_real_parts_coefficients() {
        let expected = Coefficients {
            c0: 222.0,
            c1: -297.0,
            c00: 79_832.0,
            c10: -56_308.0,
            c01: -2295.0,
            c11: 1444.0,
            c20: -9701.0,
            c21: 111.0,
            c30: -1289.0,
        };
        assert_eq!(Coefficients::of(BYTES), Some(expected));
        assert_eq!(Coefficients::of([0; 18]), None);
    }

    #[test]
    fn golden_bytes() {
        let number = |number: i32| {
            let [_, bytes @ ..] = number.to_be_bytes();
            bytes
        };
        let driver = Dps310 {
            speed: DATA.speeds[0],
            coefficients: Coefficients::of(BYTES).unwrap(),
            configuration: [0, 0x80],
            pressure: number(-200_000),
            temperature: number(150_000),
        };
        let (pressure_pa, temperature_c) = driver
            .coefficients
            .compensate(-200_000.0 / SCALES[0], 150_000.0 / SCALES[0]);
        assert!((pressure_pa - 99_162.09).abs() < 0.02, "{pressure_pa}");
        assert!((temperature_c - 26.0276).abs() < 1e-4, "{temperature_c}");
        assert_eq!(
            driver.sample().pressure,
            crate::conversion::Pressure::Pascal(pressure_pa)
        );
        let bytes = |conversion| driver.command(conversion).unwrap();
        assert_eq!(bytes(Conversion::Pressure).bytes(), [0x08, 0x01]);
        assert_eq!(bytes(Conversion::Temperature).bytes(), [0x08, 0x02]);
    }
}
