//! Random presses.

use std::f64::consts::{PI, TAU};

use anyhow::{Context, Result};
use glam::{DQuat, DVec2, DVec3};
use rand::{Rng, SeedableRng};
use rand_chacha::ChaCha8Rng;
use twintac_sensor::Sensor;
use twintac_shape::{Distance, Shape, SignedDistance};
use twintac_simulate::PressPlace;

use super::thin;

/// Largest angle between the indenter's axis and the gel's normal, radians.
const MAX_TILT_RAD: f64 = 0.35;

/// Smallest and largest depth as fractions of the gel's height.
const DEPTHS: [f64; 2] = [0.1, 0.7];

/// Largest depth of presses with thin bodies, as a fraction of the gel's height.
const THIN_DEPTH: f64 = 0.35;

/// Force that ends a press, N.
pub(crate) const ENOUGH_N: f64 = 200.0;

/// A random press.
pub(crate) struct RandomPress {
    pub(crate) place: PressPlace,
    pub(crate) indenter: Box<dyn SignedDistance>,
}

/// The press of an index, independent of other draws. Half of the presses use the sensor's
/// indenters.
pub(crate) fn draw(sensor: &Sensor, seed: u64, index: u64) -> Result<RandomPress> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(index);
    let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
    let depth_mm = high.z * random.random_range(DEPTHS[0]..DEPTHS[1]);
    let (name, shape, cone) = if random.random_bool(0.5) {
        let indenter = &sensor.indenters[random.random_range(0..sensor.indenters.len())];
        (indenter.name.clone(), indenter.shape.clone(), None)
    } else {
        invent(&mut random, depth_mm)
    };
    let indenter = match cone {
        Some(cone) => Box::new(cone),
        None => shape
            .signed_distance_field(&sensor.surfaces)
            .with_context(|| format!("{shape:?}"))?,
    };
    let rotation = turn(&mut random);
    let place = PressPlace {
        indenter: name,
        shape,
        x_mm: random.random_range(low.x..high.x),
        y_mm: random.random_range(low.y..high.y),
        rotation,
        depth_mm,
        enough_force_n: Some(ENOUGH_N),
    };
    Ok(RandomPress { place, indenter })
}

/// The press of an index with a body that is thin, hollow, sharp or made of several parts.
pub(crate) fn draw_thin(sensor: &Sensor, seed: u64, index: u64) -> Result<RandomPress> {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    random.set_stream(index);
    let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
    let (name, shape) = thin::invent(&mut random);
    let indenter = shape
        .signed_distance_field(&sensor.surfaces)
        .with_context(|| format!("{shape:?}"))?;
    let place = PressPlace {
        indenter: name.to_owned(),
        shape,
        x_mm: random.random_range(0.7 * low.x..0.7 * high.x),
        y_mm: random.random_range(0.7 * low.y..0.7 * high.y),
        rotation: turn(&mut random),
        depth_mm: high.z * random.random_range(DEPTHS[0]..THIN_DEPTH),
        enough_force_n: Some(ENOUGH_N),
    };
    Ok(RandomPress { place, indenter })
}

/// A random tilt and yaw.
fn turn(random: &mut ChaCha8Rng) -> DQuat {
    let tilt_about = DVec2::from_angle(random.random_range(0.0..TAU)).extend(0.0);
    let tilt = DQuat::from_axis_angle(tilt_about, random.random_range(0.0..MAX_TILT_RAD));
    let yaw = DQuat::from_rotation_z(random.random_range(0.0..TAU));
    (tilt * yaw).normalize()
}

/// A sphere, cylinder, box or cone of random size and rounding. For the mesh, a sphere stands for a
/// cone.
fn invent(random: &mut ChaCha8Rng, depth_mm: f64) -> (String, Shape, Option<Cone>) {
    let height_mm = 12.0;
    match random.random_range(0..4) {
        0 => {
            let radius_mm = random.random_range(1.5..12.0);
            ("random sphere".into(), Shape::Sphere { radius_mm }, None)
        }
        1 => {
            let radius_mm = random.random_range(1.5..7.0);
            let shape = Shape::Cylinder {
                radius_mm,
                height_mm,
                edge_radius_mm: random.random_range(0.2..0.9) * radius_mm.min(2.0),
            };
            ("random cylinder".into(), shape, None)
        }
        2 => {
            let sides = [(); 2].map(|()| random.random_range(3.0..14.0));
            let least_mm = f64::min(sides[0], sides[1]).min(4.0);
            let shape = Shape::Box {
                size_mm: [sides[0], sides[1], height_mm],
                edge_radius_mm: random.random_range(0.1..0.45) * least_mm,
            };
            ("random box".into(), shape, None)
        }
        _ => {
            let tip_mm = random.random_range(0.3..2.0);
            let cone = Cone::new(tip_mm, random.random_range(0.25 * PI..0.8 * PI), height_mm);
            let radius_mm = cone.radius_mm(0.5 * depth_mm);
            ("random cone".into(), Shape::Sphere { radius_mm }, Some(cone))
        }
    }
}

/// A cone with its rounded tip down. Its side ends tangentially in a second sphere.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Cone {
    tip_mm: f64,
    end_mm: f64,
    /// Distance of the two spheres' centres, mm.
    length_mm: f64,
    /// Half of the opening angle, radians.
    half_angle: f64,
}

impl Cone {
    fn new(tip_mm: f64, angle_rad: f64, length_mm: f64) -> Self {
        let half_angle = 0.5 * angle_rad;
        Self {
            tip_mm,
            end_mm: tip_mm + length_mm * half_angle.sin(),
            length_mm,
            half_angle,
        }
    }

    /// Approximate radius at a height above its lowest point.
    fn radius_mm(&self, height_mm: f64) -> f64 {
        let past_mm = height_mm - self.tip_mm * (1.0 - self.half_angle.sin());
        self.tip_mm * self.half_angle.cos() + past_mm.max(0.0) * self.half_angle.tan()
    }
}

impl SignedDistance for Cone {
    fn signed_distance(&self, point_mm: DVec3) -> Distance {
        let at = point_mm - DVec3::Z * self.tip_mm;
        let outwards = at.truncate().normalize_or(DVec2::X);
        let plane = DVec2::new(at.truncate().length(), at.z);
        let (sine, cosine) = self.half_angle.sin_cos();
        // Position along the side, from where the tip's sphere touches it.
        let along = plane.dot(DVec2::new(sine, cosine));
        let round = |centre: DVec2, radius_mm: f64| {
            let way = plane - centre;
            (way.length() - radius_mm, way.normalize_or(DVec2::NEG_Y))
        };
        let (distance_mm, gradient) = if along < 0.0 {
            round(DVec2::ZERO, self.tip_mm)
        } else if along > self.length_mm * cosine {
            round(DVec2::new(0.0, self.length_mm), self.end_mm)
        } else {
            let normal = DVec2::new(cosine, -sine);
            (plane.dot(normal) - self.tip_mm, normal)
        };
        Distance {
            distance_mm,
            gradient: (outwards * gradient.x).extend(gradient.y),
        }
    }

    fn bounds_mm(&self) -> (DVec3, DVec3) {
        let half = DVec3::splat(self.end_mm);
        (
            -half.with_z(0.0),
            half.with_z(self.tip_mm + self.length_mm + self.end_mm),
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_cone_is_no_closer_than_its_distance_says() {
        let cone = Cone::new(0.7, 1.2, 12.0);
        let mut random = ChaCha8Rng::seed_from_u64(3);
        for _ in 0..2000 {
            let mut number = || random.random_range(-8.0..16.0);
            let at = DVec3::new(number(), number(), number());
            let found = cone.signed_distance(at);
            let step = 1e-6 * DVec3::new(number(), number(), number());
            let next = cone.signed_distance(at + step);
            let slope = next.distance_mm - found.distance_mm - found.gradient.dot(step);
            assert!(slope.abs() < 1e-9, "{at}: {slope}");
            let surface = cone.signed_distance(at - found.gradient * found.distance_mm);
            assert!(found.distance_mm < 0.0 || surface.distance_mm.abs() < 1e-9);
        }
    }
}
