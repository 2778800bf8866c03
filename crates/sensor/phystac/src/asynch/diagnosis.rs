//! What a failed transaction says: of one taxel, of the switch, or of the bus.

use embedded_hal_async::i2c::{Error as _, I2c};

use super::PhysTac;
use super::phystac::Taxel;
use crate::channels::Channels;
use crate::error::Error;
use crate::fault::Fault;

impl<I2C: I2c, D, C, const N: usize> PhysTac<I2C, D, C, N> {
    /// What an error met with one channel open says of its taxel, unless it says more.
    pub(super) async fn fault_of(
        &mut self,
        taxel: Taxel,
        error: Error<I2C::Error>,
    ) -> Result<Fault, Error<I2C::Error>> {
        match error {
            Error::BarometerMissing => {
                // If the channel is closed, nobody answers either.
                let verified = self.switch().verify(taxel.channel).await;
                self.diagnose(Some(taxel), verified).await?;
                Ok(Fault::Missing)
            }
            Error::ConversionStuck => Ok(Fault::Stuck),
            Error::OversamplingRefused { .. } => Ok(Fault::Refused),
            error => match self.diagnose(Some(taxel), Err(error)).await {
                Err(Error::Bus(source)) => Ok(Fault::Bus(source.kind())),
                result => result,
            },
        }
    }

    /// Tells a bus that failed from one that hangs: whether it works with all channels closed.
    ///
    /// `taxel` is the one whose channel was open, if it was one alone.
    pub(super) async fn diagnose<T>(
        &mut self,
        taxel: Option<Taxel>,
        result: Result<T, Error<I2C::Error>>,
    ) -> Result<T, Error<I2C::Error>> {
        let Err(Error::Bus(source)) = result else {
            return result;
        };
        if self.switch().select(Channels::NONE).await.is_ok() {
            return Err(Error::Bus(source));
        }
        let taxel = taxel.map(|Taxel { index, channel }| {
            if self.suspect.replace(index) == Some(index) {
                self.isolated = self.isolated | channel;
            }
            index
        });
        Err(Error::BusHung { taxel, source })
    }
}
