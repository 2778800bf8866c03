//! Evaluation of a surrogate.

use std::sync::Arc;

use glam::DVec2;
use twintac_shape::Pose;

use crate::contact::{ContactPoints, N_CHANNELS};
use crate::engine::{Engine, Scratch};
use crate::footprint::Footprint;
use crate::out_of_distribution::{OodScore, narrowness};
use crate::surface::SurfaceGrid;
use crate::trained_on::TrainedOn;
use crate::{Body, FastGel, Touch};

/// A surrogate ready for evaluation: it owns all memory that an evaluation needs.
#[derive(Clone, Debug)]
pub struct FastReader {
    /// The sensor and the gel that it was trained for.
    sensor: Arc<str>,
    gel: Arc<TrainedOn>,
    points: Arc<ContactPoints>,
    engine: Arc<Engine>,
    /// Network inputs of the sensors that are evaluated together.
    inputs: Vec<f32>,
    scratch: Scratch,
    /// Proximity of the bodies to each sensor of the last [`FastReader::read_many`].
    proximity: Vec<f32>,
    /// The locations of the last footprint.
    carrying: Vec<(DVec2, f32)>,
    ports_mm: Arc<[DVec2]>,
    grid: Arc<SurfaceGrid>,
    ood_score: Arc<OodScore>,
}

impl FastGel {
    /// Lays the networks out for evaluation.
    #[must_use]
    pub fn reader(&self) -> FastReader {
        let points = ContactPoints::new(&self.layout.grids);
        let engine = Engine::of(self);
        FastReader {
            sensor: self.sensor.as_str().into(),
            gel: Arc::clone(&self.gel),
            inputs: vec![0.0; engine.n_together() * points.n_inputs()],
            scratch: engine.scratch(),
            proximity: Vec::new(),
            carrying: Vec::new(),
            ports_mm: self.ports_mm.as_slice().into(),
            grid: Arc::new(self.layout.grid().clone()),
            ood_score: Arc::new(self.ood_score.clone()),
            points: Arc::new(points),
            engine: Arc::new(engine),
        }
    }

    /// Number of taxels.
    #[must_use]
    pub fn n_taxels(&self) -> usize {
        self.ports_mm.len()
    }
}

impl FastReader {
    /// Number of taxels.
    #[must_use]
    pub fn n_taxels(&self) -> usize {
        self.ports_mm.len()
    }

    /// Name of the sensor, and the gel, that it was trained for.
    pub(crate) fn trained_on(&self) -> (&str, &Arc<TrainedOn>) {
        (&self.sensor, &self.gel)
    }

    /// Pressures and wrench of a sensor under bodies at these poses in the gel's frame.
    ///
    /// - `pressure_kpa`: output; hydrostatic pressure at each port, kPa. `[n_taxels]`
    /// - `wrench`: output; force on the gel, N, and torque about the centre of the top of its
    ///   bounding box, N mm.
    ///
    /// # Panics
    /// If the slice of pressures has another length than there are taxels, or if a pose is not
    /// finite.
    pub fn read(&mut self, bodies: &[(&Body, Pose)], pressure_kpa: &mut [f32], wrench: &mut [f32; 6]) {
        assert_eq!(pressure_kpa.len(), self.n_taxels(), "a pressure for each taxel");
        let inputs = &mut self.inputs[..self.points.n_inputs()];
        self.points.fill(bodies.iter().copied(), inputs);
        let all = std::slice::from_mut(wrench);
        self.engine.read(inputs, &mut self.scratch, pressure_kpa, all);
        let touched = self.points.touched(self.points.nearest(inputs));
        quieten(touched, pressure_kpa, wrench);
    }

    /// Out-of-distribution (OOD) score of a contact: 0 where nothing is near the gel, above 1 where
    /// pressures and force may be wrong. It is above 1
    ///
    /// - where the distance to the nearest training contact, by how deep, steep, large, tilted and
    ///   uneven a contact is, is larger than for 99 of 100 contacts of the same kinds;
    /// - where the contact is deeper than the training presses;
    /// - where so few training presses pressed that more than one of ten predictions would have an
    ///   error of more than a tenth, as held-out presses have shown;
    /// - where more than a twentieth of what presses is narrower than 1.25 grid spacings (2.5 mm on
    ///   PhysTac), as blades, pins and thin walls are.
    ///
    /// # Panics
    /// If a pose is not finite.
    pub fn ood_score(&mut self, bodies: &[(&Body, Pose)]) -> f32 {
        let inputs = &mut self.inputs[..self.points.n_inputs()];
        self.points.fill(bodies.iter().copied(), inputs);
        let narrow = bodies
            .iter()
            .map(|(body, pose)| narrowness(&self.grid, body, pose));
        narrow.fold(self.ood_score.score(&self.grid, inputs), f32::max)
    }

    /// Network inputs of the points of all grids. `[n_points * N_CHANNELS]`
    pub(crate) fn inputs(&mut self, bodies: &[(&Body, Pose)]) -> &[f32] {
        let inputs = &mut self.inputs[..self.points.n_inputs()];
        self.points.fill(bodies.iter().copied(), inputs);
        inputs
    }

    /// The area that carries the bodies, and the locations of the ports, mm; `None` where nothing
    /// touches.
    pub(crate) fn footprint(&mut self, bodies: &[(&Body, Pose)]) -> Option<(Footprint<'_>, &[DVec2])> {
        let inputs = &mut self.inputs[..self.points.n_inputs()];
        self.points.fill(bodies.iter().copied(), inputs);
        let of_grid = &inputs[..N_CHANNELS * self.grid.len()];
        let footprint = Footprint::of(&self.grid, of_grid, &mut self.carrying)?;
        Some((footprint, &self.ports_mm))
    }

    /// [`Self::read`] of many sensors, one after the other on the calling thread. The numbers of a
    /// sensor do not depend on the others.
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
    pub fn read_many(
        &mut self,
        bodies: &[Body],
        touches: &[Touch],
        ends: &[usize],
        pressure_kpa: &mut [f32],
        wrench: &mut [[f32; 6]],
    ) {
        self.read_from(bodies, touches, 0, ends, pressure_kpa, wrench);
    }

    /// How near the bodies were to each sensor of the last [`Self::read_many`]: 1 where one
    /// touches, falling linearly to 0 where the nearest is 2 mm away or farther. Distances are
    /// those of points of the gel's surface, which are 2 mm apart on PhysTac. `[n_sensors]`
    #[must_use]
    pub fn proximity(&self) -> &[f32] {
        &self.proximity
    }

    /// The same for sensors whose first touch has the number `first`.
    pub(crate) fn read_from(
        &mut self,
        bodies: &[Body],
        touches: &[Touch],
        mut first: usize,
        ends: &[usize],
        pressure_kpa: &mut [f32],
        wrench: &mut [[f32; 6]],
    ) {
        let n_sensors = ends.len();
        assert_eq!(
            pressure_kpa.len(),
            n_sensors * self.n_taxels(),
            "a pressure for each taxel of each sensor"
        );
        assert_eq!(wrench.len(), n_sensors, "a wrench for each sensor");
        self.proximity.clear();
        let (n_together, n_inputs) = (self.engine.n_together(), self.points.n_inputs());
        let n_taxels = self.n_taxels().max(1);
        let numbers = pressure_kpa
            .chunks_mut(n_together * n_taxels)
            .zip(wrench.chunks_mut(n_together));
        for (ends, (pressure_kpa, wrench)) in ends.chunks(n_together).zip(numbers) {
            for (end, inputs) in ends.iter().zip(self.inputs.chunks_exact_mut(n_inputs)) {
                let touching = touches[first..*end]
                    .iter()
                    .map(|touch| (&bodies[touch.body as usize], touch.gel_from_body));
                self.points.fill(touching, inputs);
                first = *end;
            }
            let inputs = &self.inputs[..ends.len() * n_inputs];
            self.engine.read(inputs, &mut self.scratch, pressure_kpa, wrench);
            let sensors = pressure_kpa.chunks_exact_mut(n_taxels).zip(wrench.iter_mut());
            for (inputs, (pressure_kpa, wrench)) in inputs.chunks_exact(n_inputs).zip(sensors) {
                let nearest = self.points.nearest(inputs);
                self.proximity.push(nearest.min(1.0));
                quieten(self.points.touched(nearest), pressure_kpa, wrench);
            }
        }
    }
}

/// Scales pressures and wrench by the degree of contact: outputs of the networks are never exactly
/// zero.
fn quieten(touched: f32, pressure_kpa: &mut [f32], wrench: &mut [f32; 6]) {
    if touched < 1.0 {
        for number in pressure_kpa.iter_mut().chain(wrench) {
            *number *= touched;
        }
    }
}
