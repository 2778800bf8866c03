//! Fits a [`BenchEstimate`] by variable projection: for every trial value of radius, contact
//! heights and stiffness, the gains that fit best are found by a linear fit.

use std::collections::{BTreeMap, BTreeSet};

use twintac_depth_table::DepthTableSource;
use twintac_recording::{Control, Recording};

use super::problem::{Guess, Problem, exactly};
use super::{BenchEstimate, BenchSettings, Estimate, Places};
use crate::DigitacError;
use crate::numerics::minimize;

/// Tolerance of ln radius and ln stiffness, and of contact heights in mm.
const TOLERANCE: f64 = 2e-3;
/// Places of each file that the fit looks at, at least.
const MIN_PLACES_OF_FILE: usize = 3;
/// Rounds over the contact heights.
const MAX_ROUNDS: usize = 8;
/// Reach around the best values in fits that leave a block out, in the same units.
const JACKKNIFE_REACH: f64 = 0.2;

/// Fits the bench to some presses of a recording.
pub fn fit_bench(
    recording: &Recording,
    places: &Places,
    train: &[usize],
    source: &dyn DepthTableSource,
    settings: &BenchSettings,
) -> Result<BenchEstimate, DigitacError> {
    check(settings)?;
    let chosen = choose(recording, places, train, settings.n_places);
    if chosen.is_empty() {
        return Err(DigitacError::TooFew {
            expected: "presses to fit the bench to".into(),
            found: "none".into(),
        });
    }
    let problem = Problem::new(recording, places, &chosen, source, settings)?;
    let everywhere = problem.solve(&problem.start(), None)?;
    let without: Vec<Guess> = (0..problem.n_blocks())
        .map(|block| problem.solve(&problem.start_near(&everywhere), Some(block)))
        .collect::<Result<_, _>>()?;
    problem.bench(&everywhere, &without)
}

fn check(settings: &BenchSettings) -> Result<(), DigitacError> {
    let [low, high] = settings.stiffness_limits;
    let wrong = |setting, expected, found| {
        Err(DigitacError::Setting {
            setting,
            expected,
            found,
        })
    };
    if settings.tip_radii_mm.first().is_some_and(|r| *r <= 0.0)
        || !settings.tip_radii_mm.is_sorted_by(|a, b| a < b)
    {
        return wrong(
            "tip_radii_mm",
            "increasing radii above zero",
            format!("{:?}", settings.tip_radii_mm),
        );
    }
    if low <= 0.0 || low >= high {
        return wrong(
            "stiffness_limits",
            "two increasing numbers above zero",
            format!("{low}, {high}"),
        );
    }
    if settings.time_constants_s.iter().any(|tau| *tau <= 0.0) {
        return wrong(
            "time_constants_s",
            "times above zero",
            format!("{:?}", settings.time_constants_s),
        );
    }
    Ok(())
}

/// Presses at places spread evenly over the taxels, and over the largest readings; every file has some.
fn choose(recording: &Recording, places: &Places, train: &[usize], n_places: usize) -> Vec<usize> {
    // By place, the taxel that reads the most, and what.
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

/// Where to look for them.
#[derive(Clone, Debug)]
struct Bounds {
    center: Guess,
    ln_radius: [f64; 2],
    offset_mm: f64,
    ln_stiffness: [f64; 2],
}

impl Problem<'_> {
    fn start(&self) -> Bounds {
        let files = self
            .presses
            .iter()
            .filter(|p| p.press.control == Control::Pose)
            .map(|p| p.press.mounting.clone());
        let ln_radius = match (self.ln_radii.first(), self.ln_radii.last()) {
            (Some(low), Some(high)) => [*low, *high],
            _ => [0.0, 0.0],
        };
        Bounds {
            center: Guess {
                ln_radius: 0.5 * (ln_radius[0] + ln_radius[1]),
                offsets_mm: files.map(|file| (file, 0.0)).collect(),
                ln_stiffness: 0.0,
            },
            ln_radius,
            offset_mm: self.settings.contact_offset_limit_mm,
            ln_stiffness: self.ln_stiffness_limits,
        }
    }

    fn start_near(&self, guess: &Guess) -> Bounds {
        let start = self.start();
        let near =
            |[low, high]: [f64; 2], at: f64| [low.max(at - JACKKNIFE_REACH), high.min(at + JACKKNIFE_REACH)];
        Bounds {
            ln_radius: near(start.ln_radius, guess.ln_radius),
            offset_mm: start.offset_mm,
            ln_stiffness: near(start.ln_stiffness, guess.ln_stiffness),
            center: guess.clone(),
        }
    }

    /// The best values within bounds, from all places but those of one block.
    fn solve(&self, bounds: &Bounds, without_block: Option<usize>) -> Result<Guess, DigitacError> {
        let mut best = bounds.center.clone();
        let mut failure = None;
        let mut at_radius = |ln_radius: f64| -> (Guess, f64) {
            let start = Guess {
                ln_radius,
                ..best.clone()
            };
            match self.solve_at_radius(start, bounds, without_block) {
                Ok((guess, value)) => {
                    best = guess.clone();
                    (guess, value)
                }
                Err(error) => {
                    failure = Some(error);
                    (bounds.center.clone(), f64::INFINITY)
                }
            }
        };
        let [low, high] = bounds.ln_radius;
        let ln_radius = if low < high {
            minimize(low, high, TOLERANCE, |at| at_radius(at).1).0
        } else {
            low
        };
        let (guess, _) = at_radius(ln_radius);
        failure.map_or(Ok(guess), Err)
    }

    fn solve_at_radius(
        &self,
        mut guess: Guess,
        bounds: &Bounds,
        without_block: Option<usize>,
    ) -> Result<(Guess, f64), DigitacError> {
        let curves = self.curves_at(guess.ln_radius)?;
        let deviation = |guess: &Guess| {
            self.deviation(&curves, guess, without_block)
                .map_or(f64::INFINITY, |(_, d)| d)
        };
        let [low, high] = bounds.ln_stiffness;
        if low < high {
            let at = |ln_stiffness| {
                deviation(&Guess {
                    ln_stiffness,
                    ..guess.clone()
                })
            };
            guess.ln_stiffness = minimize(low, high, TOLERANCE, at).0;
        }
        if bounds.offset_mm > 0.0 && !guess.offsets_mm.is_empty() {
            improve_offsets(&mut guess, bounds.offset_mm, deviation);
        }
        let (_, value) = self.deviation(&curves, &guess, without_block)?;
        Ok((guess, value))
    }

    fn bench(&self, best: &Guess, without: &[Guess]) -> Result<BenchEstimate, DigitacError> {
        let curves = self.curves_at(best.ln_radius)?;
        let (gains, deviation_kpa) = self.deviation(&curves, best, None)?;
        let mut doubts = doubts(best, &self.start());
        doubts.extend(self.odd_presses(&curves, best, &gains)?);
        let readings = self
            .presses
            .iter()
            .flat_map(|p| p.press.taxels_kpa.iter().zip(&p.press.valid));
        let usable = readings.flat_map(|(row, valid)| row.iter().zip(valid).filter(|(_, valid)| **valid));
        let largest_kpa = usable.map(|(reading, _)| *reading).fold(0.0, f64::max);
        let estimate = |value: &dyn Fn(&Guess) -> f64| {
            Estimate::jackknife(value(best), &without.iter().map(value).collect::<Vec<_>>())
        };
        let start = self.start();
        let radius_mm = (self.ln_radii.len() > 1).then(|| estimate(&|guess| guess.ln_radius.exp()));
        let forced = start.ln_stiffness[0] < start.ln_stiffness[1];
        let contact_offset_mm: BTreeMap<String, Estimate> = best
            .offsets_mm
            .keys()
            .map(|file| (file.clone(), estimate(&|guess| guess.offsets_mm[file])))
            .collect();
        Ok(BenchEstimate {
            tip_radius_mm: radius_mm
                .or_else(|| self.settings.tip_radii_mm.first().map(|radius| exactly(*radius))),
            contact_offset_elsewhere_mm: median(
                contact_offset_mm.values().map(|offset| offset.value).collect(),
            ),
            contact_offset_mm,
            stiffness: forced.then(|| estimate(&|guess| guess.ln_stiffness.exp())),
            gains: Some(gains),
            deviation_percent: if largest_kpa > 0.0 {
                100.0 * deviation_kpa / largest_kpa
            } else {
                0.0
            },
            doubts,
        })
    }
}

/// Searches the contact heights: of all files together, then of each on its own, until none moves. One file's
/// height changes the gains, and through them the best heights of the others.
fn improve_offsets(guess: &mut Guess, limit_mm: f64, deviation: impl Fn(&Guess) -> f64) {
    let files: Vec<String> = guess.offsets_mm.keys().cloned().collect();
    let mut groups = vec![files.clone()];
    if files.len() > 1 {
        groups.extend(files.into_iter().map(|file| vec![file]));
    }
    let mut reach_mm = limit_mm;
    for _ in 0..MAX_ROUNDS {
        let mut moved_mm: f64 = 0.0;
        for group in &groups {
            let moved_by = |shift_mm: f64| {
                let mut moved = guess.clone();
                for file in group {
                    moved
                        .offsets_mm
                        .entry(file.clone())
                        .and_modify(|mm| *mm = (*mm + shift_mm).clamp(-limit_mm, limit_mm));
                }
                moved
            };
            let (shift_mm, value) = minimize(-reach_mm, reach_mm, TOLERANCE, |shift_mm| {
                deviation(&moved_by(shift_mm))
            });
            if value < deviation(guess) {
                *guess = moved_by(shift_mm);
                moved_mm = moved_mm.max(shift_mm.abs());
            }
        }
        if moved_mm < TOLERANCE {
            break;
        }
        reach_mm = (2.0 * moved_mm).clamp(4.0 * TOLERANCE, limit_mm);
    }
}

fn doubts(best: &Guess, bounds: &Bounds) -> Vec<String> {
    let mut doubts = Vec::new();
    let mut doubt = |what: &str, value: f64, [low, high]: [f64; 2]| {
        if low < high && (value - low < 3.0 * TOLERANCE || high - value < 3.0 * TOLERANCE) {
            doubts.push(format!("{what} ended at a limit of its range"));
        }
    };
    doubt("the tip's radius", best.ln_radius, bounds.ln_radius);
    doubt("the stiffness", best.ln_stiffness, bounds.ln_stiffness);
    for (file, offset_mm) in &best.offsets_mm {
        doubt(
            &format!("the contact height of {file}"),
            *offset_mm,
            [-bounds.offset_mm, bounds.offset_mm],
        );
    }
    doubts
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    if n == 0 {
        0.0
    } else {
        0.5 * (values[(n - 1) / 2] + values[n / 2])
    }
}
