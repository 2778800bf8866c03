//! What a failed transaction says: of one taxel, of a switch, or of the bus.

use embedded_hal_async::i2c::{Error as _, I2c};

use super::PhysTac;
use super::phystac::Taxel;
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

    /// Whether transactions go through with all channels closed; without a switch: at all, whoever acknowledges.
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
