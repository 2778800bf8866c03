//! An emulated switch with eight barometers, with its own time, and with faults on demand.

#![allow(dead_code)] // each test binary uses its part

use std::cell::RefCell;
use std::future::Future;
use std::ops::Range;
use std::pin::pin;
use std::rc::Rc;
use std::task::{Context, Poll, Waker};

use embedded_hal::i2c::{ErrorKind, ErrorType, NoAcknowledgeSource, Operation};

pub(crate) const NACK: ErrorKind = ErrorKind::NoAcknowledge(NoAcknowledgeSource::Address);

/// One barometer.
#[derive(Clone, Debug)]
pub(crate) struct Part {
    pub(crate) is_present: bool,
    /// Whether it holds its lines low while its channel is open.
    pub(crate) is_shorted: bool,
    /// Pressure that the next conversion measures, counts.
    pub(crate) counts: i32,
    /// Temperature that the next conversion measures, 1/256 °C.
    pub(crate) temperature: i16,
    pub(crate) conversion_ns: u64,
    pub(crate) configuration: u8,
    pub(crate) keeps_configuration: bool,
    /// When the conversion in progress ends, and its result.
    converting: Option<(u64, [u8; 5])>,
    data: [u8; 5],
}

/// The wires and all parts on them.
#[derive(Debug)]
pub(crate) struct World {
    pub(crate) parts: Vec<Part>,
    pub(crate) mask: u8,
    pub(crate) has_switch: bool,
    pub(crate) now_ns: u64,
    pub(crate) bus_hz: u64,
    /// Clocks that the bus has given.
    pub(crate) clocks: u64,
    /// Transactions so far.
    pub(crate) count: usize,
    /// Transactions that fail, with which error, and whether the parts receive them nevertheless.
    pub(crate) failing: Range<usize>,
    pub(crate) failure: ErrorKind,
    pub(crate) failing_are_heard: bool,
    /// The transaction before which the switch loses its mask.
    pub(crate) brown_out_at: Option<usize>,
    /// Whether the bus hangs until a reset: every transaction fails.
    pub(crate) is_hung: bool,
    pub(crate) log: Vec<String>,
}

/// The state that the drivers and the test share.
#[derive(Clone, Debug)]
pub(crate) struct Bench(Rc<RefCell<World>>);

impl Bench {
    pub(crate) fn new() -> Self {
        let part = |index: i16| Part {
            is_present: true,
            is_shorted: false,
            counts: 3_242_400 + i32::from(index),
            temperature: 6400 + index,
            conversion_ns: 6_000_000,
            configuration: 0x28,
            keeps_configuration: true,
            converting: None,
            data: [0; 5],
        };
        Self(Rc::new(RefCell::new(World {
            parts: (0..8).map(part).collect(),
            mask: 0,
            has_switch: true,
            now_ns: 0,
            bus_hz: 400_000,
            clocks: 0,
            count: 0,
            failing: 0..0,
            failure: ErrorKind::Bus,
            failing_are_heard: false,
            brown_out_at: None,
            is_hung: false,
            log: Vec::new(),
        })))
    }

    pub(crate) fn with<T>(&self, look: impl FnOnce(&mut World) -> T) -> T {
        look(&mut self.0.borrow_mut())
    }

    /// A clock of the bench's own time.
    pub(crate) fn clock(&self) -> impl Fn() -> u64 + use<> {
        let bench = self.clone();
        move || bench.with(|world| world.now_ns / 1000)
    }

    pub(crate) fn take_log(&self) -> Vec<String> {
        self.with(|world| std::mem::take(&mut world.log))
    }

    /// Pulses the switch's RESET, and ends a hang.
    pub(crate) fn reset(&self) {
        self.with(|world| {
            world.mask = 0;
            world.is_hung = false;
            world.failing = 0..0;
        });
    }
}

impl World {
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        let index = self.count;
        self.count += 1;
        if self.brown_out_at == Some(index) {
            self.mask = 0;
        }
        let fails = self.failing.contains(&index);
        let mut result = Ok(());
        if !fails || self.failing_are_heard {
            result = self.carry_out(address, operations);
        }
        let bytes: usize = operations.iter().map(bytes_of).sum();
        let clocks = 9 * bytes + 10 * operations.len() + 1;
        self.clocks += clocks as u64;
        self.now_ns += 1_000_000_000 * clocks as u64 / self.bus_hz;
        if fails {
            result = Err(self.failure);
        }
        self.log.push(describe(address, operations, result.is_ok()));
        result
    }

    fn carry_out(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        self.is_hung |= (0..8).any(|index| self.mask >> index & 1 == 1 && self.parts[index].is_shorted);
        if self.is_hung {
            return Err(ErrorKind::ArbitrationLoss);
        }
        match address {
            0x70 if self.has_switch => self.talk_to_switch(operations),
            0x6D => self.talk_to_parts(operations)?,
            _ => return Err(NACK),
        }
        Ok(())
    }

    fn talk_to_switch(&mut self, operations: &mut [Operation<'_>]) {
        match operations {
            [Operation::Write(bytes)] => self.mask = *bytes.last().expect("a mask"),
            [Operation::Read(bytes)] => bytes.fill(self.mask),
            other => panic!("the switch knows no {other:?}"),
        }
    }

    fn talk_to_parts(&mut self, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        let (mask, now_ns) = (self.mask, self.now_ns);
        let open = self.parts.iter_mut().enumerate();
        let open = open.filter(|(index, part)| mask >> index & 1 == 1 && part.is_present);
        let mut open: Vec<&mut Part> = open.map(|(_, part)| part).collect();
        if open.is_empty() {
            return Err(NACK);
        }
        match operations {
            [Operation::Write(bytes)] => open.iter_mut().for_each(|part| part.write(bytes, now_ns)),
            [Operation::Write([register]), Operation::Read(bytes)] => {
                assert_eq!(mask.count_ones(), 1, "read through several channels");
                open[0].read(*register, bytes, now_ns);
            }
            other => panic!("the barometers know no {other:?}"),
        }
        Ok(())
    }
}

impl Part {
    /// Interrupts the part's power.
    pub(crate) fn restart(&mut self) {
        self.converting = None;
        self.data = [0; 5];
    }

    fn is_converting(&mut self, now_ns: u64) -> bool {
        if let Some((_, data)) = self.converting.take_if(|(end_ns, _)| *end_ns <= now_ns) {
            self.data = data;
        }
        self.converting.is_some()
    }

    fn write(&mut self, bytes: &[u8], now_ns: u64) {
        match bytes {
            [0x30, 0x0A] => {
                assert!(!self.is_converting(now_ns), "triggered while converting");
                let [_, high, middle, low] = self.counts.to_be_bytes();
                let [upper, lower] = self.temperature.to_be_bytes();
                let end_ns = now_ns.saturating_add(self.conversion_ns);
                self.converting = Some((end_ns, [high, middle, low, upper, lower]));
            }
            [0xA6, value] if self.keeps_configuration => self.configuration = *value,
            [0xA6, _] => {}
            other => panic!("nobody may write {other:02x?}"),
        }
    }

    fn read(&mut self, register: u8, bytes: &mut [u8], now_ns: u64) {
        let is_converting = self.is_converting(now_ns);
        match register {
            0x06 => bytes.copy_from_slice(&self.data),
            0x30 => bytes[0] = if is_converting { 0x0A } else { 0x02 },
            0xA6 => bytes[0] = self.configuration,
            other => panic!("nobody may read {other:#04x}"),
        }
    }
}

fn bytes_of(operation: &Operation<'_>) -> usize {
    match operation {
        Operation::Read(bytes) => bytes.len(),
        Operation::Write(bytes) => bytes.len(),
    }
}

fn describe(address: u8, operations: &[Operation<'_>], is_ok: bool) -> String {
    let mut line = format!("{address:02x}");
    for operation in operations {
        match operation {
            Operation::Write(bytes) => bytes.iter().for_each(|byte| line += &format!(" {byte:02x}")),
            Operation::Read(bytes) if is_ok => {
                line += " ->";
                bytes.iter().for_each(|byte| line += &format!(" {byte:02x}"));
            }
            Operation::Read(_) => {}
        }
    }
    line + if is_ok { "" } else { " !" }
}

impl ErrorType for Bench {
    type Error = ErrorKind;
}

impl embedded_hal::i2c::I2c for Bench {
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        self.with(|world| world.transaction(address, operations))
    }
}

impl embedded_hal::delay::DelayNs for Bench {
    fn delay_ns(&mut self, ns: u32) {
        self.with(|world| world.now_ns += u64::from(ns));
    }
}

impl embedded_hal_async::i2c::I2c for Bench {
    async fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        pending_once().await;
        self.with(|world| world.transaction(address, operations))
    }
}

impl embedded_hal_async::delay::DelayNs for Bench {
    async fn delay_ns(&mut self, ns: u32) {
        pending_once().await;
        self.with(|world| world.now_ns += u64::from(ns));
    }
}

async fn pending_once() {
    let mut has_waited = false;
    std::future::poll_fn(|_| match std::mem::replace(&mut has_waited, true) {
        true => Poll::Ready(()),
        false => Poll::Pending,
    })
    .await;
}

/// Polls a future up to `most` times; `None` if it is dropped before its end.
pub(crate) fn poll_up_to<F: Future>(most: usize, future: F) -> Option<F::Output> {
    let mut future = pin!(future);
    let mut context = Context::from_waker(Waker::noop());
    (0..most).find_map(|_| match future.as_mut().poll(&mut context) {
        Poll::Ready(output) => Some(output),
        Poll::Pending => None,
    })
}
