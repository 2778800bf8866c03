//! Where to begin: readings of a shape at presses all over its domain. The best of these presses
//! are near the one that is sought.

use rayon::prelude::*;

use crate::error::InverseError;
use crate::model::{ContactModel, N, Press};
use crate::turn::nearest;

/// Spacing of the locations, mm.
const SPACING_MM: f64 = 2.0;

/// Spacing of the yaw angles, radians.
const SPIN_RAD: f64 = 0.3;

/// Depths, as fractions of the largest depth.
const DEPTHS: [f64; 6] = [0.04, 0.1, 0.2, 0.36, 0.6, 0.9];

/// Smallest and largest strength of a starting press relative to the press of the table from which
/// it is made.
const STRENGTHS: [f32; 2] = [0.5, 2.0];

/// Readings grow roughly with this power of depth: it lies between those of a flat punch and of a
/// ball (Hertz).
const POWER: f64 = 1.3;

/// Presses closer than this are one start, mm.
const APART_MM: f64 = 4.0;

/// Largest number of values of a table: 1 GB of memory.
const MOST_NUMBERS: f64 = 2.5e8;

/// Readings are padded with zeros to a multiple of this number.
pub(crate) const LANES: usize = 8;

/// The readings of one shape.
#[derive(Clone, Debug)]
pub(crate) struct Starts {
    presses: Vec<[f64; N]>,
    /// Readings, kPa; `[n_presses][n_padded]`.
    readings_kpa: Vec<f32>,
    n_padded: usize,
    turn_rad: Option<f64>,
    ranges: [[f64; 2]; N],
}

impl Starts {
    pub(crate) fn of<M: ContactModel>(model: &M, shape: usize) -> Result<Self, InverseError> {
        let domain = model.domain(shape);
        let ranges = domain.ranges();
        let n_readings = model.n_readings();
        let n_padded = n_readings.next_multiple_of(LANES);
        let places = [0, 1].map(|axis| 1.0 + (ranges[axis][1] - ranges[axis][0]).max(0.0) / SPACING_MM);
        let n_yaws = domain
            .turn_rad
            .map_or(1.0, |turn_rad| (turn_rad / SPIN_RAD).ceil());
        let n_presses = places[0] * places[1] * n_yaws * DEPTHS.len() as f64;
        if n_presses * n_padded as f64 > MOST_NUMBERS {
            return Err(InverseError::TooLarge {
                presses: n_presses,
                readings: n_readings,
                most: MOST_NUMBERS,
            });
        }
        let [xs, ys] = [0, 1].map(|axis| evenly(ranges[axis], SPACING_MM));
        let yaws = match domain.turn_rad {
            None => vec![0.0],
            Some(turn_rad) => {
                let n = (turn_rad / SPIN_RAD).ceil();
                (0..n as usize).map(|yaw| yaw as f64 * turn_rad / n).collect()
            }
        };
        let [least_mm, most_mm] = ranges[2];
        let depths: Vec<f64> = if most_mm > least_mm {
            DEPTHS.iter().map(|part| least_mm.max(part * most_mm)).collect()
        } else {
            vec![most_mm]
        };
        let mut presses = Vec::new();
        for x in &xs {
            for y in &ys {
                for depth in &depths {
                    presses.extend(yaws.iter().map(|yaw| [*x, *y, *depth, *yaw]));
                }
            }
        }
        let mut readings_kpa = vec![0.0; presses.len() * n_padded];
        readings_kpa
            .par_chunks_exact_mut(n_padded)
            .zip(&presses)
            .for_each_init(
                || model.clone(),
                |model, (readings_kpa, at)| {
                    model.read(shape, &Press::of(*at), &mut readings_kpa[..n_readings]);
                },
            );
        Ok(Self {
            presses,
            readings_kpa,
            n_padded,
            turn_rad: domain.turn_rad,
            ranges,
        })
    }

    /// Number of presses in the table.
    pub(crate) fn len(&self) -> usize {
        self.presses.len()
    }

    /// The best presses that are apart from each other, best first. `weighted` has the readings
    /// times the square roots of their weights, and `roots` these square roots; both `[n_padded]`.
    /// `costs` is scratch memory.
    pub(crate) fn best(
        &self,
        weighted: &[f32],
        roots: &[f32],
        costs: &mut Vec<f32>,
        n_starts: usize,
        starts: &mut Vec<[f64; N]>,
    ) {
        let square: f32 = weighted.iter().map(|value| value * value).sum();
        costs.clear();
        let rows = self.readings_kpa.chunks_exact(self.n_padded);
        costs.extend(rows.map(|row| {
            let (product, own) = products(weighted, roots, row);
            let strength = strength(product, own);
            square - 2.0 * strength * product + strength * strength * own
        }));
        starts.clear();
        while starts.len() < n_starts {
            let apart = |at: &[f64; N]| starts.iter().all(|start| self.is_apart(start, at));
            let mut best: Option<(usize, f32)> = None;
            for (number, cost) in costs.iter().enumerate() {
                if best.is_none_or(|(_, least)| *cost < least) && apart(&self.presses[number]) {
                    best = Some((number, *cost));
                }
            }
            let Some((number, _)) = best else { return };
            let row = &self.readings_kpa[number * self.n_padded..][..self.n_padded];
            let (product, own) = products(weighted, roots, row);
            let mut at = self.presses[number];
            at[2] *= f64::from(strength(product, own)).powf(1.0 / POWER);
            at[2] = at[2].clamp(self.ranges[2][0], self.ranges[2][1]);
            starts.push(at);
        }
    }

    /// Whether two presses are different starts. A difference of yaw counts by the path of a corner
    /// 5 mm from the centre.
    pub(crate) fn is_apart(&self, a: &[f64; N], b: &[f64; N]) -> bool {
        let turn = self
            .turn_rad
            .map_or(0.0, |turn_rad| nearest(a[3] - b[3], turn_rad));
        (a[0] - b[0]).hypot(a[1] - b[1]) + 5.0 * turn.abs() > APART_MM
    }
}

/// Product of the weighted readings with the weighted row, and of the weighted row with itself.
#[inline(always)]
fn products(weighted: &[f32], roots: &[f32], row: &[f32]) -> (f32, f32) {
    let (mut products, mut squares) = ([0.0; LANES], [0.0; LANES]);
    let lanes =
        |values: &[f32], first: usize| -> [f32; LANES] { std::array::from_fn(|lane| values[first + lane]) };
    for first in (0..row.len()).step_by(LANES) {
        let (reading, root, row) = (lanes(weighted, first), lanes(roots, first), lanes(row, first));
        for lane in 0..LANES {
            let own = root[lane] * row[lane];
            products[lane] += reading[lane] * own;
            squares[lane] += own * own;
        }
    }
    (products.iter().sum(), squares.iter().sum())
}

fn strength(product: f32, own: f32) -> f32 {
    (product / own.max(f32::MIN_POSITIVE)).clamp(STRENGTHS[0], STRENGTHS[1])
}

/// Values from the smallest to the largest, about this far apart; one in the middle if both are the
/// same.
fn evenly([low, high]: [f64; 2], spacing: f64) -> Vec<f64> {
    let n = ((high - low) / spacing).round();
    if n < 1.0 {
        return vec![0.5 * (low + high)];
    }
    (0..=n as usize)
        .map(|i| low + (high - low) * i as f64 / n)
        .collect()
}
