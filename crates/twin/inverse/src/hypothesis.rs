//! One possible press of one shape, followed from frame to frame. Gauss-Newton steps lead towards
//! the most probable press, given what was known before and what is read now (an extended Kalman
//! filter, iterated and damped). Laplace's approximation gives the probability of the readings.

use crate::matrix::{Matrix, Vector, form, inverse, solve, times, triangle};
use crate::model::{ContactModel, N, Press};
use crate::settings::InverseSettings;
use crate::turn::nearest;

/// Steps of the difference quotients: mm, mm, mm, radians.
const DIFFERENCES: Vector = [0.2, 0.2, 0.06, 0.05];

/// Largest changes in one step: mm, mm, mm, radians.
const LONGEST: Vector = [2.0, 2.0, 1.0, 0.35];

/// Initial, smallest and largest damping, as fractions of the diagonal.
const DAMPING: [f64; 3] = [1e-2, 1e-4, 1e3];

/// A frame with its weights.
pub(crate) struct Weighed<'a> {
    /// Readings, kPa; `[n_readings]`.
    pub(crate) readings_kpa: &'a [f32],
    /// Inverse variance of each reading in this frame; `[n_readings]`.
    pub(crate) weights: &'a [f64],
    /// Time since the previous frame, s.
    pub(crate) since_s: f64,
}

/// Ranges and prior variances of a shape's presses.
#[derive(Clone, Debug)]
pub(crate) struct Prior {
    pub(crate) shape: usize,
    ranges: [[f64; 2]; N],
    turn_rad: Option<f64>,
    is_free: [bool; N],
    /// Variances without any information.
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
            // Variances of uniform distributions. For a fixed number the value does not matter,
            // because it is not estimated.
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

    /// Whether a number is estimated.
    pub(crate) fn is_free(&self, number: usize) -> bool {
        self.is_free[number]
    }

    /// Difference from one press to another, with the shorter rotation.
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
    /// Derivatives of the force with respect to each number.
    pub(crate) force_slope: Vector,
    /// Logarithm of the probability of all readings given its presses, minus what was forgotten.
    pub(crate) evidence: f64,
    /// Logarithm of the fraction of all presses of the shape that fit as well (Occam's factor, by
    /// Laplace's approximation). With it, a shape with more freedom is not more probable for that
    /// reason. It counts once and not in each frame, because information is forgotten and gained
    /// again all the time.
    occam: f64,
    /// This frame's contribution to the evidence.
    pub(crate) gain: f64,
    /// Weighted sum of squares of this frame's residuals.
    pub(crate) cost: f64,
    pub(crate) is_alive: bool,
    /// Frames that it may still take to approach a good press before it counts; 0: it counts.
    pub(crate) on_trial: u32,
    damping: f64,
    readings_kpa: Vec<f32>,
    trial_kpa: Vec<f32>,
    /// Derivatives of the readings; `[N][n_readings]`.
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

    /// Begins at a press without any other information. It is on trial for `on_trial` frames.
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

    /// Logarithm of its probability, up to a constant that is the same for all hypotheses.
    pub(crate) fn score(&self) -> f64 {
        self.evidence + self.occam
    }

    /// Whether it counts: it is alive and not on trial.
    pub(crate) fn is_evaluated(&self) -> bool {
        self.is_alive && self.on_trial == 0
    }

    /// Updates the press with a frame.
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

    /// The covariance before a frame: the last one, increased with the time since then.
    fn spread(&self, prior: &Prior, since_s: f64, settings: &InverseSettings) -> Matrix {
        let grown = (since_s / settings.correlated_s.max(1e-9)).min(30.0).exp();
        let walk = [
            settings.place_walk_mm,
            settings.place_walk_mm,
            settings.depth_walk_mm,
            settings.yaw_walk_rad,
        ];
        let mut spread = self.covariance.map(|row| row.map(|value| value * grown));
        for number in 0..N {
            spread[number][number] += walk[number].powi(2) * since_s;
        }
        // A variance is never larger than the prior one.
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

    /// The inverse covariance after a frame.
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

    /// Residuals of the readings, kPa; `[n_readings]`.
    fn left<'a>(&'a self, frame: &'a Weighed<'_>) -> impl Iterator<Item = f64> + 'a {
        let both = frame.readings_kpa.iter().zip(&self.readings_kpa);
        both.map(|(read, own)| f64::from(read - own))
    }

    fn cost_of(&self, own_kpa: &[f32], frame: &Weighed<'_>) -> f64 {
        let both = frame.readings_kpa.iter().zip(own_kpa).zip(frame.weights);
        both.map(|((read, own), weight)| f64::from(read - own).powi(2) * weight)
            .sum()
    }

    /// Root mean square of the residuals, in standard deviations.
    pub(crate) fn misfit(&self, readings_kpa: &[f32], weights: &[f64]) -> f64 {
        let frame = Weighed {
            readings_kpa,
            weights,
            since_s: 0.0,
        };
        (self.cost_of(&self.readings_kpa, &frame) / weights.len().max(1) as f64).sqrt()
    }

    /// One damped step (Levenberg and Marquardt). It is taken only if it does not increase the
    /// cost.
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
