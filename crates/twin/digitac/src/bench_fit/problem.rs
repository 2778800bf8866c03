//! The presses, tables and unknowns of a setup calibration, as port pressures that depend on the
//! unknowns.

use std::collections::BTreeMap;
use std::ops::Range;

use twintac_depth_table::DepthCurves;
use twintac_recording::{Control, Press};

use super::smooth_factor::N_TERMS;
use super::widths::BenchWidths;
use super::{BenchEstimate, BenchSettings, Estimate, PortEstimate, SmoothFactor, Taxels, deepest_pose};
use crate::DigitacError;
use crate::numerics::{Unknown, median};
use crate::physical_fit::{Elastic, Pressures, Slope};

/// Number of depths at which tables are resampled.
const N_DEPTHS: usize = 96;
/// Power by which these depths are closer together near the surface.
const DEPTH_POWER: f64 = 1.5;
/// Step of ln radius and ln stiffness for derivatives.
const STEP: f64 = 1e-3;
/// Regularization of the ports' radius towards its description, per square millimetre.
const RADIUS_PULL: f64 = 1e-3;
/// Largest coefficient of the correction factor.
const FORM_LIMIT: f64 = 3.0;
/// The locations of ports along an axis are fitted only if presses are spread along it by at least
/// this, mm.
const SPREAD_MM: f64 = 2.0;

/// A press, in the order of the series.
pub(crate) struct Along<'a> {
    pub(crate) press: &'a Press,
    /// Index of its location among the resampled ones.
    pub(crate) place: usize,
    pub(crate) touch_z_mm: f64,
    /// Whether its readings are used for training.
    pub(crate) is_used: bool,
}

/// A table over depth, resampled at graded depths.
struct Resampled {
    depth_mm: f64,
    /// Force, then pressure and its three slopes of each taxel;
    /// `[n_radii][N_DEPTHS][1 + 4 * n_taxels]`.
    rows: Vec<Vec<Vec<f64>>>,
}

/// An unknown of the setup calibration.
#[derive(Clone, Copy, Debug)]
enum Quantity {
    /// The contact height of an installation, mm.
    ContactHeight(usize),
    LnRadius,
    LnStiffness,
    /// True minus described radius of all ports, mm.
    PortRadius,
    /// Shift of a port from its description, mm.
    PortShift {
        taxel: usize,
        axis: usize,
    },
    /// A coefficient of the correction factor.
    Coefficient(usize),
}

/// Values of all unknowns.
#[derive(Clone, Debug)]
struct Guess {
    offsets_mm: Vec<f64>,
    ln_radius: f64,
    ln_stiffness: f64,
    ports: Vec<PortEstimate>,
    form: Option<SmoothFactor>,
}

pub(crate) struct BenchProblem<'a> {
    presses: Vec<Along<'a>>,
    /// Frames of each press.
    frames: Vec<Range<usize>>,
    /// Installations of prescribed pose, with their frames.
    mountings: Vec<(String, Range<usize>)>,
    places: Vec<Resampled>,
    ln_radii: Vec<f64>,
    ln_stiffness: [f64; 2],
    /// Axes along which ports may be shifted.
    axes: Vec<usize>,
    /// The correction factor without its coefficients.
    form: Option<SmoothFactor>,
    n_taxels: usize,
    settings: &'a BenchSettings,
}

/// The estimate of a quantity that follows from the fitted values.
pub(super) type EstimateOf<'a> = dyn Fn(&dyn Fn(&[f64]) -> f64) -> Estimate + 'a;

impl<'a> BenchProblem<'a> {
    /// `curves` are those of each radius at each location; `[n_radii][n_places]`. With one radius
    /// or none, the radius is not fitted.
    pub(crate) fn new(
        presses: Vec<Along<'a>>,
        curves: &[Vec<DepthCurves>],
        radii_mm: &[f64],
        n_taxels: usize,
        (settings, taxels): (&'a BenchSettings, &Taxels),
    ) -> Self {
        let mut frames: Vec<Range<usize>> = Vec::with_capacity(presses.len());
        let mut mountings: Vec<(String, Range<usize>)> = Vec::new();
        for along in &presses {
            let start = frames.last().map_or(0, |before| before.end);
            let end = start + along.press.time_s.len();
            frames.push(start..end);
            if along.press.control == Control::Force {
                continue;
            }
            match mountings.last_mut() {
                Some((name, range)) if *name == along.press.mounting => range.end = end,
                _ => mountings.push((along.press.mounting.clone(), start..end)),
            }
        }
        let is_forced = presses.iter().any(|along| along.press.control == Control::Force);
        let position = |axis: usize| {
            let all = presses
                .iter()
                .flat_map(|along| along.press.gel_from_indenter.first());
            all.map(move |pose| pose.position_mm[axis])
        };
        let spread_mm = |axis: usize| {
            let low = position(axis).fold(f64::INFINITY, f64::min);
            position(axis).fold(f64::NEG_INFINITY, f64::max) - low
        };
        let has_places = settings.port_shift_limit_mm > 0.0;
        let n_places = curves.first().map_or(0, Vec::len);
        Self {
            axes: (0..2)
                .filter(|axis| has_places && spread_mm(*axis) > SPREAD_MM)
                .collect(),
            ln_stiffness: if is_forced && settings.radii_mm().len() < 2 {
                settings.stiffness_limits.map(f64::ln)
            } else {
                [0.0; 2]
            },
            places: (0..n_places)
                .map(|place| resampled(curves, place, n_taxels))
                .collect(),
            form: (settings.smooth_factor && radii_mm.len() < 2)
                .then(|| form(&presses, taxels))
                .flatten(),
            ln_radii: radii_mm.iter().map(|radius| radius.ln()).collect(),
            presses,
            frames,
            mountings,
            n_taxels,
            settings,
        }
    }

    /// The same, with ports and a correction factor that may differ from the learned ones, as far
    /// as these were fitted.
    pub(super) fn near_learned(mut self, learned: &BenchEstimate) -> Self {
        let is_shifted = |axis: usize| learned.ports.iter().any(|port| port.shift_mm[axis] != 0.0);
        self.axes = (0..2).filter(|axis| is_shifted(*axis)).collect();
        self.form.clone_from(&learned.smooth_factor);
        self
    }

    /// All unknowns, in the order of the values.
    fn quantities(&self) -> Vec<Quantity> {
        let mut quantities: Vec<Quantity> = (0..self.mountings.len()).map(Quantity::ContactHeight).collect();
        let scalars = [
            (self.ln_radii.len() > 1, Quantity::LnRadius),
            (self.ln_stiffness[0] < self.ln_stiffness[1], Quantity::LnStiffness),
            (
                self.settings.port_radius_limit_mm > 0.0 && !self.axes.is_empty(),
                Quantity::PortRadius,
            ),
        ];
        let fitted = scalars.into_iter().filter(|(is_fitted, _)| *is_fitted);
        quantities.extend(fitted.map(|(_, quantity)| quantity));
        for taxel in 0..self.n_taxels {
            let axes = self.axes.iter();
            quantities.extend(axes.map(|&axis| Quantity::PortShift { taxel, axis }));
        }
        if self.form.is_some() {
            quantities.extend((0..N_TERMS).map(Quantity::Coefficient));
        }
        quantities
    }

    fn fits_stiffness(&self) -> bool {
        self.ln_stiffness[0] < self.ln_stiffness[1]
    }

    /// For each unknown, the learned value and the standard deviation by which another test setup
    /// may differ from it. Ports are sought around their described locations.
    pub(super) fn learned(&self, learned: &BenchEstimate, widths: &BenchWidths) -> Vec<(f64, f64)> {
        let of = |quantity: Quantity| match quantity {
            Quantity::ContactHeight(mounting) => (
                learned.contact_offset_mm(&self.mountings[mounting].0),
                widths.contact_offset_mm,
            ),
            // The other test setup has the same tip.
            Quantity::LnRadius => (learned.tip_radius_mm.map_or(0.0, |radius| radius.value.ln()), 0.0),
            Quantity::LnStiffness => (learned.stiffness().ln(), widths.ln_stiffness),
            Quantity::PortRadius => (
                learned.ports.first().map_or(0.0, |port| port.wider_mm),
                widths.port_mm,
            ),
            // The shift of a port of one cast says nothing about the port of another cast.
            Quantity::PortShift { .. } => (0.0, widths.port_mm),
            Quantity::Coefficient(term) => {
                let factor = learned.smooth_factor.as_ref();
                (
                    factor.map_or(0.0, |factor| factor.coefficients[term]),
                    widths.factor,
                )
            }
        };
        self.quantities().into_iter().map(of).collect()
    }

    fn guess(&self, values: &[f64]) -> Guess {
        let mut guess = Guess {
            offsets_mm: vec![0.0; self.mountings.len()],
            ln_radius: self.ln_radii.first().copied().unwrap_or(0.0),
            ln_stiffness: 0.0,
            ports: vec![PortEstimate::default(); self.n_taxels],
            form: self.form.clone(),
        };
        for (quantity, &value) in self.quantities().into_iter().zip(values) {
            match quantity {
                Quantity::ContactHeight(mounting) => guess.offsets_mm[mounting] = value,
                Quantity::LnRadius => guess.ln_radius = value,
                Quantity::LnStiffness => guess.ln_stiffness = value,
                Quantity::PortRadius => guess.ports.iter_mut().for_each(|port| port.wider_mm = value),
                Quantity::PortShift { taxel, axis } => guess.ports[taxel].shift_mm[axis] = value,
                Quantity::Coefficient(term) => {
                    if let Some(form) = &mut guess.form {
                        form.coefficients[term] = value;
                    }
                }
            }
        }
        guess
    }

    /// The test setup for fitted values; `estimate` adds standard errors. Installations without
    /// training presses have no contact height.
    pub(crate) fn estimate(
        &self,
        values: &[f64],
        estimate: &EstimateOf<'_>,
        is_trained_on: &dyn Fn(&str) -> bool,
    ) -> BenchEstimate {
        let guess = self.guess(values);
        let estimate = |value: &dyn Fn(&Guess) -> f64| estimate(&|values: &[f64]| value(&self.guess(values)));
        let offsets = self.mountings.iter().enumerate();
        let contact_offset_mm: BTreeMap<String, Estimate> = offsets
            .filter(|(_, (name, _))| is_trained_on(name))
            .map(|(index, (name, _))| (name.clone(), estimate(&|guess| guess.offsets_mm[index])))
            .collect();
        BenchEstimate {
            tip_radius_mm: (!self.ln_radii.is_empty()).then(|| estimate(&|guess| guess.ln_radius.exp())),
            contact_offset_elsewhere_mm: median(
                contact_offset_mm.values().map(|offset| offset.value).collect(),
            ),
            contact_offset_mm,
            stiffness: self
                .fits_stiffness()
                .then(|| estimate(&|guess| guess.ln_stiffness.exp())),
            ports: if self.axes.is_empty() {
                Vec::new()
            } else {
                guess.ports.clone()
            },
            smooth_factor: guess.form.clone(),
            doubts: self.doubts(values),
            ..BenchEstimate::nominal()
        }
    }

    fn doubts(&self, values: &[f64]) -> Vec<String> {
        let mut doubts = Vec::new();
        let all = self.quantities().into_iter().zip(self.unknowns());
        for ((quantity, unknown), value) in all.zip(values) {
            let [low, high] = unknown.bounds;
            let near = 0.01 * (high - low);
            if low < high && (value - low < near || high - value < near) {
                doubts.push(format!("{} ended at a limit of its range", self.name(quantity)));
            }
        }
        doubts
    }

    fn name(&self, quantity: Quantity) -> String {
        match quantity {
            Quantity::ContactHeight(mounting) => {
                format!("the contact height of {}", self.mountings[mounting].0)
            }
            Quantity::LnRadius => "the tip's radius".to_owned(),
            Quantity::LnStiffness => "the stiffness".to_owned(),
            Quantity::PortRadius => "the radius of the ports".to_owned(),
            Quantity::PortShift { taxel, axis } => {
                format!("the position of port {taxel} along {}", ["x", "y"][axis])
            }
            Quantity::Coefficient(term) => format!("term {term} of the correction factor"),
        }
    }

    /// Derivative of the pressures of all frames with respect to an unknown.
    fn slope(&self, unknown: usize, quantity: Quantity, guess: &Guess, read: &Read) -> Slope {
        let all = 0..read.kpa.first().map_or(0, Vec::len);
        let quotient = |moved: &dyn Fn(f64) -> Guess| -> Vec<Vec<f64>> {
            let [low, high] = [-STEP, STEP].map(|by| self.read(&moved(by)).kpa);
            let rows = low.iter().zip(&high);
            let rates = rows.map(|(low, high)| {
                let pairs = low.iter().zip(high);
                pairs.map(|(low, high)| (high - low) / (2.0 * STEP)).collect()
            });
            rates.collect()
        };
        let (taxel, frames, kpa) = match quantity {
            Quantity::ContactHeight(mounting) => {
                let frames = self.mountings[mounting].1.clone();
                let rows = read.by_depth.iter();
                let kpa = rows.map(|row| row[frames.clone()].to_vec()).collect();
                (None, frames, kpa)
            }
            Quantity::LnRadius => {
                let moved = |by: f64| Guess {
                    ln_radius: guess.ln_radius + by,
                    ..guess.clone()
                };
                (None, all, quotient(&moved))
            }
            Quantity::LnStiffness => {
                let moved = |by: f64| Guess {
                    ln_stiffness: guess.ln_stiffness + by,
                    ..guess.clone()
                };
                (None, all, quotient(&moved))
            }
            Quantity::PortRadius => {
                let kpa = read.by_port.iter().map(|ways| ways[2].clone()).collect();
                (None, all, kpa)
            }
            Quantity::PortShift { taxel, axis } => {
                (Some(taxel), all, vec![read.by_port[taxel][axis].clone()])
            }
            Quantity::Coefficient(term) => {
                let rows = read.kpa.iter().zip(&read.terms);
                let kpa = rows.map(|(row, terms)| {
                    let pairs = row.iter().zip(&terms[term]);
                    pairs.map(|(kpa, term)| kpa * term).collect()
                });
                (None, all, kpa.collect())
            }
        };
        Slope {
            unknown,
            taxel,
            frames,
            kpa,
        }
    }

    /// Pressures of each frame, with their derivatives with respect to depth and ports.
    fn read(&self, guess: &Guess) -> Read {
        let n_frames = self.frames.last().map_or(0, |frames| frames.end);
        let mut read = Read::zeros(
            self.n_taxels,
            n_frames,
            if guess.form.is_some() { N_TERMS } else { 0 },
        );
        let weights = radius_weights(&self.ln_radii, guess.ln_radius);
        let tables: Vec<Vec<Vec<f64>>> = self.places.iter().map(|place| place.blended(&weights)).collect();
        let stiffness = guess.ln_stiffness.exp();
        let offset_mm = |mounting: &str| {
            let index = self.mountings.iter().position(|(name, _)| name == mounting);
            index.map_or(0.0, |index| guess.offsets_mm[index])
        };
        for (along, frames) in self.presses.iter().zip(&self.frames) {
            let (place, table) = (&self.places[along.place], &tables[along.place]);
            let press = along.press;
            let is_forced = press.control == Control::Force;
            let factor = if is_forced { stiffness } else { 1.0 };
            let offset_mm = offset_mm(&press.mounting);
            let place_mm =
                deepest_pose(press).map_or([0.0; 2], |pose| pose.position_mm.truncate().to_array());
            let splines = guess.form.as_ref().map(|form| {
                let taxels = 0..self.n_taxels;
                (
                    form,
                    taxels.map(|k| form.splines(k, place_mm)).collect::<Vec<_>>(),
                )
            });
            for (frame, to) in frames.clone().enumerate() {
                let found = if is_forced {
                    let force_n = press.force_n.as_ref().and_then(|force_n| force_n.get(frame));
                    at_force(table, force_n.copied().unwrap_or(0.0) / stiffness)
                } else {
                    place
                        .at_depth(along.touch_z_mm - press.gel_from_indenter[frame].position_mm.z + offset_mm)
                };
                let Some((i, share)) = found else { continue };
                let step_mm = place.depth_at(i + 1) - place.depth_at(i);
                for (k, port) in guess.ports.iter().enumerate() {
                    let column = |c: usize| {
                        let (low, high) = (table[i][1 + 4 * k + c], table[i + 1][1 + 4 * k + c]);
                        [
                            factor * (low + share * (high - low)),
                            factor * (high - low) / step_mm,
                        ]
                    };
                    let [value, x, y, wider] = [0, 1, 2, 3].map(column);
                    let slope = [x[0], y[0], wider[0]];
                    let formed = splines.as_ref().map_or(1.0, |(form, splines)| {
                        let depth_mm = place.depth_at(i) + share * step_mm;
                        let terms = form.terms(&splines[k], depth_mm);
                        for (row, term) in read.terms[k].iter_mut().zip(terms) {
                            row[to] = term;
                        }
                        form.factor(&splines[k], depth_mm)
                    });
                    read.kpa[k][to] = formed * (value[0] + port.change_kpa(slope));
                    read.by_depth[k][to] = formed * (value[1] + port.change_kpa([x[1], y[1], wider[1]]));
                    for (to_way, slope) in read.by_port[k].iter_mut().zip(slope) {
                        to_way[to] = formed * slope;
                    }
                }
            }
        }
        read
    }
}

/// Weights of the tables for the given radii that give the table for a radius between them: the
/// polynomial in ln radius through all.
pub(crate) fn radius_weights(ln_radii: &[f64], ln_radius: f64) -> Vec<f64> {
    if ln_radii.len() < 2 {
        return vec![1.0];
    }
    let weight = |i: usize| {
        let others = ln_radii.iter().enumerate().filter(move |(j, _)| *j != i);
        others
            .map(|(_, other)| (ln_radius - other) / (ln_radii[i] - other))
            .product()
    };
    (0..ln_radii.len()).map(weight).collect()
}

/// Port pressures of all frames with derivatives.
struct Read {
    /// Pressures, kPa; `[n_taxels][n_frames]`.
    kpa: Vec<Vec<f64>>,
    by_depth: Vec<Vec<f64>>,
    /// Derivatives with respect to the port's x, y and radius; `[n_taxels][3][n_frames]`.
    by_port: Vec<[Vec<f64>; 3]>,
    /// Terms of the correction factor; `[n_taxels][N_TERMS][n_frames]`, or empty.
    terms: Vec<Vec<Vec<f64>>>,
}

impl Read {
    fn zeros(n_taxels: usize, n_frames: usize, n_terms: usize) -> Self {
        let row = || vec![0.0; n_frames];
        Self {
            kpa: (0..n_taxels).map(|_| row()).collect(),
            by_depth: (0..n_taxels).map(|_| row()).collect(),
            by_port: (0..n_taxels).map(|_| [row(), row(), row()]).collect(),
            terms: (0..n_taxels)
                .map(|_| (0..n_terms).map(|_| row()).collect())
                .collect(),
        }
    }
}

impl Elastic for BenchProblem<'_> {
    fn unknowns(&self) -> Vec<Unknown> {
        let unknown = |start: f64, bounds: [f64; 2], pull: f64| Unknown {
            start,
            bounds,
            center: 0.0,
            pull,
        };
        let within = |limit: f64, pull: f64| unknown(0.0, [-limit, limit], pull);
        let settings = self.settings;
        let of = |quantity: Quantity| match quantity {
            Quantity::ContactHeight(_) => within(settings.contact_offset_limit_mm, 0.0),
            Quantity::LnRadius => {
                let ends =
                    [self.ln_radii.first(), self.ln_radii.last()].map(|end| end.copied().unwrap_or(0.0));
                unknown(0.5 * (ends[0] + ends[1]), ends, 0.0)
            }
            Quantity::LnStiffness => unknown(0.0, self.ln_stiffness, 0.0),
            Quantity::PortRadius => within(settings.port_radius_limit_mm, RADIUS_PULL),
            Quantity::PortShift { .. } => within(settings.port_shift_limit_mm, settings.port_shift_pull),
            Quantity::Coefficient(_) => within(FORM_LIMIT, settings.smooth_factor_pull),
        };
        self.quantities().into_iter().map(of).collect()
    }

    fn pressures(&self, values: &[f64], with_slopes: bool) -> Result<Pressures, DigitacError> {
        let guess = self.guess(values);
        let read = self.read(&guess);
        let slopes = if with_slopes {
            let quantities = self.quantities().into_iter().enumerate();
            quantities
                .map(|(unknown, quantity)| self.slope(unknown, quantity, &guess, &read))
                .collect()
        } else {
            Vec::new()
        };
        Ok(Pressures {
            kpa: read.kpa,
            slopes,
        })
    }
}

/// The correction factor before it is fitted, with its reach and its depth from the presses.
fn form(presses: &[Along<'_>], taxels: &Taxels) -> Option<SmoothFactor> {
    if taxels.ports_mm.is_empty() {
        return None;
    }
    let poses = presses.iter().flat_map(|along| {
        along
            .press
            .gel_from_indenter
            .iter()
            .map(move |pose| (along, pose))
    });
    let (mut far_mm, mut depth_mm) = (1e-3_f64, 1e-3_f64);
    for (along, pose) in poses {
        if along.is_used {
            depth_mm = depth_mm.max(along.touch_z_mm - pose.position_mm.z);
        }
        for port in &taxels.ports_mm {
            far_mm = far_mm.max((port[0] - pose.position_mm.x).hypot(port[1] - pose.position_mm.y));
        }
    }
    Some(SmoothFactor {
        ports_mm: taxels.ports_mm.clone(),
        reach_mm: 0.5 * far_mm,
        depth_mm,
        coefficients: vec![0.0; N_TERMS],
    })
}

fn resampled(curves: &[Vec<DepthCurves>], place: usize, n_taxels: usize) -> Resampled {
    let own: Vec<&DepthCurves> = curves.iter().map(|of_radius| &of_radius[place]).collect();
    let depth_mm = own
        .iter()
        .map(|curves| curves.max_depth_mm())
        .fold(f64::INFINITY, f64::min);
    let row = |curves: &DepthCurves, depth_mm: f64| {
        let mut row = vec![curves.force_n(depth_mm)];
        for (pressure, slope) in curves
            .pressure_kpa(depth_mm)
            .into_iter()
            .zip(curves.slope_kpa_per_mm(depth_mm))
        {
            row.push(pressure);
            row.extend(slope);
        }
        debug_assert_eq!(row.len(), 1 + 4 * n_taxels);
        row
    };
    let mut resampled = Resampled {
        depth_mm,
        rows: Vec::new(),
    };
    resampled.rows = own
        .iter()
        .map(|curves| {
            (0..N_DEPTHS)
                .map(|i| row(curves, resampled.depth_at(i)))
                .collect()
        })
        .collect();
    resampled
}

impl Resampled {
    fn depth_at(&self, index: usize) -> f64 {
        self.depth_mm * (index as f64 / (N_DEPTHS - 1) as f64).powf(DEPTH_POWER)
    }

    /// The row below a depth and the fraction of the way to the next row; `None` above the gel.
    /// Depths beyond the table are extrapolated from its last two rows.
    fn at_depth(&self, depth_mm: f64) -> Option<(usize, f64)> {
        if depth_mm <= 0.0 {
            return None;
        }
        let position = (depth_mm / self.depth_mm).powf(DEPTH_POWER.recip()) * (N_DEPTHS - 1) as f64;
        let index = (position as usize).min(N_DEPTHS - 2);
        let (low, high) = (self.depth_at(index), self.depth_at(index + 1));
        Some((index, (depth_mm - low) / (high - low)))
    }

    fn blended(&self, weights: &[f64]) -> Vec<Vec<f64>> {
        if let [rows] = &self.rows[..] {
            return rows.clone();
        }
        (0..N_DEPTHS)
            .map(|i| {
                let columns = 0..self.rows[0][i].len();
                columns
                    .map(|c| {
                        self.rows
                            .iter()
                            .zip(weights)
                            .map(|(rows, w)| w * rows[i][c])
                            .sum()
                    })
                    .collect()
            })
            .collect()
    }
}

/// The row below a force and the fraction of the way to the next row; `None` without a force.
/// Forces beyond the table are at its end.
fn at_force(table: &[Vec<f64>], force_n: f64) -> Option<(usize, f64)> {
    if force_n <= 0.0 {
        return None;
    }
    let index = table
        .partition_point(|row| row[0] < force_n)
        .clamp(1, table.len() - 1)
        - 1;
    let (low, high) = (table[index][0], table[index + 1][0]);
    let share = if high > low {
        (force_n - low) / (high - low)
    } else {
        1.0
    };
    Some((index, share.clamp(0.0, 1.0)))
}
