//! Random choice of shape, location, depth and mesh of a press.

use std::f64::consts::TAU;

use glam::{DQuat, DVec2, DVec3};
use rand::Rng;
use twintac_fast::finest_edge_mm;
use twintac_sensor::Sensor;
use twintac_shape::{Part, Pose, Shape, SurfaceFile};

use crate::random_mesh;

/// Width of the gel for which the sizes below hold, mm: the root of the area of PhysTac's gel.
const WIDTH_MM: f64 = 25.0;

/// Largest tilt of a press, radians.
pub(crate) const LARGEST_TILT: f64 = 0.3;

/// Largest rotation during a sliding press, radians.
const LARGEST_TURN: f64 = 0.15;

/// Largest tilt of a part of a union, radians.
const LARGEST_TILT_OF_PART: f64 = 0.4;

/// Largest depth of a press, as a fraction of the gel's height.
const DEEPEST: f64 = 0.6;

/// The deepest frame of a press has at least this fraction of the largest depth. The frames before
/// it cover smaller depths.
const SHALLOWEST: f64 = 0.35;

/// Edges under a shape over the shortest: of accurate meshes, and of cheap ones.
const FINE: [f64; 2] = [1.0, 4.0 / 3.0];
const COARSE: [f64; 2] = [4.0 / 3.0, 1.75];

/// Number of edges over the gel's height, away from the shape.
const EDGES_PER_HEIGHT: f64 = 7.0;

/// A press to be solved.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Draw {
    pub(crate) shape: Shape,
    pub(crate) place_mm: DVec2,
    pub(crate) rotation: DQuat,
    pub(crate) depth_mm: f64,
    pub(crate) edge_mm: f64,
    /// The motion after the shape is down.
    pub(crate) slide: Option<Slide>,
}

/// A motion along the surface.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Slide {
    /// Displacement, mm.
    pub(crate) by_mm: DVec2,
    /// The rotation during the motion, about an axis in the gel's frame.
    pub(crate) turn: DQuat,
}

/// The purpose of a press.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Purpose {
    /// Training: balls, cylinders, boxes, rings and wedges, alone or as a union; a third of them on
    /// coarse meshes.
    Training,
    /// Testing: crosses, triangles and random meshes, which are not trained on, on the finest
    /// meshes; straight down.
    Test,
    /// Testing: the same shapes, which slide and rotate after they are down.
    Slide,
}

/// Radii of the sensor's own balls, as fractions of the described radius: the true size of a tip
/// may have to be fitted.
const OWN_SIZES: [f64; 2] = [0.6, 1.6];

/// Fraction of the gel's extent by which the location moves on from press to press (modulo 1): two
/// numbers whose multiples leave no hole (Roberts, 2018, "The unreasonable effectiveness of
/// quasirandom sequences").
const SPREAD: DVec2 = DVec2::new(0.754_877_666_246_692_7, 0.569_840_290_998_053_2);

/// How far beyond an edge a location may fall, as a fraction of the extent. Such a location is
/// moved to the second fraction from the edge.
const BEYOND: f64 = 0.06;
const AT_EDGE: f64 = 0.01;

/// The purpose of a press with one of the sensor's own indenters.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Own {
    Training,
    Test,
}

/// The press of a number with one of the sensor's own indenters, no farther from the ports than the
/// gel is high; `None` for a sensor without indenters. The locations of successive numbers are
/// spread evenly over this area: a few random locations would leave holes.
pub(crate) fn own(sensor: &Sensor, own: Own, seed: u64, number: u64) -> Option<Draw> {
    let name = match own {
        Own::Training => "own lesson",
        Own::Test => "own exam",
    };
    let first = match own {
        Own::Training => {
            let mut of_all = twintac_random::stream(seed, name);
            DVec2::new(of_all.random(), of_all.random())
        }
        // The first test press is in the middle, however few there are.
        Own::Test => DVec2::splat(0.5),
    };
    let random = &mut twintac_random::stream(seed, &format!("{name} {number}"));
    let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
    let height_mm = height_mm(sensor);
    let ports_mm = sensor.taxels.iter().map(|taxel| taxel.position_mm.truncate());
    let first_mm = ports_mm.clone().fold(DVec2::INFINITY, DVec2::min) - height_mm;
    let last_mm = ports_mm.fold(DVec2::NEG_INFINITY, DVec2::max) + height_mm;
    let (first_mm, last_mm) = (first_mm.max(low.truncate()), last_mm.min(high.truncate()));
    let place_mm = first_mm + (last_mm - first_mm) * towards_edges((first + number as f64 * SPREAD).fract());
    if sensor.indenters.is_empty() {
        return None;
    }
    let indenter = &sensor.indenters[random.random_range(0..sensor.indenters.len())];
    let shape = match indenter.shape {
        Shape::Sphere { radius_mm } => Shape::Sphere {
            radius_mm: radius_mm * random.random_range(OWN_SIZES[0]..OWN_SIZES[1]),
        },
        ref shape => shape.clone(),
    };
    let yaw_rad = random.random_range(0.0..TAU);
    let depth_mm = deepest_mm(sensor) * random.random_range(SHALLOWEST..1.0);
    Some(upright(sensor, &shape, place_mm, yaw_rad, depth_mm))
}

/// Moves more locations close to the edges, because no press lies beyond them. `part`: location as
/// a fraction of the extent.
fn towards_edges(part: DVec2) -> DVec2 {
    let stretched = (1.0 + 2.0 * BEYOND) * part - BEYOND;
    stretched.clamp(DVec2::splat(AT_EDGE), DVec2::splat(1.0 - AT_EDGE))
}

/// Largest depth of presses, mm.
pub(crate) fn deepest_mm(sensor: &Sensor) -> f64 {
    let limit_mm = sensor.limits.map_or(f64::INFINITY, |limits| limits.depth_mm);
    limit_mm.min(DEEPEST * height_mm(sensor))
}

/// Height of the gel, mm.
fn height_mm(sensor: &Sensor) -> f64 {
    let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
    high.z - low.z
}

/// Root of the gel's area in plan, mm.
fn width_mm(sensor: &Sensor) -> f64 {
    let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
    (high - low).truncate().element_product().sqrt()
}

/// The shortest mesh edges under a shape, mm.
fn finest_mm(sensor: &Sensor) -> f64 {
    finest_edge_mm(height_mm(sensor), width_mm(sensor))
}

/// Factor from the sizes below to those of shapes for this sensor.
pub(crate) fn scale(sensor: &Sensor) -> f64 {
    width_mm(sensor) / WIDTH_MM
}

/// Number of edges over the gel's height, away from the shape, for a press with edges of this
/// length under it, mm. Where the side of the gel meets its base, the pressure grows without limit
/// as the mesh gets finer, so the pressure at a port there depends on the edges. For such a sensor
/// all edges of a mesh have one length, so that the pressure does not also depend on the location
/// of the press.
pub(crate) fn edges_per_height(sensor: &Sensor, edge_mm: f64) -> f64 {
    if sensor.has_port_at_side() {
        height_mm(sensor) / edge_mm
    } else {
        EDGES_PER_HEIGHT
    }
}

/// Draws a press for a sensor.
pub(crate) fn draw(sensor: &Sensor, purpose: Purpose, random: &mut impl Rng) -> Draw {
    let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
    let size_mm = (high - low).truncate();
    let scale = scale(sensor);
    let is_for_training = purpose == Purpose::Training;
    let shape = match (is_for_training, random.random_range(0..7)) {
        (false, kind) => unseen(kind, scale, random),
        (true, kind @ 0..5) => simple(kind, scale, random),
        (true, _) => whole(scale, random),
    };
    // Coarse meshes are cheap and allow many presses; fine meshes are accurate.
    let coarseness = match random.random_range(0..3) {
        _ if !is_for_training => None,
        0 => Some(COARSE),
        _ => Some(FINE),
    };
    let tilt = if random.random_bool(0.4) {
        0.0
    } else {
        random.random_range(0.0..LARGEST_TILT)
    };
    let within = DVec2::new(random.random(), random.random());
    let rotation = turned(tilt, random);
    Draw {
        shape,
        place_mm: low.truncate() + size_mm * within,
        rotation,
        depth_mm: deepest_mm(sensor) * random.random_range(SHALLOWEST..1.0),
        edge_mm: finest_mm(sensor) * coarseness.map_or(1.0, |[least, most]| random.random_range(least..most)),
        slide: (purpose == Purpose::Slide).then(|| {
            // Towards the middle, so that the shape stays on the gel.
            let inwards = (DVec2::splat(0.5) - within).to_angle() + random.random_range(-1.0..1.0);
            let axis = DVec2::from_angle(random.random_range(0.0..TAU)).extend(0.0);
            Slide {
                by_mm: scale * random.random_range(2.0..5.0) * DVec2::from_angle(inwards),
                turn: DQuat::from_axis_angle(axis, random.random_range(0.0..LARGEST_TURN)),
            }
        }),
    }
}

/// A press straight down of an upright shape, on the finest mesh.
pub(crate) fn upright(sensor: &Sensor, shape: &Shape, place_mm: DVec2, yaw_rad: f64, depth_mm: f64) -> Draw {
    Draw {
        shape: shape.clone(),
        place_mm,
        rotation: DQuat::from_rotation_z(yaw_rad),
        depth_mm,
        edge_mm: finest_mm(sensor),
        slide: None,
    }
}

/// A random rotation about the vertical, then a tilt in a random direction.
fn turned(tilt: f64, random: &mut impl Rng) -> DQuat {
    let axis = DVec2::from_angle(random.random_range(0.0..TAU)).extend(0.0);
    let yaw = DQuat::from_rotation_z(random.random_range(0.0..TAU));
    (DQuat::from_axis_angle(axis, tilt) * yaw).normalize()
}

/// A shape of one piece, tall enough that its top never goes below the gel's surface.
pub(crate) fn simple(kind: u32, scale: f64, random: &mut impl Rng) -> Shape {
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
            angle_rad: between(1.3, 2.4) / scale,
            length_mm: between(6.0, 20.0),
            height_mm: 0.7 * height_mm,
            // A sharper ridge would slip between the nodes of the mesh.
            edge_radius_mm: between(1.0, 2.0),
        },
    }
}

/// A shape that is not among the simple ones.
fn unseen(kind: u32, scale: f64, random: &mut impl Rng) -> Shape {
    let mut between = |low: f64, high: f64| scale * random.random_range(low..high);
    let edge_radius_mm = between(0.6, 1.6);
    let height_mm = 14.0 * scale;
    match kind {
        0..3 => Shape::X {
            length_mm: between(10.0, 18.0),
            width_mm: between(3.3, 5.0),
            height_mm,
            edge_radius_mm,
        },
        3..5 => Shape::Triangle {
            side_mm: between(8.0, 18.0),
            height_mm,
            edge_radius_mm,
        },
        _ => Shape::Stl(SurfaceFile::new(random_mesh::name(
            random.random_range(0..random_mesh::N),
        ))),
    }
}

/// A union of two or three shapes beside each other.
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

#[cfg(test)]
mod tests {
    use super::*;
    use twintac_sensor::SensorFile;

    /// The largest distance of a location on the gel from the nearest training press, mm.
    fn largest_hole_mm(sensor: &Sensor, seed: u64, n: u64) -> f64 {
        let presses: Vec<DVec2> = (0..n)
            .map(|number| own(sensor, Own::Training, seed, number).unwrap().place_mm)
            .collect();
        let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
        let (low, size) = (low.truncate(), (high - low).truncate());
        let places =
            (0..=20u32).flat_map(|i| (0..=20u32).map(move |j| DVec2::new(f64::from(i), f64::from(j)) / 20.0));
        let holes = places.map(|part| {
            let distances = presses.iter().map(|press| press.distance(low + size * part));
            distances.fold(f64::INFINITY, f64::min)
        });
        holes.fold(0.0, f64::max)
    }

    #[test]
    fn a_few_own_presses_leave_no_hole() {
        // With 100 random locations the largest hole is 4.4 mm. The ports are so far out that
        // presses reach all of the gel.
        let mut sensor = (*SensorFile::phystac().unwrap().sensor).clone();
        sensor.gel.solid = twintac_shape::Solid::Block {
            size_mm: [25.0, 25.0, 6.0],
            center_mm: [0.0; 2],
            edge_radius_mm: 0.0,
        };
        for (number, taxel) in (0u32..).zip(&mut sensor.taxels) {
            let (column, row) = (f64::from(number % 4), f64::from(number / 4));
            taxel.position_mm = DVec3::new(5.0 * column - 7.5, 15.0 * row - 7.5, taxel.position_mm.z);
        }
        for seed in 1..5 {
            let hole_mm = largest_hole_mm(&sensor, seed, 100);
            assert!(hole_mm < 3.0, "{hole_mm}");
        }
        let first = own(&sensor, Own::Test, 1, 0).unwrap().place_mm;
        assert!(
            first.length() < 1e-9,
            "a test press in the middle, not at {first}"
        );
    }
}
