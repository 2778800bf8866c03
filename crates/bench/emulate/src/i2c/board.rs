//! The bus, and what is on it.

use std::fmt;
use std::sync::{Arc, Mutex};

use embedded_hal::i2c::{ErrorKind, ErrorType, I2c, Operation};

use super::barometer::Barometer;
use super::parts::Parts;
use super::transaction::Transaction;
use super::{BoardSettings, ClockLine, DataLine, ResetLine};
use crate::clock::nanoseconds;
use crate::fault::FaultWire;
use crate::schedule::Schedule;
use crate::worker::locked;
use crate::{CHANNELS, EmulateError, FaultKind, ScheduledFault, Workcell};

/// Lateness beyond which the bus does not catch up.
const MOST_LATE_NS: u64 = 5_000_000;

/// A sensor's board, with its lines.
#[derive(Clone)]
pub struct Board {
    parts: Arc<Mutex<Parts>>,
    workcell: Workcell,
    period_ns: f64,
    timeout_ns: u64,
}

/// A controller's port to the board. A transaction takes as long as its clocks do: nine for a byte, one for each START and STOP.
///
/// What is not acknowledged is [`ErrorKind::NoAcknowledge`], a data line that is held [`ErrorKind::Bus`].
#[derive(Clone)]
pub struct Bus(Board);

impl Board {
    /// A board in a workcell, with the faults that show on its bus.
    ///
    /// # Errors
    /// A setting or a fault that makes no sense.
    pub fn new(
        workcell: Workcell,
        settings: &BoardSettings,
        faults: &[ScheduledFault],
    ) -> Result<Self, EmulateError> {
        settings.check()?;
        crate::fault::check_faults(faults)?;
        let barometer = |channel: usize| {
            let is_there = settings.channels.contains(&(channel as u8)); // 0 to 7
            is_there.then(|| Barometer::new(channel, settings.barometer, settings.seed))
        };
        Ok(Self {
            parts: Arc::new(Mutex::new(Parts::new(
                settings.switch_address,
                std::array::from_fn(barometer),
                Schedule::new(faults, FaultWire::I2c),
            ))),
            workcell,
            period_ns: 1e9 / settings.bus_hz,
            timeout_ns: nanoseconds(settings.timeout_s),
        })
    }

    pub(crate) fn inject(&self, fault: ScheduledFault) {
        locked(&self.parts).schedule.add(fault);
    }

    /// A port to its bus.
    #[must_use]
    pub fn bus(&self) -> Bus {
        Bus(self.clone())
    }

    /// The bus's clock and data lines, as pins, while no transaction is under way.
    #[must_use]
    pub fn lines(&self) -> (ClockLine, DataLine) {
        let parts = || Arc::clone(&self.parts);
        let clock = ClockLine {
            parts: parts(),
            is_high: true,
        };
        let data = DataLine {
            parts: parts(),
            is_high: true,
        };
        (clock, data)
    }

    /// The switch's RESET.
    #[must_use]
    pub fn reset_line(&self) -> ResetLine {
        let parts = Arc::clone(&self.parts);
        ResetLine { parts }
    }

    /// How long each channel's barometer takes for a conversion, s.
    #[must_use]
    pub fn conversions_s(&self) -> [Option<f64>; CHANNELS] {
        let parts = locked(&self.parts);
        parts
            .barometers
            .each_ref()
            .map(|part| part.as_ref().map(Barometer::conversion_s))
    }

    fn transaction(&self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        let clock = self.workcell.clock();
        let begun_ns = clock.now_ns();
        let (result, ends_ns) = {
            let mut parts = locked(&self.parts);
            parts.misbehave(begun_ns);
            let stretches = parts.schedule.active().map(|what| match what {
                FaultKind::ClockStretch { by_s } => by_s,
                _ => 0.0,
            });
            let stretched_s: f64 = stretches.sum();
            if parts.is_held() {
                (Err(ErrorKind::Bus), begun_ns + self.timeout_ns)
            } else {
                let mut transaction =
                    Transaction::begin(&mut parts, &self.workcell, begun_ns, self.period_ns);
                let result = transaction.carry_out(address, operations);
                (result, transaction.stop() + nanoseconds(stretched_s))
            }
        };
        self.pace(ends_ns);
        result
    }

    /// Waits for the end of a transaction. The operating system wakes late, by about the time of a transaction: what one took too long, the
    /// next ones are shorter.
    fn pace(&self, ends_ns: u64) {
        let clock = self.workcell.clock();
        let due_ns = ends_ns.saturating_sub(locked(&self.parts).late_ns);
        clock.wait_until_ns(due_ns);
        locked(&self.parts).late_ns = (clock.now_ns() - due_ns).min(MOST_LATE_NS);
    }
}

impl ErrorType for Bus {
    type Error = ErrorKind;
}

impl I2c for Bus {
    fn transaction(&mut self, address: u8, operations: &mut [Operation<'_>]) -> Result<(), ErrorKind> {
        self.0.transaction(address, operations)
    }
}

impl fmt::Debug for Board {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let parts = locked(&self.parts);
        f.debug_struct("Board")
            .field("mask", &parts.switch.mask())
            .field("barometers", &parts.barometers.iter().flatten().count())
            .finish()
    }
}

impl fmt::Debug for Bus {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}
