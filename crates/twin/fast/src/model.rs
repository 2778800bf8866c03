//! What a trained fast twin is made of.

use glam::{DVec2, DVec3};
use twintac_sensor::Sensor;
use twintac_shape::{ShapeError, Solid};

use crate::Lesson;
use crate::layout::Layout;
use crate::lesson::lesson_places_mm;
use crate::networks::Networks;
use crate::novelty::Novelty;
use crate::training::{Course, Frames, TrainProgress, TrainSettings, train};

/// A fast twin of one sensor's gel: from what touches to the pressure at each port and the force.
#[derive(Clone, Debug, PartialEq)]
pub struct FastGel {
    pub(crate) sensor: String,
    pub(crate) layout: Layout,
    /// Where the ports are, mm. `[n_taxels]`
    pub(crate) ports_mm: Vec<DVec2>,
    /// About which torques count, mm.
    pub(crate) center_mm: DVec3,
    pub(crate) networks: Networks,
    pub(crate) novelty: Novelty,
}

impl FastGel {
    /// Learns from presses of a sensor's gel.
    ///
    /// # Errors
    /// A lesson whose shape can't be.
    ///
    /// # Panics
    /// No lesson with a frame.
    pub fn train(
        sensor: &Sensor,
        lessons: &[Lesson],
        settings: &TrainSettings,
        seed: u64,
        progress: &mut dyn FnMut(TrainProgress),
    ) -> Result<Self, ShapeError> {
        let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
        let layout = Layout::of(sensor);
        let center_mm = (0.5 * (low + high)).with_z(high.z);
        let places_mm = lesson_places_mm(sensor);
        let places = (&places_mm[..], sensor.taxels.len());
        let frames = Frames::of(lessons, &layout, places, center_mm)?;
        // A surface of triangles may have the heights of its mirror image, and other sides.
        let has_known_sides = !matches!(sensor.gel.solid, Solid::Stl { .. });
        let is_symmetric = layout.is_symmetric(center_mm).map(|is| is && has_known_sides);
        let ports_mm = ports_mm(sensor);
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
        Ok(Self {
            novelty: Novelty::of(&frames, layout.grid()),
            sensor: sensor.name.clone(),
            ports_mm,
            layout,
            center_mm,
            networks,
        })
    }
}

impl FastGel {
    /// Name of the sensor.
    #[must_use]
    pub fn sensor(&self) -> &str {
        &self.sensor
    }

    /// Where the ports are in the gel's plane, mm. `[n_taxels]`
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

/// Where a sensor's ports are, mm.
fn ports_mm(sensor: &Sensor) -> Vec<DVec2> {
    let taxels = sensor.taxels.iter();
    taxels.map(|taxel| taxel.position_mm.truncate()).collect()
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
        assert_eq!(Layout::of(&sensor).is_symmetric(center_mm), [false, true]);
        let images = |axis| mirror_images(&ports_mm(&sensor), center_mm.truncate(), axis);
        assert_eq!(images(1), Some(vec![2, 1, 0, 5, 4, 3, 7, 6]));
        assert_eq!(images(0), None);
    }
}
