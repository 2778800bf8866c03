//! Estimates from a trained model: differences between taxels, height of the installation,
//! positions of the ports.

use std::collections::BTreeSet;

use digitac::{BenchEstimate, Estimate, Gains};
use twintac_recording::Provenance;
use twintac_sensor::Sensor;

use crate::motion::Motion;
use crate::text::Line;
use crate::width::{Width, digits, mean};

/// Number of standard errors above which a shift or a rotation counts.
const SIGMAS: f64 = 2.0;

/// What a model found about a cast sensor and its test setup.
pub struct Casting<'a> {
    /// Provenance of the recordings that the model was trained on.
    pub provenance: Provenance,
    /// Whether the model has gains at all: the paper's network has none.
    pub has_gains: bool,
    /// The gains of the taxels.
    pub gains: &'a Gains,
    /// The calibration of the test setup.
    pub bench: &'a BenchEstimate,
    /// The sensor's description.
    pub sensor: &'a Sensor,
    /// Indices of excluded taxels, whose readings are not to be trusted.
    pub doubtful: BTreeSet<usize>,
}

/// The lines of the fields that a model gives. Without a model each line says so.
#[must_use]
pub fn lines(casting: Option<&Casting<'_>>) -> Vec<Line> {
    let Some(casting) = casting else {
        let fields = [
            "gain_deviation",
            "growth_deviation_per_kpa",
            "modulus_deviation",
            "height_deviation_mm",
            "place_deviation_mm",
            "turn_deviation_rad",
            "tilt_deviation_rad",
        ];
        let why = "it is found from a trained model, and none was given";
        return fields
            .into_iter()
            .map(|field| Line::left_out(field, why))
            .collect();
    };
    let [place, turn] = casting.mounting();
    vec![
        casting.gain(),
        casting.growth(),
        Line::left_out(
            "modulus_deviation",
            "a spread requires the gels of several sensors",
        ),
        casting.height(),
        place,
        turn,
        Line::left_out(
            "tilt_deviation_rad",
            "models are trained on a level test setup, or levelled by first touches that they do not store",
        ),
    ]
}

impl Casting<'_> {
    /// Whether readings depend on earlier frames.
    pub fn has_memory(&self) -> bool {
        self.gains.memory.iter().flatten().any(|share| *share > 0.0)
    }

    /// Values of the taxels that are not excluded.
    fn trusted(&self, of: impl Fn(usize) -> f64) -> Vec<f64> {
        let taxels = 0..self.gains.gain.len();
        taxels
            .filter(|taxel| !self.doubtful.contains(taxel))
            .map(of)
            .collect()
    }

    /// Says how many taxels are excluded.
    fn without_doubtful(&self) -> String {
        match self.doubtful.len() {
            0 => String::new(),
            n => format!(", without {n} excluded"),
        }
    }

    fn gain(&self) -> Line {
        let field = "gain_deviation";
        if !self.has_gains {
            return Line::left_out(field, "the paper's network has no gains");
        }
        let gains = self.trusted(|taxel| self.gains.gain[taxel]);
        let usual = mean(&gains);
        let Some(width) = Width::about_mean(&gains).map(|width| width.times(1.0 / usual)) else {
            return Line::left_out(field, "a spread requires two taxels");
        };
        let comment = format!(
            "{} (model): spread of the taxels' gains within one sensor about their mean, {}, as a fraction of it{}; {}.",
            self.provenance,
            digits(usual, 3),
            self.without_doubtful(),
            width.sureness()
        );
        Line::given(field, width.value, comment)
    }

    /// The growth depends on the port's pressure, so it is converted to the same pressure for all
    /// taxels, that of a taxel with mean gain.
    fn growth(&self) -> Line {
        let field = "growth_deviation_per_kpa";
        if !self.has_gains || self.gains.stiffening_per_kpa.iter().all(|growth| *growth == 0.0) {
            return Line::left_out(field, "the model has no static nonlinearity of the ports");
        }
        let usual = mean(&self.trusted(|taxel| self.gains.gain[taxel]));
        let growth =
            self.trusted(|taxel| self.gains.stiffening_per_kpa[taxel] * self.gains.gain[taxel] / usual);
        let Some(width) = Width::about_mean(&growth) else {
            return Line::left_out(field, "a spread requires two taxels");
        };
        let comment = format!(
            "{} (model): spread of the ports' static nonlinearity about its mean, {} per kPa for a taxel of mean gain{}; {}.",
            self.provenance,
            digits(mean(&growth), 3),
            self.without_doubtful(),
            width.sureness()
        );
        Line::given(field, width.value, comment)
    }

    fn height(&self) -> Line {
        let field = "height_deviation_mm";
        let heights: Vec<&Estimate> = self.bench.contact_offset_mm.values().collect();
        let values: Vec<f64> = heights.iter().map(|height| height.value).collect();
        let Some(width) = Width::about_mean(&values) else {
            let n = values.len();
            let why =
                format!("a spread requires two installations, and the model has contact heights of {n}");
            return Line::left_out(field, why);
        };
        let squares: Vec<f64> = heights.iter().map(|height| height.uncertainty.powi(2)).collect();
        let error_mm = mean(&squares).sqrt();
        let Some(width) = width.without(error_mm) else {
            let (found, error) = (digits(width.value, 2), digits(error_mm, 2));
            let why = format!(
                "contact heights of {} installations differ by {found} mm, no more than their standard error, {error} mm",
                width.n
            );
            return Line::left_out(field, why);
        };
        let comment = format!(
            "{} (model): spread of the installations' contact heights about their mean, without their standard error, {} mm; {}.",
            self.provenance,
            digits(error_mm, 2),
            width.sureness()
        );
        Line::given(field, width.value, comment)
    }

    /// Position and rotation: the rigid motion that the ports' shifts have in common.
    fn mounting(&self) -> [Line; 2] {
        let fields = ["place_deviation_mm", "turn_deviation_rad"];
        let Some(motion) = self.motion() else {
            let why = "three ports whose positions the model fitted along x and y are required";
            return fields.map(|field| Line::left_out(field, why));
        };
        let own = format!(
            "the ports' individual shifts, {} mm, belong to the casting and are not included",
            digits(motion.own_mm.value, 2)
        );
        let line = |field, values: &[f64], error: f64, what: &str, unit: &str| {
            let found = Width::about_zero(values);
            let stands_out = found.filter(|found| found.value > SIGMAS * error);
            match stands_out.and_then(|found| found.without(error)) {
                Some(width) => Line::given(
                    field,
                    width.value,
                    format!(
                        "{} (model): common {what} of the ports, about zero, of one installation; {own}; {}.",
                        self.provenance,
                        width.sureness()
                    ),
                ),
                None => Line::left_out(
                    field,
                    format!(
                        "the common {what} of the ports, {} {unit}, is not significant against its error, {}; {own}",
                        digits(found.map_or(0.0, |found| found.value), 2),
                        digits(error, 2)
                    ),
                ),
            }
        };
        let [place, turn] = fields;
        [
            line(
                place,
                &motion.shift_mm,
                motion.shift_error_mm,
                "shift along x and y",
                "mm",
            ),
            line(turn, &[motion.turn_rad], motion.turn_error_rad, "rotation", "rad"),
        ]
    }

    fn motion(&self) -> Option<Motion> {
        let ports = self.bench.ports.iter().zip(&self.sensor.taxels).enumerate();
        let (shifts_mm, places_mm): (Vec<[f64; 2]>, Vec<[f64; 2]>) = ports
            .filter(|(taxel, _)| !self.doubtful.contains(taxel))
            .map(|(_, (port, taxel))| (port.shift_mm, [taxel.position_mm.x, taxel.position_mm.y]))
            .unzip();
        Motion::of(&shifts_mm, &places_mm)
    }
}

#[cfg(test)]
mod tests {
    use std::collections::BTreeMap;

    use digitac::PortEstimate;
    use twintac_random::{RandomStream, normal, stream};
    use twintac_sensor::SensorFile;

    use super::*;

    /// A calibrated setup with `n` installations of an indenter.
    fn bench(
        random: &mut RandomStream,
        n: usize,
        deviation_mm: f64,
        ports: Vec<PortEstimate>,
    ) -> BenchEstimate {
        let mut height = |number: usize| {
            let estimate = Estimate {
                value: 0.1 + normal(random, deviation_mm) + normal(random, 0.02),
                uncertainty: 0.02,
            };
            (format!("file {number}"), estimate)
        };
        BenchEstimate {
            tip_radius_mm: None,
            contact_offset_mm: (0..n).map(&mut height).collect::<BTreeMap<_, _>>(),
            contact_offset_elsewhere_mm: 0.0,
            stiffness: None,
            ports,
            smooth_factor: None,
            has_history: false,
            gains: None,
            deviation_percent: 0.0,
            doubts: Vec::new(),
        }
    }

    fn gains(gain: Vec<f64>, growth: Vec<f64>) -> Gains {
        Gains {
            memory: vec![Vec::new(); gain.len()],
            stiffening_per_kpa: growth,
            gain,
            time_constants_s: Vec::new(),
        }
    }

    fn value(lines: &[Line], field: &str) -> Option<f64> {
        let line = lines.iter().find(|line| line.field == field).unwrap();
        line.said.as_ref().ok().map(|given| given.value)
    }

    /// The root mean square over many sensors of eight taxels with known widths.
    #[test]
    fn known_widths_of_gains_heights_and_mounting_are_recovered() {
        let sensor = SensorFile::phystac().unwrap().sensor;
        let mut random = stream(1, "castings");
        let expected = [
            ("gain_deviation", 0.1),
            ("growth_deviation_per_kpa", 0.002),
            ("height_deviation_mm", 0.05),
            ("place_deviation_mm", 0.3),
            ("turn_deviation_rad", 0.05),
        ];
        let mut squares = [0.0; 5];
        for _ in 0..200 {
            let gain: Vec<f64> = (0..8).map(|_| 1.5 * (1.0 + normal(&mut random, 0.1))).collect();
            let growth = gain
                .iter()
                .map(|gain| (0.01 + normal(&mut random, 0.002)) * 1.5 / gain)
                .collect();
            let (x, y) = (normal(&mut random, 0.3), normal(&mut random, 0.3));
            let turn = normal(&mut random, 0.05);
            let ports = sensor.taxels.iter().map(|taxel| PortEstimate {
                shift_mm: [
                    x - turn * taxel.position_mm.y + normal(&mut random, 0.01),
                    y + turn * taxel.position_mm.x + normal(&mut random, 0.01),
                ],
                wider_mm: 0.0,
            });
            let ports = ports.collect();
            let bench = bench(&mut random, 8, 0.05, ports);
            let gains = gains(gain, growth);
            let casting = Casting {
                provenance: Provenance::Simulated,
                has_gains: true,
                gains: &gains,
                bench: &bench,
                sensor: &sensor,
                doubtful: BTreeSet::new(),
            };
            let lines = lines(Some(&casting));
            for (square, (field, _)) in squares.iter_mut().zip(expected) {
                *square += value(&lines, field).unwrap_or(0.0).powi(2) / 200.0;
            }
        }
        for (square, (field, expected)) in squares.into_iter().zip(expected) {
            let found = square.sqrt();
            assert!(
                (found / expected - 1.0).abs() < 0.12,
                "{field}: {found}, not {expected}"
            );
        }
    }

    #[test]
    fn what_a_model_does_not_tell_is_left_out_with_the_reason() {
        let sensor = SensorFile::phystac().unwrap().sensor;
        let mut random = stream(1, "one mounting");
        let bench = bench(&mut random, 1, 0.05, Vec::new());
        let gains = gains(vec![1.0; 8], vec![0.0; 8]);
        let mut casting = Casting {
            provenance: Provenance::Simulated,
            has_gains: true,
            gains: &gains,
            bench: &bench,
            sensor: &sensor,
            doubtful: (1..8).collect(),
        };
        let all = lines(Some(&casting));
        let why = |field: &str| {
            let line = all.iter().find(|line| line.field == field).unwrap();
            line.said.as_ref().err().unwrap().clone()
        };
        assert!(why("gain_deviation").contains("two taxels"));
        assert!(why("growth_deviation_per_kpa").contains("no static nonlinearity"));
        assert!(why("height_deviation_mm").contains("two installations"));
        assert!(why("place_deviation_mm").contains("three ports"));
        assert!(lines(None).iter().all(|line| line.said.is_err()));
        casting.has_gains = false;
        assert!(lines(Some(&casting)).iter().all(|line| line.said.is_err()));
    }
}
