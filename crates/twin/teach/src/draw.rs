//! What is pressed, where and how deep.

use std::f64::consts::TAU;

use glam::{DQuat, DVec2, DVec3};
use rand::Rng;
use twintac_sensor::Sensor;
use twintac_shape::{Part, Pose, Shape};

/// The gel's width of which the sizes below are, mm: the root of PhysTac's area.
const WIDTH_MM: f64 = 25.0;

/// Largest tilt of a press, radians.
const LARGEST_TILT: f64 = 0.3;

/// Largest tilt of a part of a whole.
const LARGEST_TILT_OF_PART: f64 = 0.4;

/// How deep a press goes at most, of the gel's height.
const DEEPEST: f64 = 0.6;

/// Height of the gel for which meshes have the edges below, mm: PhysTac's.
const HEIGHT_MM: f64 = 8.5;

/// The shortest edges under a shape, mm.
const FINEST_MM: f64 = 0.6;

/// A press to teach with.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Draw {
    pub(crate) shape: Shape,
    pub(crate) place_mm: DVec2,
    pub(crate) rotation: DQuat,
    pub(crate) depth_mm: f64,
    pub(crate) edge_mm: f64,
    pub(crate) edges_per_height: f64,
}

/// Counts how presses have been drawn: those of another version are other presses, though number and seed be the same.
pub const DRAW_VERSION: u32 = 1;

/// What is drawn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Purpose {
    /// Balls, cylinders, boxes, rings and wedges, alone or together; most on coarse meshes.
    Lesson,
    /// Crosses and triangles, which no lesson has, on fine meshes.
    Exam,
}

/// Draws a press for a sensor.
pub(crate) fn draw(sensor: &Sensor, purpose: Purpose, random: &mut impl Rng) -> Draw {
    let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
    let size_mm = (high - low).truncate();
    let scale = size_mm.element_product().sqrt() / WIDTH_MM;
    let height_mm = high.z - low.z;
    let shape = match (purpose, random.random_range(0..7)) {
        (Purpose::Exam, kind) => unseen(kind, scale, random),
        (Purpose::Lesson, kind @ 0..5) => simple(kind, scale, random),
        (Purpose::Lesson, _) => whole(scale, random),
    };
    // Coarse presses are cheap, so that there are many; fine ones are right.
    let (edges_per_height, finest_mm, coarsest_mm) = match random.random_range(0..3) {
        _ if purpose == Purpose::Exam => (7.0, FINEST_MM, FINEST_MM),
        0 => (6.0, 1.05, 1.4),
        1 => (7.0, 0.8, 1.05),
        _ => (7.0, FINEST_MM, 0.8),
    };
    let tilt = if random.random_bool(0.4) {
        0.0
    } else {
        random.random_range(0.0..LARGEST_TILT)
    };
    let limit_mm = sensor.limits.map_or(f64::INFINITY, |limits| limits.depth_mm);
    let deepest_mm = limit_mm.min(DEEPEST * height_mm);
    Draw {
        shape,
        place_mm: low.truncate() + size_mm * DVec2::new(random.random(), random.random()),
        rotation: turned(tilt, random),
        depth_mm: deepest_mm * random.random_range(0.2..1.0),
        edge_mm: height_mm / HEIGHT_MM
            * if finest_mm < coarsest_mm {
                random.random_range(finest_mm..coarsest_mm)
            } else {
                finest_mm
            },
        edges_per_height,
    }
}

/// Turned at random about the vertical, then tilted in a random direction.
fn turned(tilt: f64, random: &mut impl Rng) -> DQuat {
    let axis = DVec2::from_angle(random.random_range(0.0..TAU)).extend(0.0);
    let spin = DQuat::from_rotation_z(random.random_range(0.0..TAU));
    (DQuat::from_axis_angle(axis, tilt) * spin).normalize()
}

/// A shape of one piece, tall enough never to be pushed in to its top.
fn simple(kind: u32, scale: f64, random: &mut impl Rng) -> Shape {
    let mut between = |low: f64, high: f64| scale * random.random_range(low..high);
    let edge_radius_mm = between(0.6, 1.6);
    let height_mm = 14.0 * scale;
    match kind {
        0 => Shape::Sphere {
            radius_mm: between(2.5, 15.0),
        },
        1 => Shape::Cylinder {
            radius_mm: between(2.0, 8.0),
            height_mm,
            edge_radius_mm,
        },
        2 => Shape::Box {
            size_mm: [between(3.5, 16.0), between(3.5, 16.0), height_mm],
            edge_radius_mm,
        },
        3 => {
            let outer_radius_mm = between(4.0, 9.0);
            let inner_radius_mm = between(0.25, 0.75) / scale * outer_radius_mm;
            Shape::Ring {
                outer_radius_mm,
                inner_radius_mm,
                height_mm,
                edge_radius_mm: edge_radius_mm.min(0.45 * (outer_radius_mm - inner_radius_mm)),
            }
        }
        _ => Shape::Wedge {
            angle_rad: between(0.9, 2.4) / scale,
            length_mm: between(6.0, 20.0),
            height_mm: 0.7 * height_mm,
            edge_radius_mm,
        },
    }
}

/// A shape that is not among the simple ones.
fn unseen(kind: u32, scale: f64, random: &mut impl Rng) -> Shape {
    let mut between = |low: f64, high: f64| scale * random.random_range(low..high);
    let edge_radius_mm = between(0.6, 1.6);
    let height_mm = 14.0 * scale;
    if kind.is_multiple_of(2) {
        Shape::X {
            length_mm: between(10.0, 18.0),
            width_mm: between(3.3, 5.0),
            height_mm,
            edge_radius_mm,
        }
    } else {
        Shape::Triangle {
            side_mm: between(8.0, 18.0),
            height_mm,
            edge_radius_mm,
        }
    }
}

/// Two or three shapes beside each other.
fn whole(scale: f64, random: &mut impl Rng) -> Shape {
    let n_parts = random.random_range(2..4);
    let mut part = |_| {
        let shape = simple(random.random_range(0..5), scale, random);
        let tilt = if random.random_bool(0.5) {
            0.0
        } else {
            random.random_range(0.0..LARGEST_TILT_OF_PART)
        };
        let mut between = |low: f64, high: f64| scale * random.random_range(low..high);
        let position_mm = DVec3::new(between(-9.0, 9.0), between(-9.0, 9.0), between(0.0, 1.5));
        Part {
            shape,
            whole_from_part: Pose {
                position_mm,
                rotation: turned(tilt, random),
            },
        }
    };
    Shape::Union {
        parts: (0..n_parts).map(&mut part).collect(),
    }
}
