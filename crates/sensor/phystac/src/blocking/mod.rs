//! The drivers over [`embedded_hal`].
//!
//! With a blocking bus all futures are ready at once. The protocol is therefore written once, in
//! [`asynch`](crate::asynch), and each of its futures is polled once here. No executor and no waker
//! are needed.

mod phystac;
mod switch;

pub use phystac::PhysTac;
pub use switch::Tca9548a;

use core::pin::pin;
use core::task::{Context, Poll, Waker};

use embedded_hal::i2c::{ErrorType, Operation};

/// A blocking bus or delay as an async one whose futures are ready at once, for code that is
/// written over [`embedded_hal_async`].
#[derive(Clone, Copy, Debug)]
pub struct AtOnce<T>(pub T);

impl<T: ErrorType> ErrorType for AtOnce<T> {
    type Error = T::Error;
}

impl<T: embedded_hal::i2c::I2c> embedded_hal_async::i2c::I2c for AtOnce<T> {
    async fn read(&mut self, address: u8, read: &mut [u8]) -> Result<(), T::Error> {
        self.0.read(address, read)
    }

    async fn write(&mut self, address: u8, write: &[u8]) -> Result<(), T::Error> {
        self.0.write(address, write)
    }

    async fn write_read(&mut self, address: u8, write: &[u8], read: &mut [u8]) -> Result<(), T::Error> {
        self.0.write_read(address, write, read)
    }

    async fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), T::Error> {
        self.0.transaction(address, operations)
    }
}

impl<T: embedded_hal::delay::DelayNs> embedded_hal_async::delay::DelayNs for AtOnce<T> {
    async fn delay_ns(&mut self, ns: u32) {
        self.0.delay_ns(ns);
    }

    async fn delay_us(&mut self, us: u32) {
        self.0.delay_us(us);
    }
}

/// The output of a future that awaits only [`AtOnce`], and so is never pending. Any other future is
/// polled in a loop without sleep.
pub fn now<F: Future>(future: F) -> F::Output {
    let mut future = pin!(future);
    let mut context = Context::from_waker(Waker::noop());
    loop {
        if let Poll::Ready(output) = future.as_mut().poll(&mut context) {
            return output;
        }
    }
}
