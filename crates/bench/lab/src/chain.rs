//! The read-out chain: from the pressures at the ports to recorded readings.

use twintac_random::{RandomStream, normal};

use crate::EmulatedReadout;
use crate::port::Port;

/// The read-out of one press. Its offsets drift from their initial values.
pub(crate) struct Chain<'a> {
    readout: &'a EmulatedReadout,
    /// The port of each taxel.
    ports: &'a [Port],
    resolution_kpa: f64,
    walk_kpa: Vec<f64>,
    previous_s: f64,
}

impl<'a> Chain<'a> {
    pub(crate) fn new(readout: &'a EmulatedReadout, ports: &'a [Port], resolution_kpa: f64) -> Self {
        Self {
            readout,
            ports,
            resolution_kpa,
            walk_kpa: vec![0.0; ports.len()],
            previous_s: 0.0,
        }
    }

    /// The time stamp, s, and the readings, kPa, of the frame that is scheduled at a time.
    /// `port_kpa` gives the pressure of the gel at a taxel's port at a time.
    pub(crate) fn read(
        &mut self,
        scheduled_s: f64,
        random: &mut RandomStream,
        port_kpa: impl Fn(usize, f64) -> f64,
    ) -> (f64, Vec<f64>) {
        let readout = self.readout;
        let jitter_s = normal(random, readout.jitter_s);
        let time_s = scheduled_s + jitter_s.clamp(-3.0 * readout.jitter_s, 3.0 * readout.jitter_s);
        let step_s = (time_s - self.previous_s).max(0.0);
        self.previous_s = time_s;
        let readings_kpa = (0..self.walk_kpa.len())
            .map(|taxel| {
                let late_s = readout.lag_s + taxel as f64 * readout.lag_per_taxel_s;
                self.walk_kpa[taxel] += normal(random, readout.drift_kpa_per_sqrt_s * step_s.sqrt());
                let gel_kpa = port_kpa(taxel, time_s + late_s);
                let clean_kpa = self.ports[taxel].absolute_kpa(gel_kpa, 0.0) + self.walk_kpa[taxel];
                let noisy_kpa = clean_kpa + normal(random, readout.noise_kpa);
                (noisy_kpa / self.resolution_kpa).round() * self.resolution_kpa
            })
            .collect();
        (time_s, readings_kpa)
    }
}
