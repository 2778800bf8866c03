//! A bus with a time limit for each transaction.

use core::fmt;
use core::future::poll_fn;
use core::pin::pin;
use core::task::Poll;

use embedded_hal::i2c::{Error, ErrorKind, ErrorType, Operation};
use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;

/// A bus on which each transaction is given up after a time limit.
///
/// A controller that waits for a line which a part holds low would wait for ever, so its future is
/// dropped at the limit. The bus below must allow that; a bus that starts its peripheral anew for
/// each transaction does.
#[derive(Debug)]
pub(crate) struct Bounded<B, D> {
    bus: B,
    delay: D,
    limit_us: u32,
}

/// Why a transaction failed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum BoundedError<E> {
    /// The error of the bus itself.
    Bus(E),
    /// The transaction did not end in time.
    TimedOut,
}

impl<B, D> Bounded<B, D> {
    /// A bus whose transactions may take `limit_us` µs. The longest transaction of any chip takes 1
    /// ms at 100 kHz.
    pub(crate) const fn new(bus: B, delay: D, limit_us: u32) -> Self {
        Self { bus, delay, limit_us }
    }

    /// The bus below.
    pub(crate) const fn bus_mut(&mut self) -> &mut B {
        &mut self.bus
    }
}

/// The output of a future, or [`TimedOut`](BoundedError::TimedOut) if the limit comes first.
async fn within<T, E>(
    transaction: impl Future<Output = Result<T, E>>,
    limit: impl Future<Output = ()>,
) -> Result<T, BoundedError<E>> {
    let (mut transaction, mut limit) = (pin!(transaction), pin!(limit));
    poll_fn(|context| {
        if let Poll::Ready(ended) = transaction.as_mut().poll(context) {
            return Poll::Ready(ended.map_err(BoundedError::Bus));
        }
        limit.as_mut().poll(context).map(|()| Err(BoundedError::TimedOut))
    })
    .await
}

impl<E: Error> Error for BoundedError<E> {
    fn kind(&self) -> ErrorKind {
        match self {
            Self::Bus(error) => error.kind(),
            Self::TimedOut => ErrorKind::Other,
        }
    }
}

impl<E: fmt::Debug> fmt::Display for BoundedError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Bus(error) => write!(f, "the bus failed: {error:?}"),
            Self::TimedOut => f.write_str("a transaction did not end in time"),
        }
    }
}

impl<E: fmt::Debug> core::error::Error for BoundedError<E> {}

impl<B: ErrorType, D> ErrorType for Bounded<B, D> {
    type Error = BoundedError<B::Error>;
}

impl<B: I2c, D: DelayNs> I2c for Bounded<B, D> {
    async fn read(&mut self, address: u8, read: &mut [u8]) -> Result<(), Self::Error> {
        within(self.bus.read(address, read), self.delay.delay_us(self.limit_us)).await
    }

    async fn write(&mut self, address: u8, write: &[u8]) -> Result<(), Self::Error> {
        within(self.bus.write(address, write), self.delay.delay_us(self.limit_us)).await
    }

    async fn write_read(&mut self, address: u8, write: &[u8], read: &mut [u8]) -> Result<(), Self::Error> {
        let limit = self.delay.delay_us(self.limit_us);
        within(self.bus.write_read(address, write, read), limit).await
    }

    async fn transaction(
        &mut self,
        address: u8,
        operations: &mut [Operation<'_>],
    ) -> Result<(), Self::Error> {
        let limit = self.delay.delay_us(self.limit_us);
        within(self.bus.transaction(address, operations), limit).await
    }
}

#[cfg(test)]
mod tests {
    extern crate std;

    use core::task::{Context, Waker};
    use std::cell::Cell;
    use std::rc::Rc;

    use super::*;

    /// A controller that waits for a line that is held low. It counts how often it was dropped.
    struct Held(Rc<Cell<u32>>);
    struct Dropped(Rc<Cell<u32>>);

    impl Drop for Dropped {
        fn drop(&mut self) {
            self.0.set(self.0.get() + 1);
        }
    }

    impl ErrorType for Held {
        type Error = ErrorKind;
    }

    impl I2c for Held {
        async fn transaction(&mut self, _: u8, _: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
            let _guard = Dropped(Rc::clone(&self.0));
            core::future::pending().await
        }
    }

    /// A delay that takes a number of polls for each ms.
    struct Polls;

    impl DelayNs for Polls {
        async fn delay_ns(&mut self, ns: u32) {
            let mut left = ns / 1_000_000;
            poll_fn(|context| {
                context.waker().wake_by_ref();
                left = left.saturating_sub(1);
                if left == 0 { Poll::Ready(()) } else { Poll::Pending }
            })
            .await;
        }
    }

    #[test]
    fn what_does_not_end_is_given_up_and_dropped() {
        let dropped = Rc::new(Cell::new(0));
        let mut bus = Bounded::new(Held(Rc::clone(&dropped)), Polls, 5000);
        let mut polls = 0;
        let result = {
            let mut read = [0; 3];
            let mut future = pin!(bus.write_read(0x76, &[0], &mut read));
            let mut context = Context::from_waker(Waker::noop());
            loop {
                polls += 1;
                if let Poll::Ready(result) = future.as_mut().poll(&mut context) {
                    break result;
                }
                assert!(polls < 100);
            }
        };
        assert_eq!(
            (result, polls, dropped.get()),
            (Err(BoundedError::TimedOut), 5, 1)
        );
        assert_eq!(BoundedError::<ErrorKind>::TimedOut.kind(), ErrorKind::Other);
    }
}
