//! The lines of the bus as pins, for freeing a hung bus.

use std::convert::Infallible;
use std::sync::{Arc, Mutex};

use embedded_hal::digital::{ErrorType, InputPin, OutputPin};

use super::parts::Parts;
use crate::worker::locked;

/// The bus's clock line as an open-drain pin. Each of its rising edges is a clock.
#[derive(Clone, Debug)]
pub struct ClockLine {
    pub(super) parts: Arc<Mutex<Parts>>,
    pub(super) is_high: bool,
}

/// The bus's data line as an open-drain pin.
#[derive(Clone, Debug)]
pub struct DataLine {
    pub(super) parts: Arc<Mutex<Parts>>,
    pub(super) is_high: bool,
}

/// The switch's RESET, active low.
#[derive(Clone, Debug)]
pub struct ResetLine {
    pub(super) parts: Arc<Mutex<Parts>>,
}

impl ErrorType for ClockLine {
    type Error = Infallible;
}

impl ErrorType for DataLine {
    type Error = Infallible;
}

impl ErrorType for ResetLine {
    type Error = Infallible;
}

impl OutputPin for ClockLine {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.is_high = false;
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        if !std::mem::replace(&mut self.is_high, true) {
            locked(&self.parts).clock();
        }
        Ok(())
    }
}

impl InputPin for ClockLine {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.is_high)
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        Ok(!self.is_high)
    }
}

impl OutputPin for DataLine {
    fn set_low(&mut self) -> Result<(), Infallible> {
        self.is_high = false;
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        self.is_high = true;
        Ok(())
    }
}

impl InputPin for DataLine {
    fn is_high(&mut self) -> Result<bool, Infallible> {
        Ok(self.is_high && !locked(&self.parts).is_held())
    }

    fn is_low(&mut self) -> Result<bool, Infallible> {
        self.is_high().map(|is_high| !is_high)
    }
}

impl OutputPin for ResetLine {
    fn set_low(&mut self) -> Result<(), Infallible> {
        locked(&self.parts).reset();
        Ok(())
    }

    fn set_high(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}
