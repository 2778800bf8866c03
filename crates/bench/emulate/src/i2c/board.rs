//! The bus and the parts on it.

use std::fmt;
use std::sync::{Arc, Mutex};

use embedded_hal::i2c::{ErrorKind, ErrorType, I2c, Operation};
use twintac_random::stream;

use super::chip::{Analog, Make, kind};
use super::parts::{Part, Parts};
use super::switch::Switch;
use super::transaction::Transaction;
use super::{BoardSettings, ClockLine, DataLine, PartSettings, ResetLine};
use crate::clock::nanoseconds;
use crate::fault::FaultWire;
use crate::schedule::Schedule;
use crate::worker::locked;
use crate::{EmulateError, FaultKind, ScheduledFault, Workcell};

/// Delay beyond which the bus does not try to catch up, ns.
const MOST_LATE_NS: u64 = 5_000_000;

/// A sensor's board, with its bus.
#[derive(Clone)]
pub struct Board {
    parts: Arc<Mutex<Parts>>,
    workcell: Workcell,
    period_ns: f64,
    timeout_ns: u64,
}

/// A controller's port to the board. A transaction takes as long as its clocks: nine for a byte,
/// one for each START and STOP.
///
/// A byte that is not acknowledged gives [`ErrorKind::NoAcknowledge`]; a data line that is held
/// gives [`ErrorKind::Bus`].
#[derive(Clone)]
pub struct Bus(Board);

impl Board {
    /// A board in a workcell. It takes the faults that show on its bus from the list.
    ///
    /// # Errors
    /// A setting or a fault that is not valid.
    pub fn new(
        workcell: Workcell,
        settings: &BoardSettings,
        faults: &[ScheduledFault],
    ) -> Result<Self, EmulateError> {
        settings.check()?;
        crate::fault::check_faults(faults)?;
        let switches = settings.switches();
        let part = |(taxel, part): (usize, &PartSettings)| {
            let random = stream(settings.seed, &format!("barometer {taxel}"));
            let kind = kind(&part.chip)?;
            let noise_pa = settings.noise_pa.filter(|_| !kind.has_settings);
            let analog = Analog::new(random, settings.barometer.conversion_spread, noise_pa);
            let make = Make {
                analog,
                settings: &settings.barometer,
            };
            Some(Part {
                address: part.address(),
                behind: part.switch.and_then(|address| {
                    let switch = switches.iter().position(|switch| *switch == address)?;
                    Some((switch, part.channel))
                }),
                taxel,
                chip: (kind.make)(make),
                is_addressed: false,
            })
        };
        let barometers = settings.parts.iter().enumerate().filter_map(part).collect();
        let schedule = Schedule::new(faults, FaultWire::I2c);
        let switches = switches.iter().map(|address| Switch::new(*address)).collect();
        Ok(Self {
            parts: Arc::new(Mutex::new(Parts::new(switches, barometers, schedule))),
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

    /// The bus's clock and data lines, as pins, for use while no transaction is under way.
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

    /// The RESET line of all switches.
    #[must_use]
    pub fn reset_line(&self) -> ResetLine {
        let parts = Arc::clone(&self.parts);
        ResetLine { parts }
    }

    /// How long each barometer takes for a conversion with its present settings, s.
    #[must_use]
    pub fn conversions_s(&self) -> Vec<f64> {
        let parts = locked(&self.parts);
        parts
            .barometers
            .iter()
            .map(|part| part.chip.conversion_s())
            .collect()
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

    /// Waits for the end of a transaction. The operating system wakes a thread late, by about the
    /// time of a transaction. The next transactions are shortened by the delay of this one.
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
            .field("switches", &parts.switches)
            .field("barometers", &parts.barometers.len())
            .finish()
    }
}

impl fmt::Debug for Bus {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.fmt(f)
    }
}
