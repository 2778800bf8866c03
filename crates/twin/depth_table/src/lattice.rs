//! Tables over depth on a regular lattice of locations, and the table at any location between them.
//!
//! An array that is pressed at thousands of locations need not be simulated at each. The pressure
//! at a port varies over distances of the gel's height, so splines through a lattice of a third of
//! that height have a smaller error than the mesh.

use glam::DVec2;

use crate::DepthTable;

/// Locations that differ by less than this along an axis count as one line, mm.
const FLAT_MM: f64 = 1e-3;

/// The locations x = x0 + i·dx, y = y0 + j·dy, with x running fastest. There are at least four
/// along an axis that has an extent, and one along an axis that has none.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lattice {
    low_mm: DVec2,
    step_mm: DVec2,
    n_x: usize,
    n_y: usize,
}

impl Lattice {
    /// Covers a rectangle with nodes at most `spacing_mm` apart.
    #[must_use]
    pub fn covering(low_mm: DVec2, high_mm: DVec2, spacing_mm: f64) -> Self {
        let size_mm = high_mm - low_mm;
        let axis = |length_mm: f64| {
            if length_mm < FLAT_MM {
                return (1, spacing_mm);
            }
            let intervals = ((length_mm / spacing_mm - 1e-9).ceil() as usize).max(3);
            (intervals + 1, length_mm / intervals as f64)
        };
        let ((n_x, step_x_mm), (n_y, step_y_mm)) = (axis(size_mm.x), axis(size_mm.y));
        Self {
            low_mm,
            step_mm: DVec2::new(step_x_mm, step_y_mm),
            n_x,
            n_y,
        }
    }

    /// The locations to simulate, mm; `[n_locations]`.
    #[must_use]
    pub fn places_mm(&self) -> Vec<DVec2> {
        (0..self.n_y)
            .flat_map(|j| {
                (0..self.n_x).map(move |i| self.low_mm + self.step_mm * DVec2::new(i as f64, j as f64))
            })
            .collect()
    }

    /// The corners of the lattice, mm.
    #[must_use]
    pub fn corners_mm(&self) -> Vec<DVec2> {
        let ends = |n: usize| if n > 1 { vec![0, n - 1] } else { vec![0] };
        let corner = |i: usize, j: usize| self.low_mm + self.step_mm * DVec2::new(i as f64, j as f64);
        ends(self.n_y)
            .into_iter()
            .flat_map(|j| ends(self.n_x).into_iter().map(move |i| corner(i, j)))
            .collect()
    }

    /// The table at a location inside the lattice, from the tables at [`Lattice::places_mm`], by
    /// cubic splines, frame by frame. Frames that a node near the location lacks are left out.
    #[must_use]
    pub fn at(&self, tables: &[DepthTable], place_mm: DVec2) -> DepthTable {
        let along_x = spline_weights((place_mm.x - self.low_mm.x) / self.step_mm.x, self.n_x);
        let along_y = spline_weights((place_mm.y - self.low_mm.y) / self.step_mm.y, self.n_y);
        let nodes: Vec<(&DepthTable, f64)> = tables
            .iter()
            .enumerate()
            .map(|(node, table)| (table, along_x[node % self.n_x] * along_y[node / self.n_x]))
            .collect();
        let mut table = DepthTable::blend(&nodes);
        let z_mm = table.gel_from_indenter_at_touch.position_mm.z;
        table.gel_from_indenter_at_touch.position_mm = place_mm.extend(z_mm);
        table
    }
}

/// The weight of each node's value at a position (in steps), for the cubic spline through equally
/// spaced nodes whose third derivative is continuous at the second and the last node but one
/// (not-a-knot); `[n_nodes]`. At these two nodes its curvature is the second difference. Between
/// them, the curvatures m solve m₋ + 4 m + m₊ = 6 times the second difference.
fn spline_weights(position: f64, n_nodes: usize) -> Vec<f64> {
    if n_nodes == 1 {
        return vec![1.0];
    }
    let cell = (position.floor().max(0.0) as usize).min(n_nodes - 2);
    let (b, a) = (position - cell as f64, cell as f64 + 1.0 - position);
    (0..n_nodes)
        .map(|node| {
            let value = |i: usize| f64::from(u8::from(i == node));
            let curvature = curvatures(n_nodes, &value);
            a * value(cell)
                + b * value(cell + 1)
                + ((a.powi(3) - a) * curvature[cell] + (b.powi(3) - b) * curvature[cell + 1]) / 6.0
        })
        .collect()
}

fn curvatures(n_nodes: usize, value: &dyn Fn(usize) -> f64) -> Vec<f64> {
    let difference = |i: usize| value(i - 1) - 2.0 * value(i) + value(i + 1);
    let last = n_nodes - 1;
    let mut m = vec![0.0; n_nodes];
    (m[1], m[last - 1]) = (difference(1), difference(last - 1));
    // Elimination and back substitution of the tridiagonal system between these nodes.
    let mut pivot = vec![1.0; n_nodes];
    let mut upper = vec![0.0; n_nodes];
    for i in 2..last - 1 {
        pivot[i] = 4.0 - upper[i - 1];
        upper[i] = 1.0 / pivot[i];
        m[i] = (6.0 * difference(i) - m[i - 1]) / pivot[i];
    }
    for i in (2..last - 1).rev() {
        m[i] -= upper[i] * m[i + 1];
    }
    m[0] = 2.0 * m[1] - m[2];
    m[last] = 2.0 * m[last - 1] - m[last - 2];
    m
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{PressFrame, SolveQuality};
    use twintac_shape::Pose;

    fn table_of(place: DVec2) -> DepthTable {
        let value = place.x.powi(3) - 2.0 * place.x * place.y + place.y.powi(2) * place.x;
        let quality = SolveQuality {
            iterations: 1,
            residual: 0.0,
            penetration_mm: 0.0,
            smallest_volume_ratio: 1.0,
            wall_time_s: 0.0,
        };
        let frame = PressFrame {
            depth_mm: 1.0,
            force_n: value,
            port_pressure_kpa: vec![2.0 * value],
            port_slope_kpa_per_mm: vec![[value; 3]],
            stress_feature_kpa_per_mm: vec![3.0 * value],
            quality,
        };
        DepthTable {
            indenter: "sphere".into(),
            gel_from_indenter_at_touch: Pose::from_position(place.extend(8.0)),
            n_nodes: 1,
            frames: vec![frame],
            failure: None,
        }
    }

    #[test]
    fn a_line_of_places_is_a_lattice_of_one_row() {
        let lattice = Lattice::covering(DVec2::new(-1.0, 2.0), DVec2::new(6.0, 2.0), 1.5);
        assert_eq!(lattice.places_mm().len(), 6);
        let tables: Vec<DepthTable> = lattice.places_mm().into_iter().map(table_of).collect();
        let place = DVec2::new(3.3, 2.0);
        let (found, expected) = (lattice.at(&tables, place), table_of(place));
        assert!((found.frames[0].force_n - expected.frames[0].force_n).abs() < 1e-9);
    }

    #[test]
    fn cubics_are_interpolated_exactly_up_to_the_border() {
        let lattice = Lattice::covering(DVec2::new(-1.0, 2.0), DVec2::new(6.0, 9.5), 1.5);
        let tables: Vec<DepthTable> = lattice.places_mm().into_iter().map(table_of).collect();
        for place in [
            DVec2::new(-1.0, 2.0),
            DVec2::new(0.3, 2.1),
            DVec2::new(3.3, 5.0),
            DVec2::new(6.0, 9.5),
        ] {
            let (found, expected) = (lattice.at(&tables, place), table_of(place));
            assert!((found.frames[0].force_n - expected.frames[0].force_n).abs() < 1e-9);
            assert!(
                (found.frames[0].port_pressure_kpa[0] - expected.frames[0].port_pressure_kpa[0]).abs() < 1e-9
            );
            assert!((found.gel_from_indenter_at_touch.position_mm.z - 8.0).abs() < 1e-12);
        }
    }
}
