//! Contact estimation on a press in steps that are held.

use std::error::Error;
use std::time::Instant;

use glam::DVec2;
use twintac_fast::{FastGel, FastReader};
use twintac_inverse::{Contact, FastModel, Inverse};
use twintac_map::{MapSettings, PreparedMap, Rectangle};
use twintac_random::{normal, stream};
use twintac_sensor::Sensor;

use crate::presses::Solved;

/// Frames per second, and the number of frames for which a step is held.
const RATE_HZ: f64 = 100.0;
const HELD: usize = 20;

/// Noise of the readings, kPa.
const NOISE_KPA: f64 = 0.05;

/// Spacing of a map's points, mm.
const SPACING_MM: f64 = 0.5;

/// Estimated and true values at the end of a held step.
pub(crate) struct Watched {
    pub(crate) shape: usize,
    pub(crate) told: usize,
    /// Step of the press, from 0.
    pub(crate) step: usize,
    pub(crate) is_over_taxels: bool,
    pub(crate) place_error_mm: f64,
    /// Errors over the estimated deviations: x, y, depth, force.
    pub(crate) over_deviation: [f64; 4],
    pub(crate) depth_mm: f64,
    pub(crate) depth_percent: f64,
    pub(crate) force_percent: f64,
    /// Distance from the true location to the largest value of the interpolated map, mm.
    pub(crate) peak_error_mm: f64,
    /// Root mean square error over the base of the gel, % of its largest pressure: of the contact's
    /// map, and of the interpolated one.
    pub(crate) floor_percent: [f64; 2],
}

/// Sensor, models and maps for the evaluation.
pub(crate) struct Evaluator {
    taxels_mm: Vec<DVec2>,
    places_mm: Vec<DVec2>,
    height_mm: f64,
    floor: FastReader,
    map: PreparedMap,
    /// For each frame: computing time, s, and whether it was the first in contact.
    times: Vec<(f64, bool)>,
}

impl Evaluator {
    pub(crate) fn new(
        sensor: &Sensor,
        gel: &FastGel,
        places_mm: &[DVec2],
    ) -> Result<Self, Box<dyn Error + Send + Sync>> {
        let taxels_mm: Vec<DVec2> = sensor
            .taxels
            .iter()
            .map(|taxel| taxel.position_mm.truncate())
            .collect();
        let (low, high) = sensor.gel.solid.bounds_mm(&sensor.surfaces);
        let rectangle = Rectangle {
            min_mm: [low.x, low.y],
            max_mm: [high.x, high.y],
        };
        let cells = (high - low).truncate() / SPACING_MM;
        let settings = MapSettings {
            grid: [cells.x as usize, cells.y as usize],
            ..MapSettings::default()
        };
        let at: Vec<[f64; 2]> = taxels_mm.iter().map(|at| at.to_array()).collect();
        let places_mm = places_mm[taxels_mm.len()..].to_vec();
        Ok(Self {
            map: PreparedMap::new(&at, rectangle, &settings, &[])?,
            floor: gel.with_ports(&places_mm)?.reader(),
            height_mm: high.z,
            taxels_mm,
            places_mm,
            times: Vec::new(),
        })
    }

    /// Evaluates one press. `shape` is its index among the known shapes.
    pub(crate) fn watch(
        &mut self,
        number: usize,
        press: &Solved,
        inverse: &Inverse<FastModel>,
        shape: usize,
    ) -> Result<Vec<Watched>, Box<dyn Error + Send + Sync>> {
        let random = &mut stream(1, &format!("noise of press {number}"));
        let mut tracker = inverse.start();
        let mut watched = Vec::new();
        let is_timed = inverse.n_shapes() > 1;
        let mut is_first = true;
        for (step, frame) in press.solved.frames.iter().enumerate() {
            let n_taxels = self.taxels_mm.len();
            let mut last = (Vec::new(), None);
            for _ in 0..HELD {
                let true_kpa = frame.floor_kpa[..n_taxels].iter();
                let readings_kpa: Vec<f64> = true_kpa
                    .map(|true_kpa| f64::from(*true_kpa) + normal(random, NOISE_KPA))
                    .collect();
                let start = Instant::now();
                let contact = tracker.update(1.0 / RATE_HZ, &readings_kpa)?;
                let seconds = start.elapsed().as_secs_f64();
                if is_timed && contact.is_some() {
                    self.times.push((seconds, is_first));
                    is_first = false;
                }
                last = (readings_kpa, contact.cloned());
            }
            if let (readings_kpa, Some(contact)) = last {
                let force_n = -frame.force_n.z;
                let depth_mm = self.height_mm - frame.gel_from_indenter.position_mm.z;
                let truth = [press.place_mm.x, press.place_mm.y, depth_mm, force_n];
                let maps = self.maps(&readings_kpa, &contact, inverse, &frame.floor_kpa[n_taxels..])?;
                let mut found = errors(&contact, truth, step, maps);
                found.shape = shape;
                found.peak_error_mm = maps.0.distance(press.place_mm);
                let [low, high] = [self.taxels_mm[0], self.taxels_mm[n_taxels - 1]];
                found.is_over_taxels = press.place_mm.cmpge(low).all() && press.place_mm.cmple(high).all();
                watched.push(found);
            }
        }
        Ok(watched)
    }

    /// The location of the largest value of the interpolated map, and the errors of both maps of
    /// the base.
    fn maps(
        &mut self,
        readings_kpa: &[f64],
        contact: &Contact,
        inverse: &Inverse<FastModel>,
        true_kpa: &[f32],
    ) -> Result<(DVec2, [f64; 2]), Box<dyn Error + Send + Sync>> {
        let mut map_kpa = Vec::new();
        self.map.fill(readings_kpa, &mut map_kpa)?;
        let [columns, _] = self.map.grid();
        let low = DVec2::from(self.map.rectangle().min_mm);
        let peak = (0..map_kpa.len())
            .max_by(|a, b| map_kpa[*a].total_cmp(&map_kpa[*b]))
            .unwrap_or(0);
        let peak = DVec2::new((peak % columns) as f64, (peak / columns) as f64);
        let (body, position_mm) = inverse.model().placed(contact);
        let mut own_kpa = vec![0.0; self.places_mm.len()];
        self.floor
            .read(&[(body, position_mm)], &mut own_kpa, &mut [0.0; 6]);
        let largest = f64::from(true_kpa.iter().copied().fold(f32::MIN_POSITIVE, f32::max));
        let percent = |found: &dyn Fn(usize) -> f64| {
            let square = (0..true_kpa.len())
                .map(|i| (found(i) - f64::from(true_kpa[i])).powi(2))
                .sum::<f64>();
            100.0 * (square / true_kpa.len() as f64).sqrt() / largest
        };
        let of_map = |i: usize| {
            let cell = ((self.places_mm[i] - low) / SPACING_MM).floor().as_uvec2();
            map_kpa[cell.y as usize * columns + cell.x as usize]
        };
        let floor_percent = [percent(&|i| f64::from(own_kpa[i])), percent(&of_map)];
        Ok((low + SPACING_MM * (peak + 0.5), floor_percent))
    }

    /// Computing time of a frame, µs: median, 99th percentile, and the median of first frames in
    /// contact.
    pub(crate) fn microseconds(&self) -> [f64; 3] {
        let sorted = |is_first: bool| {
            let times = self.times.iter().filter(|(_, first)| *first == is_first);
            let mut times: Vec<f64> = times.map(|(seconds, _)| 1e6 * seconds).collect();
            times.sort_by(f64::total_cmp);
            times
        };
        let (on, first) = (sorted(false), sorted(true));
        let at = |times: &[f64], part: f64| {
            times
                .get((part * times.len() as f64) as usize)
                .copied()
                .unwrap_or(0.0)
        };
        [at(&on, 0.5), at(&on, 0.99), at(&first, 0.5)]
    }
}

fn errors(contact: &Contact, truth: [f64; 4], step: usize, (_, floor_percent): (DVec2, [f64; 2])) -> Watched {
    let [x, y, depth_mm, force_n] = truth;
    let error = contact.place_mm - DVec2::new(x, y);
    let deviation = contact.place_deviation_mm;
    Watched {
        shape: 0,
        told: contact.shape,
        step,
        is_over_taxels: false,
        place_error_mm: error.length(),
        over_deviation: [
            error.x / deviation.x,
            error.y / deviation.y,
            (contact.depth_mm - depth_mm) / contact.depth_deviation_mm,
            (contact.force_n - force_n) / contact.force_deviation_n,
        ],
        depth_mm,
        depth_percent: 100.0 * (contact.depth_mm / depth_mm - 1.0).abs(),
        force_percent: 100.0 * (contact.force_n / force_n - 1.0).abs(),
        peak_error_mm: 0.0,
        floor_percent,
    }
}
