//! The surrogate of the gel ([`FastGel`]) as a forward model of contacts.

use std::sync::Arc;

use glam::{DQuat, DVec2};
use serde::{Deserialize, Serialize};
use twintac_fast::{Body, FastGel, FastReader};
use twintac_shape::{Pose, Shape, ShapeError, Surfaces};

use crate::contact::Contact;
use crate::model::{ContactModel, Domain, Press};
use crate::turn::turn_rad;

/// A shape that may be in contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct KnownShape {
    /// Its name.
    pub name: String,
    /// The shape.
    pub shape: Shape,
}

/// Readings of a [`FastGel`] under known shapes that press upright.
///
/// First touch is where the lowest point of a shape is at the height of the gel at its location.
/// This is exact for flat gels.
#[derive(Clone, Debug)]
pub struct FastModel {
    gel: Arc<FastGel>,
    bodies: Arc<Vec<Placed>>,
    reader: FastReader,
    depths_mm: [f64; 2],
}

#[derive(Clone, Debug)]
struct Placed {
    body: Body,
    /// Height of the body's lowest point in its own frame, mm.
    lowest_mm: f64,
    turn_rad: Option<f64>,
}

impl FastModel {
    /// A model of these shapes, for presses down to `deepest_mm` below first touch.
    ///
    /// # Errors
    /// An impossible shape.
    pub fn new(
        gel: &FastGel,
        shapes: &[KnownShape],
        surfaces: &Surfaces,
        deepest_mm: f64,
    ) -> Result<Self, ShapeError> {
        let placed = |known: &KnownShape| {
            let (low, _) = known.shape.signed_distance_field(surfaces)?.bounds_mm();
            Ok(Placed {
                body: Body::new(&known.shape, surfaces)?,
                lowest_mm: low.z,
                turn_rad: turn_rad(&known.shape),
            })
        };
        Ok(Self {
            bodies: Arc::new(shapes.iter().map(placed).collect::<Result<_, _>>()?),
            reader: gel.reader(),
            gel: Arc::new(gel.clone()),
            depths_mm: [0.01 * deepest_mm, deepest_mm],
        })
    }

    /// The gel.
    #[must_use]
    pub fn gel(&self) -> &FastGel {
        &self.gel
    }

    /// The body of a contact, and its pose in the gel's frame.
    #[must_use]
    pub fn placed(&self, contact: &Contact) -> (&Body, Pose) {
        let placed = &self.bodies[contact.shape];
        (&placed.body, pose(&self.gel, placed, &contact.press()))
    }
}

fn pose(gel: &FastGel, placed: &Placed, press: &Press) -> Pose {
    let touch_mm = gel.height_mm_at(press.place_mm) - placed.lowest_mm;
    Pose {
        position_mm: press.place_mm.extend(touch_mm - press.depth_mm),
        rotation: DQuat::from_rotation_z(press.yaw_rad),
    }
}

impl ContactModel for FastModel {
    fn n_readings(&self) -> usize {
        self.gel.n_taxels()
    }

    fn n_shapes(&self) -> usize {
        self.bodies.len()
    }

    fn domain(&self, shape: usize) -> Domain {
        let [low, high]: [DVec2; 2] = self.gel.bounds_mm();
        Domain {
            places_mm: [low, high],
            depths_mm: self.depths_mm,
            turn_rad: self.bodies[shape].turn_rad,
        }
    }

    fn read(&mut self, shape: usize, press: &Press, readings_kpa: &mut [f32]) -> f64 {
        let placed = &self.bodies[shape];
        let mut wrench = [0.0; 6];
        let there = [(&placed.body, pose(&self.gel, placed, press))];
        self.reader.read(&there, readings_kpa, &mut wrench);
        f64::from(-wrench[2])
    }
}
