//! Estimates from recordings: noise, resolution, zeros, drift, hysteresis, frame rate, and faults
//! of taxels.

use std::collections::BTreeSet;

use twintac_characterize::{Characterization, Condition, Fate, Finding};
use twintac_recording::Provenance;

use crate::text::Line;
use crate::width::{Width, digits, mean, succession};

/// Fine, dead, stuck and late.
const N_FATES: usize = 4;

/// A characterization, and the taxels that count: those that read and are not excluded.
struct Told<'a> {
    found: &'a Characterization,
    taxels: BTreeSet<&'a str>,
}

/// The lines of the fields that recordings give. Without recordings each line says so.
/// `has_memory`: whether the model beside them has viscoelastic relaxation.
#[must_use]
pub fn lines(found: Option<&Characterization>, doubtful: &BTreeSet<usize>, has_memory: bool) -> Vec<Line> {
    let Some(found) = found else {
        let fields = [
            "offset_deviation_kpa",
            "drift_kpa_per_k",
            "drift_deviation_kpa_per_k",
            "temperature_deviation_k",
            "temperature_time_s",
            "cross_talk",
            "cross_talk_deviation",
            "noise_deviation_kpa",
            "quantum_kpa",
            "hysteresis",
            "dead_chance",
            "stuck_chance",
            "late_chance",
            "rate_hz",
            "jitter",
        ];
        let why = "it is found from recordings, and none were given";
        return fields
            .into_iter()
            .map(|field| Line::left_out(field, why))
            .collect();
    };
    let surroundings = "it belongs to the surroundings, not to the sensor; without it, drift has no effect";
    let told = Told::of(found, doubtful);
    let mut lines = vec![told.offset()];
    lines.extend(told.drift());
    lines.push(Line::left_out("temperature_deviation_k", surroundings));
    lines.push(Line::left_out("temperature_time_s", surroundings));
    let spread = "the reading of a taxel while another is pressed is mostly the load that spreads in the gel, which the simulated gel includes";
    lines.push(Line::left_out("cross_talk", spread));
    lines.push(Line::left_out("cross_talk_deviation", spread));
    lines.extend(told.noise());
    lines.push(told.hysteresis(has_memory));
    lines.extend(fates(&found.conditions, found.provenance));
    lines.extend(timing(found));
    lines
}

/// The figure, or why there is none.
fn told<T>(finding: &Finding<T>) -> Result<&T, String> {
    match finding {
        Finding::Found(figure) => Ok(figure),
        Finding::NotGiven(why) => Err(why.clone()),
    }
}

impl<'a> Told<'a> {
    fn of(found: &'a Characterization, doubtful: &BTreeSet<usize>) -> Self {
        let taxels = found.conditions.iter().enumerate();
        let counted = taxels.filter(|(index, taxel)| {
            !doubtful.contains(index) && matches!(taxel.fate, Fate::Fine | Fate::Late)
        });
        Self {
            found,
            taxels: counted.map(|(_, taxel)| taxel.taxel.as_str()).collect(),
        }
    }

    /// The figures of the taxels that count, or why there are none.
    fn counted<'f, T>(
        &self,
        finding: &'f Finding<Vec<T>>,
        name: impl Fn(&T) -> &str,
    ) -> Result<Vec<&'f T>, String> {
        let all = told(finding)?.iter();
        let counted: Vec<&T> = all.filter(|figure| self.taxels.contains(name(figure))).collect();
        if counted.is_empty() {
            return Err("no working taxel that is not excluded has this figure".to_owned());
        }
        Ok(counted)
    }

    fn offset(&self) -> Line {
        let field = "offset_deviation_kpa";
        let zeros = match self.counted(&self.found.zero_return, |taxel| &taxel.taxel) {
            Ok(zeros) => zeros,
            Err(why) => return Line::left_out(field, why),
        };
        let rms: Vec<f64> = zeros.iter().map(|taxel| taxel.rms_kpa).collect();
        let n: usize = zeros.iter().map(|taxel| taxel.n_presses).sum();
        let squares: f64 = zeros
            .iter()
            .map(|taxel| taxel.n_presses as f64 * taxel.rms_kpa.powi(2))
            .sum();
        let comment = format!(
            "{} (recordings): root mean square of the zeros' deviation right after a press, which includes the remaining viscoelastic relaxation; {} to {} kPa by taxel, from {n} values.",
            self.found.provenance,
            digits(rms.iter().copied().fold(f64::INFINITY, f64::min), 2),
            digits(rms.iter().copied().fold(0.0, f64::max), 2),
        );
        Line::given(field, (squares / n as f64).sqrt(), comment)
    }

    fn drift(&self) -> [Line; 2] {
        let fields = ["drift_kpa_per_k", "drift_deviation_kpa_per_k"];
        let taxels = match self.counted(&self.found.temperature_drift, |taxel| &taxel.taxel) {
            Ok(taxels) => taxels,
            Err(why) => return fields.map(|field| Line::left_out(field, why.clone())),
        };
        let coefficients: Vec<f64> = taxels.iter().map(|taxel| taxel.coefficient_kpa_per_k).collect();
        let [low_c, high_c] = taxels
            .iter()
            .fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], taxel| {
                [low.min(taxel.between_c[0]), high.max(taxel.between_c[1])]
            });
        let between = format!("{} to {} °C", digits(low_c, 3), digits(high_c, 3));
        let [common, own] = fields;
        let deviation = Width::about_mean(&coefficients).map_or_else(
            || Line::left_out(own, "a spread requires two taxels"),
            |width| {
                let comment = format!(
                    "{} (recordings): spread of these slopes over the taxels; {}.",
                    self.found.provenance,
                    width.sureness()
                );
                Line::given(own, width.value, comment)
            },
        );
        let comment = format!(
            "{} (recordings): mean slope of unloaded pressure over temperature of {} taxels, {between}; includes the weather.",
            self.found.provenance,
            coefficients.len()
        );
        [Line::given(common, mean(&coefficients), comment), deviation]
    }

    /// Noise and resolution. Uniform rounding to a step adds a twelfth of the step's square to the
    /// square of the noise, which is subtracted.
    fn noise(&self) -> [Line; 2] {
        let fields = ["noise_deviation_kpa", "quantum_kpa"];
        let step_kpa = self.found.quantum.found().map_or(0.0, |quantum| quantum.step_kpa);
        let noise = self.counted(&self.found.noise, |taxel| &taxel.taxel).map(|taxels| {
            let n: usize = taxels.iter().map(|taxel| taxel.n_readings).sum();
            let square: f64 = taxels
                .iter()
                .map(|taxel| taxel.n_readings as f64 * taxel.deviation_kpa.powi(2))
                .sum::<f64>()
                / n as f64;
            let own = square - step_kpa.powi(2) / 12.0;
            if own <= 0.0 {
                let why = format!(
                    "unloaded readings differ by {} kPa, no more than their steps cause",
                    digits(square.sqrt(), 2)
                );
                return Line::left_out(fields[0], why);
            }
            let all = taxels.iter().map(|taxel| taxel.deviation_kpa);
            let comment = format!(
                "{} (recordings): standard deviation of unloaded readings about the mean of their press, {} to {} kPa by taxel; from {n} values of {} taxels.",
                self.found.provenance,
                digits(all.clone().fold(f64::INFINITY, f64::min), 2),
                digits(all.fold(0.0, f64::max), 2),
                taxels.len()
            );
            Line::given(fields[0], own.sqrt(), comment)
        });
        let quantum = told(&self.found.quantum).map(|quantum| {
            let comment = format!(
                "{} (recordings): smallest step between readings, of which the others are multiples; from {} values.",
                self.found.provenance, quantum.n_differences
            );
            Line::given(fields[1], quantum.step_kpa, comment)
        });
        let [noise_field, quantum_field] = fields;
        [
            noise.unwrap_or_else(|why| Line::left_out(noise_field, why)),
            quantum.unwrap_or_else(|why| Line::left_out(quantum_field, why)),
        ]
    }

    /// A play operator of half width `h`, as a fraction of the reading, has a largest gap of 2 h /
    /// (1 + h) of full scale.
    fn hysteresis(&self, has_memory: bool) -> Line {
        let field = "hysteresis";
        if self.found.n_used == 0 {
            let why = "loading and unloading are compared at the same force, and no press has a known force";
            return Line::left_out(field, why);
        }
        let taxels = match self.counted(&self.found.hysteresis, |taxel| &taxel.taxel) {
            Ok(taxels) => taxels,
            Err(why) => return Line::left_out(field, why),
        };
        let gaps: Vec<f64> = taxels.iter().map(|taxel| taxel.percent / 100.0).collect();
        let gap = mean(&gaps);
        if !(0.0..1.0).contains(&gap) {
            let why = format!(
                "loading differs from unloading by {} % of full scale, which a play operator cannot describe",
                digits(100.0 * gap, 2)
            );
            return Line::left_out(field, why);
        }
        let twin = if has_memory {
            " The model has viscoelastic relaxation, which causes hysteresis as well: leave this out of a batch with that twin."
        } else {
            ""
        };
        let comment = format!(
            "{} (recordings): half of the gap between loading and unloading at the same force, {} % of full scale on average over {} taxels and {} presses.{twin}",
            self.found.provenance,
            digits(100.0 * gap, 2),
            taxels.len(),
            taxels.iter().map(|taxel| taxel.n_presses).sum::<usize>()
        );
        Line::given(field, gap / (2.0 - gap), comment)
    }
}

fn fates(conditions: &[Condition], provenance: Provenance) -> [Line; 3] {
    let n = conditions.len();
    let n_timed = conditions.iter().filter(|taxel| taxel.n_timed > 0).count();
    let fates = [
        ("dead_chance", Fate::Dead, "dead"),
        ("stuck_chance", Fate::Stuck, "stuck"),
        ("late_chance", Fate::Late, "late"),
    ];
    fates.map(|(field, fate, word)| {
        if fate == Fate::Late && n_timed == 0 {
            let why = "no press is fast enough to show whether a taxel is late by a frame";
            return Line::left_out(field, why);
        }
        let seen = conditions.iter().filter(|taxel| taxel.fate == fate).count();
        let told = if fate == Fate::Late {
            format!(", of which {n_timed} could be checked")
        } else {
            String::new()
        };
        let mostly = if seen == 0 { "; mostly the prior of the rule" } else { "" };
        let comment = format!(
            "{provenance} (recordings): {seen} of {n} taxels {word}{told}; rule of succession for four fates, ({seen} + 1) / ({n} + {N_FATES}){mostly}."
        );
        Line::given(field, succession(seen, n, N_FATES), comment)
    })
}

fn timing(found: &Characterization) -> [Line; 2] {
    let fields = ["rate_hz", "jitter"];
    let timing = match &found.timing {
        Finding::Found(timing) => timing,
        Finding::NotGiven(why) => return fields.map(|field| Line::left_out(field, why.clone())),
    };
    let (provenance, n, n_gaps) = (found.provenance, timing.n_intervals, timing.n_gaps);
    let [rate, jitter] = fields;
    let rate_comment = format!(
        "{provenance} (recordings): one over the mean time between frames, by their time stamps; from {n} values, without {n_gaps} gaps."
    );
    let jitter_comment = format!(
        "{provenance} (recordings): standard deviation of these times as a fraction of their mean; from {n} values."
    );
    [
        Line::given(rate, timing.rate_hz, rate_comment),
        Line::given(jitter, timing.jitter.min(1.0), jitter_comment),
    ]
}
