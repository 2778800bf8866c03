//! Contact estimation for one sensor, frame by frame.

use glam::DVec2;
use twintac_config::{Problem, Ranges};

use crate::contact::Contact;
use crate::error::InverseError;
use crate::hypothesis::{Hypothesis, Prior, Weighed};
use crate::inverse::{Inverse, Prepared};
use crate::matrix::form;
use crate::model::{ContactModel, N};
use crate::starts::LANES;

/// The largest reading that is accepted, kPa: forty times the pressure under a kilometre of
/// granite.
pub const LARGEST_READING_KPA: f64 = 1e6;

/// The longest time between two frames that is accepted, s.
const LONGEST_S: f64 = 1e9;

/// Hypotheses that are less probable than the best by a factor of e to this power are updated only
/// in their shape's turn.
const IMPROBABLE: f64 = 10.0;

/// A hypothesis of a shape is replaced by a new one if it is less probable than the shape's best by
/// a factor of e to this power.
const WORSE: f64 = 3.0;

/// Number of frames of a new hypothesis before it counts.
const ON_TRIAL: u32 = 6;

/// A new hypothesis may fit a frame better by chance by this much, in weighted squares, because
/// earlier frames do not bind it yet.
const BY_CHANCE: f64 = 10.0;

/// Number of presses of a shape's table that are tried in turn.
const N_CANDIDATES: usize = 8;

/// Two hypotheses of one shape that differ by less than this are the same: mm, mm, mm, radians.
const SAME: [f64; N] = [0.4, 0.4, 0.15, 0.1];

/// Follows the contact of one sensor. Updates allocate no memory.
///
/// A few presses of each shape are followed at once, because several presses fit the readings of
/// few taxels. In each frame, the table of one shape's readings is searched for another press that
/// fits, which replaces one that does not.
#[derive(Clone, Debug)]
pub struct Tracker<M> {
    inverse: Inverse<M>,
    /// The hypotheses of each shape; `[n_shapes * n_starts]`.
    hypotheses: Vec<Hypothesis>,
    is_touched: bool,
    /// The shape whose table is searched in this frame.
    turn: usize,
    /// Which of its candidates is tried.
    candidate: usize,
    /// Number of frames of this contact, minus what was forgotten.
    n_frames: f64,
    contact: Contact,
    readings_kpa: Vec<f32>,
    weights: Vec<f64>,
    /// Weights for a single frame, without correlation; `[n_readings]`.
    alone: Vec<f64>,
    /// Scratch memory of the search: `[n_padded]`, and one value for each press of a table.
    weighted: Vec<f32>,
    roots: Vec<f32>,
    costs: Vec<f32>,
    starts: Vec<[f64; N]>,
}

impl<M: ContactModel> Inverse<M> {
    /// A tracker for a sensor that nothing has touched yet.
    #[must_use]
    pub fn start(&self) -> Tracker<M> {
        Tracker::new(self.clone())
    }
}

impl<M: ContactModel> Tracker<M> {
    fn new(inverse: Inverse<M>) -> Self {
        let n_readings = inverse.model.n_readings();
        let (n_shapes, n_starts) = (inverse.shapes.len(), inverse.settings.n_starts);
        let n_padded = n_readings.next_multiple_of(LANES);
        let largest = inverse.shapes.iter().map(|shape| shape.starts.len()).max();
        Self {
            hypotheses: vec![Hypothesis::nothing(n_readings); n_shapes * n_starts],
            is_touched: false,
            turn: 0,
            candidate: 0,
            n_frames: 0.0,
            contact: Contact {
                shape_probabilities: vec![0.0; n_shapes],
                ..Contact::default()
            },
            readings_kpa: vec![0.0; n_readings],
            weights: vec![0.0; n_readings],
            alone: vec![0.0; n_readings],
            weighted: vec![0.0; n_padded],
            roots: vec![0.0; n_padded],
            costs: Vec::with_capacity(largest.unwrap_or(0)),
            starts: Vec::with_capacity(n_starts.max(N_CANDIDATES)),
            inverse,
        }
    }

    /// Takes a frame and returns the contact, or `None` if the readings are within noise. After an
    /// error, the tracker is as it was before the frame.
    ///
    /// - `since_previous_s`: time since the previous frame, s, with or without contact.
    /// - `readings_kpa`: readings above the sensor without contact, kPa; `[n_readings]`.
    ///
    /// # Errors
    /// [`InverseError::Frame`]: a wrong number of readings; a reading that is not finite or beyond
    /// [`LARGEST_READING_KPA`]; a time that is not finite or negative.
    pub fn update(
        &mut self,
        since_previous_s: f64,
        readings_kpa: &[f64],
    ) -> Result<Option<&Contact>, InverseError> {
        self.check(since_previous_s, readings_kpa)
            .map_err(InverseError::Frame)?;
        let settings = self.inverse.settings;
        let largest_kpa = readings_kpa.iter().copied().fold(0.0, f64::max);
        if largest_kpa < settings.touch_deviations * settings.noise_kpa {
            self.is_touched = false;
            return Ok(None);
        }
        self.weigh(since_previous_s, readings_kpa, largest_kpa);
        if !self.is_touched {
            self.hypotheses
                .iter_mut()
                .for_each(|hypothesis| hypothesis.is_alive = false);
            self.n_frames = 0.0;
        }
        for shape in 0..self.inverse.shapes.len() {
            if !self.is_touched || shape == self.turn {
                self.search(shape);
            }
        }
        self.is_touched = true;
        self.follow(since_previous_s);
        self.turn += 1;
        if self.turn == self.inverse.shapes.len() {
            self.turn = 0;
            self.candidate = (self.candidate + 1) % N_CANDIDATES;
        }
        self.conclude();
        Ok(Some(&self.contact))
    }

    fn check(&self, since_previous_s: f64, readings_kpa: &[f64]) -> Result<(), Problem> {
        let mut ranges = Ranges::default();
        let expected = self.readings_kpa.len();
        ranges.that(
            "readings_kpa",
            readings_kpa.len() == expected,
            || format!("has {} readings", readings_kpa.len()),
            || format!("give one of each of {expected} taxels"),
        );
        ranges.number("since_previous_s", since_previous_s, 0.0..=LONGEST_S);
        let can_be = |kpa: &f64| kpa.abs() <= LARGEST_READING_KPA;
        if let Some(taxel) = readings_kpa.iter().position(|kpa| !can_be(kpa)) {
            let field = format!("readings_kpa[{taxel}]");
            ranges.number(
                &field,
                readings_kpa[taxel],
                -LARGEST_READING_KPA..=LARGEST_READING_KPA,
            );
        }
        ranges.finish()
    }

    fn weigh(&mut self, since_s: f64, readings_kpa: &[f64], largest_kpa: f64) {
        let settings = &self.inverse.settings;
        let repeats = (settings.correlated_s / since_s.max(1e-6)).max(1.0);
        for (number, reading_kpa) in readings_kpa.iter().enumerate() {
            let model = (settings.model_part * reading_kpa).powi(2)
                + (settings.model_part_of_largest * largest_kpa).powi(2);
            let noise = settings.noise_kpa.powi(2);
            self.readings_kpa[number] = *reading_kpa as f32;
            self.weights[number] = 1.0 / (noise + repeats * model);
            self.alone[number] = 1.0 / (noise + model);
            self.roots[number] = self.weights[number].sqrt() as f32;
            self.weighted[number] = self.roots[number] * self.readings_kpa[number];
        }
    }

    /// At the start of a contact, begins with the best presses of a shape. Later, tries one more
    /// press.
    fn search(&mut self, shape: usize) {
        let n_starts = self.inverse.settings.n_starts;
        let Prepared { prior, starts } = &self.inverse.shapes[shape];
        let model = &mut self.inverse.model;
        let n_wanted = if self.is_touched { N_CANDIDATES } else { n_starts };
        starts.best(
            &self.weighted,
            &self.roots,
            &mut self.costs,
            n_wanted,
            &mut self.starts,
        );
        let own = &mut self.hypotheses[shape * n_starts..(shape + 1) * n_starts];
        if !self.is_touched {
            for (hypothesis, at) in own.iter_mut().zip(&self.starts) {
                hypothesis.begin(model, prior, *at, 0);
            }
            return;
        }
        let Some(at) = self.starts.get(self.candidate) else {
            return;
        };
        let mut alive = own.iter().filter(|hypothesis| hypothesis.is_alive);
        if alive.any(|known| !starts.is_apart(&known.at, at)) {
            return;
        }
        let best = best_score(own);
        let value = |hypothesis: &Hypothesis| match (hypothesis.is_alive, hypothesis.on_trial) {
            (false, _) => f64::NEG_INFINITY,
            (true, 0) => hypothesis.score(),
            (true, _) => f64::INFINITY,
        };
        if let Some(worst) = own.iter_mut().min_by(|a, b| value(a).total_cmp(&value(b)))
            && value(worst) < best - WORSE
        {
            worst.begin(model, prior, *at, ON_TRIAL);
        }
    }

    /// Updates all hypotheses that are probable, on trial, or of the shape whose turn it is.
    fn follow(&mut self, since_s: f64) {
        let settings = self.inverse.settings;
        let frame = Weighed {
            readings_kpa: &self.readings_kpa,
            weights: &self.weights,
            since_s,
        };
        let remembered = (-since_s / settings.shape_memory_s).exp();
        let best = best_score(&self.hypotheses);
        let mut gain = f64::NEG_INFINITY;
        for (number, hypothesis) in self.hypotheses.iter_mut().enumerate() {
            let is_turn = number / settings.n_starts == self.turn;
            let is_probable = hypothesis.on_trial > 0 || hypothesis.score() > best - IMPROBABLE;
            if hypothesis.is_alive && (is_turn || is_probable) {
                let prior = &self.inverse.shapes[number / settings.n_starts].prior;
                hypothesis.update(&mut self.inverse.model, prior, &frame, &settings);
                if hypothesis.is_evaluated() {
                    gain = gain.max(hypothesis.gain);
                }
            } else {
                hypothesis.gain = f64::NAN;
            }
        }
        for hypothesis in self
            .hypotheses
            .iter_mut()
            .filter(|hypothesis| hypothesis.is_evaluated())
        {
            // A hypothesis that was not updated keeps its distance to the best.
            let own = if hypothesis.gain.is_nan() {
                gain
            } else {
                hypothesis.gain
            };
            hypothesis.evidence = remembered * (hypothesis.evidence - best) + own;
        }
        self.n_frames = remembered * self.n_frames + 1.0;
        let most = best_score(&self.hypotheses) - WORSE;
        for (shape, own) in self.hypotheses.chunks_mut(settings.n_starts).enumerate() {
            update_evaluated(own, self.n_frames, most);
            merge(own, &self.inverse.shapes[shape].prior);
        }
    }

    /// Computes the contact from the hypotheses.
    fn conclude(&mut self) {
        let settings = &self.inverse.settings;
        let best = best_score(&self.hypotheses);
        let weight = |hypothesis: &Hypothesis| {
            if hypothesis.is_evaluated() {
                (hypothesis.score() - best).exp()
            } else {
                0.0
            }
        };
        let total: f64 = self.hypotheses.iter().map(weight).sum();
        let contact = &mut self.contact;
        let shapes = self.hypotheses.chunks(settings.n_starts);
        for (probability, own) in contact.shape_probabilities.iter_mut().zip(shapes) {
            *probability = own.iter().map(weight).sum::<f64>() / total;
        }
        let probabilities = contact.shape_probabilities.iter().enumerate();
        contact.shape = probabilities
            .max_by(|a, b| a.1.total_cmp(b.1))
            .map_or(0, |(shape, _)| shape);
        let own = &self.hypotheses[contact.shape * settings.n_starts..][..settings.n_starts];
        let prior = &self.inverse.shapes[contact.shape].prior;
        let Some(told) = own.iter().max_by(|a, b| weight(a).total_cmp(&weight(b))) else {
            return;
        };
        // The covariance is taken about the most probable press, over all hypotheses of its shape.
        let of_shape: f64 = own.iter().map(weight).sum();
        contact.covariance = [[0.0; N]; N];
        let mut force_square = (settings.force_part * told.force_n).powi(2);
        for hypothesis in own.iter().filter(|hypothesis| hypothesis.is_evaluated()) {
            let part = weight(hypothesis) / of_shape;
            let way = prior.way(&told.at, &hypothesis.at);
            for row in 0..N {
                for column in 0..N {
                    contact.covariance[row][column] +=
                        part * (hypothesis.covariance[row][column] + way[row] * way[column]);
                }
            }
            force_square += part
                * (form(&hypothesis.covariance, &hypothesis.force_slope)
                    + (hypothesis.force_n - told.force_n).powi(2));
        }
        let deviation = |number: usize| {
            if prior.is_free(number) {
                contact.covariance[number][number].max(0.0).sqrt()
            } else {
                0.0
            }
        };
        contact.place_deviation_mm = DVec2::new(deviation(0), deviation(1));
        contact.depth_deviation_mm = deviation(2);
        contact.yaw_deviation_rad = deviation(3);
        contact.force_deviation_n = force_square.sqrt();
        let [x, y, depth_mm, yaw_rad] = told.at;
        contact.place_mm = DVec2::new(x, y);
        contact.depth_mm = depth_mm;
        contact.yaw_rad = yaw_rad;
        contact.force_n = told.force_n;
        contact.misfit = told.misfit(&self.readings_kpa, &self.alone);
    }
}

fn best_score(hypotheses: &[Hypothesis]) -> f64 {
    let evaluated = hypotheses.iter().filter(|hypothesis| hypothesis.is_evaluated());
    evaluated.map(Hypothesis::score).fold(f64::NEG_INFINITY, f64::max)
}

/// Ends trials. A hypothesis that fits this frame clearly better than the shape's best counts as if
/// it had fitted all frames of the contact that well, but it does not become more probable than any
/// hypothesis that did fit them.
fn update_evaluated(own: &mut [Hypothesis], n_frames: f64, most: f64) {
    let evaluated = own
        .iter()
        .filter(|hypothesis| hypothesis.is_evaluated() && !hypothesis.gain.is_nan());
    let best = evaluated.max_by(|a, b| a.score().total_cmp(&b.score()));
    let Some((evidence, cost)) = best.map(|best| (best.evidence, best.cost)) else {
        return;
    };
    for hypothesis in own
        .iter_mut()
        .filter(|hypothesis| hypothesis.is_alive && hypothesis.on_trial > 0)
    {
        hypothesis.on_trial -= 1;
        if hypothesis.on_trial == 0 {
            let better = cost - hypothesis.cost;
            let in_all = n_frames * (better - BY_CHANCE).max(0.0) + better.min(0.0);
            hypothesis.evidence = (evidence + 0.5 * in_all).min(most.max(evidence));
        }
    }
}

/// Of hypotheses that have arrived at the same press, keeps the most probable.
fn merge(own: &mut [Hypothesis], prior: &Prior) {
    for first in 0..own.len() {
        for second in 0..own.len() {
            let [a, b] = [&own[first], &own[second]];
            let way = prior.way(&a.at, &b.at);
            let is_same = way.iter().zip(SAME).all(|(way, same)| way.abs() < same);
            let is_better = !b.is_evaluated() || a.score() >= b.score();
            if first != second && a.is_evaluated() && b.is_alive && is_same && is_better {
                own[second].is_alive = false;
            }
        }
    }
}
