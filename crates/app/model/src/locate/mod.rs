//! Contact estimation with a trained twin: from readings to location, depth and indenter.
//!
//! The twin's viscoelastic part is removed from the readings, frame by frame; what remains depends
//! on the present press alone. It is compared with the twin's elastic readings at locations and
//! depths all over the gel.

mod errors;
mod frames;
mod table;

use std::path::Path;
use std::time::Instant;

use digitac::{BenchEstimate, Model, Variant, WithoutMemory};
use serde::Serialize;
use twintac_config::{Checked, Problem};
use twintac_depth_table::DepthTableSource;
use twintac_inverse::{
    Contact, Inverse, InverseError, InverseSettings, LARGEST_READING_KPA, TableModel, Tracker,
};
use twintac_recording::{Control, Press, Provenance, Recording};
use twintac_simulate::Gel;
use twintac_work::{Progress, Silent, WorkError};

use crate::gel::gel_of;
use crate::press_checksum::press_checksum;
use crate::taxels::left_out;
use crate::temperature::as_in_training;
use crate::unseen::refuse_other_sensor;

pub use errors::LocationErrors;
pub use frames::{LocatedFrame, LocatedPress};

/// Time constant with which the zero follows a sensor that nothing touches, s.
const ZERO_S: f64 = 1.0;

/// Estimates contacts from readings, by a trained twin.
///
/// Given are the indenters of the sensor's description, the fitted radius of a tip, and the contact
/// heights of the mountings that the twin was trained on. The gel is touched at one location at a
/// time. Taxels that the description excludes (`doubtful`) are not used.
pub struct Locator {
    model: Model,
    gel: Gel,
    indenters: Vec<String>,
    /// Indices of the taxels that are used.
    taxels: Vec<usize>,
    inverse: Inverse<TableModel>,
}

/// Estimated contacts, frame by frame, and their errors.
#[derive(Clone, Debug, Serialize)]
pub struct Located {
    /// Provenance of the readings.
    pub provenance: Provenance,
    /// The sensor's name.
    pub sensor: String,
    /// The variant of the twin.
    pub variant: Variant,
    /// Settings of the estimator.
    pub settings: InverseSettings,
    /// Errors on presses that the twin was not trained on; `None` without such presses.
    pub unseen: Option<LocationErrors>,
    /// Errors on presses that the twin was trained on.
    pub trained_on: Option<LocationErrors>,
    /// The presses in order.
    pub presses: Vec<LocatedPress>,
    /// Mean time of a frame, ms, on one core. It is not reproducible.
    #[serde(skip)]
    pub frame_ms: f64,
}

impl Locator {
    /// The default settings of the estimator, with the values of a file (TOML) in place of its own,
    /// if there is a file.
    ///
    /// # Errors
    /// A file that cannot be read, an unknown field, a value that is not allowed.
    pub fn settings(path: Option<&Path>) -> Result<InverseSettings, WorkError> {
        let settings = InverseSettings {
            noise_kpa: 0.03,
            model_part_of_largest: 0.02,
            n_steps: 3,
            deepest_mm: 2.5,
            ..InverseSettings::default()
        };
        path.map_or(Ok(settings), |path| {
            Ok(twintac_config::read_over(path, &settings)?.checked()?)
        })
    }

    /// Opens a model's folder, and computes the twin's readings for each of the named indenters, or
    /// for all of the sensor's description, at locations within one and a half gel heights of the
    /// taxels, and down to `deepest_mm`. Indenters have their described orientation.
    ///
    /// # Errors
    /// A folder that holds no twin, or a damaged one; an indenter that the sensor does not have; a
    /// location that cannot be pressed; settings that are not allowed.
    pub fn open(
        model_folder: &Path,
        indenters: &[String],
        settings: InverseSettings,
        progress: &dyn Progress,
    ) -> Result<Self, WorkError> {
        let model = Model::load(model_folder)?;
        let gel = gel_of(&model, model_folder)?;
        let doubtful = left_out(gel.sensor());
        let taxels: Vec<usize> = (0..model.record.taxels.len())
            .filter(|taxel| !doubtful.contains(taxel))
            .collect();
        let described = gel.sensor().indenters.iter().map(|known| known.name.clone());
        let indenters = match indenters {
            [] => described.collect(),
            named => named.to_vec(),
        };
        let refused = |problem: InverseError| WorkError::Input(problem.to_string());
        settings.checked()?;
        if settings.deepest_mm > gel.height_mm() {
            let problem = format!("is {}", settings.deepest_mm);
            let hint = format!("give no more than the gel's height, {:.2}", gel.height_mm());
            return Err(Problem::new("deepest_mm", problem, hint).into());
        }
        let tables = table::tables(&model, &gel, (&indenters, &taxels), settings.deepest_mm, progress)?;
        let inverse = Inverse::new(TableModel::new(tables), settings).map_err(refused)?;
        Ok(Self {
            model,
            gel,
            indenters,
            taxels,
            inverse,
        })
    }

    /// Estimates the contacts of a recording, frame by frame in their order. Presses of one
    /// mounting follow each other, because the gel remembers. A press begins untouched. An unusable
    /// reading is replaced by the taxel's last usable one.
    ///
    /// # Errors
    /// Recordings of another sensor; poses beside the gel.
    pub fn locate(&self, recording: &Recording) -> Result<Located, WorkError> {
        let record = &self.model.record;
        refuse_other_sensor(recording, self.gel.sensor())?;
        let recording = &*as_in_training(recording, record, &Silent)?;
        let trained_on: Vec<bool> = recording
            .presses
            .iter()
            .map(|press| record.trained_on.contains(&press_checksum(press)))
            .collect();
        let (mut presses, mut busy_s) = (Vec::new(), 0.0);
        let mut following: Option<LocatorTracker> = None;
        for (number, press) in recording.presses.iter().enumerate() {
            let before = number.checked_sub(1).map(|before| &recording.presses[before]);
            if !before.is_some_and(|before| follows(before, press)) {
                following = None;
            }
            let following = following.get_or_insert_with(|| self.start());
            following.sensor.tare();
            let truth = Truth::of(press, &record.bench, &self.gel)?;
            let start = Instant::now();
            let frames = (0..press.time_s.len())
                .map(|frame| self.frame(following, press, frame, &truth))
                .collect::<Result<_, InverseError>>()
                .map_err(|problem| WorkError::Input(format!("{}: {problem}", press.name)))?;
            busy_s += start.elapsed().as_secs_f64();
            presses.push(LocatedPress {
                name: press.name.clone(),
                mounting: press.mounting.clone(),
                trained_on: trained_on[number],
                frames,
            });
        }
        let n_frames: usize = presses.iter().map(|press| press.frames.len()).sum();
        Ok(Located {
            provenance: recording.provenance,
            sensor: recording.sensor.clone(),
            variant: record.variant,
            settings: *self.inverse.settings(),
            unseen: LocationErrors::of(&presses, false),
            trained_on: LocationErrors::of(&presses, true),
            presses,
            frame_ms: 1e3 * busy_s / n_frames.max(1) as f64,
        })
    }

    /// Names of the indenters that it distinguishes. The shape of a contact is an index into them.
    #[must_use]
    pub fn indenters(&self) -> &[String] {
        &self.indenters
    }

    /// Names of the taxels, in the order of readings.
    #[must_use]
    pub fn taxels(&self) -> &[String] {
        &self.model.record.taxels
    }

    /// Starts the estimation of a sensor that nothing touches yet, frame by frame.
    #[must_use]
    pub fn start(&self) -> LocatorTracker {
        LocatorTracker {
            taxels: self.taxels.clone(),
            sensor: self.model.twin.without_memory(),
            tracker: self.inverse.start(),
            before_s: None,
            usable_kpa: vec![0.0; self.model.record.taxels.len()],
            readings_kpa: vec![0.0; self.model.record.taxels.len()],
            read_kpa: vec![0.0; self.taxels.len()],
        }
    }

    fn frame(
        &self,
        following: &mut LocatorTracker,
        press: &Press,
        frame: usize,
        truth: &Truth,
    ) -> Result<LocatedFrame, InverseError> {
        let time_s = press.time_s[frame];
        let since_s = following.before_s.map_or(0.0, |before_s| time_s - before_s);
        following.before_s = Some(time_s);
        let contact = following.update(since_s, &press.taxels_kpa[frame], &press.valid[frame])?;
        let contact = contact.cloned();
        let found = contact.as_ref();
        Ok(LocatedFrame {
            time_s,
            indenter: found.map(|contact| self.indenters[contact.shape].clone()),
            place_mm: found.map(|contact| contact.place_mm.to_array()),
            place_deviation_mm: found.map(|contact| contact.place_deviation_mm.to_array()),
            depth_mm: found.map(|contact| contact.depth_mm),
            depth_deviation_mm: found.map(|contact| contact.depth_deviation_mm),
            force_n: found.map(|contact| contact.force_n),
            misfit: found.map(|contact| contact.misfit),
            true_place_mm: press.gel_from_indenter[frame].position_mm.truncate().to_array(),
            true_depth_mm: truth.depth_mm(press, frame),
            largest_kpa: following.read_kpa.iter().copied().fold(0.0, f64::max),
        })
    }
}

/// Estimates the contact of one sensor by its trained twin, frame by frame.
#[derive(Clone, Debug)]
pub struct LocatorTracker {
    sensor: WithoutMemory,
    tracker: Tracker<TableModel>,
    before_s: Option<f64>,
    usable_kpa: Vec<f64>,
    readings_kpa: Vec<f64>,
    /// Indices of the taxels that are used, and their readings.
    taxels: Vec<usize>,
    read_kpa: Vec<f64>,
}

impl LocatorTracker {
    /// Takes a frame, `since_s` after the one before: readings above the untouched sensor, kPa, and
    /// whether each is usable; `[n_taxels]` both. An unusable reading is replaced by the taxel's
    /// last usable one. Returns the contact, or `None` if the readings are within noise.
    ///
    /// # Errors
    /// Another number of readings; a time that is not finite or negative. The state is then
    /// unchanged.
    pub fn update(
        &mut self,
        since_s: f64,
        readings_kpa: &[f64],
        valid: &[bool],
    ) -> Result<Option<&Contact>, InverseError> {
        let n_taxels = self.usable_kpa.len();
        if [readings_kpa.len(), valid.len()] != [n_taxels; 2] {
            let problem = format!("has {} readings", readings_kpa.len());
            let hint = format!("give one of each of {n_taxels} taxels");
            return Err(InverseError::Frame(Problem::new("readings_kpa", problem, hint)));
        }
        if !(since_s >= 0.0 && since_s.is_finite()) {
            let problem = Problem::new("since_s", format!("is {since_s}"), "give 0 or more");
            return Err(InverseError::Frame(problem));
        }
        for ((usable, reading), valid) in self.usable_kpa.iter_mut().zip(readings_kpa).zip(valid) {
            if *valid && reading.abs() <= LARGEST_READING_KPA {
                *usable = *reading;
            }
        }
        self.readings_kpa.copy_from_slice(&self.usable_kpa);
        self.sensor.step(since_s, &mut self.readings_kpa);
        for (read, taxel) in self.read_kpa.iter_mut().zip(&self.taxels) {
            *read = self.readings_kpa[*taxel];
        }
        let contact = self.tracker.update(since_s, &self.read_kpa)?;
        if contact.is_none() {
            self.sensor.settle((since_s / ZERO_S).min(1.0));
        }
        Ok(contact)
    }
}

/// The true position of the indenter of a press.
struct Truth {
    /// Height of first contact, where depths count from, mm.
    zero_z_mm: Option<f64>,
}

impl Truth {
    fn of(press: &Press, bench: &BenchEstimate, gel: &Gel) -> Result<Self, WorkError> {
        let Some(pose) = press.gel_from_indenter.first() else {
            return Ok(Self { zero_z_mm: None });
        };
        let zero_z_mm = match press.control {
            Control::Force => None,
            Control::Pose => {
                let touch = DepthTableSource::touch(gel, &press.indenter, pose)?;
                Some(touch.position_mm.z + bench.contact_offset_mm(&press.mounting))
            }
        };
        Ok(Self { zero_z_mm })
    }

    fn depth_mm(&self, press: &Press, frame: usize) -> Option<f64> {
        let z_mm = press.gel_from_indenter[frame].position_mm.z;
        self.zero_z_mm.map(|zero_z_mm| zero_z_mm - z_mm)
    }
}

/// Whether a press continues the clock and the gel's history of the one before.
fn follows(before: &Press, press: &Press) -> bool {
    let ended_s = before.time_s.last();
    let started_s = press.time_s.first();
    before.mounting == press.mounting
        && matches!((ended_s, started_s), (Some(ended_s), Some(started_s)) if ended_s < started_s)
}
