//! The error of an adapted twin over the number of presses that it was adapted with, beside a twin
//! that was trained on all presses.

use std::path::Path;

use digitac::Model;
use rayon::prelude::*;
use serde::Serialize;
use twintac_model::{Figures, NewGel, names};
use twintac_plot::{Ink, Panel, Panels, Scene, Series, png, svg};
use twintac_recording::Provenance;
use twintac_store::{write_file, write_json};
use twintac_work::{Work, WorkError};

use crate::Run;
use crate::cross_validation::Spread;
use crate::stages::training::HELD_OUT;

/// The numbers of presses to adapt with, and the number of seeds.
#[derive(Clone, Debug)]
pub struct CurvePlan {
    /// Numbers of presses.
    pub presses: Vec<usize>,
    /// Number of seeds, from 1 on. Each seed chooses other presses.
    pub seeds: u64,
}

/// Errors of an adapted twin over the number of presses that it was adapted with, in % of the
/// largest reading of the file.
#[derive(Clone, Debug, Serialize)]
pub struct AdaptationCurve {
    /// Provenance of the readings.
    pub provenance: Provenance,
    /// The sensor that was adapted to.
    pub sensor: String,
    /// Files that the adapted twin was originally trained on.
    pub learned_from: Vec<String>,
    /// What the figures mean.
    pub definition: String,
    /// Taxels excluded from the headline figure.
    pub taxels_left_out: Vec<String>,
    /// Number of test presses: the run's held-out ones, on which no twin was trained.
    pub evaluated_presses: usize,
    /// Number of presses from which those to adapt with were chosen: the training and validation
    /// presses of the run's own twin.
    pub training_presses: usize,
    /// Errors of the original twin, without adaptation.
    pub as_learned: Figures,
    /// Errors of the run's own twin, trained on all of its training presses.
    pub trained_on_all: Figures,
    /// The adapted twins.
    pub points: Vec<AdaptationPoint>,
}

/// Twins that were adapted with the same number of presses.
#[derive(Clone, Debug, Serialize)]
pub struct AdaptationPoint {
    /// Number of presses.
    pub presses: usize,
    /// Error of the nearest taxel in contact, over the seeds; `None` if no frame is in contact.
    pub nearest_in_contact: Option<Spread>,
    /// The mean divided by the error of the twin that was trained on all presses.
    pub over_trained_on_all: Option<f64>,
    /// The errors and the presses of each seed.
    pub seeds: Vec<SeedOfPoint>,
}

/// A twin that was adapted with the presses that one seed chose.
#[derive(Clone, Debug, Serialize)]
pub struct SeedOfPoint {
    /// The seed.
    pub seed: u64,
    /// Names of the presses.
    pub adapted_with: Vec<String>,
    /// Errors on the held-out presses.
    #[serde(flatten)]
    pub figures: Figures,
}

/// Adapts a model to the sensor of a run, with several numbers of its training presses, and
/// evaluates each adapted twin on the run's test presses, beside the run's own twin. Writes
/// `curve.json`, `curve.svg` and `curve.png`.
///
/// # Errors
/// A run that is not evaluated; fewer training presses than asked for; a model that cannot be
/// adapted.
pub fn adaptation_curve(
    model_folder: &Path,
    run: &Run,
    plan: &CurvePlan,
    out: &Path,
) -> Result<AdaptationCurve, WorkError> {
    let model = Model::load(model_folder)?;
    let (recording, metrics) = (run.recording()?, run.metrics()?);
    let split = Model::load(&run.training()?.file(HELD_OUT))?.record.split;
    let training_presses = [&split.train[..], &split.validation].concat();
    if let Some(most) = plan.presses.iter().find(|count| **count > training_presses.len()) {
        return Err(WorkError::Input(format!(
            "{most} presses to adapt with are more than the {} training presses of the run's own twin; give fewer with --curve",
            training_presses.len()
        )));
    }
    let gel = NewGel::open(
        (&model, model_folder),
        Some(run.sensor()),
        &recording,
        out,
        run.caller(),
    )?;
    let as_learned = gel.evaluate_as_learned(&split.test)?;
    let work = Work::start(
        run.progress(),
        "adapting",
        plan.presses.len() * plan.seeds as usize,
    );
    let one = |n_presses: usize, seed: u64| -> Result<SeedOfPoint, WorkError> {
        let used = gel.choose(&training_presses, n_presses, seed)?;
        let evaluation = gel.evaluate(&gel.adapt(&used)?, &split.test)?;
        work.step("");
        Ok(SeedOfPoint {
            seed,
            adapted_with: used
                .iter()
                .map(|&press| recording.presses[press].name.clone())
                .collect(),
            figures: Figures::from(&evaluation.twin.overall),
        })
    };
    let trained_on_all = metrics.twin.overall;
    let point = |&presses: &usize| -> Result<AdaptationPoint, WorkError> {
        let seeds = (1..=plan.seeds).into_par_iter().map(|seed| one(presses, seed));
        let seeds: Vec<SeedOfPoint> = seeds.collect::<Result<_, _>>()?;
        let errors: Vec<f64> = seeds
            .iter()
            .filter_map(|seed| seed.figures.nearest_in_contact_percent)
            .collect();
        let nearest_in_contact = Spread::of(&errors);
        Ok(AdaptationPoint {
            presses,
            nearest_in_contact,
            over_trained_on_all: nearest_in_contact
                .zip(trained_on_all.nearest_in_contact_percent)
                .map(|(adapted, on_all)| adapted.mean_percent / on_all),
            seeds,
        })
    };
    let points = plan.presses.iter().map(point).collect::<Result<_, _>>()?;
    let curve = AdaptationCurve {
        provenance: recording.provenance,
        sensor: metrics.sensor,
        learned_from: model.record.files.clone(),
        definition: metrics.definition,
        taxels_left_out: names(gel.left_out.clone(), &recording.taxels),
        evaluated_presses: split.test.len(),
        training_presses: training_presses.len(),
        as_learned: Figures::from(&as_learned.twin.overall),
        trained_on_all,
        points,
    };
    write_json(&out.join("curve.json"), &curve)?;
    let scene = curve.scene();
    write_file(&out.join("curve.svg"), svg(&scene).as_bytes())?;
    write_file(&out.join("curve.png"), &png(&scene, 2.0)?)?;
    Ok(curve)
}

impl AdaptationCurve {
    /// The plot: error over the number of presses, with the smallest and the largest value of the
    /// seeds, and the error of the twin that was trained on all presses.
    #[must_use]
    pub fn scene(&self) -> Scene {
        let series =
            |name: &str, value: &dyn Fn(&AdaptationPoint) -> Option<f64>, ink: Ink, dashed: bool| Series {
                name: name.to_owned(),
                points: self
                    .points
                    .iter()
                    .filter_map(|point| Some([point.presses as f64, value(point)?]))
                    .collect(),
                ink,
                width_px: if dashed { 1.0 } else { 2.0 },
                dashed,
            };
        let of_seeds = |point: &AdaptationPoint| -> Vec<f64> {
            let seeds = point.seeds.iter();
            seeds
                .filter_map(|seed| seed.figures.nearest_in_contact_percent)
                .collect()
        };
        let on_all = self.trained_on_all.nearest_in_contact_percent;
        let best = |point: &AdaptationPoint| of_seeds(point).into_iter().reduce(f64::min);
        let worst = |point: &AdaptationPoint| of_seeds(point).into_iter().reduce(f64::max);
        let trained = format!("trained on all {} presses", self.training_presses);
        Panels {
            title: format!(
                "A twin adapted to {}, {} data; {} test presses",
                self.sensor, self.provenance, self.evaluated_presses
            ),
            x_label: "presses to adapt with".to_owned(),
            panels: vec![Panel {
                name: String::new(),
                y_label: "error (% of largest reading)".to_owned(),
                series: vec![
                    series(
                        "adapted",
                        &|point| point.nearest_in_contact.map(|error| error.mean_percent),
                        Ink::Twin,
                        false,
                    ),
                    series("best and worst choice", &best, Ink::Twin, true),
                    series("", &worst, Ink::Twin, true),
                    series(&trained, &|_| on_all, Ink::Text, false),
                ],
                y_range: None,
            }],
            panel_height_px: 260.0,
            logarithmic: false,
        }
        .scene()
    }
}
