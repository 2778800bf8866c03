//! The presses, tables and unknowns that a bench is fitted with, as port pressures that answer to them.

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

/// Depths at which tables are resampled.
const N_DEPTHS: usize = 96;
/// They stand closer near the surface, by this power.
const DEPTH_POWER: f64 = 1.5;
/// Step of ln radius and ln stiffness for slopes.
const STEP: f64 = 1e-3;
/// Pull of the ports' radius to its description, for each square millimetre.
const RADIUS_PULL: f64 = 1e-3;
/// Largest coefficient of the smooth factor.
const FORM_LIMIT: f64 = 3.0;
/// Presses must be spread over at least this along an axis for the ports' places along it to be fitted, mm.
const SPREAD_MM: f64 = 2.0;

/// A press, in the order of the series.
pub(crate) struct Along<'a> {
    pub(crate) press: &'a Press,
    /// Its place among the resampled ones.
    pub(crate) place: usize,
    pub(crate) touch_z_mm: f64,
    /// Whether its readings teach.
    pub(crate) is_used: bool,
}

/// A table over depth at evenly graded depths.
struct Resampled {
    depth_mm: f64,
    /// Force, then of each taxel pressure and its three slopes; `[N_DEPTHS][1 + 4 * n_taxels]`, for each radius.
    rows: Vec<Vec<Vec<f64>>>,
}

/// Values of all unknowns.
#[derive(Clone, Debug)]
struct Guess<'a> {
    offsets_mm: &'a [f64],
    ln_radius: f64,
    ln_stiffness: f64,
    ports: Vec<PortEstimate>,
    form: Option<SmoothFactor>,
}

pub(crate) struct BenchProblem<'a> {
    presses: Vec<Along<'a>>,
    /// Frames of each press.
    frames: Vec<Range<usize>>,
    /// Mountings of prescribed pose, with their frames.
    mountings: Vec<(String, Range<usize>)>,
    places: Vec<Resampled>,
    ln_radii: Vec<f64>,
    ln_stiffness: [f64; 2],
    /// Axes along which ports may be shifted.
    axes: Vec<usize>,
    /// The form of an unknown tip, without its coefficients.
    form: Option<SmoothFactor>,
    n_taxels: usize,
    settings: &'a BenchSettings,
}

/// How well what follows from fitted values is known.
pub(super) type EstimateOf<'a> = dyn Fn(&dyn Fn(&[f64]) -> f64) -> Estimate + 'a;

impl<'a> BenchProblem<'a> {
    /// `curves` are those of each radius at each place; `[n_radii][n_places]`. One radius, or none, is not fitted.
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

    /// The same with ports and a smooth factor that may differ from what was learned wherever something was.
    pub(super) fn near_learned(mut self, learned: &BenchEstimate) -> Self {
        let is_shifted = |axis: usize| learned.ports.iter().any(|port| port.shift_mm[axis] != 0.0);
        self.axes = (0..2).filter(|axis| is_shifted(*axis)).collect();
        self.form.clone_from(&learned.smooth_factor);
        self
    }

    /// What was learned of each unknown, and by how much another bench may differ from it: standard deviations. Ports are looked for around where
    /// they are described.
    pub(super) fn learned(&self, learned: &BenchEstimate, widths: &BenchWidths) -> Vec<(f64, f64)> {
        let heights = self.mountings.iter();
        let mut values: Vec<(f64, f64)> = heights
            .map(|(mounting, _)| (learned.contact_offset_mm(mounting), widths.contact_offset_mm))
            .collect();
        if self.fits_stiffness() {
            values.push((learned.stiffness().ln(), widths.ln_stiffness));
        }
        if self.fits_port_radius() {
            let wider_mm = learned.ports.first().map_or(0.0, |port| port.wider_mm);
            values.push((wider_mm, widths.port_mm));
        }
        // Where a port of one cast is beside its description says nothing of another cast's.
        let n_shifts = learned.ports.len() * self.axes.len();
        values.extend(std::iter::repeat_n((0.0, widths.port_mm), n_shifts));
        let factors = learned
            .smooth_factor
            .iter()
            .flat_map(|factor| &factor.coefficients);
        values.extend(factors.map(|coefficient| (*coefficient, widths.factor)));
        values
    }

    fn fits_radius(&self) -> bool {
        self.ln_radii.len() > 1
    }

    fn fits_stiffness(&self) -> bool {
        self.ln_stiffness[0] < self.ln_stiffness[1]
    }

    fn fits_port_radius(&self) -> bool {
        self.settings.port_radius_limit_mm > 0.0 && !self.axes.is_empty()
    }

    fn guess<'v>(&self, values: &'v [f64]) -> Guess<'v> {
        let (offsets_mm, rest) = values.split_at(self.mountings.len());
        let mut rest = rest.iter().copied();
        let mut next = |is_fitted: bool| if is_fitted { rest.next() } else { None };
        let ln_radius =
            next(self.fits_radius()).unwrap_or_else(|| self.ln_radii.first().copied().unwrap_or(0.0));
        let ln_stiffness = next(self.fits_stiffness()).unwrap_or(0.0);
        let wider_mm = next(self.fits_port_radius()).unwrap_or(0.0);
        let mut ports = vec![
            PortEstimate {
                wider_mm,
                ..PortEstimate::default()
            };
            self.n_taxels
        ];
        for port in &mut ports {
            for &axis in &self.axes {
                port.shift_mm[axis] = next(true).unwrap_or(0.0);
            }
        }
        let form = self.form.clone().map(|form| SmoothFactor {
            coefficients: (0..N_TERMS).map(|_| next(true).unwrap_or(0.0)).collect(),
            ..form
        });
        Guess {
            offsets_mm,
            ln_radius,
            ln_stiffness,
            ports,
            form,
        }
    }

    /// The estimate that values stand for; `estimate` says how well what follows from values is known. Mountings that taught nothing have none.
    pub(crate) fn estimate(
        &self,
        values: &[f64],
        estimate: &EstimateOf<'_>,
        has_taught: &dyn Fn(&str) -> bool,
    ) -> BenchEstimate {
        let guess = self.guess(values);
        let estimate =
            |value: &dyn Fn(&Guess<'_>) -> f64| estimate(&|values: &[f64]| value(&self.guess(values)));
        let offsets = self.mountings.iter().enumerate();
        let contact_offset_mm: BTreeMap<String, Estimate> = offsets
            .filter(|(_, (name, _))| has_taught(name))
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
        for (what, (value, unknown)) in self.names().into_iter().zip(values.iter().zip(self.unknowns())) {
            let [low, high] = unknown.bounds;
            let near = 0.01 * (high - low);
            if low < high && (value - low < near || high - value < near) {
                doubts.push(format!("{what} ended at a limit of its range"));
            }
        }
        doubts
    }

    fn names(&self) -> Vec<String> {
        let mut names: Vec<String> = self
            .mountings
            .iter()
            .map(|(name, _)| format!("the contact height of {name}"))
            .collect();
        let scalars = [
            (self.fits_radius(), "the tip's radius"),
            (self.fits_stiffness(), "the stiffness"),
            (self.fits_port_radius(), "the radius of the ports"),
        ];
        names.extend(
            scalars
                .iter()
                .filter(|(is_fitted, _)| *is_fitted)
                .map(|(_, name)| (*name).to_owned()),
        );
        for taxel in 0..self.n_taxels {
            names.extend(
                self.axes
                    .iter()
                    .map(|axis| format!("the place of port {taxel} along {}", ["x", "y"][*axis])),
            );
        }
        if self.form.is_some() {
            names.extend((0..N_TERMS).map(|term| format!("term {term} of the smooth factor")));
        }
        names
    }

    /// Pressures and their slopes by depth and by the ports, of each frame.
    fn read(&self, guess: &Guess<'_>) -> Read {
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

/// Weights of the radii's tables for a radius between them: the polynomial in ln radius through all.
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

/// Port pressures of all frames with slopes.
struct Read {
    /// `[n_taxels][n_frames]`
    kpa: Vec<Vec<f64>>,
    by_depth: Vec<Vec<f64>>,
    /// By place along x, along y, and radius; `[n_taxels][3][n_frames]`
    by_port: Vec<[Vec<f64>; 3]>,
    /// Terms of the smooth factor; `[n_taxels][N_TERMS][n_frames]`, or none.
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
        let mut unknowns = vec![within(self.settings.contact_offset_limit_mm, 0.0); self.mountings.len()];
        if let (true, Some(low), Some(high)) =
            (self.fits_radius(), self.ln_radii.first(), self.ln_radii.last())
        {
            unknowns.push(unknown(0.5 * (low + high), [*low, *high], 0.0));
        }
        if self.fits_stiffness() {
            unknowns.push(unknown(0.0, self.ln_stiffness, 0.0));
        }
        if self.fits_port_radius() {
            unknowns.push(within(self.settings.port_radius_limit_mm, RADIUS_PULL));
        }
        let n_shifts = self.n_taxels * self.axes.len();
        let (limit_mm, pull) = (self.settings.port_shift_limit_mm, self.settings.port_shift_pull);
        unknowns.extend((0..n_shifts).map(|_| within(limit_mm, pull)));
        if self.form.is_some() {
            unknowns.extend((0..N_TERMS).map(|_| within(FORM_LIMIT, self.settings.smooth_factor_pull)));
        }
        unknowns
    }

    fn pressures(&self, values: &[f64], with_slopes: bool) -> Result<Pressures, DigitacError> {
        let guess = self.guess(values);
        let read = self.read(&guess);
        let mut slopes = Vec::new();
        if with_slopes {
            let all = 0..read.kpa.first().map_or(0, Vec::len);
            for (unknown, (_, frames)) in self.mountings.iter().enumerate() {
                slopes.push(Slope {
                    unknown,
                    taxel: None,
                    frames: frames.clone(),
                    kpa: read
                        .by_depth
                        .iter()
                        .map(|row| row[frames.clone()].to_vec())
                        .collect(),
                });
            }
            let mut unknown = self.mountings.len();
            let mut quotient = |low: Guess<'_>, high: Guess<'_>| {
                let (low, high) = (self.read(&low).kpa, self.read(&high).kpa);
                let rows = low.iter().zip(&high);
                let kpa = rows.map(|(low, high)| {
                    low.iter()
                        .zip(high)
                        .map(|(l, h)| (h - l) / (2.0 * STEP))
                        .collect()
                });
                slopes.push(Slope {
                    unknown,
                    taxel: None,
                    frames: all.clone(),
                    kpa: kpa.collect(),
                });
                unknown += 1;
            };
            if self.fits_radius() {
                let moved = |by: f64| Guess {
                    ln_radius: guess.ln_radius + by,
                    ..guess.clone()
                };
                quotient(moved(-STEP), moved(STEP));
            }
            if self.fits_stiffness() {
                let moved = |by: f64| Guess {
                    ln_stiffness: guess.ln_stiffness + by,
                    ..guess.clone()
                };
                quotient(moved(-STEP), moved(STEP));
            }
            if self.fits_port_radius() {
                slopes.push(Slope {
                    unknown,
                    taxel: None,
                    frames: all.clone(),
                    kpa: read.by_port.iter().map(|ways| ways[2].clone()).collect(),
                });
                unknown += 1;
            }
            for (taxel, ways) in read.by_port.iter().enumerate() {
                for &axis in &self.axes {
                    slopes.push(Slope {
                        unknown,
                        taxel: Some(taxel),
                        frames: all.clone(),
                        kpa: vec![ways[axis].clone()],
                    });
                    unknown += 1;
                }
            }
            if self.form.is_some() {
                for term in 0..N_TERMS {
                    let of_taxel = |k: usize| {
                        read.kpa[k]
                            .iter()
                            .zip(&read.terms[k][term])
                            .map(|(p, t)| p * t)
                            .collect()
                    };
                    slopes.push(Slope {
                        unknown,
                        taxel: None,
                        frames: all.clone(),
                        kpa: (0..self.n_taxels).map(of_taxel).collect(),
                    });
                    unknown += 1;
                }
            }
        }
        Ok(Pressures {
            kpa: read.kpa,
            slopes,
        })
    }
}

/// Room for what is not simulated of tip and gel.
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

    /// Between which rows a depth lies, and how far; `None` above the gel. What is deeper than the table lies ahead of its last two rows.
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

/// Between which rows a force lies, and how far; `None` without a force. What is more than the table has is at its end.
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
