//! I2C0, and its pins while the bus hangs.

use embassy_rp::Peri;
use embassy_rp::bind_interrupts;
use embassy_rp::gpio::{Level, OutputOpenDrain};
use embassy_rp::i2c::{Async, Config, Error, I2c, InterruptHandler};
use embassy_rp::peripherals::{I2C0, PIN_4, PIN_5};
use embassy_time::Delay;
use embedded_hal_async::i2c::{ErrorType, I2c as Transactions, Operation};
use phystac::recovery::{RecoveryError, free_bus};

bind_interrupts!(struct Irqs {
    I2C0_IRQ => InterruptHandler<I2C0>;
});

/// I2C0 on GP4 (SDA) and GP5 (SCL).
///
/// The peripheral is set up again for each transaction, which takes some microseconds. A
/// transaction that was given up half-way therefore has no effect on the next one, and between
/// transactions the pins are free for the recovery of the bus.
pub(crate) struct Bus {
    pub(crate) i2c: Peri<'static, I2C0>,
    pub(crate) sda: Peri<'static, PIN_4>,
    pub(crate) scl: Peri<'static, PIN_5>,
    pub(crate) bus_hz: u32,
}

impl Bus {
    fn open(&mut self) -> I2c<'_, I2C0, Async> {
        let mut config = Config::default();
        config.frequency = self.bus_hz;
        let (scl, sda) = (self.scl.reborrow(), self.sda.reborrow());
        I2c::new_async(self.i2c.reborrow(), scl, sda, Irqs, config)
    }

    /// Sends nine clock pulses and a STOP.
    pub(crate) fn clock_out(&mut self) -> Result<(), RecoveryError> {
        let mut scl = OutputOpenDrain::new(self.scl.reborrow(), Level::High);
        let mut sda = OutputOpenDrain::new(self.sda.reborrow(), Level::High);
        free_bus(&mut scl, &mut sda, &mut Delay)
    }
}

impl ErrorType for Bus {
    type Error = Error;
}

impl Transactions for Bus {
    async fn read(&mut self, address: u8, read: &mut [u8]) -> Result<(), Error> {
        Transactions::read(&mut self.open(), address, read).await
    }

    async fn write(&mut self, address: u8, write: &[u8]) -> Result<(), Error> {
        Transactions::write(&mut self.open(), address, write).await
    }

    async fn write_read(&mut self, address: u8, write: &[u8], read: &mut [u8]) -> Result<(), Error> {
        Transactions::write_read(&mut self.open(), address, write, read).await
    }

    async fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), Error> {
        Transactions::transaction(&mut self.open(), address, operations).await
    }
}
