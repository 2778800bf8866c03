//! The trait of a chip's driver.

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;

use super::data::{ChipData, Speed};
use crate::conversion::Sample;
use crate::error::Error;
use crate::line::Line;

/// The quantity that a conversion measures.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Conversion {
    /// Pressure. A chip that always converts both quantities converts temperature as well.
    Pressure,
    /// Temperature, for chips that convert it separately.
    Temperature,
}

/// The bytes that start a conversion, and its duration. All chips of one address that need the same
/// bytes get them in one write.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Command {
    bytes: [u8; 4],
    len: usize,
    /// The longest time that the conversion takes, µs. `None`: not published.
    pub(crate) conversion_us: Option<u32>,
}

impl Command {
    /// A command of at most four bytes.
    pub(crate) fn new<const LEN: usize>(bytes: [u8; LEN], conversion_us: Option<u32>) -> Self {
        let mut all = [0; 4];
        all[..LEN].copy_from_slice(&bytes);
        Self {
            bytes: all,
            len: LEN,
            conversion_us,
        }
    }

    pub(crate) fn bytes(&self) -> &[u8] {
        &self.bytes[..self.len]
    }
}

/// Progress of a conversion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Progress {
    /// It has not ended yet.
    Converting,
    /// Its result was read.
    Done,
}

/// The driver of one chip. The command that starts a conversion carries all settings that the chip
/// needs, where the chip allows it: a chip that lost its power between two conversions then
/// measures as before.
pub(crate) trait Driver: Copy {
    /// Starts the chip: checks its identity, reads its calibration, sets how it measures.
    ///
    /// # Errors
    /// [`Error::BarometerMissing`], [`Error::WrongChip`], [`Error::Uncalibrated`],
    /// [`Error::ConversionStuck`], [`Error::OversamplingRefused`], [`Error::Bus`].
    async fn start<I: I2c, D: DelayNs>(
        data: &'static ChipData,
        speed: Option<Speed>,
        line: &mut Line<'_, I, D>,
    ) -> Result<Self, Error<I::Error>>;

    /// The command that starts a conversion. `None`: the chip has no such conversion.
    fn command(&self, conversion: Conversion) -> Option<Command>;

    /// Whether a conversion is in progress. `false` for a chip that has no such flag.
    ///
    /// # Errors
    /// [`Error::BarometerMissing`], [`Error::Bus`].
    async fn is_busy<I: I2c, D: DelayNs>(&self, line: &mut Line<'_, I, D>) -> Result<bool, Error<I::Error>> {
        let _ = line;
        Ok(false)
    }

    /// Reads the result of a conversion, if it has ended.
    ///
    /// # Errors
    /// [`Error::ConversionStuck`]: there is no result, and there will be none.
    /// [`Error::Restarted`], [`Error::BarometerMissing`], [`Error::Bus`].
    async fn collect<I: I2c, D: DelayNs>(
        &mut self,
        conversion: Conversion,
        line: &mut Line<'_, I, D>,
    ) -> Result<Progress, Error<I::Error>>;

    /// The last sample that was read.
    fn sample(&self) -> Sample;
}
