//! What a failed transaction means: a fault of one taxel, of a switch, or of the bus.

use embedded_hal_async::i2c::{Error as _, I2c};

use super::PhysTac;
use super::phystac::Taxel;
use crate::error::Error;
use crate::fault::Fault;

impl<I2C: I2c, D, C, const N: usize> PhysTac<I2C, D, C, N> {
    /// The fault of a taxel that follows from an error with only its channel open. An error that
    /// concerns more than this taxel is returned as an error.
    pub(super) async fn fault_of(
        &mut self,
        taxel: Taxel,
        error: Error<I2C::Error>,
    ) -> Result<Fault, Error<I2C::Error>> {
        match error {
            Error::BarometerMissing => {
                // If the channel is closed, nothing acknowledges either.
                if let Some((switch, channel)) = taxel.place.behind {
                    let verified = self.switch(switch).verify(channel).await;
                    self.diagnose(Some(taxel), verified).await?;
                }
                Ok(Fault::Missing)
            }
            Error::ConversionStuck => Ok(Fault::Stuck),
            Error::OversamplingRefused { .. } => Ok(Fault::Refused),
            Error::WrongChip { .. } => Ok(Fault::WrongChip),
            Error::Uncalibrated => Ok(Fault::Uncalibrated),
            Error::Restarted => Ok(Fault::Restarted),
            error => match self.diagnose(Some(taxel), Err(error)).await {
                Err(Error::Bus(source)) => Ok(Fault::Bus(source.kind())),
                result => result,
            },
        }
    }

    /// Distinguishes a single failed transaction from a hung bus: the bus works if transactions
    /// succeed with all channels closed.
    ///
    /// `taxel` is the taxel whose channel was open, if only one was.
    pub(super) async fn diagnose<T>(
        &mut self,
        taxel: Option<Taxel>,
        result: Result<T, Error<I2C::Error>>,
    ) -> Result<T, Error<I2C::Error>> {
        let Err(Error::Bus(source)) = result else {
            return result;
        };
        if self.is_alive().await {
            return Err(Error::Bus(source));
        }
        let taxel = taxel.map(|Taxel { index, place }| {
            if self.suspect.replace(index) == Some(index) && place.behind.is_some() {
                self.isolate(place.behind);
            }
            index
        });
        Err(Error::BusHung { taxel, source })
    }

    /// Whether transactions succeed with all channels closed. Without a switch: whether any
    /// transaction succeeds, acknowledged or not.
    async fn is_alive(&mut self) -> bool {
        if self.settings.wiring.switches().next().is_some() {
            return self.close().await.is_ok();
        }
        let Some(first) = self.settings.wiring.taxels().next() else {
            return false;
        };
        let read = self.i2c_mut().read(first.address, &mut [0]).await;
        let read = read.map_err(|source| Error::of_transaction(source, Error::BarometerMissing));
        matches!(read, Ok(()) | Err(Error::BarometerMissing))
    }
}
