//! The I²C bus of a computer that runs Linux, such as a Raspberry Pi: `/dev/i2c-N`.

use std::fmt;
use std::path::Path;

use embedded_hal::i2c::{ErrorKind, ErrorType, I2c, NoAcknowledgeSource, Operation};
use linux_embedded_hal::i2cdev::linux::LinuxI2CError;
use linux_embedded_hal::{Delay, I2CError, I2cdev};
use phystac::{PhysTac, Settings};

use crate::{BoxedClock, SourceError, TAXELS};

/// Adapters report a missing acknowledgement by two error numbers (Linux, i2c/fault-codes). This
/// one is unknown to `linux-embedded-hal`, and it is the one of a Raspberry Pi.
const EREMOTEIO: i32 = 121;
const ETIMEDOUT: i32 = 110;

/// An I²C bus of Linux.
pub struct LinuxBus(I2cdev);

/// Why a transaction on the bus failed.
pub struct LinuxBusError(I2CError);

/// The driver on an I²C bus of Linux.
pub type LinuxPhysTac = PhysTac<LinuxBus, Delay, BoxedClock, TAXELS>;

/// Creates the driver of a described sensor on `/dev/i2c-N`. Nothing is sent yet.
///
/// # Errors
/// The bus cannot be opened.
pub fn open_linux(
    path: &Path,
    settings: Settings<TAXELS>,
    clock: BoxedClock,
) -> Result<LinuxPhysTac, SourceError> {
    let bus = I2cdev::new(path).map_err(|error| SourceError::Open {
        wire: path.display().to_string(),
        problem: error.to_string(),
    })?;
    Ok(PhysTac::new(LinuxBus(bus), Delay, clock, settings))
}

impl ErrorType for LinuxBus {
    type Error = LinuxBusError;
}

impl I2c for LinuxBus {
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), LinuxBusError> {
        I2c::transaction(&mut self.0, address, operations).map_err(LinuxBusError)
    }
}

impl embedded_hal::i2c::Error for LinuxBusError {
    fn kind(&self) -> ErrorKind {
        let code = match self.0.inner() {
            LinuxI2CError::Errno(code) => Some(*code),
            LinuxI2CError::Io(error) => error.raw_os_error(),
        };
        match code {
            Some(EREMOTEIO) => ErrorKind::NoAcknowledge(NoAcknowledgeSource::Unknown),
            Some(ETIMEDOUT) => ErrorKind::Bus,
            _ => self.0.kind(),
        }
    }
}

impl fmt::Debug for LinuxBus {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("LinuxBus")
    }
}

impl fmt::Debug for LinuxBusError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        fmt::Display::fmt(&self.0, f)
    }
}

#[cfg(test)]
mod tests {
    use embedded_hal::i2c::Error;

    use super::*;

    #[test]
    fn nobody_there_is_told_from_a_bus_that_hangs() {
        let kind = |code| LinuxBusError(LinuxI2CError::Errno(code).into()).kind();
        let io = |code| LinuxI2CError::Io(std::io::Error::from_raw_os_error(code));
        assert!(matches!(kind(EREMOTEIO), ErrorKind::NoAcknowledge(_)));
        assert!(matches!(kind(6), ErrorKind::NoAcknowledge(_))); // ENXIO
        assert!(matches!(
            LinuxBusError(io(EREMOTEIO).into()).kind(),
            ErrorKind::NoAcknowledge(_)
        ));
        assert_eq!(kind(ETIMEDOUT), ErrorKind::Bus);
        assert_eq!(kind(5), ErrorKind::Bus); // EIO
    }

    #[test]
    fn a_bus_that_is_not_there_is_named() {
        let settings = Settings::new(phystac::Wiring::new(&[]).unwrap());
        let error = open_linux(Path::new("/dev/i2c-none"), settings, Box::new(|| 0))
            .err()
            .unwrap();
        assert!(error.to_string().contains("/dev/i2c-none"), "{error}");
    }
}
