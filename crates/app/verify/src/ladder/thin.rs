//! Random bodies that are thin, hollow, sharp or made of several parts.

use glam::{DQuat, DVec3};
use rand::Rng;
use rand_chacha::ChaCha8Rng;
use twintac_shape::{Part, Pose, Shape};

/// A plate, ring, blade, pin, wedge, cup, bracket or cross.
pub(super) fn invent(random: &mut ChaCha8Rng) -> (&'static str, Shape) {
    let thickness_mm = 0.2 * 15.0_f64.powf(random.random_range(0.0..1.0));
    let long_mm = random.random_range(6.0..14.0);
    match random.random_range(0..8) {
        0 => ("plate", block([long_mm, 0.8 * long_mm, thickness_mm])),
        1 => ("ring", ring(long_mm, thickness_mm, 8.0)),
        2 => ("blade", block([thickness_mm, long_mm, 8.0])),
        3 => ("pin", pin(thickness_mm)),
        4 => {
            let wedge = Shape::Wedge {
                angle_rad: random.random_range(0.5..2.5),
                length_mm: long_mm,
                height_mm: 8.0,
                edge_radius_mm: 0.1 * thickness_mm,
            };
            ("wedge", wedge)
        }
        5 => {
            let lid = Part {
                shape: pin_of(0.5 * long_mm - 0.01, 1.0),
                whole_from_part: Pose::from_position(DVec3::Z * 5.0),
            };
            ("cup", union(vec![part(ring(long_mm, thickness_mm, 6.0)), lid]))
        }
        6 => {
            let web = Part {
                shape: block([2.0, long_mm - 0.1, 6.0]),
                whole_from_part: Pose::from_position(DVec3::Z * (0.5 * thickness_mm)),
            };
            (
                "bracket",
                union(vec![part(block([long_mm, long_mm, thickness_mm])), web]),
            )
        }
        _ => {
            let bar = block([long_mm, 0.3 * long_mm, 6.0]);
            let across = Part {
                shape: bar.clone(),
                whole_from_part: Pose {
                    rotation: DQuat::from_rotation_z(random.random_range(0.3..1.6)),
                    ..Pose::IDENTITY
                },
            };
            ("cross", union(vec![part(bar), across]))
        }
    }
}

fn block(size_mm: [f64; 3]) -> Shape {
    let least_mm = size_mm.into_iter().fold(f64::INFINITY, f64::min);
    Shape::Box {
        size_mm,
        edge_radius_mm: (0.25 * least_mm).min(0.3),
    }
}

fn ring(outside_mm: f64, wall_mm: f64, height_mm: f64) -> Shape {
    let outer_radius_mm = 0.5 * outside_mm;
    let wall_mm = wall_mm.min(0.8 * outer_radius_mm);
    Shape::Ring {
        outer_radius_mm,
        inner_radius_mm: outer_radius_mm - wall_mm,
        height_mm,
        edge_radius_mm: 0.25 * wall_mm,
    }
}

fn pin(thickness_mm: f64) -> Shape {
    pin_of(0.5 * thickness_mm, 8.0)
}

fn pin_of(radius_mm: f64, height_mm: f64) -> Shape {
    Shape::Cylinder {
        radius_mm,
        height_mm,
        edge_radius_mm: 0.25 * radius_mm.min(0.5 * height_mm),
    }
}

fn part(shape: Shape) -> Part {
    Part {
        shape,
        whole_from_part: Pose::IDENTITY,
    }
}

fn union(parts: Vec<Part>) -> Shape {
    Shape::Union { parts }
}
