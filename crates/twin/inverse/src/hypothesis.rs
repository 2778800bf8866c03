//! One possible press of one shape, followed from frame to frame: Gauss and Newton's steps towards the most probable press, between what was
//! known before and what is read now (an extended Kalman filter, iterated and damped), and how probable the readings are by it (Laplace).

use crate::matrix::{Matrix, Vector, form, inverse, solve, times, triangle};
use crate::model::{ContactModel, N, Press};
use crate::settings::InverseSettings;
use crate::turn::nearest;

/// Steps of the differences that slopes are taken from: mm, mm, mm, radians.
const DIFFERENCES: Vector = [0.2, 0.2, 0.06, 0.05];

/// Longest ways in one step: mm, mm, mm, radians.
const LONGEST: Vector = [2.0, 2.0, 1.0, 0.35];

/// Damping, as parts of the diagonal: at first, least, and largest.
const DAMPING: [f64; 3] = [1e-2, 1e-4, 1e3];

/// A frame as it is weighed.
pub(crate) struct Weighed<'a> {
    /// kPa, `[n_readings]`
    pub(crate) readings_kpa: &'a [f32],
    /// One over the variance of each reading in this frame.
    pub(crate) weights: &'a [f64],
    /// Time since the frame before, s.
    pub(crate) since_s: f64,
}

/// What a hypothesis needs of its shape.
#[derive(Clone, Debug)]
pub(crate) struct Prior {
    pub(crate) shape: usize,
    ranges: [[f64; 2]; N],
    turn_rad: Option<f64>,
    is_free: [bool; N],
    /// Variances of what nobody knows anything about.
    broad: Vector,
}

impl Prior {
    pub(crate) fn of<M: ContactModel>(model: &M, shape: usize) -> Self {
        let domain = model.domain(shape);
        let ranges = domain.ranges();
        Self {
            shape,
            ranges,
            turn_rad: domain.turn_rad,
            is_free: ranges.map(|[low, high]| high > low),
            // Of an even distribution; what is known is not looked for, whatever stands here.
            broad: ranges.map(|[low, high]| {
                if high > low {
                    (high - low).powi(2) / 12.0
                } else {
                    1.0
                }
            }),
        }
    }

    fn within(&self, mut at: Vector) -> Vector {
        for (number, [low, high]) in self.ranges.into_iter().enumerate().take(N - 1) {
            at[number] = at[number].clamp(low, high);
        }
        at[N - 1] = self
            .turn_rad
            .map_or(0.0, |turn_rad| at[N - 1].rem_euclid(turn_rad));
        at
    }

    /// Whether a number is looked for.
    pub(crate) fn is_free(&self, number: usize) -> bool {
        self.is_free[number]
    }

    /// From one press to another, the short way around.
    pub(crate) fn way(&self, from: &Vector, to: &Vector) -> Vector {
        let mut way: Vector = std::array::from_fn(|number| to[number] - from[number]);
        way[N - 1] = self
            .turn_rad
            .map_or(0.0, |turn_rad| nearest(way[N - 1], turn_rad));
        way
    }
}

/// A possible press.
#[derive(Clone, Debug)]
pub(crate) struct Hypothesis {
    pub(crate) at: Vector,
    pub(crate) covariance: Matrix,
    pub(crate) force_n: f64,
    /// How the force changes with each number.
    pub(crate) force_slope: Vector,
    /// Logarithm of how probable all readings are by its presses, with what was forgotten taken off.
    pub(crate) evidence: f64,
    /// Logarithm of the part of all presses of the shape that fit as well (Occam's factor, by Laplace): a shape is no more probable for having
    /// more to choose from. It counts once, not in each frame: what is known is forgotten and learned again all the time.
    occam: f64,
    /// What this frame added to it.
    pub(crate) gain: f64,
    /// Sum of the weighted squares of what is left of this frame's readings.
    pub(crate) cost: f64,
    pub(crate) is_alive: bool,
    /// Frames that it has left to come near a good press before it is judged; 0: it is judged.
    pub(crate) on_trial: u32,
    damping: f64,
    readings_kpa: Vec<f32>,
    trial_kpa: Vec<f32>,
    /// `[N][n_readings]`
    slopes: [Vec<f64>; N],
}

impl Hypothesis {
    pub(crate) fn nothing(n_readings: usize) -> Self {
        Self {
            at: [0.0; N],
            covariance: [[0.0; N]; N],
            force_n: 0.0,
            force_slope: [0.0; N],
            evidence: 0.0,
            occam: 0.0,
            gain: 0.0,
            cost: 0.0,
            is_alive: false,
            on_trial: 0,
            damping: DAMPING[0],
            readings_kpa: vec![0.0; n_readings],
            trial_kpa: vec![0.0; n_readings],
            slopes: std::array::from_fn(|_| vec![0.0; n_readings]),
        }
    }

    /// Begins at a press, of which nothing else is known, so many frames on trial.
    pub(crate) fn begin<M: ContactModel>(&mut self, model: &mut M, prior: &Prior, at: Vector, on_trial: u32) {
        self.at = prior.within(at);
        self.covariance = [[0.0; N]; N];
        for number in 0..N {
            self.covariance[number][number] = prior.broad[number];
        }
        self.evidence = 0.0;
        self.occam = 0.0;
        self.on_trial = on_trial;
        self.damping = DAMPING[0];
        self.is_alive = true;
        self.force_n = model.read(prior.shape, &Press::of(self.at), &mut self.readings_kpa);
    }

    /// How probable it is: a logarithm, up to what is the same for all.
    pub(crate) fn score(&self) -> f64 {
        self.evidence + self.occam
    }

    /// Whether it counts.
    pub(crate) fn is_judged(&self) -> bool {
        self.is_alive && self.on_trial == 0
    }

    /// Takes notice of a frame.
    pub(crate) fn update<M: ContactModel>(
        &mut self,
        model: &mut M,
        prior: &Prior,
        frame: &Weighed<'_>,
        settings: &InverseSettings,
    ) {
        let before = self.at;
        let spread = self.spread(prior, frame.since_s, settings);
        let (known, _) = inverse(&spread);
        let mut information = known;
        for _ in 0..settings.n_steps.max(1) {
            self.find_slopes(model, prior);
            information = self.information(&known, frame);
            let way = prior.way(&self.at, &before);
            let back = times(&known, &way);
            let right: Vector = std::array::from_fn(|number| {
                let terms = self.slopes[number]
                    .iter()
                    .zip(self.left(frame))
                    .zip(frame.weights);
                back[number]
                    + terms
                        .map(|((slope, left), weight)| slope * left * weight)
                        .sum::<f64>()
            });
            self.step(model, prior, frame, (&before, &known), (&information, right));
        }
        let (covariance, log_information) = inverse(&information);
        self.covariance = covariance;
        let way = prior.way(&before, &self.at);
        self.cost = self.cost_of(&self.readings_kpa, frame);
        self.gain = -0.5 * (self.cost + form(&known, &way));
        self.occam = -0.5 * (log_information + prior.broad.iter().map(|broad| broad.ln()).sum::<f64>());
    }

    /// What is known before a frame: what was known, less sure after a while.
    fn spread(&self, prior: &Prior, since_s: f64, settings: &InverseSettings) -> Matrix {
        let grown = (since_s / settings.correlated_s.max(1e-9)).min(30.0).exp();
        let walk = [
            settings.place_walk_mm,
            settings.place_walk_mm,
            settings.depth_walk_mm,
            settings.spin_walk_rad,
        ];
        let mut spread = self.covariance.map(|row| row.map(|value| value * grown));
        for number in 0..N {
            spread[number][number] += walk[number].powi(2) * since_s;
        }
        // Nobody knows less than nothing.
        let shrink: Vector =
            std::array::from_fn(|number| (prior.broad[number] / spread[number][number]).sqrt().min(1.0));
        std::array::from_fn(|row| {
            std::array::from_fn(|column| spread[row][column] * shrink[row] * shrink[column])
        })
    }

    fn find_slopes<M: ContactModel>(&mut self, model: &mut M, prior: &Prior) {
        for number in (0..N).filter(|number| prior.is_free[*number]) {
            let mut at = self.at;
            let [_, high] = prior.ranges[number];
            let is_at_end = number < N - 1 && at[number] + DIFFERENCES[number] > high;
            let difference = if is_at_end {
                -DIFFERENCES[number]
            } else {
                DIFFERENCES[number]
            };
            at[number] += difference;
            let force_n = model.read(prior.shape, &Press::of(at), &mut self.trial_kpa);
            self.force_slope[number] = (force_n - self.force_n) / difference;
            let both = self.trial_kpa.iter().zip(&self.readings_kpa);
            for (slope, (there, here)) in self.slopes[number].iter_mut().zip(both) {
                *slope = f64::from(there - here) / difference;
            }
        }
    }

    /// What is known with a frame.
    fn information(&self, known: &Matrix, frame: &Weighed<'_>) -> Matrix {
        let mut information = *known;
        for (row, along) in information.iter_mut().zip(&self.slopes) {
            for (entry, across) in row.iter_mut().zip(&self.slopes) {
                let slopes = along.iter().zip(across).zip(frame.weights);
                *entry += slopes.map(|((a, b), weight)| a * b * weight).sum::<f64>();
            }
        }
        information
    }

    /// What the press leaves of the readings, kPa.
    fn left<'a>(&'a self, frame: &'a Weighed<'_>) -> impl Iterator<Item = f64> + 'a {
        let both = frame.readings_kpa.iter().zip(&self.readings_kpa);
        both.map(|(read, own)| f64::from(read - own))
    }

    fn cost_of(&self, own_kpa: &[f32], frame: &Weighed<'_>) -> f64 {
        let both = frame.readings_kpa.iter().zip(own_kpa).zip(frame.weights);
        both.map(|((read, own), weight)| f64::from(read - own).powi(2) * weight)
            .sum()
    }

    /// What the press leaves of readings, as a root mean square in deviations.
    pub(crate) fn misfit(&self, readings_kpa: &[f32], weights: &[f64]) -> f64 {
        let frame = Weighed {
            readings_kpa,
            weights,
            since_s: 0.0,
        };
        (self.cost_of(&self.readings_kpa, &frame) / weights.len().max(1) as f64).sqrt()
    }

    /// One damped step (Levenberg and Marquardt), taken if it leads down.
    fn step<M: ContactModel>(
        &mut self,
        model: &mut M,
        prior: &Prior,
        frame: &Weighed<'_>,
        (before, known): (&Vector, &Matrix),
        (information, right): (&Matrix, Vector),
    ) {
        let mut damped = *information;
        for (number, row) in damped.iter_mut().enumerate() {
            row[number] *= 1.0 + self.damping;
        }
        let mut way = solve(&triangle(&damped), right);
        let lengths = way.iter().zip(LONGEST).map(|(way, longest)| way.abs() / longest);
        let length = lengths.fold(1.0, f64::max);
        way = way.map(|way| way / length);
        let there = prior.within(std::array::from_fn(|number| self.at[number] + way[number]));
        let force_n = model.read(prior.shape, &Press::of(there), &mut self.trial_kpa);
        let total =
            |at: &Vector, own_kpa: &[f32]| self.cost_of(own_kpa, frame) + form(known, &prior.way(before, at));
        if total(&there, &self.trial_kpa) <= total(&self.at, &self.readings_kpa) {
            self.at = there;
            self.force_n = force_n;
            std::mem::swap(&mut self.readings_kpa, &mut self.trial_kpa);
            self.damping = (0.2 * self.damping).max(DAMPING[1]);
        } else {
            self.damping = (8.0 * self.damping).min(DAMPING[2]);
        }
    }
}
