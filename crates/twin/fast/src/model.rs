//! What a trained fast twin is made of.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use twintac_sensor::Sensor;
use twintac_shape::{ShapeError, Solid};

use crate::Lesson;
use crate::layout::Layout;
use crate::lesson::lesson_places_mm;
use crate::networks::Networks;
use crate::novelty::Novelty;
use crate::taught::{FastGelMismatch, Port, TaughtGel};
use crate::training::{Course, Frames, TrainProgress, TrainSettings, train};

/// A fast twin of one sensor's gel: from what touches to the pressure at each port and the force.
#[derive(Clone, Debug, PartialEq)]
pub struct FastGel {
    pub(crate) sensor: String,
    /// The gel that it was taught, which its readers share.
    pub(crate) gel: Arc<TaughtGel>,
    /// The ports that it was taught, those of the sensor. `[n_taxels]`
    pub(crate) ports: Vec<Port>,
    pub(crate) layout: Layout,
    /// Where it is read, mm: at those ports, unless [`Self::with_ports`] has moved them.
    /// `[n_taxels]`
    pub(crate) ports_mm: Vec<DVec2>,
    /// About which torques count, mm.
    pub(crate) center_mm: DVec3,
    pub(crate) networks: Networks,
    pub(crate) novelty: Novelty,
}

impl FastGel {
    /// Learns from presses of a sensor's gel, and from others, which are held out, how far off it
    /// then is where few lessons pressed: its novelty tells. With none held out nobody knows, and
    /// places count as sure where any lesson pressed.
    ///
    /// # Errors
    /// A lesson whose shape can't be.
    ///
    /// # Panics
    /// No lesson with a frame.
    pub fn train(
        sensor: &Sensor,
        (lessons, held_out): (&[Lesson], &[Lesson]),
        settings: &TrainSettings,
        seed: u64,
        progress: &mut dyn FnMut(TrainProgress),
    ) -> Result<Self, ShapeError> {
        let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
        let layout = Layout::of(sensor);
        let center_mm = (0.5 * (low + high)).with_z(high.z);
        let places_mm = lesson_places_mm(sensor);
        let places = (&places_mm[..], sensor.taxels.len());
        let frames = Frames::of(lessons, &layout, places, center_mm, &sensor.surfaces)?;
        // A surface of triangles may have the heights of its mirror image, and other sides.
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
            // What a port feels over the gel's side is felt in few other places: patches do not tell it.
            mirrored_taxels: sensor.has_port_at_side().then(|| [0, 1].map(mirrored)),
            seed,
        };
        let networks = train(&course, progress);
        let mut trained = Self {
            novelty: Novelty::of(&frames, layout.grid(), is_symmetric),
            sensor: sensor.name.clone(),
            gel: Arc::new(TaughtGel::of(sensor)),
            ports,
            ports_mm,
            layout,
            center_mm,
            networks,
        };
        trained.calibrate_novelty(held_out, &sensor.surfaces)?;
        Ok(trained)
    }
}

impl FastGel {
    /// Name of the sensor.
    #[must_use]
    pub fn sensor(&self) -> &str {
        &self.sensor
    }

    /// Whether it is the fast gel of a sensor: whether it was taught the sensor's gel (shape,
    /// material, shell, and what is cast into it) and is read at the sensor's ports. Names do not
    /// count, nor do indenters, limits, the read-out, relaxation and friction, which a fast gel
    /// does not know.
    ///
    /// # Errors
    /// All that differs, in words.
    pub fn check(&self, sensor: &Sensor) -> Result<(), FastGelMismatch> {
        let mut differences = self.gel.differences(&TaughtGel::of(sensor));
        differences.extend(Port::difference(&self.read_ports(), &Port::all(sensor)));
        FastGelMismatch::of((&self.sensor, &sensor.name), differences)
    }

    /// The ports at which it is read.
    fn read_ports(&self) -> Vec<Port> {
        match &self.ports[..] {
            ports if Port::places_mm(ports) == self.ports_mm => ports.to_vec(),
            [] => Vec::new(),
            [first, ..] => self.ports_mm.iter().map(|at| first.at(*at)).collect(),
        }
    }

    /// Where it is read in the gel's plane, mm: at the ports, in their order. `[n_taxels]`
    #[must_use]
    pub fn ports_mm(&self) -> &[DVec2] {
        &self.ports_mm
    }

    /// The same gel with its ports at other places of the floor, mm, instead of the taxels': a reading is the pressure over a disc as large as a
    /// port there. Ports on a regular grid share what they need: thousands take a few MB. Where taxels reach over the gel's side, pressures at other places are
    /// less exact than the taxels' own.
    #[must_use]
    pub fn with_ports(&self, places_mm: &[DVec2]) -> Self {
        let mut gel = self.clone();
        gel.ports_mm = places_mm.to_vec();
        gel.networks.taxels = None;
        gel
    }

    /// Corners of the gel in plan, mm.
    #[must_use]
    pub fn bounds_mm(&self) -> [DVec2; 2] {
        let low_mm = self.layout.surroundings.low_mm();
        [low_mm, 2.0 * self.center_mm.truncate() - low_mm]
    }

    /// Height of the undeformed gel above the board, mm, linear between points 2 mm apart.
    #[must_use]
    pub fn height_mm_at(&self, place_mm: DVec2) -> f64 {
        self.layout.grid().height_mm_at(place_mm)
    }
}

/// For each place, the number of its mirror image about a center across an axis; `None` if one of them has none.
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
