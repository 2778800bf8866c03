//! The twin's elastic readings at locations and depths all over its gel.

use std::collections::BTreeMap;

use digitac::{BenchEstimate, Model, TwinAtPlace};
use glam::DVec2;
use rayon::prelude::*;
use twintac_depth_table::{DepthTable, DepthTableRequest, DepthTableSource, Lattice};
use twintac_inverse::ReadingTable;
use twintac_shape::Pose;
use twintac_simulate::Gel;
use twintac_tables::DepthTableStore;
use twintac_work::{Progress, Work, WorkError};

/// Largest distance of a location from the taxels, and smallest distance from the gel's edges, in
/// gel heights.
const FARTHEST: f64 = 1.5;
const NEAREST: f64 = 0.5;

/// Spacing of the solved locations in gel heights, along a line and over a plane.
const SPACINGS: [f64; 2] = [1.0 / 4.0, 1.0 / 3.0];

/// Spacing of the table's locations and depths, mm.
const PLACE_STEP_MM: f64 = 0.5;
const DEPTH_STEP_MM: f64 = 0.05;

/// A table for each of the named indenters, of the taxels that are used.
pub(super) fn tables(
    model: &Model,
    gel: &Gel,
    (indenters, taxels): (&[String], &[usize]),
    deepest_mm: f64,
    progress: &dyn Progress,
) -> Result<Vec<ReadingTable>, WorkError> {
    let [low, high] = places(gel, taxels);
    let is_plane = (high - low).min_element() > 0.0;
    let lattice = Lattice::covering(low, high, SPACINGS[usize::from(is_plane)] * gel.height_mm());
    let _work = Work::start(progress, "simulating", 0);
    let store = DepthTableStore::of(gel.clone(), progress)?;
    indenters
        .iter()
        .map(|indenter| {
            let solved = solve(model, &store, indenter, &lattice, deepest_mm)?;
            let at = |place_mm| lattice.at(&solved, place_mm);
            readings(model, &at, [low, high], taxels)
        })
        .collect()
}

/// Corners of the rectangle of possible locations, mm. For taxels in one row the rectangle is a
/// line.
fn places(gel: &Gel, taxels: &[usize]) -> [DVec2; 2] {
    let sensor = gel.sensor();
    let (bottom, top) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
    let own = || {
        taxels
            .iter()
            .map(|taxel| sensor.taxels[*taxel].position_mm.truncate())
    };
    let low = own().reduce(DVec2::min).unwrap_or_default();
    let high = own().reduce(DVec2::max).unwrap_or_default();
    let is_wide = (high - low).cmpgt(DVec2::ZERO);
    let farther = |way: f64, corner: DVec2| {
        let to = corner + way * FARTHEST * gel.height_mm();
        let inside = NEAREST * gel.height_mm();
        let to = to.clamp(bottom.truncate() + inside, top.truncate() - inside);
        DVec2::select(is_wide, to, corner)
    };
    [farther(-1.0, low), farther(1.0, high)]
}

fn solve(
    model: &Model,
    store: &DepthTableStore<'_>,
    indenter: &str,
    lattice: &Lattice,
    deepest_mm: f64,
) -> Result<Vec<DepthTable>, WorkError> {
    let tip_radius_mm = model.record.bench.tip_radius_mm.map(|radius| radius.value);
    let request = |place: DVec2| {
        let touch = store.touch(indenter, &Pose::from_position(place.extend(0.0)))?;
        Ok::<_, WorkError>(DepthTableRequest {
            indenter: indenter.to_owned(),
            gel_from_indenter_at_touch: touch,
            max_depth_mm: deepest_mm,
            enough_force_n: None,
            tip_radius_mm,
        })
    };
    let requests = lattice
        .places_mm()
        .into_iter()
        .map(request)
        .collect::<Result<Vec<_>, _>>();
    Ok(store.depth_tables(&requests?)?)
}

/// The twin's elastic readings at each location, down to the depth that the tables of all locations
/// reach.
fn readings(
    model: &Model,
    at: &(dyn Fn(DVec2) -> DepthTable + Sync),
    [low, high]: [DVec2; 2],
    taxels: &[usize],
) -> Result<ReadingTable, WorkError> {
    let steps = ((high - low) / PLACE_STEP_MM).ceil();
    let step_mm = (high - low) / steps.max(DVec2::ONE);
    let [n_x, n_y] = steps.to_array().map(|steps| steps as usize + 1);
    let places: Vec<DVec2> = (0..n_y)
        .flat_map(|j| (0..n_x).map(move |i| low + step_mm * DVec2::new(i as f64, j as f64)))
        .collect();
    // Depths count from first contact, whatever the mounting.
    let bench = BenchEstimate {
        contact_offset_mm: BTreeMap::new(),
        contact_offset_elsewhere_mm: 0.0,
        ..model.record.bench.clone()
    };
    let twin_at = |place: &DVec2| Ok(TwinAtPlace::new(&model.twin, &at(*place), &bench, "")?);
    let twins: Vec<TwinAtPlace> = places.par_iter().map(twin_at).collect::<Result<_, WorkError>>()?;
    let deepest_mm = twins
        .iter()
        .map(TwinAtPlace::max_depth_mm)
        .fold(f64::INFINITY, f64::min);
    let n_depths = (deepest_mm / DEPTH_STEP_MM).ceil() as usize + 1;
    let depth_step_mm = deepest_mm / (n_depths as f64 - 1.0);
    let mut readings_kpa = vec![Vec::new(); n_depths * places.len()];
    let mut force_n = vec![0.0; n_depths * places.len()];
    let mut all_kpa = vec![0.0; model.record.taxels.len()];
    for (place, mut twin) in twins.into_iter().enumerate() {
        for depth in 0..n_depths {
            twin.rest();
            twin.step(0.0, depth as f64 * depth_step_mm, &mut all_kpa);
            let node = depth * places.len() + place;
            readings_kpa[node] = taxels.iter().map(|taxel| all_kpa[*taxel]).collect();
            force_n[node] = bench.stiffness() * twin.force_n();
        }
    }
    // An axis with one node is not estimated; its step is not used.
    let along = |step: f64| if step > 0.0 { step } else { 1.0 };
    Ok(ReadingTable {
        first_mm: [low.x, low.y, 0.0],
        step_mm: [along(step_mm.x), along(step_mm.y), depth_step_mm],
        n: [n_x, n_y, n_depths],
        readings_kpa,
        force_n,
    })
}
