//! The TCA9548A.

/// The switch: one register, which opens a channel for each bit.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Switch {
    mask: u8,
    /// The byte written in this transaction; it counts from STOP on.
    written: Option<u8>,
}

impl Switch {
    pub(super) fn mask(self) -> u8 {
        self.mask
    }

    pub(super) fn write(&mut self, byte: u8) {
        self.written = Some(byte);
    }

    pub(super) fn stop(&mut self) {
        self.mask = self.written.take().unwrap_or(self.mask);
    }

    /// RESET, or power that comes back.
    pub(super) fn reset(&mut self) {
        *self = Self::default();
    }
}
