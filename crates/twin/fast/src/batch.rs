//! Evaluation of many sensors in one call.

use rayon::prelude::*;

use crate::{Body, FastGel, FastReader, Touch};

/// Evaluates the surrogates of many sensors of one kind. It owns all memory that an evaluation
/// needs.
#[derive(Clone, Debug)]
pub struct FastBatch {
    /// One for each thread.
    readers: Vec<FastReader>,
    n_taxels: usize,
}

impl FastGel {
    /// Prepares to evaluate many sensors on this number of threads.
    #[must_use]
    pub fn batch(&self, n_threads: usize) -> FastBatch {
        FastBatch {
            readers: vec![self.reader(); n_threads.max(1)],
            n_taxels: self.n_taxels(),
        }
    }
}

impl FastBatch {
    /// Pressures and wrenches of many sensors, each under its own touches. The numbers of a sensor
    /// do not depend on the other sensors, on their number, or on the number of threads.
    ///
    /// - `bodies`: all rigid bodies; any number of sensors may share a body.
    /// - `touches`: those of the first sensor, then those of the second, and so on.
    /// - `ends`: where the touches of each sensor end. `[n_sensors]`, the last is the number of
    ///   touches.
    /// - `pressure_kpa`: output; hydrostatic pressure at each port, kPa. `[n_sensors * n_taxels]`
    /// - `wrench`: output; force on each gel, N, and torque about the centre of the top of its
    ///   bounding box, N mm. `[n_sensors]`
    ///
    /// # Panics
    /// If a slice has another length, if ends decrease, if a touch names a body that does not
    /// exist, or if a pose is not finite.
    pub fn read(
        &mut self,
        bodies: &[Body],
        touches: &[Touch],
        ends: &[usize],
        pressure_kpa: &mut [f32],
        wrench: &mut [[f32; 6]],
    ) {
        let n_sensors = ends.len();
        assert_eq!(
            pressure_kpa.len(),
            n_sensors * self.n_taxels,
            "a pressure for each taxel of each sensor"
        );
        assert_eq!(wrench.len(), n_sensors, "a wrench for each sensor");
        assert_eq!(
            ends.last().copied().unwrap_or(0),
            touches.len(),
            "the last end is the number of touches"
        );
        if let [reader] = self.readers.as_mut_slice() {
            // A single thread does not need the thread pool.
            reader.read_many(bodies, touches, ends, pressure_kpa, wrench);
            return;
        }
        let of_thread = n_sensors.div_ceil(self.readers.len()).max(1);
        let n_taxels = self.n_taxels;
        let chunks = pressure_kpa
            .par_chunks_mut(of_thread * n_taxels)
            .zip(wrench.par_chunks_mut(of_thread));
        let work = self.readers.par_iter_mut().zip(chunks).enumerate();
        work.for_each(|(chunk, (reader, (pressure_kpa, wrench)))| {
            let start = chunk * of_thread;
            let own = start..start + wrench.len();
            let first = if start == 0 { 0 } else { ends[start - 1] };
            reader.read_from(bodies, touches, first, &ends[own], pressure_kpa, wrench);
        });
    }
}
