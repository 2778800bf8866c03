//! The surface of a rigid indenter as a skin of solid elements with curved faces.
//!
//! Every indenter here is a flat plate (a disc, a rectangle, or, for a ball, a point), expanded by
//! a radius in all directions.

use std::collections::BTreeMap;
use std::f64::consts::{FRAC_PI_2, TAU};

use glam::{DVec2, DVec3};
use twintac_shape::Shape;

/// Angle of one face around a ball or a disc, radians.
const WIDE_RAD: f64 = 0.3;

/// Angle of one face across a rounded edge, radians.
const ROUNDING_RAD: f64 = 0.53;

/// Angle of the part of a ball that can touch, from its lowest point, radians.
const BALL_RAD: f64 = 1.1;

/// Heights of the walls above the rounded edge, mm.
const WALL_MM: [f64; 2] = [1.5, 3.0];

/// A shell of 15-node wedges and 20-node hexahedra.
pub(super) struct Skin {
    /// Positions of the nodes, mm. The indenter's lowest point is the origin.
    pub(super) nodes_mm: Vec<DVec3>,
    /// Nodes of each element: corners of the outer face, of the inner face, then midpoints of the
    /// outer face's edges, of the inner face's edges, and of the edges between the faces.
    pub(super) elements: Vec<Vec<usize>>,
}

/// A point on the rim of the plate, and the direction in which the rounded edge leaves it.
#[derive(Clone, Copy)]
struct Rim {
    at_mm: DVec2,
    outwards: DVec2,
}

/// The angle around the rounded edge, and the height on the wall.
#[derive(Clone, Copy)]
struct Ring {
    turn_rad: f64,
    wall_mm: f64,
}

impl Skin {
    /// The skin of a ball, a cylinder or a box; `None` for others.
    pub(super) fn of(shape: &Shape) -> Option<Self> {
        let (rim, radius_mm) = match *shape {
            Shape::Sphere { radius_mm } => (disc(0.0), radius_mm),
            Shape::Cylinder {
                radius_mm,
                edge_radius_mm,
                ..
            } => (disc(radius_mm - edge_radius_mm), edge_radius_mm),
            Shape::Box {
                size_mm,
                edge_radius_mm,
            } => {
                let half_mm = 0.5 * DVec2::new(size_mm[0], size_mm[1]) - edge_radius_mm;
                (rectangle(half_mm), edge_radius_mm)
            }
            _ => return None,
        };
        let rings = rings(matches!(shape, Shape::Sphere { .. }));
        let mut skin = Self {
            nodes_mm: Vec::new(),
            elements: Vec::new(),
        };
        // Points alternate between corners and midpoints.
        let place = |around: usize, ring: Ring, part: f64| {
            let Rim { at_mm, outwards } = rim[around % rim.len()];
            let grown_mm = part * radius_mm;
            let aside_mm = at_mm + outwards * (grown_mm * ring.turn_rad.sin());
            aside_mm.extend(radius_mm - grown_mm * ring.turn_rad.cos() + ring.wall_mm)
        };
        for around in (0..rim.len()).step_by(2) {
            let flat = |part: f64| {
                let [a, middle, b] = [0, 1, 2].map(|i| place(around + i, rings[0], part));
                let center = a.with_x(0.0).with_y(0.0);
                vec![center, a, b, center.midpoint(a), middle, b.midpoint(center)]
            };
            skin.add(flat);
            for ring in rings.windows(3).step_by(2) {
                let face = |part: f64| {
                    let corners = [(0, 0), (0, 2), (2, 2), (2, 0), (0, 1), (1, 2), (2, 1), (1, 0)];
                    corners.map(|(i, j)| place(around + i, ring[j], part)).to_vec()
                };
                skin.add(face);
            }
        }
        skin.merge();
        Some(skin)
    }

    /// Adds the element of a face. `face` returns its nodes at a relative radius (1: outer, 0.5:
    /// inner). If the last edge has no length, the face is a triangle; if another edge has none,
    /// there is no element.
    fn add(&mut self, face: impl Fn(f64) -> Vec<DVec3>) {
        const SAME_MM: f64 = 1e-9;
        let [outer, middle, inner] = [1.0, 0.75, 0.5].map(|part| {
            let mut nodes = face(part);
            if nodes.len() == 8 && face(1.0)[0].distance(face(1.0)[3]) < SAME_MM {
                nodes = [0, 1, 2, 4, 5, 6].map(|node| nodes[node]).to_vec();
            }
            nodes
        });
        let n = outer.len() / 2;
        if (0..n).any(|i| outer[i].distance(outer[(i + 1) % n]) < SAME_MM) {
            return;
        }
        let parts = [&outer[..n], &inner[..n], &outer[n..], &inner[n..], &middle[..n]];
        let first = self.nodes_mm.len();
        self.nodes_mm.extend(parts.concat());
        self.elements.push((first..self.nodes_mm.len()).collect());
    }

    /// Merges nodes at the same position.
    fn merge(&mut self) {
        let mut known = BTreeMap::new();
        let mut nodes_mm = Vec::new();
        for node in self.elements.iter_mut().flatten() {
            let at_mm = self.nodes_mm[*node];
            let key = (at_mm * 1e7).round().as_i64vec3().to_array();
            *node = *known.entry(key).or_insert_with(|| {
                nodes_mm.push(at_mm);
                nodes_mm.len() - 1
            });
        }
        self.nodes_mm = nodes_mm;
    }
}

/// The rings from the plate outwards.
fn rings(is_ball: bool) -> Vec<Ring> {
    let (most_rad, step_rad) = if is_ball {
        (BALL_RAD, WIDE_RAD)
    } else {
        (FRAC_PI_2, ROUNDING_RAD)
    };
    let n = 2 * (most_rad / step_rad).ceil() as usize;
    let turn = |i: usize| Ring {
        turn_rad: most_rad * i as f64 / n as f64,
        wall_mm: 0.0,
    };
    let mut rings: Vec<Ring> = (0..=n).map(turn).collect();
    if !is_ball {
        rings.extend(WALL_MM.map(|wall_mm| Ring {
            turn_rad: FRAC_PI_2,
            wall_mm,
        }));
    }
    rings
}

fn disc(radius_mm: f64) -> Vec<Rim> {
    let n = 2 * (TAU / WIDE_RAD).ceil() as usize;
    (0..n)
        .map(|i| DVec2::from_angle(TAU * i as f64 / n as f64))
        .map(|outwards| Rim {
            at_mm: radius_mm * outwards,
            outwards,
        })
        .collect()
}

/// The rim of a rectangle: around four corners, and along four sides.
fn rectangle(half_mm: DVec2) -> Vec<Rim> {
    let n = 2 * (FRAC_PI_2 / ROUNDING_RAD).ceil() as usize;
    let corners = [
        DVec2::ONE,
        DVec2::new(-1.0, 1.0),
        DVec2::NEG_ONE,
        DVec2::new(1.0, -1.0),
    ];
    let mut rim = Vec::new();
    for (corner, &sign) in corners.iter().enumerate() {
        let (at_mm, next_mm) = (half_mm * sign, half_mm * corners[(corner + 1) % 4]);
        let outwards = |turn: usize| DVec2::from_angle(FRAC_PI_2 * (corner as f64 + turn as f64 / n as f64));
        rim.extend((0..=n).map(|turn| Rim {
            at_mm,
            outwards: outwards(turn),
        }));
        rim.extend((1..4).map(|i| Rim {
            at_mm: at_mm.lerp(next_mm, f64::from(i) / 4.0),
            outwards: outwards(n),
        }));
    }
    rim
}
