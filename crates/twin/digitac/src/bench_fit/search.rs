//! Fits a [`BenchEstimate`] together with the barometers, in two steps.
//!
//! The radius of the tip and the stiffness of the gel change what has to be simulated. They are
//! found first, from few locations that are simulated for several radii. All other unknowns, such
//! as contact heights and locations of ports, are then found with the tables of all locations.

use std::collections::{BTreeMap, BTreeSet};

use twintac_config::Checked;
use twintac_depth_table::{DepthCurves, DepthTable, DepthTableSource};
use twintac_recording::{Control, Press, Recording};

use super::problem::{Along, BenchProblem};
use super::simulated::{bare_features, curves, features_along, follow_each_other};
use super::{BenchEstimate, BenchSettings, Estimate, Places, Taxels};
use crate::features::Sample;
use crate::numerics::minimize;
use crate::physical_fit::{BarometerModel, Elastic, Fitted, Series, Solution, fit};
use crate::{DigitacError, Features, Gains};

/// Smallest number of locations of each file that the first step uses.
const MIN_PLACES_OF_FILE: usize = 3;
/// A press is worth a warning if the contact height that fits it best differs from that of its file
/// by more than this, mm.
const SUSPICIOUS_MM: f64 = 0.08;
/// Tolerance of a press's own contact height, mm.
const TOLERANCE_MM: f64 = 2e-3;

/// Fits the quantities that the tables of a recording depend on, the radius of the tip and the
/// stiffness of the gel, to some of its presses.
pub fn fit_bench(
    recording: &Recording,
    places: &Places,
    train: &[usize],
    source: &dyn DepthTableSource,
    settings: &BenchSettings,
    taxels: &Taxels,
) -> Result<BenchEstimate, DigitacError> {
    settings.checked()?;
    let radii_mm = settings.radii_mm();
    let is_forced = |index: &usize| recording.presses[*index].control == Control::Force;
    let chosen = choose(recording, places, train, settings.n_places);
    if chosen.is_empty() {
        return Err(DigitacError::TooFew {
            expected: "presses for the setup calibration".into(),
            found: "none".into(),
        });
    }
    if radii_mm.len() < 2 && !chosen.iter().any(is_forced) {
        return Ok(BenchEstimate {
            tip_radius_mm: radii_mm.first().map(|radius| Estimate {
                value: *radius,
                uncertainty: 0.0,
            }),
            ..BenchEstimate::nominal()
        });
    }
    let used: Vec<usize> = chosen
        .iter()
        .map(|&press| places.of_press[press])
        .collect::<BTreeSet<_>>()
        .into_iter()
        .collect();
    let here = Places {
        requests: used.iter().map(|&place| places.requests[place].clone()).collect(),
        of_press: Vec::new(),
    };
    let here = if radii_mm.len() < 2 {
        here.with_stiffness(settings.stiffness_limits[0])
    } else {
        here
    };
    let radii: Vec<Option<f64>> = match radii_mm {
        [] => vec![None],
        radii => radii.iter().copied().map(Some).collect(),
    };
    // All radii are in one request, so that the source may work on them in parallel.
    let of_radius = |radius: &Option<f64>| here.clone().with_tip_radius(*radius).requests;
    let requests: Vec<_> = radii.iter().flat_map(of_radius).collect();
    let tables = source.depth_tables(&requests).map_err(DigitacError::Simulation)?;
    if tables.len() != requests.len() {
        return Err(DigitacError::DepthTableCount {
            expected: requests.len(),
            found: tables.len(),
        });
    }
    let curves: Vec<Vec<DepthCurves>> = tables
        .chunks(used.len())
        .map(|tables| curves(&here, tables, recording.taxels.len()))
        .collect::<Result<_, _>>()?;
    let place_of = |press: usize| used.partition_point(|&other| other < places.of_press[press]);
    let bench = Fit::rested(recording, places, &chosen, settings, taxels);
    bench.solve(&curves, radii_mm, &place_of)
}

/// As [`fit_bench`], from the tables of all locations, which were simulated for each radius of the
/// settings; `[n_radii][n_places]`.
pub(crate) fn fit_radius(
    recording: &Recording,
    places: &Places,
    tables: &[Vec<DepthTable>],
    train: &[usize],
    settings: &BenchSettings,
    taxels: &Taxels,
) -> Result<BenchEstimate, DigitacError> {
    settings.checked()?;
    let curves: Vec<Vec<DepthCurves>> = tables
        .iter()
        .map(|tables| curves(places, tables, recording.taxels.len()))
        .collect::<Result<_, _>>()?;
    let bench = Fit::rested(recording, places, train, settings, taxels);
    bench.solve(&curves, settings.radii_mm(), &|press| places.of_press[press])
}

/// Fits all other unknowns to all training presses, with the tables of all locations: contact
/// heights, ports, and barometers. All presses are simulated in turn, so that relaxation after
/// other presses is taken into account.
pub fn refine_bench(
    recording: &Recording,
    places: &Places,
    tables: &[DepthTable],
    train: &[usize],
    found: &BenchEstimate,
    settings: &BenchSettings,
    taxels: &Taxels,
) -> Result<BenchEstimate, DigitacError> {
    settings.checked()?;
    let curves = vec![curves(places, tables, recording.taxels.len())?];
    let fit = Fit {
        recording,
        places,
        settings,
        taxels,
        used: train.iter().copied().collect(),
        presses: ordered(recording).collect(),
        has_history: settings.history,
    };
    let refined = fit.solve(&curves, &[], &|press| places.of_press[press])?;
    let mut bench = BenchEstimate {
        tip_radius_mm: found.tip_radius_mm,
        doubts: [&found.doubts[..], &refined.doubts].concat(),
        ..refined
    };
    bench.doubts.dedup();
    let odd = fit.odd_presses(&curves[0], &bench)?;
    bench.doubts.extend(odd);
    Ok(bench)
}

/// Presses at locations spread evenly over the taxels and over the largest readings. Each file has
/// some.
fn choose(recording: &Recording, places: &Places, train: &[usize], n_places: usize) -> Vec<usize> {
    // By location, the taxel with the largest reading, and this reading.
    let mut most: BTreeMap<usize, (usize, f64)> = BTreeMap::new();
    let mut by_file: BTreeMap<&str, BTreeSet<usize>> = BTreeMap::new();
    for &index in train {
        let press = &recording.presses[index];
        let place = places.of_press[index];
        by_file.entry(&press.mounting).or_default().insert(place);
        let most = most.entry(place).or_insert((0, 0.0));
        for (row, valid) in press.taxels_kpa.iter().zip(&press.valid) {
            for taxel in (0..row.len()).filter(|&taxel| valid[taxel]) {
                if row[taxel] > most.1 {
                    *most = (taxel, row[taxel]);
                }
            }
        }
    }
    let evenly = |among: Vec<usize>, count: usize| -> Vec<usize> {
        let mut sorted = among;
        sorted.sort_by(|a, b| {
            let ((taxel_a, reading_a), (taxel_b, reading_b)) = (most[a], most[b]);
            taxel_a.cmp(&taxel_b).then(reading_a.total_cmp(&reading_b))
        });
        let count = count.min(sorted.len());
        (0..count)
            .map(|i| sorted[(2 * i + 1) * sorted.len() / (2 * count)])
            .collect()
    };
    let mut chosen: BTreeSet<usize> = evenly(most.keys().copied().collect(), n_places)
        .into_iter()
        .collect();
    for in_file in by_file.values() {
        let has = in_file.intersection(&chosen).count();
        let others = in_file.difference(&chosen).copied().collect();
        chosen.extend(evenly(others, MIN_PLACES_OF_FILE.saturating_sub(has)));
    }
    train
        .iter()
        .copied()
        .filter(|&press| chosen.contains(&places.of_press[press]))
        .collect()
}

/// Numbers of presses, with those of one installation together, otherwise in their order.
pub(crate) fn in_order<'a>(mountings: impl Iterator<Item = &'a str>) -> Vec<usize> {
    let mut first: BTreeMap<&str, usize> = BTreeMap::new();
    let mut keyed: Vec<(usize, usize)> = mountings
        .enumerate()
        .map(|(press, mounting)| (*first.entry(mounting).or_insert(press), press))
        .collect();
    keyed.sort_unstable();
    keyed.into_iter().map(|(_, press)| press).collect()
}

fn ordered(recording: &Recording) -> impl Iterator<Item = usize> {
    in_order(recording.presses.iter().map(|press| &press.mounting[..])).into_iter()
}

/// The presses and settings of a fit.
struct Fit<'a> {
    recording: &'a Recording,
    places: &'a Places,
    settings: &'a BenchSettings,
    taxels: &'a Taxels,
    /// Presses in the order in which the gel was pressed.
    presses: Vec<usize>,
    /// Presses whose readings are used for training.
    used: BTreeSet<usize>,
    has_history: bool,
}

impl<'a> Fit<'a> {
    /// A fit to some presses alone, as if the gel had rested before each installation.
    fn rested(
        recording: &'a Recording,
        places: &'a Places,
        chosen: &[usize],
        settings: &'a BenchSettings,
        taxels: &'a Taxels,
    ) -> Self {
        Self {
            recording,
            places,
            settings,
            taxels,
            used: chosen.iter().copied().collect(),
            presses: ordered(recording)
                .filter(|press| chosen.contains(press))
                .collect(),
            has_history: false,
        }
    }

    fn press(&self, index: usize) -> &Press {
        &self.recording.presses[index]
    }

    fn touch_z_mm(&self, index: usize) -> f64 {
        let request = &self.places.requests[self.places.of_press[index]];
        request.gel_from_indenter_at_touch.position_mm.z
    }

    fn solve(
        &self,
        curves: &[Vec<DepthCurves>],
        radii_mm: &[f64],
        place_of: &dyn Fn(usize) -> usize,
    ) -> Result<BenchEstimate, DigitacError> {
        let n_taxels = self.recording.taxels.len();
        let along = |&index: &usize| Along {
            press: self.press(index),
            place: place_of(index),
            touch_z_mm: self.touch_z_mm(index),
            is_used: self.used.contains(&index),
        };
        let along: Vec<Along<'_>> = self.presses.iter().map(along).collect();
        let problem = BenchProblem::new(along, curves, radii_mm, n_taxels, (self.settings, self.taxels));
        let all = 0..self.recording.presses.len();
        let mut features: Vec<Features> = all
            .map(|index| bare_features(self.press(index), self.touch_z_mm(index)))
            .collect();
        if self.has_history {
            follow_each_other(&self.recording.presses, &mut features);
        }
        let model = BarometerModel::new(&features, &self.settings.time_constants_s, self.settings.port_law);
        let solve = |is_used: &dyn Fn(usize) -> bool, near: Option<&Solution>| {
            let fitted: Vec<Fitted<'_>> = self
                .presses
                .iter()
                .map(|&index| Fitted {
                    mounting: &self.press(index).mounting,
                    features: &features[index],
                    readings_kpa: &self.press(index).taxels_kpa,
                    valid: &self.press(index).valid,
                    is_used: self.used.contains(&index) && is_used(index),
                })
                .collect();
            let series = Series::new(&fitted, n_taxels, &self.taxels.left_out);
            fit(&problem, &series, &model, &self.taxels.left_out, near)
        };
        let everywhere = solve(&|_| true, None)?;
        let n_places = self
            .used
            .iter()
            .map(|&index| place_of(index))
            .collect::<BTreeSet<_>>()
            .len();
        let n_blocks = self.settings.n_blocks.min(n_places);
        let blocks = if n_blocks < 2 || problem.unknowns().is_empty() {
            0
        } else {
            n_blocks
        };
        let without: Vec<Vec<f64>> = (0..blocks)
            .map(|block| {
                let found = solve(&|index| place_of(index) % n_blocks != block, Some(&everywhere))?;
                Ok(found.values)
            })
            .collect::<Result<_, DigitacError>>()?;
        let jackknife = |value: &dyn Fn(&[f64]) -> f64| {
            let others: Vec<f64> = without.iter().map(|values| value(values)).collect();
            Estimate::jackknife(value(&everywhere.values), &others)
        };
        Ok(BenchEstimate {
            has_history: self.has_history,
            gains: Some(everywhere.gains.clone()),
            deviation_percent: 100.0 * everywhere.deviation,
            ..problem.estimate(&everywhere.values, &jackknife, &|mounting| {
                self.used
                    .iter()
                    .any(|&index| self.press(index).mounting == mounting)
            })
        })
    }

    /// Presses whose contact height differs from that of their file, found with fixed barometers.
    fn odd_presses(
        &self,
        curves: &[DepthCurves],
        bench: &BenchEstimate,
    ) -> Result<Vec<String>, DigitacError> {
        let reach_mm = self.settings.contact_offset_limit_mm;
        let Some(gains) = bench.gains.as_ref().filter(|_| reach_mm > 0.0) else {
            return Ok(Vec::new());
        };
        let mut odd = Vec::new();
        for &index in self
            .used
            .iter()
            .filter(|&&index| self.press(index).control == Control::Pose)
        {
            let press = self.press(index);
            let own_mm = bench.contact_offset_mm(&press.mounting);
            let mut failure = None;
            let mut moved = bench.clone();
            let at = |extra_mm: f64| {
                moved.contact_offset_mm.clear();
                moved.contact_offset_elsewhere_mm = own_mm + extra_mm;
                let place = &curves[self.places.of_press[index]];
                match features_along(place, press, self.touch_z_mm(index), &moved) {
                    Ok(features) => self.own_deviation(press, &features, gains),
                    Err(error) => {
                        failure = Some(error);
                        f64::INFINITY
                    }
                }
            };
            let (extra_mm, _) = minimize(-reach_mm, reach_mm, TOLERANCE_MM, at);
            failure.map_or(Ok(()), Err)?;
            if extra_mm.abs() > SUSPICIOUS_MM {
                odd.push(format!(
                    "press {} touches {extra_mm:+.2} mm deeper than the rest of its file",
                    press.name
                ));
            }
        }
        Ok(odd)
    }

    fn own_deviation(&self, press: &Press, features: &Features, gains: &Gains) -> f64 {
        let sample = Sample {
            readings_kpa: &press.taxels_kpa,
            valid: &press.valid,
        };
        let predicted = gains.readings_kpa(&[features]).swap_remove(0);
        sample.deviation_kpa(&predicted, &self.taxels.left_out)
    }
}
