//! Many sensors read in one call.

use rayon::prelude::*;

use crate::{Body, FastGel, FastReader, Touch};

/// Fast gels of many sensors of one kind. It owns all memory that readings need.
#[derive(Clone, Debug)]
pub struct FastBatch {
    /// One for each thread.
    readers: Vec<FastReader>,
    n_taxels: usize,
}

impl FastGel {
    /// Prepares so many threads to read sensors.
    #[must_use]
    pub fn batch(&self, n_threads: usize) -> FastBatch {
        FastBatch {
            readers: vec![self.reader(); n_threads.max(1)],
            n_taxels: self.n_taxels(),
        }
    }
}

impl FastBatch {
    /// What the gels do under what touches each of them. A sensor's numbers do not depend on the other sensors, their number, or threads.
    ///
    /// - `bodies`: everything that touches; any number of sensors may share a body.
    /// - `touches`: of the first sensor, then of the second, and so on.
    /// - `ends`: where each sensor's touches end. `[n_sensors]`, the last is the number of touches.
    /// - `pressure_kpa`: is written; hydrostatic pressure at each port. `[n_sensors * n_taxels]`
    /// - `wrench`: is written; force, N, and torque about the top of the gel's middle, N mm. `[n_sensors]`
    ///
    /// # Panics
    /// Slices of other lengths, ends that decrease, a body that is not there, a pose that is not finite.
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
            // Nobody has to be woken.
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
