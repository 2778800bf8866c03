//! Temperature compensation of recorded presses.

use twintac_recording::Recording;

use crate::{Compensation, TemperatureError};

/// Half of the time over which temperatures are averaged, s.
const HALF_S: f64 = 5.0;

/// If temperatures exceed those of the coefficients' log by more than this, K, a remark says so.
const BEYOND_K: f64 = 5.0;

/// The result of a compensation.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Compensated {
    /// Number of presses that were compensated.
    pub n_presses: usize,
    /// Number of presses without temperatures; they are unchanged.
    pub n_without: usize,
    /// Largest drift that was subtracted, kPa.
    pub largest_kpa: f64,
    /// One sentence for each remark: temperatures far outside the range of the coefficients' log.
    pub remarks: Vec<String>,
}

impl Compensation {
    /// Subtracts the drift of the zeros within each press from its readings (`taxels_kpa`; raw
    /// readings stay). The zero of a press has the temperature of its first frames. Presses of a
    /// few seconds therefore change little, and long ones by the drift of their zeros.
    ///
    /// The chips then count as having kept their first temperature: the press's temperatures are
    /// set to it, so a second compensation changes nothing.
    ///
    /// # Errors
    /// The recording is of another sensor, or a taxel has no coefficient. Nothing is changed then.
    pub fn apply(&self, recording: &mut Recording) -> Result<Compensated, TemperatureError> {
        let drifts = self.of(&recording.sensor, &recording.taxels)?;
        let mut done = Compensated::default();
        let [mut lowest_c, mut highest_c] = [f64::INFINITY, f64::NEG_INFINITY];
        for press in &mut recording.presses {
            let Some(temperature_c) = &mut press.temperature_c else {
                done.n_without += 1;
                continue;
            };
            done.n_presses += 1;
            for (taxel, drift) in drifts.iter().enumerate() {
                let smooth_c = smooth(&press.time_s, temperature_c, taxel);
                let Some(first_c) = smooth_c.iter().copied().find(|c| c.is_finite()) else {
                    continue;
                };
                for (row, c) in press
                    .taxels_kpa
                    .iter_mut()
                    .zip(&smooth_c)
                    .filter(|(_, c)| c.is_finite())
                {
                    let drift_kpa = drift.kpa_per_k * (c - first_c);
                    row[taxel] -= drift_kpa;
                    done.largest_kpa = done.largest_kpa.max(drift_kpa.abs());
                    lowest_c = lowest_c.min(c - drift.between_c[0]);
                    highest_c = highest_c.max(c - drift.between_c[1]);
                }
                temperature_c.iter_mut().for_each(|row| row[taxel] = first_c);
            }
        }
        if lowest_c < -BEYOND_K || highest_c > BEYOND_K {
            done.remarks.push(format!(
                "temperatures are up to {:.0} K outside of the range in which the compensation was found",
                highest_c.max(-lowest_c)
            ));
        }
        Ok(done)
    }
}

/// A taxel's temperatures, each averaged over the frames around it, °C. NaN if there are none.
fn smooth(time_s: &[f64], temperature_c: &[Vec<f64>], taxel: usize) -> Vec<f64> {
    let (mut from, mut to) = (0, 0);
    let (mut sum_c, mut count) = (0.0, 0_u32);
    let known = |frame: usize| Some(temperature_c[frame][taxel]).filter(|c| !c.is_nan());
    let mut smooth_c = Vec::with_capacity(time_s.len());
    for at_s in time_s {
        while to < time_s.len() && time_s[to] <= at_s + HALF_S {
            if let Some(c) = known(to) {
                (sum_c, count) = (sum_c + c, count + 1);
            }
            to += 1;
        }
        while time_s[from] < at_s - HALF_S {
            if let Some(c) = known(from) {
                (sum_c, count) = (sum_c - c, count - 1);
            }
            from += 1;
        }
        smooth_c.push(if count > 0 {
            sum_c / f64::from(count)
        } else {
            f64::NAN
        });
    }
    smooth_c
}

#[cfg(test)]
mod tests {
    use twintac_recording::{Control, Press, Provenance};
    use twintac_shape::Pose;

    use super::*;
    use crate::TaxelDrift;

    /// One hour at one frame per second, in which the chips warm up by 4 K and nothing touches.
    fn warming(noise_c: f64) -> Recording {
        let n = 3600;
        let warmed_k = |frame: usize| 4.0 * (1.0 - (-(frame as f64) / 1200.0).exp());
        let noise_c = |frame: usize| {
            if frame.is_multiple_of(2) {
                noise_c
            } else {
                -noise_c
            }
        };
        let press = Press {
            name: "rest#1".to_owned(),
            mounting: "rest.mcap".to_owned(),
            indenter: "ball".to_owned(),
            control: Control::Pose,
            time_s: (0..n).map(|frame| frame as f64).collect(),
            gel_from_indenter: vec![Pose::IDENTITY; n],
            force_n: None,
            taxels_kpa: (0..n)
                .map(|frame| vec![2.0 * warmed_k(frame), -0.5 * warmed_k(frame)])
                .collect(),
            taxels_raw: vec![vec![101.0; 2]; n],
            temperature_c: Some(
                (0..n)
                    .map(|frame| vec![25.0 + warmed_k(frame) + noise_c(frame); 2])
                    .collect(),
            ),
            valid: vec![vec![true; 2]; n],
        };
        Recording {
            sensor: "pair".to_owned(),
            provenance: Provenance::Emulated,
            taxels: vec!["a".to_owned(), "b".to_owned()],
            presses: vec![press],
        }
    }

    fn compensation(between_c: [f64; 2]) -> Compensation {
        let taxel = |name: &str, kpa_per_k: f64| TaxelDrift {
            name: name.to_owned(),
            kpa_per_k,
            between_c,
            remaining_kpa: 0.0,
        };
        Compensation {
            sensor: "pair".to_owned(),
            provenance: Provenance::Emulated,
            taxels: vec![taxel("b", -0.5), taxel("a", 2.0)],
        }
    }

    #[test]
    fn a_drift_of_eight_kpa_an_hour_is_taken_off_to_less_than_a_twentieth_of_one() {
        let mut recording = warming(0.05);
        let before = recording.clone();
        let done = compensation([25.0, 29.0]).apply(&mut recording).unwrap();
        assert_eq!((done.n_presses, done.n_without, done.remarks.len()), (1, 0, 0));
        assert!(done.largest_kpa > 7.0, "{done:?}");
        let press = &recording.presses[0];
        let worst_kpa = press
            .taxels_kpa
            .iter()
            .flatten()
            .fold(0.0, |worst: f64, kpa| worst.max(kpa.abs()));
        assert!(worst_kpa < 0.05, "{worst_kpa}");
        assert_eq!(press.taxels_raw, before.presses[0].taxels_raw);
        // A second compensation changes nothing.
        let once = recording.clone();
        let again = compensation([25.0, 29.0]).apply(&mut recording).unwrap();
        assert!(again.largest_kpa < 1e-12, "{again:?}");
        let pairs = once.presses[0]
            .taxels_kpa
            .iter()
            .flatten()
            .zip(recording.presses[0].taxels_kpa.iter().flatten());
        assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-12));
    }

    #[test]
    fn presses_without_temperatures_and_readings_without_one_stay() {
        let mut recording = warming(0.0);
        let rows = recording.presses[0].temperature_c.as_mut().unwrap();
        rows.iter_mut().for_each(|row| row[1] = f64::NAN);
        recording.presses.push(Press {
            name: "rest#2".to_owned(),
            temperature_c: None,
            ..recording.presses[0].clone()
        });
        let before = recording.clone();
        let done = compensation([25.0, 29.0]).apply(&mut recording).unwrap();
        assert_eq!((done.n_presses, done.n_without), (1, 1));
        assert_eq!(recording.presses[1], before.presses[1]);
        let column = |recording: &Recording, taxel: usize| -> Vec<f64> {
            recording.presses[0]
                .taxels_kpa
                .iter()
                .map(|row| row[taxel])
                .collect()
        };
        assert_eq!(column(&recording, 1), column(&before, 1));
        assert_ne!(column(&recording, 0), column(&before, 0));
    }

    #[test]
    fn other_sensors_are_refused_and_other_temperatures_said() {
        let mut recording = warming(0.0);
        recording.sensor = "tip".to_owned();
        let before = recording.clone();
        assert!(compensation([25.0, 29.0]).apply(&mut recording).is_err());
        assert_eq!(recording, before);
        let mut recording = warming(0.0);
        let done = compensation([15.0, 20.0]).apply(&mut recording).unwrap();
        assert!(done.remarks[0].contains("9 K outside"), "{done:?}");
    }
}
