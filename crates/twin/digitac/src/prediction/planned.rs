//! Predicted readings along planned presses.

use glam::DVec3;
use serde::{Deserialize, Serialize};
use twintac_depth_table::{DepthTable, DepthTableSource};
use twintac_protocol::PressPlan;
use twintac_recording::{Control, Press, Provenance, Recording};
use twintac_shape::Pose;

use crate::{
    BenchEstimate, Certainty, Contact, DigitacError, Features, PlaceSettings, Places, PressCertainty, Twin,
    TwinAtPlace, features,
};

/// Predicted readings along a press. All vectors have the same length, `n_frames`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Prediction {
    /// The press's name.
    pub name: String,
    /// The indenter's name.
    pub indenter: String,
    /// Time since the start of the press, s.
    pub time_s: Vec<f64>,
    /// Location of the indenter's origin in the gel's plane, mm; `[n_frames][2]`.
    pub place_mm: Vec<[f64; 2]>,
    /// Depth below first touch, mm, with the contact height of the recordings' test setup; negative
    /// above the gel.
    pub depth_mm: Vec<f64>,
    /// Force of the indenter on the gel, N.
    pub force_n: Vec<f64>,
    /// Predicted readings above those without contact, kPa; `[n_frames][n_taxels]`.
    pub readings_kpa: Vec<Vec<f64>>,
    /// Whether the frame was simulated: it is not deeper than the gel could be pressed in the
    /// simulation. The last simulated pressures are used for deeper frames.
    pub simulated: Vec<bool>,
    /// Uncertainty of the readings; `None` for a twin without intervals.
    pub certainty: Option<PressCertainty>,
}

/// Steps a twin along planned presses, each from rest, at a frame rate. The gel at their locations
/// comes from `source`, and `bench` is the estimate of the test setup. `certainty` gives the
/// uncertainty.
///
/// # Errors
/// An indenter that the source does not know; a location that it cannot press.
pub fn predict(
    (twin, certainty): (&Twin, Option<&Certainty>),
    bench: &BenchEstimate,
    source: &dyn DepthTableSource,
    plans: &[PressPlan],
    rate_hz: f64,
) -> Result<Vec<Prediction>, DigitacError> {
    let unread = unread(twin, source, plans, rate_hz)?;
    along((twin, certainty), bench, source, plans, &unread)
}

/// The planned presses in the form of recorded ones, without readings.
fn unread(
    twin: &Twin,
    source: &dyn DepthTableSource,
    plans: &[PressPlan],
    rate_hz: f64,
) -> Result<Recording, DigitacError> {
    let n_taxels = twin.taxels().len();
    let made = |plan: &PressPlan| Ok(unread_press(plan, &plan.trajectory(rate_hz), source, n_taxels)?.0);
    let made: Result<_, DigitacError> = plans.iter().map(made).collect();
    Ok(recording(twin, made?))
}

/// Steps a twin along the presses of a recording, which are those of `plans`.
fn along(
    (twin, certainty): (&Twin, Option<&Certainty>),
    bench: &BenchEstimate,
    source: &dyn DepthTableSource,
    plans: &[PressPlan],
    recording: &Recording,
) -> Result<Vec<Prediction>, DigitacError> {
    let n_taxels = twin.taxels().len();
    let (places, tables) = simulate(recording, bench, source)?;
    let along = features(recording, &places, &tables, bench)?;
    let contacts = match certainty {
        Some(_) => Contact::of_places(&places, source)?,
        None => Vec::new(),
    };
    let mut state = twin.state();
    state.tare_untouched();
    let predict = |(press, (plan, along)): (usize, (&PressPlan, Features))| {
        state.rest(0);
        let mut before_s = 0.0;
        let seen = twin.physics().seen(&along).iter().zip(&along.time_s);
        let readings_kpa = seen.map(|(seen, time_s)| {
            let mut readings_kpa = vec![0.0; n_taxels];
            state.step(time_s - before_s, seen, &mut readings_kpa);
            before_s = *time_s;
            readings_kpa
        });
        let readings_kpa: Vec<Vec<f64>> = readings_kpa.collect();
        let contact = |_| &contacts[places.of_press[press]];
        Prediction {
            certainty: certainty
                .map(|certainty| certainty.along(contact, &along.time_s, &along.depth_mm, &readings_kpa)),
            readings_kpa,
            name: plan.name.clone(),
            indenter: plan.indenter.clone(),
            place_mm: vec![[plan.x_mm, plan.y_mm]; along.n_frames()],
            time_s: along.time_s,
            depth_mm: along.depth_mm,
            force_n: along.force_n,
            simulated: along.simulated,
        }
    };
    Ok(plans.iter().zip(along).enumerate().map(predict).collect())
}

/// As [`predict`], in the form of a recording, for code that learns from recordings. Readings are
/// those of the twin. Frames that were not simulated count as unusable.
///
/// # Errors
/// Those of [`predict`].
pub fn simulated_recording(
    twin: &Twin,
    bench: &BenchEstimate,
    source: &dyn DepthTableSource,
    plans: &[PressPlan],
    rate_hz: f64,
) -> Result<Recording, DigitacError> {
    let n_taxels = twin.taxels().len();
    let unread = unread(twin, source, plans, rate_hz)?;
    let predictions = along((twin, None), bench, source, plans, &unread)?;
    let press = |(unread, predicted): (Press, Prediction)| {
        let usable = predicted
            .simulated
            .iter()
            .map(|simulated| vec![*simulated; n_taxels]);
        Press {
            force_n: Some(predicted.force_n),
            valid: usable.collect(),
            temperature_c: None,
            taxels_raw: predicted.readings_kpa.clone(),
            taxels_kpa: predicted.readings_kpa,
            ..unread
        }
    };
    let presses = unread.presses.into_iter().zip(predictions).map(press);
    Ok(recording(twin, presses.collect()))
}

/// A twin without contact, at the location of a planned press and down to its depth. The gel there
/// comes from `source`, and `bench` is the estimate of the test setup. `certainty` gives the
/// uncertainty.
///
/// # Errors
/// An indenter that the source does not know; a location that it cannot press.
pub fn at_place(
    (twin, certainty): (&Twin, Option<&Certainty>),
    bench: &BenchEstimate,
    source: &dyn DepthTableSource,
    plan: &PressPlan,
) -> Result<TwinAtPlace, DigitacError> {
    let (deepest, _) = unread_press(plan, &[(0.0, plan.depth_mm)], source, twin.taxels().len())?;
    let (places, tables) = simulate(&recording(twin, vec![deepest]), bench, source)?;
    let table = tables.first().ok_or(DigitacError::DepthTableCount {
        expected: 1,
        found: 0,
    })?;
    let twin = TwinAtPlace::new(twin, table, bench, &plan.indenter)?;
    Ok(match certainty {
        Some(certainty) => {
            let contact = Contact::of_places(&places, source)?.swap_remove(0);
            twin.with_certainty(certainty, contact)
        }
        None => twin,
    })
}

fn simulate(
    recording: &Recording,
    bench: &BenchEstimate,
    source: &dyn DepthTableSource,
) -> Result<(Places, Vec<DepthTable>), DigitacError> {
    let places = Places::of(recording, source, &PlaceSettings::default())?.at_bench(bench);
    let tables = source.depth_tables(&places.requests);
    Ok((places, tables.map_err(DigitacError::Simulation)?))
}

fn recording(twin: &Twin, presses: Vec<Press>) -> Recording {
    Recording {
        sensor: String::new(),
        provenance: Provenance::Simulated,
        taxels: twin.taxels().to_vec(),
        presses,
    }
}

/// A planned press in the form of a recorded one, without readings, and the pose of the indenter at
/// first touch. `trajectory` has time, s, and depth below first touch, mm.
///
/// # Errors
/// An indenter that the source does not know; a location where it misses the gel.
pub fn unread_press(
    plan: &PressPlan,
    trajectory: &[(f64, f64)],
    source: &dyn DepthTableSource,
    n_taxels: usize,
) -> Result<(Press, Pose), DigitacError> {
    let above = Pose {
        position_mm: DVec3::new(plan.x_mm, plan.y_mm, 0.0),
        rotation: plan.rotation,
    };
    let touch = source
        .touch(&plan.indenter, &above)
        .map_err(DigitacError::Simulation)?;
    let pose = |depth_mm: f64| Pose {
        position_mm: touch.position_mm - depth_mm * DVec3::Z,
        ..touch
    };
    let unread = vec![vec![0.0; n_taxels]; trajectory.len()];
    let press = Press {
        name: plan.name.clone(),
        mounting: plan.indenter.clone(),
        indenter: plan.indenter.clone(),
        control: Control::Pose,
        time_s: trajectory.iter().map(|(time_s, _)| *time_s).collect(),
        gel_from_indenter: trajectory.iter().map(|(_, depth_mm)| pose(*depth_mm)).collect(),
        force_n: None,
        taxels_kpa: unread.clone(),
        temperature_c: None,
        taxels_raw: unread,
        valid: vec![vec![false; n_taxels]; trajectory.len()],
    };
    Ok((press, touch))
}
