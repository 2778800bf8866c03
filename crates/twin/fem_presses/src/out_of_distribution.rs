//! Out-of-distribution (OOD) presses, with which the OOD score is tested.

use std::f64::consts::TAU;

use glam::{DQuat, DVec2, DVec3};
use rand::Rng;
use serde::Serialize;
use twintac_random::RandomStream;
use twintac_sensor::Sensor;
use twintac_shape::{Part, Pose, Shape};

use crate::draw::{Draw, LARGEST_TILT, deepest_mm, scale, simple, upright};

/// A kind of out-of-distribution press.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "kebab-case")]
pub enum OodKind {
    /// Training shapes, deeper than any training press.
    Deeper,
    /// Balls and rods that are thinner than those of training presses.
    Thin,
    /// Wedges that are sharper than those of training presses.
    Sharp,
    /// Training shapes with a larger tilt.
    Tilted,
    /// Six small balls at once.
    Crowded,
}

impl OodKind {
    /// All of them.
    pub const ALL: [Self; 5] = [Self::Deeper, Self::Thin, Self::Sharp, Self::Tilted, Self::Crowded];

    /// The name in files.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Deeper => "deeper",
            Self::Thin => "thin",
            Self::Sharp => "sharp",
            Self::Tilted => "tilted",
            Self::Crowded => "crowded",
        }
    }

    /// A press, and the depth from which it is out of distribution, mm.
    pub(crate) fn draw(self, sensor: &Sensor, random: &mut RandomStream) -> (Draw, f64) {
        let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
        let within = DVec2::new(random.random(), random.random());
        let place_mm = low.truncate() + (high - low).truncate() * within;
        let tilt = match self {
            Self::Tilted => random.random_range(2.0..3.3) * LARGEST_TILT,
            _ => random.random_range(0.0..LARGEST_TILT),
        };
        let axis = DVec2::from_angle(random.random_range(0.0..TAU)).extend(0.0);
        let shape = self.shape(scale(sensor), random);
        let deepest_mm = deepest_mm(sensor);
        let (depth_mm, from_mm) = match self {
            Self::Deeper => (1.15 * deepest_mm, deepest_mm),
            _ => (random.random_range(0.35..1.0) * deepest_mm, 0.0),
        };
        let drawn = upright(sensor, &shape, place_mm, random.random_range(0.0..TAU), depth_mm);
        let drawn = Draw {
            rotation: (DQuat::from_axis_angle(axis, tilt) * drawn.rotation).normalize(),
            ..drawn
        };
        (drawn, from_mm)
    }

    fn shape(self, scale: f64, random: &mut RandomStream) -> Shape {
        match self {
            Self::Deeper => simple(random.random_range(0..5), scale, random),
            Self::Thin if random.random_bool(0.5) => Shape::Sphere {
                radius_mm: scale * random.random_range(0.6..1.2),
            },
            Self::Thin => Shape::Cylinder {
                radius_mm: scale * random.random_range(0.5..1.0),
                height_mm: 14.0 * scale,
                edge_radius_mm: 0.3 * scale,
            },
            Self::Sharp => Shape::Wedge {
                angle_rad: random.random_range(0.4..0.8),
                length_mm: scale * random.random_range(6.0..20.0),
                height_mm: 10.0 * scale,
                edge_radius_mm: scale * random.random_range(0.1..0.3),
            },
            // No ball: it looks the same at any tilt.
            Self::Tilted => simple(random.random_range(1..5), scale, random),
            Self::Crowded => {
                let parts = (0..6).map(|number| {
                    let [column, row] = [f64::from(number % 3) - 1.0, f64::from(number / 3) - 0.5];
                    Part {
                        shape: Shape::Sphere {
                            radius_mm: scale * random.random_range(1.3..2.3),
                        },
                        whole_from_part: Pose::from_position(
                            scale * DVec3::new(6.0 * column, 6.0 * row, 0.0),
                        ),
                    }
                });
                Shape::Union {
                    parts: parts.collect(),
                }
            }
        }
    }
}
