//! Measurements and datagrams of the force sensor.

use twintac_random::{RandomStream, normal, stream};
use twintac_rig::Wrench;
use twintac_rig::netft::{Command, Configuration, Record, Request, Status, TICKS_PER_SECOND, encode_records};

use super::ForceSettings;
use crate::clock::{nanoseconds, seconds};
use crate::fault::FaultWire;
use crate::schedule::Schedule;
use crate::{EmulateError, FaultKind, ScheduledFault, Workcell};

const SATURATED: u32 = 0x8002_0000;
const MONITOR_LATCHED: u32 = 0x8001_0000;

/// The sensor: requests in, datagrams out. It has no sockets, and its only time is that of its
/// workcell.
#[derive(Debug)]
pub struct ForceSensor {
    settings: ForceSettings,
    configuration: Configuration,
    workcell: Workcell,
    schedule: Schedule,
    random: RandomStream,
    bias: [f64; 6],
    is_latched: bool,
    stream: Option<Stream>,
    /// Datagrams that are under way, and the one that waits to be overtaken by the next.
    under_way: Vec<Outgoing>,
    overtaken: Option<Vec<u8>>,
}

/// A datagram and the time at which it is sent.
#[derive(Clone, Debug, PartialEq)]
pub struct Outgoing {
    /// Time, ns of the emulator's clock.
    pub at_ns: u64,
    /// Its bytes.
    pub datagram: Vec<u8>,
}

#[derive(Debug)]
struct Stream {
    begun_ns: u64,
    records_per_datagram: usize,
    /// Number of records still to send. `None`: no end.
    left: Option<u32>,
    n_measured: u64,
    held: Vec<Record>,
}

impl ForceSensor {
    /// The sensor in a workcell. It takes its own faults from the list.
    ///
    /// # Errors
    /// A setting or a fault that is not valid.
    pub fn new(
        workcell: Workcell,
        settings: ForceSettings,
        faults: &[ScheduledFault],
    ) -> Result<Self, EmulateError> {
        settings.check()?;
        crate::fault::check_faults(faults)?;
        Ok(Self {
            configuration: settings.configuration(),
            schedule: Schedule::new(faults, FaultWire::Force),
            random: stream(settings.seed, "force"),
            bias: [0.0; 6],
            is_latched: false,
            stream: None,
            under_way: Vec::new(),
            overtaken: None,
            workcell,
            settings,
        })
    }

    pub(crate) fn inject(&mut self, fault: ScheduledFault) {
        self.schedule.add(fault);
    }

    /// The content of its configuration page.
    #[must_use]
    pub fn configuration(&self) -> &Configuration {
        &self.configuration
    }

    /// Carries out a request. Ignores a datagram that is no request. Returns whether the request
    /// begins a stream to its sender.
    pub fn hear(&mut self, datagram: &[u8]) -> bool {
        let Ok(request) = Request::decode(datagram) else {
            return false;
        };
        let now_ns = self.workcell.clock().now_ns();
        let records_per_datagram = match request.command {
            Command::Stop => {
                self.stream = None;
                return false;
            }
            Command::ResetLatch => {
                self.is_latched = false;
                return false;
            }
            Command::Bias => {
                // The bias is the present reading, with its noise.
                self.bias = self.measure(now_ns);
                return false;
            }
            Command::StartRealTime | Command::StartMultiUnit => 1,
            Command::StartBuffered => self.settings.buffered_records,
        };
        self.stream = Some(Stream {
            begun_ns: now_ns,
            records_per_datagram,
            left: (request.samples > 0).then_some(request.samples),
            n_measured: 0,
            held: Vec::new(),
        });
        true
    }

    /// The datagrams that are due by now, in their order.
    pub fn due(&mut self) -> Vec<Outgoing> {
        let now_ns = self.workcell.clock().now_ns();
        while let Some(at_ns) = self.next_record_ns().filter(|at_ns| *at_ns <= now_ns) {
            let record = self.record(at_ns);
            let Some(stream) = &mut self.stream else { break };
            stream.n_measured += 1;
            stream.left = stream.left.map(|left| left - 1);
            stream.held.push(record);
            let is_last = stream.left == Some(0);
            if is_last || stream.held.len() == stream.records_per_datagram {
                let datagram = encode_records(&std::mem::take(&mut stream.held));
                self.send(at_ns, datagram);
            }
            if is_last {
                self.stream = None;
            }
        }
        let (mut due, later): (Vec<_>, Vec<_>) = std::mem::take(&mut self.under_way)
            .into_iter()
            .partition(|outgoing| outgoing.at_ns <= now_ns);
        self.under_way = later;
        due.sort_by_key(|outgoing| outgoing.at_ns);
        due
    }

    /// When the next datagram will be due, ns of the emulator's clock. `None` if none is known.
    #[must_use]
    pub(crate) fn next_due_ns(&self) -> Option<u64> {
        let late = self.under_way.iter().map(|outgoing| outgoing.at_ns);
        late.chain(self.next_record_ns()).min()
    }

    /// When the next record is measured. The first one is measured when the stream begins.
    fn next_record_ns(&self) -> Option<u64> {
        let stream = self.stream.as_ref()?;
        let after_s = stream.n_measured as f64 / self.settings.rate_hz;
        Some(stream.begun_ns + nanoseconds(after_s))
    }

    fn record(&mut self, at_ns: u64) -> Record {
        let n_measured = self.stream.as_ref().map_or(0, |stream| stream.n_measured);
        self.schedule.look(seconds(at_ns));
        let mut axes = self.measure(at_ns);
        let mut is_saturated = false;
        for (axis, most) in axes.iter_mut().zip(self.settings.range) {
            if self.schedule.has(FaultKind::SaturatedForce) {
                *axis = most;
            }
            is_saturated |= axis.abs() >= most;
            *axis = axis.clamp(-most, most);
        }
        let force_n = Wrench::from_axes(axes).force_n.length();
        self.is_latched |= self.settings.monitor_n.is_some_and(|most_n| force_n > most_n);
        for (axis, bias) in axes.iter_mut().zip(self.bias) {
            *axis -= bias;
        }
        let mut bits = 0;
        for (is_set, condition) in [(is_saturated, SATURATED), (self.is_latched, MONITOR_LATCHED)] {
            bits |= if is_set { condition } else { 0 };
        }
        // Ticks of the sensor's own clock. They are computed so that no two records share a tick.
        // Both counters wrap around.
        let begun_ns = self.stream.as_ref().map_or(at_ns, |stream| stream.begun_ns);
        let ticks = (seconds(begun_ns) * TICKS_PER_SECOND).floor()
            + (n_measured as f64 * TICKS_PER_SECOND / self.settings.rate_hz).round();
        Record {
            rdt_sequence: (n_measured + 1) as u32,
            ft_sequence: ticks as u64 as u32,
            status: Status(bits),
            counts: self.configuration.counts(&Wrench::from_axes(axes)),
        }
    }

    /// The reading of the gauges, before any bias.
    fn measure(&mut self, at_ns: u64) -> [f64; 6] {
        let Wrench { force_n, torque_n_mm } = self.workcell.at_ns(at_ns).sensed.wrench;
        let mut axes = [
            force_n.x,
            force_n.y,
            force_n.z,
            torque_n_mm.x,
            torque_n_mm.y,
            torque_n_mm.z,
        ];
        for (index, axis) in axes.iter_mut().enumerate() {
            let noise = if index < 3 {
                self.settings.noise_n
            } else {
                self.settings.noise_n_mm
            };
            *axis += self.settings.zero[index] + normal(&mut self.random, noise);
        }
        axes
    }

    /// Puts a datagram on its way, changed by the faults.
    fn send(&mut self, at_ns: u64, datagram: Vec<u8>) {
        self.schedule.next_event(seconds(at_ns));
        if self.schedule.has(FaultKind::LostDatagrams) {
            return;
        }
        let delays = self.schedule.active().map(|what| match what {
            FaultKind::LateDatagrams { by_s } => by_s,
            _ => 0.0,
        });
        let late_s: f64 = delays.sum();
        let at_ns = at_ns + nanoseconds(late_s);
        let times = if self.schedule.has(FaultKind::DoubledDatagrams) {
            2
        } else {
            1
        };
        if self.schedule.has(FaultKind::ReorderedDatagrams) && self.overtaken.is_none() {
            self.overtaken = Some(datagram);
            return;
        }
        for datagram in std::iter::repeat_n(datagram, times).chain(self.overtaken.take()) {
            self.under_way.push(Outgoing { at_ns, datagram });
        }
    }
}
