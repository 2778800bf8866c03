//! One sensor, frame by frame.

use glam::DVec2;

use crate::contact::Contact;
use crate::hypothesis::{Hypothesis, Weighed};
use crate::inverse::{Inverse, Prepared};
use crate::matrix::form;
use crate::model::{ContactModel, N};
use crate::starts::{LANES, Start};

/// Hypotheses whose readings are less probable than the best's by e to this power wait for their shape's turn.
const IMPROBABLE: f64 = 10.0;

/// Two hypotheses of one shape closer than this are one: mm, mm, mm, radians.
const SAME: [f64; N] = [0.4, 0.4, 0.15, 0.1];

/// Follows the contact of one sensor. Frames allocate nothing.
///
/// A few presses of each shape are followed at once, because readings of few taxels fit several. In each frame the table of one shape's readings is
/// searched for a press that fits better than those that are followed.
#[derive(Clone, Debug)]
pub struct Tracker<M> {
    inverse: Inverse<M>,
    /// `[n_shapes * n_starts]`
    hypotheses: Vec<Hypothesis>,
    is_touched: bool,
    /// The shape whose turn it is.
    turn: usize,
    contact: Contact,
    readings_kpa: Vec<f32>,
    weights: Vec<f64>,
    /// Weights of a frame by itself.
    alone: Vec<f64>,
    /// For the search: `[n_padded]`, and a number for each press of a table.
    weighted: Vec<f32>,
    roots: Vec<f32>,
    costs: Vec<f32>,
    starts: Vec<Start>,
}

impl<M: ContactModel> Tracker<M> {
    pub(crate) fn new(inverse: Inverse<M>) -> Self {
        let n_readings = inverse.model.n_readings();
        let (n_shapes, n_starts) = (inverse.shapes.len(), inverse.settings.n_starts);
        let n_padded = n_readings.next_multiple_of(LANES);
        let largest = inverse.shapes.iter().map(|shape| shape.starts.len()).max();
        Self {
            hypotheses: vec![Hypothesis::nothing(n_readings); n_shapes * n_starts],
            is_touched: false,
            turn: 0,
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
            starts: Vec::with_capacity(n_starts),
            inverse,
        }
    }

    /// Takes a frame; returns what touches, or nothing if the readings are within noise.
    ///
    /// - `since_previous_s`: time since the frame before, s, touched or not.
    /// - `readings_kpa`: above the untouched sensor, kPa. `[n_readings]`
    ///
    /// # Panics
    /// Another number of readings, numbers that are not finite, a negative time.
    pub fn update(&mut self, since_previous_s: f64, readings_kpa: &[f64]) -> Option<&Contact> {
        assert_eq!(readings_kpa.len(), self.readings_kpa.len(), "a reading for each taxel");
        assert!(since_previous_s >= 0.0, "a time that does not run backwards");
        assert!(readings_kpa.iter().all(|reading| reading.is_finite()), "finite readings");
        let settings = self.inverse.settings;
        let largest_kpa = readings_kpa.iter().copied().fold(0.0, f64::max);
        if largest_kpa < settings.touch_deviations * settings.noise_kpa {
            self.is_touched = false;
            return None;
        }
        self.weigh(since_previous_s, readings_kpa, largest_kpa);
        if !self.is_touched {
            self.hypotheses.iter_mut().for_each(|hypothesis| hypothesis.is_alive = false);
        }
        for shape in 0..self.inverse.shapes.len() {
            if !self.is_touched || shape == self.turn {
                self.search(shape);
            }
        }
        self.is_touched = true;
        self.follow(since_previous_s);
        self.turn = (self.turn + 1) % self.inverse.shapes.len();
        self.conclude();
        Some(&self.contact)
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

    /// Looks for presses of a shape that are not followed yet.
    fn search(&mut self, shape: usize) {
        let n_starts = self.inverse.settings.n_starts;
        let Prepared { prior, starts } = &self.inverse.shapes[shape];
        let n_wanted = if self.is_touched { 1 } else { n_starts };
        starts.best(&self.weighted, &self.roots, &mut self.costs, n_wanted, &mut self.starts);
        let own = &mut self.hypotheses[shape * n_starts..(shape + 1) * n_starts];
        for start in &self.starts {
            let alive = own.iter().filter(|hypothesis| hypothesis.is_alive);
            if alive.clone().any(|known| !starts.is_apart(&known.at, &start.at)) {
                continue;
            }
            let best = alive.max_by(|a, b| a.evidence.total_cmp(&b.evidence));
            // As probable as the best of the shape, less what it fits worse now.
            let evidence = best.map_or(0.0, |best| best.evidence - 0.5 * (start.cost - best.cost).max(0.0));
            let Some(worst) = own.iter_mut().min_by(|a, b| {
                let value = |hypothesis: &Hypothesis| {
                    if hypothesis.is_alive { hypothesis.evidence } else { f64::NEG_INFINITY }
                };
                value(a).total_cmp(&value(b))
            }) else {
                return;
            };
            if !worst.is_alive || worst.cost > start.cost {
                worst.begin(&mut self.inverse.model, prior, start.at, evidence);
            }
        }
    }

    /// Takes what is probable, and what has its turn, through the frame.
    fn follow(&mut self, since_s: f64) {
        let settings = self.inverse.settings;
        let frame = Weighed {
            readings_kpa: &self.readings_kpa,
            weights: &self.weights,
            since_s,
        };
        let remembered = (-since_s / settings.shape_memory_s).exp();
        let best = best_evidence(&self.hypotheses);
        let is_followed = |number: usize, hypothesis: &Hypothesis| {
            let is_turn = number / settings.n_starts == self.turn;
            hypothesis.is_alive && (is_turn || hypothesis.evidence > best - IMPROBABLE)
        };
        let mut gain = f64::NEG_INFINITY;
        for (number, hypothesis) in self.hypotheses.iter_mut().enumerate() {
            if is_followed(number, hypothesis) {
                let prior = &self.inverse.shapes[number / settings.n_starts].prior;
                hypothesis.update(&mut self.inverse.model, prior, &frame, &settings);
                gain = gain.max(hypothesis.gain);
            } else {
                hypothesis.gain = f64::NAN;
            }
        }
        for hypothesis in self.hypotheses.iter_mut().filter(|hypothesis| hypothesis.is_alive) {
            // What waits keeps its distance.
            let own = if hypothesis.gain.is_nan() { gain } else { hypothesis.gain };
            hypothesis.evidence = remembered * (hypothesis.evidence - best) + own;
        }
        for (shape, own) in self.hypotheses.chunks_mut(settings.n_starts).enumerate() {
            let prior = &self.inverse.shapes[shape].prior;
            for first in 0..own.len() {
                for second in 0..own.len() {
                    let [a, b] = [&own[first], &own[second]];
                    let way = prior.way(&a.at, &b.at);
                    let is_same = way.iter().zip(SAME).all(|(way, same)| way.abs() < same);
                    let is_both = first != second && a.is_alive && b.is_alive;
                    if is_both && is_same && a.evidence >= b.evidence {
                        own[second].is_alive = false;
                    }
                }
            }
        }
    }

    /// What the hypotheses come to.
    fn conclude(&mut self) {
        let settings = &self.inverse.settings;
        let best = best_evidence(&self.hypotheses);
        let weight = |hypothesis: &Hypothesis| {
            if hypothesis.is_alive { (hypothesis.evidence - best).exp() } else { 0.0 }
        };
        let total: f64 = self.hypotheses.iter().map(weight).sum();
        let contact = &mut self.contact;
        let shapes = self.hypotheses.chunks(settings.n_starts);
        for (probability, own) in contact.shape_probabilities.iter_mut().zip(shapes) {
            *probability = own.iter().map(weight).sum::<f64>() / total;
        }
        let probabilities = contact.shape_probabilities.iter().enumerate();
        contact.shape = probabilities.max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |(shape, _)| shape);
        let own = &self.hypotheses[contact.shape * settings.n_starts..][..settings.n_starts];
        let prior = &self.inverse.shapes[contact.shape].prior;
        let Some(told) = own.iter().max_by(|a, b| weight(a).total_cmp(&weight(b))) else {
            return;
        };
        // About what is told, all presses of the shape that may be.
        let of_shape: f64 = own.iter().map(weight).sum();
        contact.covariance = [[0.0; N]; N];
        let mut force_square = (settings.force_part * told.force_n).powi(2);
        for hypothesis in own.iter().filter(|hypothesis| hypothesis.is_alive) {
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
            if prior.is_free(number) { contact.covariance[number][number].max(0.0).sqrt() } else { 0.0 }
        };
        contact.place_deviation_mm = DVec2::new(deviation(0), deviation(1));
        contact.depth_deviation_mm = deviation(2);
        contact.spin_deviation_rad = deviation(3);
        contact.force_deviation_n = force_square.sqrt();
        let [x, y, depth_mm, spin_rad] = told.at;
        contact.place_mm = DVec2::new(x, y);
        contact.depth_mm = depth_mm;
        contact.spin_rad = spin_rad;
        contact.force_n = told.force_n;
        contact.misfit = told.misfit(&self.readings_kpa, &self.alone);
    }
}

fn best_evidence(hypotheses: &[Hypothesis]) -> f64 {
    let alive = hypotheses.iter().filter(|hypothesis| hypothesis.is_alive);
    alive.map(|hypothesis| hypothesis.evidence).fold(f64::NEG_INFINITY, f64::max)
}
