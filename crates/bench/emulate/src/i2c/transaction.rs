//! What a transaction does to the parts, clock by clock.

use embedded_hal::i2c::{ErrorKind, NoAcknowledgeSource, Operation};

use super::parts::{Part, Parts};
use crate::{FaultKind, Workcell};

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
                Operation::Write(bytes) => {
                    for byte in bytes.iter() {
                        self.write(address, *byte)?;
                    }
                }
            }
        }
        Ok(())
    }

    /// START and an address.
    fn address(&mut self, address: u8, is_reading: bool) -> Result<(), ErrorKind> {
        self.clocks += 1 + 9;
        let mut n_heard = self.switch(address).is_some() as usize;
        self.each_barometer(address, |part, _| {
            part.is_addressed = !is_reading;
            n_heard += 1;
        });
        // Every part with this address pulls the line: one is enough.
        acknowledged(n_heard, NoAcknowledgeSource::Address)
    }

    fn write(&mut self, address: u8, byte: u8) -> Result<(), ErrorKind> {
        self.clocks += 9;
        let mut n_heard = 0;
        if let Some(switch) = self.switch(address) {
            self.parts.switches[switch].write(byte);
            n_heard += 1;
        }
        self.each_barometer(address, |part, now_ns| {
            match std::mem::take(&mut part.is_addressed) {
                true => part.chip.point(byte, now_ns),
                false => part.chip.write(byte, now_ns),
            }
            n_heard += 1;
        });
        acknowledged(n_heard, NoAcknowledgeSource::Data)
    }

    /// The byte that all answering parts make together: a line is low if one of them pulls it.
    fn read(&mut self, address: u8) -> u8 {
        self.clocks += 9;
        let mut byte = self
            .switch(address)
            .map_or(0xFF, |switch| self.parts.switches[switch].mask());
        self.each_barometer(address, |part, _| byte &= part.chip.read());
        byte
    }

    /// STOP. Returns its time, ns of the emulator's clock.
    pub(super) fn stop(&mut self) -> u64 {
        self.clocks += 1;
        self.parts
            .switches
            .iter_mut()
            .for_each(super::switch::Switch::stop);
        self.parts.barometers.iter_mut().for_each(|part| part.chip.stop());
        self.now_ns()
    }

    /// The switch with that address, if it answers.
    fn switch(&self, address: u8) -> Option<usize> {
        let is_away = self
            .parts
            .schedule
            .has(FaultKind::NoAcknowledge { channel: None });
        let found = self
            .parts
            .switches
            .iter()
            .position(|switch| switch.address() == address);
        found.filter(|_| !is_away)
    }

    /// All barometers at the address that answer and are on open channels.
    fn each_barometer(&mut self, address: u8, mut tell: impl FnMut(&mut Part, u64)) {
        let now_ns = self.now_ns();
        for index in 0..self.parts.barometers.len() {
            if self.parts.barometers[index].address != address {
                continue;
            }
            let channel = self.parts.barometers[index].channel();
            let schedule = &self.parts.schedule;
            let is_endless =
                channel.is_some_and(|channel| schedule.has(FaultKind::EndlessConversion { channel }));
            let is_away = channel.is_some() && schedule.has(FaultKind::NoAcknowledge { channel });
            let is_reached = channel.is_none_or(|channel| self.parts.is_open(channel));
            let part = &mut self.parts.barometers[index];
            part.settle(now_ns, is_endless, self.workcell);
            if is_reached && !is_away && part.chip.acknowledges() {
                tell(part, now_ns);
            }
        }
    }
}

fn acknowledged(n_heard: usize, source: NoAcknowledgeSource) -> Result<(), ErrorKind> {
    match n_heard {
        0 => Err(ErrorKind::NoAcknowledge(source)),
        _ => Ok(()),
    }
}
