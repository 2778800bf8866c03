//! HoldForce: hold a wanted force on an object of unknown stiffness.
//!
//! Under the sensor is a body on a spring. The robot moves the sensor down. Spring and gel share
//! the motion, so that both carry the same force: `F(d) = k (u - d)`, where `u` is the robot's
//! motion beyond first touch and `d` the depth of the body in the gel. Each frame takes one step of
//! Newton's method from the frame before, with the slope of the force between the last two frames.
//! At the robot's speeds the error is 0.07 N at most, and 0.13 N in the first two frames of a
//! contact.

use glam::{DQuat, DVec2, DVec3};
use rand::Rng;
use twintac_fast::{Body, FastGel, Touch};
use twintac_random::RandomStream;
use twintac_shape::{Pose, Shape, ShapeError, Surfaces};

use crate::outline::outline_mm;
use crate::task::{Felt, Look, Outcome, RATE_HZ, Task, limited, part};

/// Time of a step, s: one frame of the sensor.
const STEP_S: f64 = 1.0 / RATE_HZ;

/// Steps of an episode, and steps after which another force is wanted: one second.
const N_STEPS: usize = 220;
const N_SAME: usize = 55;
const N_WANTED: usize = N_STEPS / N_SAME;

/// Range of wanted forces, N.
const WANTED_N: [f64; 2] = [0.3, 3.0];

/// Range of the springs' stiffness, N/mm; the logarithm is uniformly distributed.
const STIFFNESS_N_PER_MM: [f64; 2] = [1.0, 10.0];

/// Largest speed of the robot, mm/s, and its start and range, mm.
const SPEED_MM_S: f64 = 10.0;
const START_MM: f64 = -0.5;
const TRAVEL_MM: [f64; 2] = [-1.0, 9.0];

/// Force, N, or depth in the gel, mm, at which the episode ends; and the cost of each step that is
/// then left, N: as much as without contact.
const LIMIT_N: f64 = 10.0;
const LIMIT_MM: f64 = 4.8;
const COST_N: f64 = WANTED_N[1];

/// Upper limit of the gel's stiffness, N/mm, and smallest motion from which it is computed, mm.
const STIFFEST_N_PER_MM: f64 = 50.0;
const LEAST_MOVE_MM: f64 = 1e-3;

/// Largest distance of bodies from the gel's middle along x and y, mm.
const PLACE_MM: DVec2 = DVec2::new(8.0, 3.0);

/// Units of observations: mm and N.
const TRAVEL_UNIT_MM: f64 = 5.0;
const FORCE_UNIT_N: f64 = 3.0;

/// The task.
pub(crate) struct HoldForce {
    shapes: Vec<Shape>,
    bodies: Vec<Body>,
    height_mm: f64,
}

/// The hidden state of an environment.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Episode {
    body: u32,
    place_mm: DVec2,
    yaw_rad: f64,
    stiffness_n_per_mm: f64,
    wanted_n: [f64; N_WANTED],
    n_steps: usize,
    /// Motion of the robot beyond first touch, and depth of the body in the gel, mm.
    travel_mm: f64,
    depth_mm: f64,
    /// Velocity of the robot, as a fraction of the largest.
    speed: f64,
    force_n: f64,
    /// Stiffness of the gel at this depth, N/mm, and depth, mm, and force, N, at which it was
    /// computed last.
    slope_n_per_mm: f64,
    measured: [f64; 2],
}

impl Episode {
    fn wanted_n(&self) -> f64 {
        self.wanted_n[(self.n_steps / N_SAME).min(N_WANTED - 1)]
    }
}

impl HoldForce {
    /// Balls, a cylinder and a cube, within 8 mm along x and 3 mm along y of the gel's middle.
    pub(crate) fn on(gel: &FastGel) -> Result<Self, ShapeError> {
        let balls = [8.0, 10.0, 12.5].map(|radius_mm| Shape::Sphere { radius_mm });
        let cylinder = Shape::Cylinder {
            radius_mm: 5.0,
            height_mm: 10.0,
            edge_radius_mm: 0.8,
        };
        let cube = Shape::Box {
            size_mm: [10.0; 3],
            edge_radius_mm: 0.8,
        };
        let shapes: Vec<Shape> = balls.into_iter().chain([cylinder, cube]).collect();
        let bodies = shapes.iter().map(|shape| Body::new(shape, &Surfaces::new()));
        Ok(Self {
            bodies: bodies.collect::<Result<_, _>>()?,
            shapes,
            height_mm: gel.height_mm_at(DVec2::ZERO),
        })
    }
}

impl Task for HoldForce {
    type Episode = Episode;
    const N_ACTIONS: usize = 1;
    const FIGURES: &'static [&'static str] = &["force_n", "wanted_n", "depth_mm", "stiffness_n_per_mm"];
    const FRAMES_S: &'static [f64] = &[STEP_S];
    const RESTS: bool = false;

    fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    fn n_observed(&self, n_taxels: usize) -> usize {
        2 * n_taxels + 3
    }

    fn begin(&self, _: usize, random: &mut RandomStream) -> Episode {
        let mut within = |most: f64| random.random_range(-most..most);
        let place_mm = DVec2::new(within(PLACE_MM.x), within(PLACE_MM.y));
        let yaw_rad = within(std::f64::consts::PI);
        let body = random.random_range(0..self.bodies.len() as u32);
        let [low, high] = STIFFNESS_N_PER_MM.map(f64::ln);
        Episode {
            body,
            place_mm,
            yaw_rad,
            stiffness_n_per_mm: random.random_range(low..high).exp(),
            wanted_n: std::array::from_fn(|_| random.random_range(WANTED_N[0]..WANTED_N[1])),
            n_steps: 0,
            travel_mm: START_MM,
            depth_mm: START_MM,
            speed: 0.0,
            force_n: 0.0,
            slope_n_per_mm: 0.0,
            measured: [START_MM, 0.0],
        }
    }

    fn act(&self, episode: &mut Episode, actions: &[f32]) {
        let before_mm = episode.travel_mm;
        let travel_mm = before_mm + part(actions[0]) * SPEED_MM_S * STEP_S;
        episode.travel_mm = travel_mm.clamp(TRAVEL_MM[0], TRAVEL_MM[1]);
        episode.speed = (episode.travel_mm - before_mm) / (SPEED_MM_S * STEP_S);
        let (spring, gel) = (episode.stiffness_n_per_mm, episode.slope_n_per_mm);
        // F + s (d' - d) = k (u - d')
        let carried_n = spring * episode.travel_mm + gel * episode.depth_mm - episode.force_n;
        // The spring does not pull; without contact it is relaxed.
        let depth_mm = carried_n / (spring + gel);
        episode.depth_mm = depth_mm.clamp(episode.travel_mm.min(0.0), episode.travel_mm);
    }

    fn touch(&self, episode: &Episode) -> Touch {
        Touch {
            body: episode.body,
            gel_from_body: Pose {
                position_mm: episode.place_mm.extend(self.height_mm - episode.depth_mm),
                rotation: DQuat::from_axis_angle(DVec3::Z, episode.yaw_rad),
            },
        }
    }

    fn feel(&self, episode: &mut Episode, felt: &Felt<'_>) -> Outcome {
        // Without contact the force of the surrogate is slightly different from zero.
        let force_n = if episode.depth_mm > 0.0 {
            felt.force_n.max(0.0)
        } else {
            0.0
        };
        let [measured_mm, measured_n] = episode.measured;
        let moved_mm = episode.depth_mm - measured_mm;
        if moved_mm.abs() > LEAST_MOVE_MM {
            let slope = (force_n - measured_n) / moved_mm;
            episode.slope_n_per_mm = slope.clamp(0.0, STIFFEST_N_PER_MM);
            episode.measured = [episode.depth_mm, force_n];
        }
        episode.force_n = force_n;
        let wanted_n = episode.wanted_n();
        episode.n_steps += 1;
        let n_left = N_STEPS - episode.n_steps.min(N_STEPS);
        let terminated = force_n > LIMIT_N || episode.depth_mm > LIMIT_MM;
        let off_n = (force_n - wanted_n).abs();
        Outcome {
            reward: -off_n - if terminated { COST_N * n_left as f64 } else { 0.0 },
            terminated,
            truncated: n_left == 0 && !terminated,
        }
    }

    fn observe(&self, episode: &Episode, felt: &Felt<'_>, observed: &mut [f32]) {
        let (readings, rest) = observed.split_at_mut(2 * felt.readings_kpa.len());
        felt.observe(readings);
        let known = [
            episode.travel_mm / TRAVEL_UNIT_MM,
            episode.speed,
            episode.wanted_n() / FORCE_UNIT_N,
        ];
        for (observed, known) in rest.iter_mut().zip(known) {
            *observed = limited(known as f32);
        }
    }

    fn figures(&self, episode: &Episode, figures: &mut [f32]) {
        let told = [
            episode.force_n,
            episode.wanted_n(),
            episode.depth_mm,
            episode.stiffness_n_per_mm,
        ];
        for (figure, told) in figures.iter_mut().zip(told) {
            *figure = told as f32;
        }
    }

    fn look(&self, episode: &Episode) -> Look {
        let pose = self.touch(episode).gel_from_body;
        Look {
            outlines_mm: outline_mm(&self.shapes[episode.body as usize], &pose),
            places_mm: Vec::new(),
            lines: vec![
                format!(
                    "force {:.2} N, target {:.2} N",
                    episode.force_n,
                    episode.wanted_n()
                ),
                format!("{:.2} mm deep in the gel", episode.depth_mm),
                format!("the spring has {:.1} N/mm", episode.stiffness_n_per_mm),
            ],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use twintac_random::stream;

    /// Moves to and fro on many springs. Returns the largest difference between the forces of gel
    /// and spring, N, in the first two frames of a contact and later, and the largest force, N.
    fn imbalance(most_speed: f32) -> [f64; 3] {
        let gel = FastGel::phystac().unwrap();
        let task = HoldForce::on(&gel).unwrap();
        let mut reader = gel.reader();
        let (mut first_n, mut worst_n, mut most_n) = (0.0_f64, 0.0_f64, 0.0_f64);
        for number in 0..20 {
            let mut random = stream(number, "imbalance");
            let mut episode = task.begin(8, &mut random);
            let (mut pressure_kpa, mut wrench) = ([0.0; 8], [0.0; 6]);
            let (mut way, mut n_felt) = (1.0, 0);
            for step in 0..N_STEPS {
                if step % 30 == 0 {
                    way = if random.random_bool(0.6) { 1.0 } else { -1.0 };
                }
                task.act(&mut episode, &[way * most_speed]);
                let touch = task.touch(&episode);
                let body = &task.bodies[touch.body as usize];
                reader.read(&[(body, touch.gel_from_body)], &mut pressure_kpa, &mut wrench);
                let gel_n = -f64::from(wrench[2]);
                let felt = Felt {
                    readings_kpa: &pressure_kpa,
                    before_kpa: &pressure_kpa,
                    force_n: gel_n,
                };
                if task.feel(&mut episode, &felt).terminated {
                    break;
                }
                let force_n = episode.force_n;
                let spring_n = episode.stiffness_n_per_mm * (episode.travel_mm - episode.depth_mm);
                n_felt = if force_n > 0.0 { n_felt + 1 } else { 0 };
                let worst_n = if n_felt > 2 { &mut worst_n } else { &mut first_n };
                *worst_n = worst_n.max((spring_n - force_n).abs());
                most_n = most_n.max(force_n);
            }
        }
        [first_n, worst_n, most_n]
    }

    #[test]
    fn spring_and_gel_carry_the_same_force() {
        // Under a flat end that just touches, the surrogate gives a tenth of a newton at once. The
        // spring follows one frame later.
        for (most_speed, limits_n) in [(0.3, [0.2, 0.03]), (1.0, [0.2, 0.07])] {
            let [first_n, worst_n, most_n] = imbalance(most_speed);
            assert!(most_n > 2.0, "nothing is pressed: {most_n}");
            assert!(
                first_n < limits_n[0] && worst_n < limits_n[1],
                "{first_n} and {worst_n} N"
            );
        }
    }
}
