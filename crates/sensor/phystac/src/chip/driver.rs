//! What is asked of a chip's driver.

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;

use super::data::{ChipData, Speed};
use crate::conversion::Sample;
use crate::error::Error;
use crate::line::Line;

/// What a chip converts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Conversion {
    /// Pressure; of a chip that always converts both, temperature as well.
    Pressure,
    /// Temperature, of a chip that converts it apart.
    Temperature,
}

/// The bytes that start a conversion, and how long it takes. All chips at an address that need the same bytes get them at once.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Command {
    bytes: [u8; 4],
    len: usize,
    /// The longest time that the conversion takes, µs. `None`: not published.
    pub(crate) conversion_us: Option<u32>,
}

impl Command {
    /// Up to four bytes.
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

/// How far a conversion is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Progress {
    /// It has not ended yet.
    Converting,
    /// Its result was read.
    Done,
}

/// Speaks to one chip. What starts a conversion carries all that the chip must know where that can be: then one that lost its power
/// between two conversions measures as before.
pub(crate) trait Driver: Copy {
    /// Switches the chip on: who it is, what it was calibrated to, how it is to measure.
    ///
    /// # Errors
    /// [`Error::BarometerMissing`], [`Error::WrongChip`], [`Error::Uncalibrated`], [`Error::ConversionStuck`], [`Error::OversamplingRefused`],
    /// [`Error::Bus`].
    async fn start<I: I2c, D: DelayNs>(
        data: &'static ChipData,
        speed: Option<Speed>,
        line: &mut Line<'_, I, D>,
    ) -> Result<Self, Error<I::Error>>;

    /// What starts a conversion. `None`: the chip has no such conversion.
    fn command(&self, conversion: Conversion) -> Option<Command>;

    /// Whether a conversion is under way. A chip that cannot say so is not.
    ///
    /// # Errors
    /// [`Error::BarometerMissing`], [`Error::Bus`].
    async fn is_busy<I: I2c, D: DelayNs>(&self, line: &mut Line<'_, I, D>) -> Result<bool, Error<I::Error>> {
        let _ = line;
        Ok(false)
    }

    /// Reads what a conversion gave, if it has ended.
    ///
    /// # Errors
    /// [`Error::ConversionStuck`]: there is no result, and none will come. [`Error::Restarted`], [`Error::BarometerMissing`], [`Error::Bus`].
    async fn collect<I: I2c, D: DelayNs>(
        &mut self,
        conversion: Conversion,
        line: &mut Line<'_, I, D>,
    ) -> Result<Progress, Error<I::Error>>;

    /// What was read last.
    fn sample(&self) -> Sample;
}
