//! Predicts the readings of a sensor along a path or a protocol, by its trained twin.

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
/// The bench is as fitted in training. The true depth exceeds that of the poses by the contact
/// height of the indenter's mounting, or by the median of all contact heights if the recordings
/// have no mounting of that name. Ports have their fitted positions, and a fitted tip keeps its
/// radius and form. An added indenter is as described, at the median height. The ratio of the gel's
/// stiffness to the simulated one counts where forces are prescribed.
pub struct Predictor {
    model: Model,
    gel: Gel,
    /// The name of the added indenter, if there is one.
    added: Option<String>,
    /// Drift of each taxel's readings with temperature, kPa; empty for none.
    drift_kpa: Vec<f64>,
}

/// The predicted readings.
#[derive(Clone, Debug, Serialize)]
pub struct Predicted {
    /// Always [`Provenance::Simulated`].
    pub provenance: Provenance,
    /// The sensor's name.
    pub sensor: String,
    /// The variant of the twin.
    pub variant: Variant,
    /// Provenance of the recordings that it was trained on.
    pub trained_on: Provenance,
    /// Names of the taxels, in the order of every row of readings.
    pub taxels: Vec<String>,
    /// The presses in order; a path counts as one.
    pub presses: Vec<Prediction>,
    /// Why a path ends early; `None` if it does not.
    pub failure: Option<String>,
}

impl Predictor {
    /// Opens a model's folder. `indenter` describes an indenter that is added to the sensor's
    /// description or replaces one of its name (TOML, see [`IndenterFile`]).
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

    /// Predicts for chips that are `warmer_k` warmer than when their zeros were taken, K; negative
    /// if they are colder.
    ///
    /// # Errors
    /// A model without temperature coefficients of its zeros.
    pub fn warmer(mut self, warmer_k: f64) -> Result<Self, WorkError> {
        let record = &self.model.record;
        let Some(temperature) = &record.temperature else {
            return Err(WorkError::Input(
                "the model has no temperature coefficients of its zeros; train it with `--temperature` and the file of `twintac characterize`"
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

    /// Predicts along the path that a TOML file describes, as [`along`](Self::along).
    ///
    /// # Errors
    /// A file that cannot be read or is wrong; those of [`along`](Self::along).
    pub fn follow(&self, file: &Path, progress: &dyn Progress) -> Result<Predicted, WorkError> {
        let path = PressPath::parse(&file.display().to_string(), &read_text(file)?)?;
        self.along(path, progress).at(|| file.display().to_string())
    }

    /// Predicts along a path: the gel is solved frame by frame, sliding and tilting included, and
    /// the twin is stepped with the pressures at its ports. Points of the path are not read.
    ///
    /// The solved gel is elastic, as in the tables that the twin was trained with: the twin has
    /// learned the behaviour over time.
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

    /// The contact of each frame: where and with what the gel is touched; `[n_frames]`.
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

    /// Steps the twin along the gel's response.
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

    /// Predicts the presses of a protocol, each from rest. The seed decides what the protocol draws
    /// at random. Weights of the protocol are left out, and a note says so.
    ///
    /// # Errors
    /// A file that cannot be read or is wrong, or has no presses; indenters or taxels that the
    /// sensor does not have; a location that cannot be pressed.
    pub fn press(&self, protocol: &Path, seed: u64, progress: &dyn Progress) -> Result<Predicted, WorkError> {
        let sensor = self.gel.sensor();
        let planned = Planned::read(protocol, sensor, seed)?;
        if planned.presses.is_empty() {
            return Err(WorkError::Input(format!(
                "{}: has no presses; give it a part, since weights are not predicted",
                protocol.display()
            )));
        }
        if !planned.loads.is_empty() {
            progress.note("the protocol's weights are left out: only presses are predicted");
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
                "{n_beyond} of {} frames are deeper than the simulation; the last simulated pressures are used for them",
                frames().count()
            ));
        }
        Ok(self.predicted(presses, None))
    }

    /// The fitted bench for presses with an indenter.
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

/// A path as the bench carries it out: deeper than its poses by the contact height, with forces
/// divided by the ratio of the stiffness to the simulated one.
fn on_bench(mut path: PressPath, contact_offset_mm: f64, stiffness: f64) -> PressPath {
    for pose in &mut path.poses {
        pose.position_mm.z -= contact_offset_mm;
        pose.force_n = pose.force_n.map(|force_n| force_n / stiffness);
    }
    path.points.clear();
    path
}

impl Predicted {
    /// The plot of depth, force, readings with their intervals, and OOD score over time. Presses
    /// follow one after the other.
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
        let ood_score = |press: &Prediction, frame: usize| {
            let sure = press.certainty.as_ref();
            sure.map_or(0.0, |sure| sure.ood_score[frame])
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
            panels.push(panel("OOD score", vec![series("", Ink::Text, &ood_score)]));
        } else {
            panels[2].y_label = "reading (kPa)".to_owned();
        }
        Panels {
            title: format!("Predicted readings of {}, {}", self.sensor, self.provenance),
            x_label: x_label.to_owned(),
            panels,
            panel_height_px: 150.0,
            logarithmic: false,
        }
        .scene()
    }
}
