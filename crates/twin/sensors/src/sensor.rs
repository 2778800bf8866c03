//! One sensor: its drawn deviations, and its state.

use glam::{DQuat, DVec3};
use rand::Rng;
use twintac_random::{RandomStream, normal, stream};
use twintac_shape::Pose;

use crate::SensorVariation;

/// Smallest time between two frames, as a fraction of the mean one.
const SHORTEST_FRAME: f64 = 0.1;

/// A sensor with its own deviations.
#[derive(Clone, Debug)]
pub(crate) struct Sensor {
    random: RandomStream,
    taxels: Vec<Taxel>,
    /// Cross-talk: fraction of the pressure at one taxel that another one reads, `[reads][feels]`;
    /// empty without cross-talk.
    couplings: Vec<f64>,
    /// From the described frame of the sensor to its actual one.
    pub(crate) actual_from_described: Pose,
    /// The gel's modulus relative to that of the surrogate's gel.
    pub(crate) modulus: f32,
    temperature_k: f64,
    /// Time until the bus delivers the next frame, s.
    until_frame_s: f64,
    /// Time since the last frame that was delivered, s.
    since_frame_s: f64,
}

#[derive(Clone, Debug)]
struct Taxel {
    fate: Fate,
    gain: f64,
    growth_per_kpa: f64,
    offset_kpa: f64,
    drift_kpa_per_k: f64,
    /// Pressure after hysteresis, kPa.
    behind_kpa: f64,
    /// The reading without a fault at the last frame, kPa.
    before_kpa: f64,
    /// What the bus delivered last, kPa; `None` before the first frame.
    delivered_kpa: Option<f64>,
}

/// The fault of a taxel.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Fate {
    Fine,
    Dead,
    Stuck,
    Late,
}

impl Sensor {
    /// Draws the sensor of a number. The same seed and number give the same sensor, whatever other
    /// sensors there are.
    pub(crate) fn draw(variation: &SensorVariation, n_taxels: usize, seed: u64, number: u64) -> Self {
        let mut random = stream(seed, &format!("sensor {number}"));
        let mut turn = |deviation_rad: f64| normal(&mut random, deviation_rad);
        let tilt = variation.tilt_deviation_rad;
        let axis = DVec3::new(turn(tilt), turn(tilt), turn(variation.turn_deviation_rad));
        let rotation = DQuat::from_scaled_axis(axis).normalize();
        let mut place = || normal(&mut random, variation.place_deviation_mm);
        let (x_mm, y_mm) = (place(), place());
        let position_mm = DVec3::new(x_mm, y_mm, normal(&mut random, variation.height_deviation_mm));
        let taxels = (0..n_taxels)
            .map(|_| Taxel::draw(variation, &mut random))
            .collect();
        let temperature_k = normal(&mut random, variation.temperature_deviation_k);
        Self {
            taxels,
            couplings: couplings(variation, n_taxels, &mut random),
            actual_from_described: Pose {
                position_mm,
                rotation,
            },
            modulus: modulus(variation, seed, number),
            temperature_k,
            until_frame_s: 0.0,
            since_frame_s: 0.0,
            random,
        }
    }

    /// One step: from the reading of an ideal sensor, kPa, to what the bus delivers. `[n_taxels]`
    pub(crate) fn step(
        &mut self,
        variation: &SensorVariation,
        since_previous_s: f64,
        true_kpa: &[f64],
        readings_kpa: &mut [f32],
    ) {
        self.until_frame_s -= since_previous_s;
        self.since_frame_s += since_previous_s;
        let is_first = self
            .taxels
            .first()
            .is_some_and(|taxel| taxel.delivered_kpa.is_none());
        if is_first {
            (self.until_frame_s, self.since_frame_s) = (0.0, 0.0);
        }
        // A frame is not lost by rounding.
        let is_frame = variation.rate_hz == 0.0 || self.until_frame_s <= 1e-9;
        if is_frame {
            self.wander(variation);
            self.wait(variation);
        }
        for (taxel, true_kpa) in self.taxels.iter_mut().zip(true_kpa) {
            taxel.lag(variation.hysteresis, *true_kpa);
        }
        for (number, reading_kpa) in readings_kpa.iter_mut().enumerate().take(self.taxels.len()) {
            if is_frame {
                let through_kpa = self.taxels[number].behind_kpa + self.cross_talk_kpa(number);
                self.taxels[number].deliver(variation, through_kpa, self.temperature_k, &mut self.random);
            }
            *reading_kpa = self.taxels[number].delivered_kpa.unwrap_or(0.0) as f32;
        }
    }

    /// Cross-talk of the other taxels at a taxel, kPa.
    fn cross_talk_kpa(&self, number: usize) -> f64 {
        let of_taxel = self.couplings.chunks_exact(self.taxels.len()).nth(number);
        let pairs = of_taxel.into_iter().flatten().zip(&self.taxels);
        pairs.map(|(part, other)| part * other.behind_kpa).sum()
    }

    /// Changes the temperature: an Ornstein-Uhlenbeck process, exact for any time step.
    fn wander(&mut self, variation: &SensorVariation) {
        if variation.temperature_deviation_k > 0.0 {
            let kept = (-self.since_frame_s / variation.temperature_time_s).exp();
            let new_k = variation.temperature_deviation_k * (1.0 - kept * kept).max(0.0).sqrt();
            self.temperature_k = kept * self.temperature_k + normal(&mut self.random, new_k);
        }
        self.since_frame_s = 0.0;
    }

    /// Draws the time until the next frame.
    fn wait(&mut self, variation: &SensorVariation) {
        if variation.rate_hz > 0.0 {
            let jitter = if variation.jitter > 0.0 {
                normal(&mut self.random, variation.jitter)
            } else {
                0.0
            };
            // A late frame does not delay the next one; of several missed frames only one is made
            // up for.
            let late_s = self.until_frame_s.max(-1.0 / variation.rate_hz);
            self.until_frame_s = late_s + (1.0 + jitter).max(SHORTEST_FRAME) / variation.rate_hz;
        }
    }

    /// Resets the state to that of a relaxed gel. The drawn deviations stay.
    pub(crate) fn rest(&mut self) {
        self.until_frame_s = 0.0;
        for taxel in &mut self.taxels {
            taxel.behind_kpa = 0.0;
            taxel.before_kpa = 0.0;
            if taxel.fate != Fate::Stuck {
                taxel.delivered_kpa = None;
            }
        }
    }
}

/// Cross-talk of each pair of taxels; empty without cross-talk, so that no random numbers are drawn
/// and the other deviations stay the same.
fn couplings(variation: &SensorVariation, n_taxels: usize, random: &mut RandomStream) -> Vec<f64> {
    let SensorVariation {
        cross_talk,
        cross_talk_deviation,
        ..
    } = *variation;
    if cross_talk == 0.0 && cross_talk_deviation == 0.0 {
        return Vec::new();
    }
    let pairs = (0..n_taxels * n_taxels).map(|pair| {
        let part = cross_talk + normal(random, cross_talk_deviation);
        let is_itself = pair / n_taxels == pair % n_taxels;
        if is_itself { 0.0 } else { part }
    });
    pairs.collect()
}

/// Draws the gel's relative modulus, from random numbers of its own: the other deviations do not
/// depend on it.
fn modulus(variation: &SensorVariation, seed: u64, number: u64) -> f32 {
    let mut random = stream(seed, &format!("gel {number}"));
    normal(&mut random, variation.modulus_deviation).exp() as f32
}

impl Taxel {
    fn draw(variation: &SensorVariation, random: &mut RandomStream) -> Self {
        let chance: f64 = random.random();
        let [dead, stuck, late] = [
            variation.dead_chance,
            variation.stuck_chance,
            variation.late_chance,
        ];
        Self {
            fate: if chance < dead {
                Fate::Dead
            } else if chance < dead + stuck {
                Fate::Stuck
            } else if chance < dead + stuck + late {
                Fate::Late
            } else {
                Fate::Fine
            },
            gain: 1.0 + normal(random, variation.gain_deviation),
            offset_kpa: normal(random, variation.offset_deviation_kpa),
            drift_kpa_per_k: variation.drift_kpa_per_k + normal(random, variation.drift_deviation_kpa_per_k),
            growth_per_kpa: if variation.growth_deviation_per_kpa > 0.0 {
                normal(random, variation.growth_deviation_per_kpa)
            } else {
                0.0
            },
            behind_kpa: 0.0,
            before_kpa: 0.0,
            delivered_kpa: None,
        }
    }

    /// Hysteresis: a play operator whose width is a fraction of the reading. It reads less during
    /// loading and more during unloading.
    fn lag(&mut self, hysteresis: f64, true_kpa: f64) {
        let half_kpa = hysteresis * true_kpa.abs();
        self.behind_kpa = self.behind_kpa.clamp(true_kpa - half_kpa, true_kpa + half_kpa);
    }

    fn deliver(
        &mut self,
        variation: &SensorVariation,
        through_kpa: f64,
        temperature_k: f64,
        random: &mut RandomStream,
    ) {
        let drift_kpa = self.drift_kpa_per_k * temperature_k;
        let growth = (1.0 + self.growth_per_kpa * through_kpa.abs()).max(0.0);
        let mut reading_kpa = self.gain * growth * through_kpa + self.offset_kpa + drift_kpa;
        if variation.noise_deviation_kpa > 0.0 {
            reading_kpa += normal(random, variation.noise_deviation_kpa);
        }
        if variation.quantum_kpa > 0.0 {
            reading_kpa = variation.quantum_kpa * (reading_kpa / variation.quantum_kpa).round();
        }
        let before_kpa = std::mem::replace(&mut self.before_kpa, reading_kpa);
        self.delivered_kpa = Some(match self.fate {
            Fate::Fine => reading_kpa,
            Fate::Dead => 0.0,
            Fate::Stuck => self.delivered_kpa.unwrap_or(reading_kpa),
            Fate::Late => before_kpa,
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_turn_is_upright_and_a_tilt_is_not() {
        let axis = |variation: &SensorVariation| {
            let drawn = Sensor::draw(variation, 1, 1, 0);
            drawn.actual_from_described.rotation.to_scaled_axis()
        };
        let turned = axis(&SensorVariation {
            turn_deviation_rad: 0.1,
            ..SensorVariation::default()
        });
        assert!(turned.z != 0.0 && turned.truncate().length() == 0.0, "{turned}");
        let tilted = axis(&SensorVariation {
            tilt_deviation_rad: 0.1,
            ..SensorVariation::default()
        });
        assert!(tilted.z == 0.0 && tilted.x != 0.0 && tilted.y != 0.0, "{tilted}");
    }
}
