//! Cross-validation of a run: for several seeds, and for several ways to hold presses out.

use std::collections::{BTreeMap, BTreeSet};

use digitac::{Bench, Errors, Fold, FoldEvaluation, HeldOut, Places, Variant, evaluate_fold};
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use twintac_depth_table::{DepthTable, DepthTableSource};
use twintac_model::names;
use twintac_plot::{Bar, Bars, Ink, png};
use twintac_recording::{Provenance, Recording};
use twintac_store::{write_file, write_json};
use twintac_tables::DepthTableStore;
use twintac_work::{At, Work, WorkError};

use crate::Run;
use crate::settings::ResolvedSettings;
use crate::stages::simulation::{Simulation, contacts};

/// Name of the folder of the results.
const FOLDER: &str = "cross_validation";

/// What to evaluate.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CrossValidationPlan {
    /// The ways to hold presses out, one after the other.
    pub held_out: Vec<HeldOut>,
    /// Seeds, from 1 to this.
    pub seeds: u64,
    /// Whether to run an ablation: each step of the twin is also left out in turn, with presses
    /// held out by location.
    pub ablation: bool,
    /// Whether the twins' intervals are evaluated as well, which takes several times as long. Not
    /// done in the ablation.
    pub intervals: bool,
}

/// A step that is left out of the twin in the ablation.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Without {
    /// The static nonlinearity of the ports: readings are proportional to the elastic response of
    /// the gel.
    PortLaw,
    /// The history: the gel is at rest before each press.
    History,
    /// The correction factor: the tip is a ball.
    SmoothFactor,
    /// The fit of the ports: they have the described positions and radii.
    Ports,
    /// Viscoelastic relaxation: readings follow the gel's elastic response without delay.
    Memory,
}

impl Without {
    const ALL: [Self; 5] = [
        Self::PortLaw,
        Self::History,
        Self::SmoothFactor,
        Self::Ports,
        Self::Memory,
    ];

    /// In words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::PortLaw => "static nonlinearity",
            Self::History => "history",
            Self::SmoothFactor => "correction factor",
            Self::Ports => "positions and radius of the ports",
            Self::Memory => "relaxation",
        }
    }

    fn apply(self, settings: &mut ResolvedSettings) {
        match self {
            Self::PortLaw => {
                settings.bench.port_law = false;
                settings.train.port_law = false;
            }
            Self::History => settings.bench.history = false,
            Self::SmoothFactor => settings.bench.smooth_factor = false,
            Self::Ports => {
                settings.bench.port_shift_limit_mm = 0.0;
                settings.bench.port_radius_limit_mm = 0.0;
            }
            Self::Memory => {
                settings.bench.time_constants_s.clear();
                settings.train.time_constants_s.clear();
            }
        }
    }
}

/// Mean and standard deviation over the seeds, %.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spread {
    /// Mean, %.
    pub mean_percent: f64,
    /// Standard deviation of one seed, %; zero for one seed.
    pub deviation_percent: f64,
}

impl Spread {
    /// `None` for no values.
    pub(crate) fn of(values: &[f64]) -> Option<Self> {
        let n = values.len() as f64;
        let mean_percent = values.iter().sum::<f64>() / n;
        let squares: f64 = values.iter().map(|v| (v - mean_percent).powi(2)).sum();
        (n > 0.0).then(|| Self {
            mean_percent,
            deviation_percent: (squares / (n - 1.0).max(1.0)).sqrt(),
        })
    }
}

/// Figures of the twins' prediction intervals and OOD scores, over all seeds.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct CertaintySpread {
    /// Coverage: percentage of the readings within their interval; the nominal value is 90 %.
    pub covered: Option<Spread>,
    /// Coverage of frames in contact.
    pub covered_in_contact: Option<Spread>,
    /// Mean width of the intervals of frames in contact, % of the largest reading of the file.
    pub width_in_contact: Option<Spread>,
    /// Percentage of the frames in contact that are flagged as out-of-distribution.
    pub flagged: Option<Spread>,
    /// AUROC of the OOD score, held-out contacts against those of training, %.
    #[serde(alias = "told_apart")]
    pub ood_detection: Option<Spread>,
}

/// The evaluations of one seed.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct OfSeed {
    /// The seed.
    pub seed: u64,
    /// One for each file, indenter or taxel that was held out, or a single one.
    #[serde(alias = "judgements")]
    pub evaluations: Vec<FoldEvaluation>,
}

/// One way to hold presses out, over all seeds. Errors are those of the headline figure: nearest
/// taxel, frames in contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CrossValidated {
    /// What was held out together.
    pub held_out: HeldOut,
    /// The step that was left out of the twin, if any.
    pub without: Option<Without>,
    /// Error of the variant that the validation presses chose, seed by seed; `None` if a seed has
    /// no frame in contact.
    pub twin: Option<Spread>,
    /// Error of each variant.
    pub variants: BTreeMap<Variant, Spread>,
    /// Error of the parametric baseline, fitted to the same presses: a power of depth times a
    /// function of distance.
    pub kernel: Option<Spread>,
    /// Figures of intervals and OOD scores.
    #[serde(default)]
    pub certainty: CertaintySpread,
    /// Percentage of the frames that lie deeper than the simulation reached. They are scored as
    /// well.
    pub frames_not_simulated_percent: Option<f64>,
    /// All results, seed by seed.
    pub seeds: Vec<OfSeed>,
}

/// The cross-validation of a run: `cross_validation/result.json`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct CrossValidation {
    /// The sensor's name.
    pub sensor: String,
    /// Provenance of the readings.
    pub provenance: Provenance,
    /// Taxels excluded from the headline figure.
    pub taxels_left_out: Vec<String>,
    /// One row for each way to hold presses out, and for each step of the ablation.
    pub rows: Vec<CrossValidated>,
}

/// One row's settings, and its folds with their seeds.
struct Row {
    held_out: HeldOut,
    without: Option<Without>,
    settings: ResolvedSettings,
    folds: Vec<(u64, Fold)>,
}

impl Run {
    /// Trains and evaluates twins anew for each seed and each way to hold presses out. No twin uses
    /// what another has seen. Only tables over depth are shared: those of the run, or, if the tip's
    /// radius is unknown, tables of all locations for each radius. Writes
    /// `cross_validation/result.json` and a plot.
    ///
    /// # Errors
    /// The run is not simulated yet; too few files, locations or indenters for what is to be held
    /// out.
    pub fn cross_validate(&self, plan: &CrossValidationPlan) -> Result<CrossValidation, WorkError> {
        let recording = self.recording()?;
        let simulation = Simulation::read(&self.simulation()?)?;
        let settings = self.setup().resolved(&recording)?;
        let tables = self.tables_of_radii(&settings, &simulation.places, simulation.tables)?;
        let rows = rows(plan, &settings, &recording)?;
        let block_mm = settings.split.block_mm_of(&recording)?;
        let contacts = contacts(&simulation.places, self.sensor(), self.settings())?;

        let jobs: Vec<(&Row, &(u64, Fold))> = rows
            .iter()
            .flat_map(|row| row.folds.iter().map(move |fold| (row, fold)))
            .collect();
        let work = Work::start(self.progress(), "evaluating", jobs.len());
        let evaluate_one = |(row, (seed, fold)): &(&Row, &(u64, Fold))| -> Result<FoldEvaluation, WorkError> {
            let bench = Bench {
                recording: &recording,
                places: &simulation.places,
                tables: &tables,
                contacts: &contacts,
                intervals_block_mm: (plan.intervals && row.without.is_none()).then_some(block_mm),
                bench: &row.settings.bench,
                pair: &row.settings.pair,
                train: &row.settings.train,
                seed: *seed,
                taxels: &row.settings.taxels,
            };
            let found =
                evaluate_fold(&bench, fold).at(|| format!("held out by {}, seed {seed}", row.held_out))?;
            work.step("");
            Ok(found)
        };
        let evaluations: Vec<FoldEvaluation> = jobs
            .par_iter()
            .with_max_len(1)
            .map(evaluate_one)
            .collect::<Result<_, _>>()?;
        let mut evaluations = evaluations.into_iter();
        let found = CrossValidation {
            sensor: self.record().sensor.clone(),
            provenance: recording.provenance,
            taxels_left_out: names(self.left_out(), &recording.taxels),
            rows: rows.iter().map(|row| row.gather(&mut evaluations)).collect(),
        };
        let folder = self.folder().join(FOLDER);
        write_json(&folder.join("result.json"), &found)?;
        write_file(&folder.join("errors.png"), &png(&found.plot().scene(), 2.0)?)?;
        Ok(found)
    }

    /// Tables of all locations for each radius that the tip can have, or the run's own tables.
    fn tables_of_radii(
        &self,
        settings: &ResolvedSettings,
        places: &Places,
        there: Vec<DepthTable>,
    ) -> Result<Vec<Vec<DepthTable>>, WorkError> {
        let radii_mm = settings.bench.tip_radii_mm.as_deref().unwrap_or_default();
        if radii_mm.len() < 2 {
            return Ok(vec![there]);
        }
        let _work = Work::start(self.progress(), "simulating", 0);
        let folder = self.folder().join(FOLDER).join("depth_tables");
        let store = DepthTableStore::of(self.gel(), self.progress())?
            .kept_in(&folder, &self.caller().program)
            .with_fast(self.fast().map(|fast| &**fast));
        let mut requests = Vec::new();
        for radius_mm in radii_mm {
            requests.extend(places.requests.iter().cloned().map(|request| {
                twintac_depth_table::DepthTableRequest {
                    tip_radius_mm: Some(*radius_mm),
                    ..request
                }
            }));
        }
        let tables = store
            .depth_tables(&requests)
            .map_err(digitac::DigitacError::Simulation)?;
        Ok(tables
            .chunks(places.requests.len())
            .map(<[DepthTable]>::to_vec)
            .collect())
    }
}

fn rows(
    plan: &CrossValidationPlan,
    settings: &ResolvedSettings,
    recording: &Recording,
) -> Result<Vec<Row>, WorkError> {
    let row = |held_out: HeldOut, without: Option<Without>| -> Result<Row, WorkError> {
        let mut settings = settings.clone();
        if let Some(without) = without {
            without.apply(&mut settings);
            settings.train.variants = Some(vec![Variant::PressureMemory]);
        }
        let mut folds = Vec::new();
        for seed in 1..=plan.seeds {
            let left_out = &settings.taxels.left_out;
            let of_seed = Fold::all(recording, held_out, (&settings.split, seed), left_out)?;
            folds.extend(of_seed.into_iter().map(|fold| (seed, fold)));
        }
        Ok(Row {
            held_out,
            without,
            settings,
            folds,
        })
    };
    let whole = plan.held_out.iter().map(|held_out| row(*held_out, None));
    let parts: &[Without] = if plan.ablation { &Without::ALL } else { &[] };
    let parts = parts.iter().map(|without| row(HeldOut::Place, Some(*without)));
    whole.chain(parts).collect()
}

impl Row {
    /// Takes the row's results, which come in the order of its folds.
    fn gather(&self, evaluations: &mut impl Iterator<Item = FoldEvaluation>) -> CrossValidated {
        let mut seeds: Vec<OfSeed> = Vec::new();
        for ((seed, _), evaluation) in self.folds.iter().zip(evaluations) {
            match seeds.last_mut() {
                Some(last) if last.seed == *seed => last.evaluations.push(evaluation),
                _ => seeds.push(OfSeed {
                    seed: *seed,
                    evaluations: vec![evaluation],
                }),
            }
        }
        let spread = |errors: &dyn Fn(&FoldEvaluation) -> Option<Errors>| {
            let of_seed = |of_seed: &OfSeed| headline(of_seed.evaluations.iter().filter_map(errors));
            let values: Option<Vec<f64>> = seeds.iter().map(of_seed).collect();
            values.and_then(|values| Spread::of(&values))
        };
        let all = || seeds.iter().flat_map(|of_seed| &of_seed.evaluations);
        let variants: BTreeSet<Variant> = all().flat_map(|j| j.variants.keys().copied()).collect();
        let n_frames: usize = all().map(|j| j.n_frames).sum();
        let n_beyond: usize = all().map(|j| j.n_frames_not_simulated).sum();
        CrossValidated {
            held_out: self.held_out,
            without: self.without,
            twin: spread(&|j| Some(j.twin)),
            variants: variants
                .into_iter()
                .filter_map(|variant| Some((variant, spread(&|j| j.variants.get(&variant).copied())?)))
                .collect(),
            kernel: spread(&|j| j.kernel),
            certainty: certainty(&seeds),
            frames_not_simulated_percent: (n_frames > 0).then(|| 100.0 * n_beyond as f64 / n_frames as f64),
            seeds,
        }
    }
}

/// Intervals and OOD scores of a row: means over the results of a seed, and their spread.
fn certainty(seeds: &[OfSeed]) -> CertaintySpread {
    let spread = |value: &dyn Fn(&FoldEvaluation) -> Option<f64>| {
        let of_seed = |of_seed: &OfSeed| {
            let values: Vec<f64> = of_seed.evaluations.iter().filter_map(value).collect();
            (!values.is_empty()).then(|| values.iter().sum::<f64>() / values.len() as f64)
        };
        let values: Vec<f64> = seeds.iter().filter_map(of_seed).collect();
        Spread::of(&values)
    };
    CertaintySpread {
        covered: spread(&|j| j.certainty?.covered_percent),
        covered_in_contact: spread(&|j| j.certainty?.covered_in_contact_percent),
        width_in_contact: spread(&|j| j.certainty?.mean_width_in_contact_percent),
        flagged: spread(&|j| j.certainty?.flagged_percent),
        ood_detection: spread(&|j| Some(j.ood_detection?.area_percent)),
    }
}

/// The headline error over several results, with each frame counted once; `None` without frames.
fn headline(errors: impl Iterator<Item = Errors>) -> Option<f64> {
    let (mut sum, mut count) = (0.0, 0);
    for errors in errors {
        let mean = errors.nearest_in_contact;
        if let Some(percent) = mean.percent {
            sum += percent * mean.count as f64;
            count += mean.count;
        }
    }
    (count > 0).then(|| sum / count as f64)
}

impl CrossValidation {
    /// The plot: a bar for each row, and for the parametric baseline on the same presses.
    fn plot(&self) -> Bars {
        let bar = |name: String, spread: Spread, ink: Ink| Bar {
            name,
            value: spread.mean_percent,
            uncertainty: Some(spread.deviation_percent),
            text: format!("{:.2} ± {:.2} %", spread.mean_percent, spread.deviation_percent),
            ink,
        };
        let mut bars = Vec::new();
        for row in &self.rows {
            bars.extend(row.twin.map(|twin| bar(row.name(), twin, Ink::Twin)));
            if let (Some(kernel), None) = (row.kernel, row.without) {
                bars.push(bar("parametric baseline".to_owned(), kernel, Ink::Muted));
            }
        }
        Bars {
            title: format!("{}, {} data", self.sensor, self.provenance),
            x_label: "error of the nearest taxel in contact, % of the file's largest reading".into(),
            bars,
        }
    }
}

impl CrossValidated {
    /// The row in words.
    #[must_use]
    pub fn name(&self) -> String {
        match self.without {
            None => format!("by {}", self.held_out),
            Some(without) => format!("by {}, without {}", self.held_out, without.name()),
        }
    }
}
