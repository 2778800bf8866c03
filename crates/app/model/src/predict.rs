//! What a sensor would read along a path or a protocol, by its trained twin.

use std::path::Path;
use std::sync::Arc;

use digitac::{BenchEstimate, Contact, Model, Prediction, Variant};
use glam::DQuat;
use serde::Serialize;
use twintac_plot::{Ink, PALETTE, Panel, Panels, Scene, Series};
use twintac_protocol::{PressPath, PressPlan};
use twintac_recording::Provenance;
use twintac_sensor::IndenterFile;
use twintac_shape::{Shape, Underside};
use twintac_simulate::{Followed, FollowedFrame, Gel};
use twintac_tables::DepthTableStore;
use twintac_work::{At, Planned, Progress, Work, WorkError, read_text};

use crate::gel::gel_of;

/// A trained twin, and the gel of its sensor.
///
/// The bench is as it was found at training. An indenter goes deeper than poses say by the contact height of its mounting, or by the median of all
/// where the recordings have no mounting of its name. Ports are where they were found, and a fitted tip keeps its radius and form. An indenter that was
/// added is as described, at the median height. The gel's stiffness over the simulated one counts where forces are prescribed.
pub struct Predictor {
    model: Model,
    gel: Gel,
    /// The indenter that was added.
    added: Option<String>,
    /// What temperature adds to each taxel's readings, kPa; empty for nothing.
    drift_kpa: Vec<f64>,
}

/// What a twin would read.
#[derive(Clone, Debug, Serialize)]
pub struct Predicted {
    /// Always [`Provenance::Simulated`].
    pub provenance: Provenance,
    /// The sensor's name.
    pub sensor: String,
    /// Which model the twin is.
    pub variant: Variant,
    /// Where the recordings come from that it was trained with.
    pub trained_on: Provenance,
    /// Names of the taxels, in the order of every row of readings.
    pub taxels: Vec<String>,
    /// The presses in order; a path is one.
    pub presses: Vec<Prediction>,
    /// Why a path ends before it should; `None` if it does not.
    pub failure: Option<String>,
}

impl Predictor {
    /// Opens a model's folder. `indenter` describes a shape that the sensor's description does not have, or has otherwise (TOML, see
    /// [`IndenterFile`]).
    ///
    /// # Errors
    /// A folder that holds no twin, or a damaged one; an indenter that is wrong.
    pub fn open(model_folder: &Path, indenter: Option<&Path>) -> Result<Self, WorkError> {
        let model = Model::load(model_folder)?;
        let mut gel = gel_of(&model, model_folder)?;
        let added = indenter.map(IndenterFile::read).transpose()?;
        if let Some(added) = &added {
            let sensor = Arc::new(added.added_to(gel.sensor())?);
            gel = gel.with_sensor(sensor);
        }
        Ok(Self {
            model,
            gel,
            added: added.map(|added| added.indenter.name),
            drift_kpa: Vec::new(),
        })
    }

    /// A twin, and the gel that it was trained with.
    #[must_use]
    pub fn new(model: Model, gel: Gel) -> Self {
        Self {
            model,
            gel,
            added: None,
            drift_kpa: Vec::new(),
        }
    }

    /// What a sensor reads whose chips are so much warmer than when its zero was taken, K; below zero if they are colder.
    ///
    /// # Errors
    /// A model that does not know how its zeros move with temperature.
    pub fn warmer(mut self, warmer_k: f64) -> Result<Self, WorkError> {
        let record = &self.model.record;
        let Some(temperature) = &record.temperature else {
            return Err(WorkError::Input(
                "the model does not know how its zeros move with temperature; train it with `--temperature`, which has what `twintac characterize` found"
                    .to_owned(),
            ));
        };
        let kpa_per_k = temperature.coefficients(&self.gel.sensor().name, &record.taxels);
        let kpa_per_k = kpa_per_k.map_err(|error| WorkError::Input(error.to_string()))?;
        self.drift_kpa = kpa_per_k
            .into_iter()
            .map(|kpa_per_k| kpa_per_k * warmer_k)
            .collect();
        Ok(self)
    }

    /// Takes the twin along the path that a TOML file describes, as [`along`](Self::along).
    ///
    /// # Errors
    /// A file that cannot be read or is wrong; those of [`along`](Self::along).
    pub fn follow(&self, file: &Path, progress: &dyn Progress) -> Result<Predicted, WorkError> {
        let path = PressPath::parse(&file.display().to_string(), &read_text(file)?)?;
        self.along(path, progress).at(|| file.display().to_string())
    }

    /// Takes the twin along a path: the gel is solved frame by frame, sliding and tilting included, and the twin stepped with what reaches its ports. Points of
    /// the path are not read.
    ///
    /// The gel answers at once, as it does in the tables that the twin was trained with: what it does over time, the twin has learned.
    ///
    /// # Errors
    /// An indenter that the sensor does not have; a path that misses the gel.
    pub fn along(&self, path: PressPath, progress: &dyn Progress) -> Result<Predicted, WorkError> {
        let bench = self.bench_for(&path.indenter);
        let stiffness = if path.asks_for_force() {
            bench.stiffness()
        } else {
            1.0
        };
        let shape = match (self.gel.shape(&path.indenter)?, bench.tip_radius_mm) {
            (Shape::Sphere { .. }, Some(radius)) => Shape::Sphere {
                radius_mm: radius.value,
            },
            (described, _) => described.clone(),
        };
        let mut elastic = self.gel.material().clone();
        elastic.prony.clear();
        let mut gel = self.gel.clone().with_material(elastic);
        if self.model.twin.variant() == Variant::Paper {
            gel = gel.with_stress_along_paths();
        }
        let offset_mm = bench.contact_offset_mm(&path.indenter);
        let path = on_bench(path, offset_mm, stiffness);
        let work = Work::start(progress, "simulating", path.frames().len());
        let followed = gel.follow(&shape, &path, &mut || work.advance())?;
        work.go_on()?;
        drop(work);
        let mut along = self.read_along(&path, &followed, &bench, stiffness);
        if let Some(certainty) = &self.model.record.certainty {
            let contacts = self.contacts(&shape, &path, &followed)?;
            let contact = |frame: usize| &contacts[frame];
            let (time_s, depth_mm) = (&along.time_s, &along.depth_mm);
            along.certainty = Some(certainty.along(contact, time_s, depth_mm, &along.readings_kpa));
        }
        Ok(self.predicted(vec![along], followed.failure))
    }

    /// Where and with what the gel is touched along a path; `[n_frames]`.
    fn contacts(
        &self,
        shape: &Shape,
        path: &PressPath,
        followed: &Followed,
    ) -> Result<Vec<Contact>, WorkError> {
        let mut before: Option<(DQuat, Underside)> = None;
        let mut contacts = Vec::with_capacity(followed.frames.len());
        for (frame, planned) in followed.frames.iter().zip(path.frames()) {
            let rotation = planned.pose.rotation;
            let underside = match before {
                Some((same, underside)) if same == rotation => underside,
                _ => self.gel.underside(shape, rotation)?,
            };
            contacts.push(Contact {
                place_mm: frame.position_mm.truncate().to_array(),
                underside: underside.clone(),
            });
            before = Some((rotation, underside));
        }
        Ok(contacts)
    }

    /// Steps the twin along what the gel did.
    fn read_along(
        &self,
        path: &PressPath,
        followed: &Followed,
        bench: &BenchEstimate,
        stiffness: f64,
    ) -> Prediction {
        let twin = &self.model.twin;
        let mut state = twin.state();
        state.tare_untouched();
        let mut before_s = 0.0;
        let read = |frame: &FollowedFrame| {
            let mut seen = if twin.variant() == Variant::Paper {
                frame.stress_feature_kpa_per_mm.clone()
            } else {
                let taxels = twin.taxels().iter();
                let mut pressure_kpa: Vec<f64> = taxels.map(|taxel| frame.pressure_kpa[taxel]).collect();
                let place_mm = frame.position_mm.truncate().to_array();
                let slopes = frame.port_slope_kpa_per_mm.iter().copied();
                bench
                    .correction_at(place_mm)
                    .apply(frame.depth_mm, slopes, &mut pressure_kpa);
                pressure_kpa
            };
            seen.iter_mut().for_each(|value| *value *= stiffness);
            let mut readings_kpa = vec![0.0; seen.len()];
            state.step(frame.time_s - before_s, &seen, &mut readings_kpa);
            before_s = frame.time_s;
            readings_kpa
        };
        let frames = &followed.frames;
        Prediction {
            readings_kpa: frames.iter().map(read).collect(),
            name: "path".to_owned(),
            indenter: path.indenter.clone(),
            time_s: frames.iter().map(|frame| frame.time_s).collect(),
            place_mm: frames
                .iter()
                .map(|frame| frame.position_mm.truncate().to_array())
                .collect(),
            depth_mm: frames.iter().map(|frame| frame.depth_mm).collect(),
            force_n: frames
                .iter()
                .map(|frame| 0.0 - stiffness * frame.force_n.z)
                .collect(),
            simulated: vec![true; frames.len()],
            certainty: None,
        }
    }

    /// Takes the twin along the presses of a protocol, each from rest. The seed decides what the protocol leaves to chance. Weights that it
    /// puts on the gel are left out, and said to be.
    ///
    /// # Errors
    /// A file that cannot be read or is wrong, or has no presses; indenters or taxels that the sensor does not have; a place that cannot be
    /// pressed.
    pub fn press(&self, protocol: &Path, seed: u64, progress: &dyn Progress) -> Result<Predicted, WorkError> {
        let sensor = self.gel.sensor();
        let planned = Planned::read(protocol, sensor, seed)?;
        if planned.presses.is_empty() {
            return Err(WorkError::Input(format!(
                "{}: has no presses; give it a part, weights alone are not predicted",
                protocol.display()
            )));
        }
        if !planned.loads.is_empty() {
            progress.note("the protocol's weights are left out: presses alone are predicted");
        }
        let work = Work::start(progress, "simulating", 0);
        let store = DepthTableStore::of(self.gel.clone(), progress)?;
        let is_added = |plan: &PressPlan| self.added.as_ref() == Some(&plan.indenter);
        let (added, known): (Vec<_>, Vec<_>) = planned.presses.iter().cloned().partition(is_added);
        let predict = |plans: &[PressPlan]| {
            let bench = self.bench_for(plans.first().map_or("", |plan| &plan.indenter));
            let twin = (&self.model.twin, self.model.record.certainty.as_ref());
            digitac::predict(twin, &bench, &store, plans, sensor.readout.rate_hz)
        };
        let (mut added, mut known) = (predict(&added)?.into_iter(), predict(&known)?.into_iter());
        let presses: Vec<Prediction> = planned
            .presses
            .iter()
            .filter_map(|plan| {
                if is_added(plan) {
                    added.next()
                } else {
                    known.next()
                }
            })
            .collect();
        drop(work);
        let frames = || presses.iter().flat_map(|press| &press.simulated);
        let n_beyond = frames().filter(|simulated| !**simulated).count();
        if n_beyond > 0 {
            progress.note(&format!(
                "{n_beyond} of {} frames lie deeper than the gel could be pressed; the last pressures stand for them",
                frames().count()
            ));
        }
        Ok(self.predicted(presses, None))
    }

    /// What is known of the bench while it presses with an indenter.
    fn bench_for(&self, indenter: &str) -> BenchEstimate {
        let bench = &self.model.record.bench;
        match &self.added {
            Some(added) if added == indenter => bench.with_described_tip(),
            _ => bench.clone(),
        }
    }

    fn predicted(&self, mut presses: Vec<Prediction>, failure: Option<String>) -> Predicted {
        let record = &self.model.record;
        for row in presses.iter_mut().flat_map(|press| &mut press.readings_kpa) {
            for (reading_kpa, drift_kpa) in row.iter_mut().zip(&self.drift_kpa) {
                *reading_kpa += drift_kpa;
            }
        }
        Predicted {
            provenance: Provenance::Simulated,
            sensor: self.gel.sensor().name.clone(),
            variant: record.variant,
            trained_on: record.provenance,
            taxels: record.taxels.clone(),
            presses,
            failure,
        }
    }
}

/// A path as a bench carries it out: so much deeper than its poses say, on a gel so much stiffer than the simulated one.
fn on_bench(mut path: PressPath, contact_offset_mm: f64, stiffness: f64) -> PressPath {
    for pose in &mut path.poses {
        pose.position_mm.z -= contact_offset_mm;
        pose.force_n = pose.force_n.map(|force_n| force_n / stiffness);
    }
    path.points.clear();
    path
}

impl Predicted {
    /// Depth, force, readings with their intervals, and how unlike contacts are to what taught, over time; presses one after the other.
    #[must_use]
    pub fn scene(&self) -> Scene {
        let mut start_s = 0.0;
        let mut starts_s = Vec::with_capacity(self.presses.len());
        for press in &self.presses {
            let first_s = press.time_s.first().copied().unwrap_or(0.0);
            starts_s.push(start_s - first_s);
            start_s += press.time_s.last().copied().unwrap_or(0.0) - first_s;
        }
        let series = |name: &str, ink: Ink, value: &dyn Fn(&Prediction, usize) -> f64| {
            let presses = self.presses.iter().zip(&starts_s);
            Series {
                name: name.to_owned(),
                points: presses
                    .flat_map(|(press, start_s)| {
                        let times = press.time_s.iter().enumerate();
                        times.map(move |(frame, time_s)| [start_s + time_s, value(press, frame)])
                    })
                    .collect(),
                ink,
                width_px: 1.25,
                dashed: false,
            }
        };
        let panel = |y_label: &str, series: Vec<Series>| Panel {
            name: String::new(),
            y_label: y_label.to_owned(),
            series,
            y_range: None,
        };
        let is_sure = self.presses.iter().all(|press| press.certainty.is_some());
        let mut readings = Vec::new();
        for (taxel, name) in self.taxels.iter().enumerate() {
            readings.push(Series {
                dashed: taxel >= PALETTE.len(),
                ..series(name, Ink::Series(taxel), &|press, frame| {
                    press.readings_kpa[frame][taxel]
                })
            });
            for side in [-1.0, 1.0].into_iter().filter(|_| is_sure) {
                let bound = |press: &Prediction, frame: usize| {
                    let sure = press.certainty.as_ref();
                    let half = sure.map_or(0.0, |sure| sure.half_width_kpa[frame][taxel]);
                    press.readings_kpa[frame][taxel] + side * half
                };
                readings.push(Series {
                    width_px: 0.5,
                    dashed: true,
                    ..series("", Ink::Series(taxel), &bound)
                });
            }
        }
        let unlikeness = |press: &Prediction, frame: usize| {
            let sure = press.certainty.as_ref();
            sure.map_or(0.0, |sure| sure.unlikeness[frame])
        };
        let x_label = if self.presses.len() > 1 {
            "time, presses one after the other (s)"
        } else {
            "time (s)"
        };
        let mut panels = vec![
            panel(
                "depth (mm)",
                vec![series("", Ink::Text, &|press, frame| press.depth_mm[frame])],
            ),
            panel(
                "force (N)",
                vec![series("", Ink::Text, &|press, frame| press.force_n[frame])],
            ),
            panel("reading, 90 % (kPa)", readings),
        ];
        if is_sure {
            panels.push(panel(
                "unlike what taught",
                vec![series("", Ink::Text, &unlikeness)],
            ));
        } else {
            panels[2].y_label = "reading (kPa)".to_owned();
        }
        Panels {
            title: format!("What {} would read, {}", self.sensor, self.provenance),
            x_label: x_label.to_owned(),
            panels,
            panel_height_px: 150.0,
            logarithmic: false,
        }
        .scene()
    }
}
