//! Readings at the nodes of a grid over location and depth, as a forward model of contacts: from a
//! trained twin, or measured.

use std::sync::Arc;

use glam::DVec2;

use crate::model::{ContactModel, Domain, Press};

/// Readings under one shape at the nodes of a grid. A coordinate whose axis has one node is not
/// estimated.
#[derive(Clone, Debug, PartialEq)]
pub struct ReadingTable {
    /// First node along x, y and depth, mm.
    pub first_mm: [f64; 3],
    /// Distance of the nodes along x, y and depth, mm.
    pub step_mm: [f64; 3],
    /// Number of nodes along x, y and depth.
    pub n: [usize; 3],
    /// Readings at each node, kPa, depth by depth and row by row along x; `[n_depth * n_y *
    /// n_x][n_readings]`.
    pub readings_kpa: Vec<Vec<f64>>,
    /// Force at each node, N; `[n_depth * n_y * n_x]`.
    pub force_n: Vec<f64>,
}

/// Tables of known shapes. Interpolation between nodes is cubic (Catmull and Rom). Before the first
/// node and behind the last one, readings are constant.
#[derive(Clone, Debug)]
pub struct TableModel {
    tables: Arc<Vec<ReadingTable>>,
    n_readings: usize,
}

impl TableModel {
    /// A model with one table for each shape.
    ///
    /// # Panics
    /// If the lists of a table do not have one value for each node, or if tables differ in their
    /// number of readings.
    #[must_use]
    pub fn new(tables: Vec<ReadingTable>) -> Self {
        let n_readings = tables
            .first()
            .and_then(|table| table.readings_kpa.first())
            .map_or(0, Vec::len);
        for table in &tables {
            let n_nodes = table.n.iter().product::<usize>();
            assert_eq!(
                [table.readings_kpa.len(), table.force_n.len()],
                [n_nodes; 2],
                "a value for each node"
            );
            let is_whole = table.readings_kpa.iter().all(|node| node.len() == n_readings);
            assert!(n_nodes > 0 && is_whole, "readings of all taxels at each node");
        }
        Self {
            tables: Arc::new(tables),
            n_readings,
        }
    }
}

impl ContactModel for TableModel {
    fn n_readings(&self) -> usize {
        self.n_readings
    }

    fn n_shapes(&self) -> usize {
        self.tables.len()
    }

    fn domain(&self, shape: usize) -> Domain {
        let table = &self.tables[shape];
        let range = |axis: usize| {
            let first_mm = table.first_mm[axis];
            [
                first_mm,
                first_mm + table.step_mm[axis] * (table.n[axis] - 1) as f64,
            ]
        };
        let ([low_x, high_x], [low_y, high_y]) = (range(0), range(1));
        Domain {
            places_mm: [DVec2::new(low_x, low_y), DVec2::new(high_x, high_y)],
            depths_mm: range(2),
            turn_rad: None,
        }
    }

    fn read(&mut self, shape: usize, press: &Press, readings_kpa: &mut [f32]) -> f64 {
        let table = &self.tables[shape];
        let at = [press.place_mm.x, press.place_mm.y, press.depth_mm];
        let axes: [_; 3] = std::array::from_fn(|axis| {
            nodes(
                (at[axis] - table.first_mm[axis]) / table.step_mm[axis],
                table.n[axis],
            )
        });
        readings_kpa.fill(0.0);
        let mut force_n = 0.0;
        for (k, depth) in axes[2] {
            for (j, y) in axes[1] {
                for (i, x) in axes[0] {
                    let share = x * y * depth;
                    if share != 0.0 {
                        let node = (k * table.n[1] + j) * table.n[0] + i;
                        force_n += share * table.force_n[node];
                        for (reading, known) in readings_kpa.iter_mut().zip(&table.readings_kpa[node]) {
                            *reading += (share * known) as f32;
                        }
                    }
                }
            }
        }
        force_n
    }
}

/// The four nodes around a position, in steps, and their weights. Beyond an end, the node at the
/// end is repeated.
fn nodes(position: f64, n: usize) -> [(usize, f64); 4] {
    if n == 1 {
        return [(0, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)];
    }
    let position = position.clamp(0.0, (n - 1) as f64);
    let cell = (position as usize).min(n - 2);
    let t = position - cell as f64;
    let shares = [
        0.5 * (-t + 2.0 * t * t - t * t * t),
        0.5 * (2.0 - 5.0 * t * t + 3.0 * t * t * t),
        0.5 * (t + 4.0 * t * t - 3.0 * t * t * t),
        0.5 * (t * t * t - t * t),
    ];
    std::array::from_fn(|number| ((cell + number).saturating_sub(1).min(n - 1), shares[number]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slopes_are_straight_between_nodes() {
        let nodes = (0..5).flat_map(|j| (0..6).map(move |i| vec![f64::from(i) + 10.0 * f64::from(j)]));
        let table = ReadingTable {
            first_mm: [1.0, -2.0, 0.0],
            step_mm: [0.5, 2.0, 1.0],
            n: [6, 5, 1],
            readings_kpa: nodes.collect(),
            force_n: vec![3.0; 30],
        };
        let mut model = TableModel::new(vec![table]);
        let press = Press {
            place_mm: DVec2::new(1.7, 1.0),
            ..Press::default()
        };
        let mut readings_kpa = [0.0];
        assert!((model.read(0, &press, &mut readings_kpa) - 3.0).abs() < 1e-12);
        assert!((readings_kpa[0] - (1.4 + 15.0)).abs() < 1e-5, "{readings_kpa:?}");
    }
}
