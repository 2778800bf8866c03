//! The report of a run, from what its stages left.

mod figures;

use digitac::{BenchEstimate, PairedPress};
use twintac_depth_table::DepthTable;
use twintac_plot::page::Fact;
use twintac_plot::{Ink, Panel, Panels, Scene, Series};
use twintac_recording::Provenance;
use twintac_report::data::{
    BenchFit, FileError, Gain, Headline, Parameter, Reference, ReferenceKind, SensorSummary,
    SimulationQuality, Stage, TaxelError, TrainingCurve, Variant, WarpPath,
};
use twintac_report::{Provenance as Badge, ReportData};

use crate::cache::read_record;
use crate::files::{read_json, write_file};
use crate::metrics::{Figures, Metrics};
use crate::stages::training::VariantRecord;
use crate::{Run, RunError};

/// Stages in the order in which they run.
const STAGES: [&str; 6] = [
    "recordings",
    "mesh",
    "simulation",
    "pairs",
    "training",
    "evaluation",
];

impl Run {
    /// Writes `report.html`, and `metrics.json` beside it.
    ///
    /// # Errors
    /// The run is not evaluated yet; a file that cannot be written.
    pub fn report(&self) -> Result<(), RunError> {
        let (held_out, metrics) = (self.held_out()?, self.metrics()?);
        let recording = self.recording()?;
        let simulation = self.simulation(&recording)?;
        let presses = self.pairs()?;
        let variants: Vec<VariantRecord> = read_json(&self.stage("training").join("variants.json"))?;
        let sensor = &*self.sensor.sensor;
        let data = ReportData {
            title: format!("Digital twin of {}", sensor.name),
            provenance: badge(metrics.provenance),
            command: self.caller.command.clone(),
            versions: vec![
                Fact::new("twintac", env!("CARGO_PKG_VERSION")),
                Fact::new("presses", &self.record.source),
            ],
            seed: Some(self.record.seed),
            warnings: self.warnings(&simulation.bench, &metrics),
            sensor: Some(SensorSummary {
                name: sensor.name.clone(),
                facts: twintac_drawing::facts(sensor),
                drawing: Some(twintac_drawing::drawing(sensor)),
            }),
            headline: Some(headline(&metrics)),
            presses: figures::series(&held_out.evaluation, &presses),
            peaks: figures::peaks(&held_out.evaluation, sensor),
            places: figures::places(&held_out.evaluation, sensor),
            agreement: Some(figures::agreement(&held_out.evaluation)),
            taxels: taxels(&metrics, sensor, &held_out.evaluation),
            depths: figures::depths(&held_out.evaluation, &self.left_out()),
            files: files(&metrics, &held_out.evaluation),
            variants: variants.iter().map(variant).collect(),
            training: variants.iter().map(curve).collect(),
            bench: Some(bench(&simulation.bench, &recording.taxels)),
            warps: some_warps(&presses, &simulation.split.test),
            simulation: Some(quality(&simulation.tables)),
            settings: serde_json::to_string_pretty(&self.record.settings).map_err(|source| {
                RunError::Json {
                    what: "the settings".to_owned(),
                    source,
                }
            })?,
            stages: self.stages(),
        };
        twintac_report::page(&data).write(&self.report_path())?;
        let figures = self.stage("evaluation").join("metrics.json");
        let figures = std::fs::read(&figures).map_err(RunError::file("reading", &figures))?;
        write_file(&self.folder.join("metrics.json"), &figures)
    }

    fn warnings(&self, bench: &BenchEstimate, metrics: &Metrics) -> Vec<String> {
        let mut warnings = Vec::new();
        if metrics.provenance == Provenance::Emulated {
            warnings.push("The sensor behind these numbers is emulated: they say how well the method works, not how well a sensor does.".into());
        }
        for taxel in self.sensor.sensor.taxels.iter() {
            if let Some(why) = &taxel.doubtful {
                warnings.push(format!(
                    "Taxel {} is left out of headline figures: {why}.",
                    taxel.name
                ));
            }
        }
        if metrics.twin.frames_not_simulated > 0 {
            let n_frames = metrics.twin.frames_not_simulated;
            warnings.push(format!(
                "{n_frames} frames are deeper than the simulation reached; the end of its table stands in."
            ));
        }
        warnings.extend(bench.doubts.iter().cloned());
        warnings
    }

    fn stages(&self) -> Vec<Stage> {
        let time = |name: &&str| {
            Some(Stage {
                name: (*name).into(),
                wall_s: read_record(&self.stage(name)).ok()?.wall_time_s,
            })
        };
        STAGES.iter().filter_map(time).collect()
    }
}

/// Alignment of presses, as the report shows it.
pub(crate) fn warps(presses: &[PairedPress]) -> Vec<WarpPath> {
    presses
        .iter()
        .map(|press| WarpPath {
            name: press.name.clone(),
            time_s: press.features.time_s.clone(),
            shift_s: shift_s(press),
        })
        .collect()
}

/// Time on the measurement's clock minus the frame's own, s.
fn shift_s(press: &PairedPress) -> Vec<f64> {
    let time_s = &press.features.time_s;
    let at = |index: f64| {
        let before = (index as usize).min(time_s.len() - 1);
        let after = (before + 1).min(time_s.len() - 1);
        time_s[before] + index.fract() * (time_s[after] - time_s[before])
    };
    press
        .warp
        .measured_index
        .iter()
        .zip(time_s)
        .map(|(&index, now_s)| at(index) - now_s)
        .collect()
}

/// The alignment of all presses as a picture.
pub(crate) fn warp_plot(warps: &[WarpPath]) -> Scene {
    let series = warps.iter().map(|warp| Series {
        name: String::new(),
        points: warp
            .time_s
            .iter()
            .zip(&warp.shift_s)
            .map(|(time_s, shift_s)| [time_s - warp.time_s[0], *shift_s])
            .collect(),
        ink: Ink::Series(0),
        width_px: 0.8,
        dashed: false,
    });
    Panels {
        title: "How measured and simulated times were matched".into(),
        x_label: "time since the press began (s)".into(),
        panels: vec![Panel {
            y_label: "shift (s)".into(),
            series: series.collect(),
            ..Panel::default()
        }],
        panel_height_px: 220.0,
        logarithmic: false,
    }
    .scene()
}

fn some_warps(presses: &[PairedPress], test: &[usize]) -> Vec<WarpPath> {
    let mut chosen = warps(
        &test
            .iter()
            .take(6)
            .map(|&index| presses[index].clone())
            .collect::<Vec<_>>(),
    );
    chosen.retain(|warp| warp.time_s.len() > 1);
    chosen
}

fn badge(provenance: Provenance) -> Badge {
    match provenance {
        Provenance::Real => Badge::Real,
        Provenance::Emulated => Badge::Emulated,
        Provenance::Simulated => Badge::Simulated,
    }
}

fn headline(metrics: &Metrics) -> Headline {
    let reference = |name: &str, kind: ReferenceKind, figures: &Figures| Reference {
        name: name.into(),
        kind,
        nearest_in_contact_percent: figures.nearest_in_contact_percent,
        all_percent: Some(figures.all_percent),
    };
    let baselines = &metrics.baselines;
    let mut references = vec![reference("zero", ReferenceKind::Baseline, &baselines.zero)];
    references.extend(
        baselines
            .polynomial
            .as_ref()
            .map(|f| reference("static polynomial", ReferenceKind::Baseline, f)),
    );
    references.extend(
        metrics
            .repeatability
            .as_ref()
            .map(|f| reference("repeatability", ReferenceKind::Floor, f)),
    );
    Headline {
        presses: metrics.held_out_presses,
        nearest_in_contact_percent: metrics.twin.overall.nearest_in_contact_percent,
        all_percent: metrics.twin.overall.all_percent,
        definition: metrics.definition.clone(),
        references,
    }
}

fn variant(record: &VariantRecord) -> Variant {
    Variant {
        name: record.variant.to_string(),
        nearest_in_contact_percent: record.test.overall.nearest_in_contact.percent,
        all_percent: record.test.overall.all.percent,
        validation_percent: record.validation.overall.nearest_in_contact.percent,
        chosen: record.chosen,
    }
}

fn curve(record: &VariantRecord) -> TrainingCurve {
    TrainingCurve {
        name: record.variant.to_string(),
        step: (1..=record.history.len()).map(|epoch| epoch as f64).collect(),
        training_loss: record.history.iter().map(|epoch| epoch.loss).collect(),
        validation_loss: record.history.iter().map(|epoch| epoch.validation_loss).collect(),
    }
}

fn files(metrics: &Metrics, evaluation: &digitac::Evaluation) -> Vec<FileError> {
    metrics
        .twin
        .by_file
        .iter()
        .map(|(file, figures)| {
            let presses: Vec<_> = evaluation
                .presses
                .iter()
                .filter(|press| press.mounting == *file)
                .collect();
            let readings = presses
                .iter()
                .flat_map(|press| press.measured_kpa.iter().flatten());
            FileError {
                name: file.clone(),
                role: "held-out presses".into(),
                provenance: None,
                presses: presses.len(),
                frames: presses.iter().map(|press| press.time_s.len()).sum(),
                largest_kpa: readings.fold(0.0, |largest: f64, reading| largest.max(*reading)),
                nearest_in_contact_percent: figures.nearest_in_contact_percent,
                all_percent: figures.all_percent,
            }
        })
        .collect()
}

fn taxels(
    metrics: &Metrics,
    sensor: &twintac_sensor::Sensor,
    evaluation: &digitac::Evaluation,
) -> Vec<TaxelError> {
    sensor
        .taxels
        .iter()
        .enumerate()
        .filter_map(|(index, taxel)| {
            let figures = metrics.twin.by_taxel.get(&taxel.name)?;
            Some(TaxelError {
                name: taxel.name.clone(),
                nearest_in_contact_percent: if figures.frames_in_contact == 0 {
                    f64::NAN
                } else {
                    figures.nearest_in_contact_percent
                },
                all_percent: figures.all_percent,
                bias_percent: figures::bias_percent(evaluation, index),
                note: taxel.doubtful.clone().unwrap_or_default(),
            })
        })
        .collect()
}

fn bench(bench: &BenchEstimate, taxels: &[String]) -> BenchFit {
    let parameter = |name: String, estimate: &digitac::Estimate, unit: &str| Parameter {
        name,
        value: estimate.value,
        uncertainty: Some(estimate.uncertainty),
        unit: unit.into(),
    };
    let mut parameters = Vec::new();
    parameters.extend(
        bench
            .tip_radius_mm
            .as_ref()
            .map(|radius| parameter("tip radius".into(), radius, "mm")),
    );
    parameters.extend(
        bench
            .stiffness
            .as_ref()
            .map(|s| parameter("stiffness over the description's".into(), s, "")),
    );
    let offsets = bench.contact_offset_mm.iter();
    parameters
        .extend(offsets.map(|(file, offset)| parameter(format!("contact deeper by, {file}"), offset, "mm")));
    let gains = bench
        .gains
        .iter()
        .flat_map(|gains| taxels.iter().zip(&gains.gain));
    BenchFit {
        parameters,
        gains: gains
            .map(|(taxel, gain)| Gain {
                taxel: taxel.clone(),
                value: *gain,
                uncertainty: None,
            })
            .collect(),
        objective_by_radius: Vec::new(),
    }
}

fn quality(tables: &[DepthTable]) -> SimulationQuality {
    let frames = || tables.iter().flat_map(|table| &table.frames);
    SimulationQuality {
        frames: frames().count(),
        worst_residual: frames().map(|f| f.quality.residual).fold(0.0, f64::max),
        largest_penetration_mm: frames().map(|f| f.quality.penetration_mm).fold(0.0, f64::max),
        smallest_volume_ratio: frames()
            .map(|f| f.quality.smallest_volume_ratio)
            .fold(f64::INFINITY, f64::min),
        failures: tables.iter().filter_map(|table| table.failure.clone()).collect(),
    }
}
