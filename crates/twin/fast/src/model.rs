//! The parts of a trained surrogate.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use thiserror::Error;
use twintac_sensor::Sensor;
use twintac_shape::{ShapeError, Solid};

use crate::FemPress;
use crate::fem_press::training_places_mm;
use crate::layout::Layout;
use crate::networks::Networks;
use crate::out_of_distribution::OodScore;
use crate::trained_on::{FastGelMismatch, Port, TrainedOn};
use crate::training::{Course, Frames, TrainProgress, TrainSettings, train};

/// A surrogate of one sensor's gel: neural networks from the bodies that touch it to the pressure
/// at each port and the force.
#[derive(Clone, Debug, PartialEq)]
pub struct FastGel {
    pub(crate) sensor: String,
    /// The gel of the training presses; shared with readers.
    pub(crate) gel: Arc<TrainedOn>,
    /// The ports of the sensor that it was trained for. `[n_taxels]`
    pub(crate) ports: Vec<Port>,
    pub(crate) layout: Layout,
    /// Locations at which it is evaluated, mm: those ports, unless [`Self::with_ports`] has moved
    /// them. `[n_taxels]`
    pub(crate) ports_mm: Vec<DVec2>,
    /// Reference point of torques, mm.
    pub(crate) center_mm: DVec3,
    pub(crate) networks: Networks,
    pub(crate) ood_score: OodScore,
}

impl FastGel {
    /// Trains a surrogate on presses of a sensor's gel. Held-out presses then show how large its
    /// errors are where few training presses pressed, which enters the OOD score
    /// ([`FastReader::ood_score`](crate::FastReader::ood_score)). Without held-out presses this
    /// error is unknown, and each location where a training press pressed counts as
    /// in-distribution.
    ///
    /// # Errors
    /// A press whose shape cannot exist.
    ///
    /// # Panics
    /// If no press has a frame.
    pub fn train(
        sensor: &Sensor,
        (presses, held_out): (&[FemPress], &[FemPress]),
        settings: &TrainSettings,
        seed: u64,
        progress: &mut dyn FnMut(TrainProgress),
    ) -> Result<Self, ShapeError> {
        let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
        let layout = Layout::of(sensor);
        let center_mm = (0.5 * (low + high)).with_z(high.z);
        let places_mm = training_places_mm(sensor);
        let places = (&places_mm[..], sensor.taxels.len());
        let frames = Frames::of(presses, &layout, places, center_mm, &sensor.surfaces)?;
        // A gel that is a surface of triangles may have a symmetric top and different sides.
        let has_known_sides = !matches!(sensor.gel.solid, Solid::Stl { .. });
        let is_symmetric = layout.grid().is_symmetric(center_mm.truncate());
        let is_symmetric = is_symmetric.map(|is| is && has_known_sides);
        let ports = Port::all(sensor);
        let ports_mm = Port::places_mm(&ports);
        let mirrored = |axis: usize| {
            let images = is_symmetric[axis].then(|| mirror_images(&ports_mm, center_mm.truncate(), axis));
            images.flatten()
        };
        let course = Course {
            frames: &frames,
            layout: &layout,
            settings,
            is_symmetric,
            // The response of a port over the gel's side occurs at few other locations: a network
            // of patches does not learn it.
            mirrored_taxels: sensor.has_port_at_side().then(|| [0, 1].map(mirrored)),
            seed,
        };
        let networks = train(&course, progress);
        let mut trained = Self {
            ood_score: OodScore::of(&frames, layout.grid(), is_symmetric),
            sensor: sensor.name.clone(),
            gel: Arc::new(TrainedOn::of(sensor)),
            ports,
            ports_mm,
            layout,
            center_mm,
            networks,
        };
        trained.calibrate_ood_score(held_out, &sensor.surfaces)?;
        Ok(trained)
    }
}

impl FastGel {
    /// Name of the sensor.
    #[must_use]
    pub fn sensor(&self) -> &str {
        &self.sensor
    }

    /// Checks that this is the surrogate of a sensor: that it was trained on the sensor's gel
    /// (shape, material, shell, and what is cast into it) and is evaluated at the sensor's ports.
    /// Names do not count. Indenters, limits, the read-out, relaxation and friction do not count
    /// either, because a surrogate does not depend on them.
    ///
    /// # Errors
    /// All differences, in words.
    pub fn check(&self, sensor: &Sensor) -> Result<(), FastGelMismatch> {
        let mut differences = self.gel.differences(&TrainedOn::of(sensor));
        differences.extend(Port::difference(&self.read_ports(), &Port::all(sensor)));
        FastGelMismatch::of((&self.sensor, &sensor.name), differences)
    }

    /// The ports at which it is evaluated.
    fn read_ports(&self) -> Vec<Port> {
        match &self.ports[..] {
            ports if Port::places_mm(ports) == self.ports_mm => ports.to_vec(),
            [] => Vec::new(),
            [first, ..] => self.ports_mm.iter().map(|at| first.at(*at)).collect(),
        }
    }

    /// Locations of the ports in the gel's plane, mm, in their order. `[n_taxels]`
    #[must_use]
    pub fn ports_mm(&self) -> &[DVec2] {
        &self.ports_mm
    }

    /// The same surrogate with its ports at other locations of the gel's base, mm, instead of the
    /// taxels': each pressure is averaged over a disc as large as a port. Ports on a regular grid
    /// share memory: thousands of them take a few MB. Where taxels reach over the gel's side,
    /// pressures at other locations are less exact than those of the taxels.
    ///
    /// # Errors
    /// A location where it was not trained ([`Self::has_port_at`]).
    pub fn with_ports(&self, places_mm: &[DVec2]) -> Result<Self, PortElsewhere> {
        if let Some(place_mm) = places_mm.iter().find(|place_mm| !self.has_port_at(**place_mm)) {
            return Err(PortElsewhere {
                place_mm: *place_mm,
                within_mm: self.port_bounds_mm(),
            });
        }
        let mut gel = self.clone();
        gel.ports_mm = places_mm.to_vec();
        gel.networks.taxels = None;
        Ok(gel)
    }

    /// Whether the pressure at a port with this center can be evaluated: it was trained where a
    /// port is within the base of the gel, or at the taxels alone if boxes are cast into the gel.
    #[must_use]
    pub fn has_port_at(&self, place_mm: DVec2) -> bool {
        let is_taxel = |port: &Port| port.position_mm.truncate().distance(place_mm) < 1e-9;
        let is_trained = place_mm.is_finite() && !self.gel.has_inclusions();
        self.ports.iter().any(is_taxel)
            || (is_trained && self.gel.has_base_under(place_mm, self.port_radius_mm()))
    }

    /// Corners in plan of the area in which ports can be, mm: the lowest and the highest; `None` if
    /// ports can be at the taxels alone.
    #[must_use]
    pub fn port_bounds_mm(&self) -> Option<[DVec2; 2]> {
        let [low_mm, high_mm] = self.bounds_mm();
        let radius_mm = self.port_radius_mm();
        (!self.gel.has_inclusions()).then_some([low_mm + radius_mm, high_mm - radius_mm])
    }

    /// Radius of the ports on the base, mm. Where taxels reach over the gel's side, training
    /// presses were evaluated up to the side.
    fn port_radius_mm(&self) -> f64 {
        let is_inside = |port: &Port| {
            self.gel
                .has_base_under(port.position_mm.truncate(), port.radius_mm)
        };
        match self.ports.first() {
            Some(port) if self.ports.iter().all(is_inside) => port.radius_mm,
            _ => 0.0,
        }
    }

    /// Corners of the gel in plan, mm: the lowest and the highest.
    #[must_use]
    pub fn bounds_mm(&self) -> [DVec2; 2] {
        let low_mm = self.layout.surroundings.low_mm();
        [low_mm, 2.0 * self.center_mm.truncate() - low_mm]
    }

    /// Height of the undeformed gel above the board, mm, interpolated linearly between points that
    /// are 2 mm apart, or a tenth of the gel's height where that is more.
    #[must_use]
    pub fn height_mm_at(&self, place_mm: DVec2) -> f64 {
        self.layout.grid().height_mm_at(place_mm)
    }
}

/// The error for a port where a surrogate was not trained.
#[derive(Clone, Copy, Debug, PartialEq, Error)]
#[error("the surrogate was not trained for a port at ({}, {}) mm, but {}", .place_mm.x, .place_mm.y, area(.within_mm.as_ref()))]
pub struct PortElsewhere {
    /// The center of the port.
    pub place_mm: DVec2,
    /// Corners in plan of the area in which ports can be, mm; `None` for the taxels alone.
    pub within_mm: Option<[DVec2; 2]>,
}

fn area(within_mm: Option<&[DVec2; 2]>) -> String {
    within_mm.map_or_else(
        || "at the taxels alone, because boxes are cast into the gel".to_owned(),
        |[low, high]| {
            format!(
                "where a port is within the gel, from ({}, {}) to ({}, {}) mm",
                low.x, low.y, high.x, high.y
            )
        },
    )
}

/// For each location, the number of its mirror image about a center across an axis; `None` if a
/// location has none.
fn mirror_images(places_mm: &[DVec2], center_mm: DVec2, axis: usize) -> Option<Vec<usize>> {
    let image = |at: &DVec2| {
        let mut image_mm = *at;
        image_mm[axis] = 2.0 * center_mm[axis] - at[axis];
        places_mm.iter().position(|at| at.distance(image_mm) < 1e-6)
    };
    places_mm.iter().map(image).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use twintac_sensor::SensorFile;

    #[test]
    fn the_fingertip_is_its_mirror_image_across_y_alone() {
        let sensor = SensorFile::phystac_tip().unwrap().sensor;
        let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
        let center_mm = (0.5 * (low + high)).with_z(high.z);
        let layout = Layout::of(&sensor);
        let is_symmetric = layout.grid().is_symmetric(center_mm.truncate());
        assert_eq!(is_symmetric, [false, true]);
        let ports_mm = Port::places_mm(&Port::all(&sensor));
        let images = |axis| mirror_images(&ports_mm, center_mm.truncate(), axis);
        assert_eq!(images(1), Some(vec![2, 1, 0, 5, 4, 3, 7, 6]));
        assert_eq!(images(0), None);
    }
}
