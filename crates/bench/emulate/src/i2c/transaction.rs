//! What a transaction does to whom, clock by clock.

use embedded_hal::i2c::{ErrorKind, NoAcknowledgeSource, Operation};

use super::barometer::Barometer;
use super::parts::Parts;
use crate::{FaultKind, Workcell};

/// Every barometer's 7-bit address.
const BAROMETER: u8 = 0x6D;

/// A transaction, byte by byte.
pub(super) struct Transaction<'a> {
    parts: &'a mut Parts,
    workcell: &'a Workcell,
    begun_ns: u64,
    period_ns: f64,
    clocks: u32,
}

impl<'a> Transaction<'a> {
    pub(super) fn begin(parts: &'a mut Parts, workcell: &'a Workcell, begun_ns: u64, period_ns: f64) -> Self {
        Self {
            parts,
            workcell,
            begun_ns,
            period_ns,
            clocks: 0,
        }
    }

    fn now_ns(&self) -> u64 {
        self.begun_ns + (f64::from(self.clocks) * self.period_ns).round() as u64
    }

    pub(super) fn carry_out(
        &mut self,
        address: u8,
        operations: &mut [Operation<'_>],
    ) -> Result<(), ErrorKind> {
        let mut was_reading = None;
        for operation in operations {
            let is_reading = matches!(operation, Operation::Read(_));
            if was_reading != Some(is_reading) {
                self.address(address, is_reading)?;
                was_reading = Some(is_reading);
            }
            match operation {
                Operation::Read(bytes) => bytes.iter_mut().for_each(|byte| *byte = self.read(address)),
                Operation::Write(bytes) => bytes.iter().for_each(|byte| self.write(address, *byte)),
            }
        }
        Ok(())
    }

    /// START and an address.
    fn address(&mut self, address: u8, is_reading: bool) -> Result<(), ErrorKind> {
        self.clocks += 1 + 9;
        let is_heard = self.is_switch(address) || {
            let mut n_heard = 0;
            self.each_barometer(address, |barometer, _| {
                barometer.address(!is_reading);
                n_heard += 1;
            });
            n_heard > 0
        };
        // Whoever hears it pulls the line: one is enough.
        is_heard
            .then_some(())
            .ok_or(ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address))
    }

    fn write(&mut self, address: u8, byte: u8) {
        self.clocks += 9;
        if self.is_switch(address) {
            self.parts.switch.write(byte);
        }
        self.each_barometer(address, |barometer, now_ns| barometer.write(byte, now_ns));
    }

    /// The byte that all who speak make together: a line is low if one of them pulls it.
    fn read(&mut self, address: u8) -> u8 {
        self.clocks += 9;
        let mut byte = if self.is_switch(address) {
            self.parts.switch.mask()
        } else {
            0xFF
        };
        self.each_barometer(address, |barometer, _| byte &= barometer.read());
        byte
    }

    /// STOP; when it is, ns of the lab's clock.
    pub(super) fn stop(&mut self) -> u64 {
        self.clocks += 1;
        self.parts.switch.stop();
        self.now_ns()
    }

    fn is_switch(&self, address: u8) -> bool {
        address == self.parts.switch_address
            && !self
                .parts
                .schedule
                .has(FaultKind::NoAcknowledge { channel: None })
    }

    /// All barometers at the address that are there and on open channels.
    fn each_barometer(&mut self, address: u8, mut tell: impl FnMut(&mut Barometer, u64)) {
        if address != BAROMETER {
            return;
        }
        let now_ns = self.now_ns();
        let Parts {
            switch,
            barometers,
            schedule,
            ..
        } = &mut *self.parts;
        for (channel, barometer) in (0..).zip(barometers) {
            let is_away = schedule.has(FaultKind::NoAcknowledge {
                channel: Some(channel),
            });
            let Some(barometer) = barometer else { continue };
            barometer.settle(
                now_ns,
                self.workcell,
                schedule.has(FaultKind::EndlessConversion { channel }),
            );
            if switch.mask() >> channel & 1 == 1 && !is_away && barometer.acknowledges() {
                tell(barometer, now_ns);
            }
        }
    }
}
