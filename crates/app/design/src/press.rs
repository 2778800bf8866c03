//! Presses a design's gel, and computes its figures.

use glam::{DQuat, DVec2};
use serde::{Deserialize, Serialize};
use twintac_depth_table::{DepthCurves, DepthTable, PressFrame};
use twintac_fit::Triangle;
use twintac_sensor::{ATMOSPHERE_KPA, Sensor};
use twintac_shape::Shape;
use twintac_simulate::{Gel, Keyframe, PressPlace};
use twintac_store::{Keyed, Recipe};
use twintac_work::{WorkError, in_one_sentence};

use crate::{Figures, Measure, RangeEnd};

/// Largest depth as a fraction of the gel's height.
const DEEPEST: f64 = 0.5;

/// Step of the finite differences of readings with respect to the location, mm.
const ASIDE_MM: f64 = 0.5;

/// A reading counts as detected above this many times its noise.
const FELT: f64 = 3.0;

/// Speed of the press for hysteresis, mm/s, and number of frames down and up.
const SPEED_MM_PER_S: f64 = 1.0;
const FRAMES_OF_A_WAY: u32 = 12;

/// The inputs of one gel's figures.
#[derive(Serialize)]
pub(crate) struct Pressed<'a> {
    /// A name for the file of the result.
    pub(crate) name: &'a str,
    pub(crate) gel: Keyed<Gel>,
    pub(crate) measure: &'a Measure,
}

/// The figures of a gel, or why there are none.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum Outcome {
    /// The figures.
    Figures(Figures),
    /// Why the design could not be evaluated.
    Refused(String),
}

impl Recipe for Pressed<'_> {
    type Value = Outcome;
    type Error = WorkError;

    fn label(&self) -> String {
        self.name.to_owned()
    }

    fn make(&self) -> Result<Outcome, WorkError> {
        Ok(self.figures().map_or_else(Outcome::Refused, Outcome::Figures))
    }
}

/// The locations at which a sensor is pressed.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Places {
    /// The pressed taxel.
    taxel: usize,
    above: DVec2,
    /// The location farthest from the pressed taxel and its next neighbours.
    between: Option<DVec2>,
    /// Directions in which a location can be found: one along a row of taxels, else two.
    directions: [Option<DVec2>; 2],
}

impl Places {
    /// The locations for a sensor with at least one taxel.
    fn of(sensor: &Sensor) -> Self {
        let ports: Vec<DVec2> = sensor
            .taxels
            .iter()
            .map(|taxel| taxel.position_mm.truncate())
            .collect();
        let middle = ports.iter().sum::<DVec2>() / ports.len() as f64;
        // Distances are rounded, so that equal ones keep their order despite rounding errors.
        let step = |mm: f64| (1e6 * mm).round();
        let nearest = ports
            .iter()
            .enumerate()
            .min_by(|(_, a), (_, b)| step(a.distance(middle)).total_cmp(&step(b.distance(middle))));
        let (taxel, &above) = nearest.expect("a sensor has a taxel");
        let mut next: Vec<DVec2> = ports
            .iter()
            .map(|port| port - above)
            .filter(|way| way.length() > 0.0)
            .collect();
        let inwards = middle - above;
        next.sort_by(|a, b| {
            let key = |way: &DVec2| [step(way.length()), -step(way.dot(inwards))];
            key(a)[0]
                .total_cmp(&key(b)[0])
                .then(key(a)[1].total_cmp(&key(b)[1]))
        });
        let first = next.first().copied();
        let second = first.and_then(|first| {
            let is_aside = |way: &&DVec2| way.perp_dot(first).abs() > 0.5 * way.length() * first.length();
            next.iter().find(is_aside).copied()
        });
        Self {
            taxel,
            above,
            between: first.map(|first| above + 0.5 * (first + second.unwrap_or(DVec2::ZERO))),
            directions: match (first, second) {
                (Some(_), Some(_)) => [Some(DVec2::X), Some(DVec2::Y)],
                (Some(first), None) => [Some(first.normalize()), None],
                (None, _) => [None, None],
            },
        }
    }
}

impl Pressed<'_> {
    fn figures(&self) -> Result<Figures, String> {
        let sensor = self.gel.sensor();
        let places = Places::of(sensor);
        let force_n = self.measure.force_n;
        let noise_kpa = self.measure.noise_kpa(sensor);
        let limits = sensor.limits;
        let half_mm = DEEPEST * self.gel.height_mm();
        let deepest_mm = limits.map_or(half_mm, |limits| limits.depth_mm.min(half_mm));

        let table = self.table(places.above, deepest_mm)?;
        let curves = self.curves(&table)?;
        self.is_reached(&curves, table.failure.as_deref())?;
        let depth_mm = curves.depth_mm(force_n);
        let readings = curves.pressure_kpa(depth_mm);
        let own_kpa = readings[places.taxel];
        if own_kpa <= 0.0 {
            return Err(format!("the pressed taxel reads {own_kpa:.4} kPa at {force_n} N"));
        }
        let others = readings
            .iter()
            .enumerate()
            .filter(|(taxel, _)| *taxel != places.taxel);
        let other_kpa = others.map(|(_, reading)| reading.abs()).max_by(f64::total_cmp);

        let mut errors_mm = Vec::new();
        if places.directions[0].is_some() {
            errors_mm.push(self.localization_error_mm(
                &places,
                places.above,
                (&curves, depth_mm),
                noise_kpa,
            )?);
        }
        let (mut sensitivity_between, mut fine) = (None, smallest_force_n(&curves, noise_kpa));
        if let Some(between) = places.between {
            let table = self.table(between, deepest_mm)?;
            let curves = self.curves(&table)?;
            self.is_reached(&curves, table.failure.as_deref())?;
            let depth_mm = curves.depth_mm(force_n);
            let most_kpa = curves.pressures_kpa(depth_mm).fold(f64::NEG_INFINITY, f64::max);
            sensitivity_between = Some(most_kpa / force_n);
            fine = smallest_force_n(&curves, noise_kpa);
            errors_mm.push(self.localization_error_mm(&places, between, (&curves, depth_mm), noise_kpa)?);
        }
        let (range_n, range_end) = self.range(&table, &curves, places.taxel);
        Ok(Figures {
            sensitivity_kpa_per_n: own_kpa / force_n,
            sensitivity_between_kpa_per_n: sensitivity_between,
            depth_mm,
            range_n,
            range_end,
            cross_talk_percent: other_kpa.map(|other_kpa| 100.0 * other_kpa / own_kpa),
            localization_error_mm: errors_mm
                .into_iter()
                .collect::<Option<Vec<f64>>>()
                .and_then(|errors| errors.into_iter().max_by(f64::total_cmp)),
            hysteresis_percent: self.hysteresis_percent(&places, depth_mm)?,
            smallest_force_n: fine.ok_or_else(|| format!("no taxel reads {FELT} times its noise"))?,
        })
    }

    fn place(&self, at: DVec2, depth_mm: f64) -> PressPlace {
        PressPlace {
            indenter: "ball".to_owned(),
            shape: Shape::Sphere {
                radius_mm: self.measure.ball_radius_mm,
            },
            x_mm: at.x,
            y_mm: at.y,
            rotation: DQuat::IDENTITY,
            depth_mm,
            enough_force_n: None,
        }
    }

    fn table(&self, at: DVec2, depth_mm: f64) -> Result<DepthTable, String> {
        let place = self.place(at, depth_mm);
        self.gel
            .depth_table(&place)
            .map_err(|error| in_one_sentence(&error))
    }

    fn curves(&self, table: &DepthTable) -> Result<DepthCurves, String> {
        DepthCurves::new(table, self.gel.sensor().taxels.len()).map_err(|error| in_one_sentence(&error))
    }

    /// `Ok` if the table reaches the force of the figures.
    fn is_reached(&self, curves: &DepthCurves, failure: Option<&str>) -> Result<(), String> {
        let force_n = self.measure.force_n;
        if curves.max_force_n() >= force_n {
            return Ok(());
        }
        Err(format!(
            "{force_n} N is not reached: {:.3} N at {:.2} mm{}",
            curves.max_force_n(),
            curves.max_depth_mm(),
            failure.map_or(String::new(), |why| format!(" ({why})"))
        ))
    }

    /// The largest force that the chip can read and the limits allow, N, and what limits it.
    fn range(&self, table: &DepthTable, curves: &DepthCurves, taxel: usize) -> (f64, RangeEnd) {
        let sensor = self.gel.sensor();
        let most_kpa = sensor.readout.max_kpa - ATMOSPHERE_KPA;
        let saturates = |frame: &PressFrame| frame.port_pressure_kpa[taxel] >= most_kpa;
        let end = if table.failure.is_some() {
            RangeEnd::Solver
        } else {
            RangeEnd::Depth
        };
        let (mut range_n, mut range_end) = (curves.max_force_n(), end);
        if let Some(beyond) = table
            .frames
            .iter()
            .position(saturates)
            .filter(|beyond| *beyond > 0)
        {
            let [before, after] = [beyond - 1, beyond].map(|frame| &table.frames[frame]);
            let [low, high] = [before, after].map(|frame| frame.port_pressure_kpa[taxel]);
            let part = (most_kpa - low) / (high - low);
            range_n = before.force_n + part * (after.force_n - before.force_n);
            range_end = RangeEnd::Saturation;
        }
        match sensor.limits {
            Some(limits) if limits.force_n < range_n => (limits.force_n, RangeEnd::Force),
            _ => (range_n, range_end),
        }
    }

    /// Error of a location found from one frame: the Cramér–Rao bound for unknown location and
    /// depth.
    fn localization_error_mm(
        &self,
        places: &Places,
        at: DVec2,
        (curves, depth_mm): (&DepthCurves, f64),
        noise_kpa: f64,
    ) -> Result<Option<f64>, String> {
        let here = curves.pressure_kpa(depth_mm);
        let deeper = curves.pressure_kpa(depth_mm + DEPTH_STEP * depth_mm);
        let mut rates = Vec::with_capacity(3);
        for way in places.directions.iter().flatten() {
            let table = self.table(at + ASIDE_MM * way, (1.0 + DEPTH_STEP) * depth_mm)?;
            let aside = self.curves(&table)?.pressure_kpa(depth_mm);
            rates.push(rate(&here, &aside, ASIDE_MM));
        }
        let n_places = rates.len();
        rates.push(rate(&here, &deeper, DEPTH_STEP * depth_mm));
        Ok(covariance(&rates, noise_kpa).map(|covariance| {
            let n = rates.len();
            (0..n_places)
                .map(|index| covariance[index * n + index])
                .sum::<f64>()
                .sqrt()
        }))
    }

    /// Largest difference between readings on the way up and on the way down, % of the largest
    /// reading.
    fn hysteresis_percent(&self, places: &Places, depth_mm: f64) -> Result<Option<f64>, String> {
        if self.gel.material().prony.is_empty() {
            return Ok(None);
        }
        let whole_s = depth_mm / SPEED_MM_PER_S;
        let keyframes: Vec<Keyframe> = (0..=2 * FRAMES_OF_A_WAY)
            .map(|frame| {
                let ways = f64::from(frame) / f64::from(FRAMES_OF_A_WAY);
                Keyframe {
                    time_s: ways * whole_s,
                    depth_mm: depth_mm * (1.0 - (1.0 - ways).abs()),
                }
            })
            .collect();
        let history = self
            .gel
            .press(&self.place(places.above, depth_mm), &keyframes)
            .map_err(|error| in_one_sentence(&error))?;
        if let Some(why) = history.failure {
            return Err(format!("down and up: {why}"));
        }
        let of_frame = |frame: &PressFrame| [frame.force_n, frame.port_pressure_kpa[places.taxel]];
        let (down, up) = history.frames.split_at(FRAMES_OF_A_WAY as usize + 1);
        let down: Vec<[f64; 2]> = down.iter().map(of_frame).collect();
        let [most_n, most_kpa] = down[down.len() - 1];
        let up = up
            .iter()
            .map(of_frame)
            .filter(|[force_n, _]| (0.0..=most_n).contains(force_n));
        let apart =
            up.filter_map(|[force_n, reading_kpa]| Some((reading_kpa - between(&down, force_n)?).abs()));
        Ok(apart
            .max_by(f64::total_cmp)
            .map(|apart_kpa| 100.0 * apart_kpa / most_kpa))
    }
}

/// Step of the finite difference with respect to depth, as a fraction of the depth.
const DEPTH_STEP: f64 = 0.05;

/// The finite difference of readings.
fn rate(before: &[f64], after: &[f64], step: f64) -> Vec<f64> {
    before
        .iter()
        .zip(after)
        .map(|(before, after)| (after - before) / step)
        .collect()
}

/// The covariance of the unknowns, from the derivatives of all readings with respect to each of
/// them: σ² (Jᵀ J)⁻¹. `None` if the readings do not determine them.
fn covariance(rates: &[Vec<f64>], noise_kpa: f64) -> Option<Vec<f64>> {
    let n = rates.len();
    // Each unknown is scaled by its own effect, so that an undetermined one shows as a large
    // inverse.
    let norms: Vec<f64> = rates.iter().map(|rate| dot(rate, rate).sqrt()).collect();
    if !norms.iter().all(|norm| *norm > 0.0) {
        return None;
    }
    let mut normal = vec![0.0; n * n];
    for row in 0..n {
        for column in 0..n {
            normal[row * n + column] = dot(&rates[row], &rates[column]) / (norms[row] * norms[column]);
        }
    }
    let inverse = Triangle::of(normal, n).inverse();
    let told = (0..n).all(|index| (0.0..LEAST_TOLD).contains(&inverse[index * n + index]));
    told.then(|| {
        let scaled = (0..n * n).map(|index| inverse[index] / (norms[index / n] * norms[index % n]));
        scaled.map(|value| noise_kpa * noise_kpa * value).collect()
    })
}

/// Largest value on the diagonal of the scaled inverse; beyond it an unknown's effect is too much
/// like that of the others.
const LEAST_TOLD: f64 = 1e8;

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// The value of a polyline at a point of its first coordinate, which increases.
fn between(points: &[[f64; 2]], at: f64) -> Option<f64> {
    points
        .windows(2)
        .find(|pair| (pair[0][0]..=pair[1][0]).contains(&at))
        .map(|pair| {
            let part = (at - pair[0][0]) / (pair[1][0] - pair[0][0]).max(f64::MIN_POSITIVE);
            pair[0][1] + part * (pair[1][1] - pair[0][1])
        })
}

/// The smallest force at which some taxel's reading is detected, N.
fn smallest_force_n(curves: &DepthCurves, noise_kpa: f64) -> Option<f64> {
    let is_felt = |depth_mm: f64| {
        curves
            .pressures_kpa(depth_mm)
            .any(|reading| reading >= FELT * noise_kpa)
    };
    let mut range = [0.0, curves.max_depth_mm()];
    if !is_felt(range[1]) {
        return None;
    }
    for _ in 0..60 {
        let middle = 0.5 * (range[0] + range[1]);
        range[usize::from(is_felt(middle))] = middle;
    }
    Some(curves.force_n(range[1]))
}
