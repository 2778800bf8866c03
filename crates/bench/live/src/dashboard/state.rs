//! Everything that the dashboard shows.

use std::collections::VecDeque;

use twintac_map::{MapSettings, PreparedMap};
use twintac_source::{Reading, Tally};

use crate::{About, LiveError, Tare, Taring};

/// Number of frames that a trace keeps.
const HISTORY: usize = 600;
/// Columns and rows of the map.
const GRID: [usize; 2] = [128, 64];
/// Factor by which a touch must be stronger than the one for which the Gaussians' width was chosen,
/// so that the width is chosen again.
const STRONGER: f64 = 1.25;
/// Touches below this pressure are not used to choose a width, kPa.
const WEAK_KPA: f64 = 0.5;

/// Everything that the dashboard shows.
#[derive(Clone, Debug)]
pub struct DashboardState {
    /// The sensor.
    pub about: About,
    /// The newest frame.
    pub latest: Option<Reading>,
    /// Pressure above the tare of each taxel, kPa, the newest last.
    pub traces_kpa: Vec<VecDeque<Option<f64>>>,
    /// Counts of the frames.
    pub tally: Tally,
    /// The recording in progress, if there is one.
    pub recording: Option<RecordingStatus>,
    /// A message for the user.
    pub message: String,
    /// The map of [`refresh`](Self::refresh), kPa, on the grid of [`prepared`](Self::prepared).
    pub map_kpa: Vec<f64>,
    /// The prepared interpolation of maps.
    pub prepared: PreparedMap,
    tare: Tare,
    taring: Option<Taring>,
    /// Whether the user was told that the temperature of chips has changed since the tare.
    was_warned: bool,
    /// Times of the frames that the traces keep, s.
    times_s: VecDeque<f64>,
    strongest_kpa: f64,
}

/// A recording in progress, as it is shown.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct RecordingStatus {
    /// Its file.
    pub file: String,
    /// Frames so far.
    pub frames: u64,
}

impl DashboardState {
    /// The state before the first frame. The first frames make a tare.
    ///
    /// # Errors
    /// [`LiveError::Map`]: two taxels have the same position.
    pub fn new(about: About) -> Result<Self, LiveError> {
        let prepared = prepare(&about, &[])?;
        let (n, kpa_per_k) = (about.taxels.len(), about.kpa_per_k.clone());
        Ok(Self {
            about,
            latest: None,
            traces_kpa: vec![VecDeque::with_capacity(HISTORY); n],
            tally: Tally::default(),
            recording: None,
            message: TARING.to_owned(),
            map_kpa: vec![0.0; GRID[0] * GRID[1]],
            prepared,
            tare: Tare::default(),
            taring: Some(Taring::new(kpa_per_k)),
            was_warned: false,
            times_s: VecDeque::with_capacity(HISTORY),
            strongest_kpa: 0.0,
        })
    }

    /// Takes the next frame.
    pub fn push(&mut self, reading: Reading) {
        if let Some(tare) = self.taring.as_mut().and_then(|taring| taring.push(&reading)) {
            (self.tare, self.taring) = (tare, None);
            self.message = "tare taken".to_owned();
        }
        let mut above_kpa = self.tare.above_kpa(&reading);
        above_kpa.resize(self.traces_kpa.len(), None); // before the first tare
        for (trace, above_kpa) in self.traces_kpa.iter_mut().zip(above_kpa) {
            keep(trace, above_kpa);
        }
        if !self.was_warned
            && let Some(remark) = self.tare.remark()
        {
            (self.message, self.was_warned) = (remark, true);
        }
        keep(&mut self.times_s, reading.bench_s);
        self.latest = Some(reading);
    }

    /// Computes the map of the newest frame from the taxels that have a reading; NaN if none has.
    /// The width of its Gaussians is chosen by leaving each taxel out in turn, on the strongest
    /// touch so far.
    ///
    /// # Errors
    /// [`LiveError::Map`].
    pub fn refresh(&mut self) -> Result<(), LiveError> {
        let above_kpa = self.above_kpa();
        let field: Vec<f64> = above_kpa.iter().map(|above| above.unwrap_or(f64::NAN)).collect();
        let strength_kpa = field.iter().copied().fold(0.0, f64::max);
        let is_whole = above_kpa.iter().all(Option::is_some);
        if is_whole && strength_kpa > WEAK_KPA.max(STRONGER * self.strongest_kpa) {
            self.strongest_kpa = strength_kpa;
            self.prepared = prepare(&self.about, &[&field])?;
        }
        self.prepared.fill(&field, &mut self.map_kpa)?;
        Ok(())
    }

    /// Takes a tare of the next frames.
    pub fn tare(&mut self) {
        self.taring = Some(Taring::new(self.about.kpa_per_k.clone()));
        self.was_warned = false;
        self.message = TARING.to_owned();
    }

    /// The newest pressures above the tare, kPa.
    #[must_use]
    pub fn above_kpa(&self) -> Vec<Option<f64>> {
        let newest = |trace: &VecDeque<Option<f64>>| trace.back().copied().flatten();
        self.traces_kpa.iter().map(newest).collect()
    }

    /// Frames per second, Hz, over the time of the traces.
    #[must_use]
    pub fn rate_hz(&self) -> Option<f64> {
        let (first_s, last_s) = (self.times_s.front()?, self.times_s.back()?);
        (last_s > first_s).then(|| (self.times_s.len() - 1) as f64 / (last_s - first_s))
    }

    /// Mean temperature of the taxels that have one, °C.
    #[must_use]
    pub fn temperature_c(&self) -> Option<f64> {
        let taxels = &self.latest.as_ref()?.frame.taxels;
        let known: Vec<f64> = taxels.iter().filter_map(|taxel| taxel.temperature_c).collect();
        (!known.is_empty()).then(|| known.iter().sum::<f64>() / known.len() as f64)
    }

    /// The name of each taxel's fault in the newest frame.
    #[must_use]
    pub fn faults(&self) -> Vec<Option<&'static str>> {
        let Some(latest) = &self.latest else {
            return vec![None; self.about.taxels.len()];
        };
        latest
            .frame
            .taxels
            .iter()
            .map(|taxel| taxel.state.fault())
            .collect()
    }

    /// Upper end of colours and traces: the largest pressure in the traces, at least 1 kPa.
    #[must_use]
    pub fn scale_kpa(&self) -> f64 {
        let all = self.traces_kpa.iter().flatten().flatten();
        all.copied().fold(1.0, f64::max)
    }
}

const TARING: &str = "taking a tare: leave the sensor untouched";

fn prepare(about: &About, fields_kpa: &[&[f64]]) -> Result<PreparedMap, LiveError> {
    let settings = MapSettings {
        grid: GRID,
        ..MapSettings::default()
    };
    Ok(PreparedMap::new(
        &about.places_mm,
        about.window(),
        &settings,
        fields_kpa,
    )?)
}

fn keep<T>(history: &mut VecDeque<T>, newest: T) {
    if history.len() == HISTORY {
        history.pop_front();
    }
    history.push_back(newest);
}
