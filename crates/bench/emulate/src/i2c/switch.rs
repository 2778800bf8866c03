//! The TCA9548A.

/// The switch: one register, which opens a channel for each bit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Switch {
    address: u8,
    mask: u8,
    /// The byte written in this transaction. It takes effect at STOP.
    written: Option<u8>,
}

impl Switch {
    pub(super) fn new(address: u8) -> Self {
        Self {
            address,
            mask: 0,
            written: None,
        }
    }

    pub(super) fn address(&self) -> u8 {
        self.address
    }

    pub(super) fn mask(self) -> u8 {
        self.mask
    }

    pub(super) fn write(&mut self, byte: u8) {
        self.written = Some(byte);
    }

    pub(super) fn stop(&mut self) {
        self.mask = self.written.take().unwrap_or(self.mask);
    }

    /// RESET, or power-up.
    pub(super) fn reset(&mut self) {
        *self = Self::new(self.address);
    }
}
