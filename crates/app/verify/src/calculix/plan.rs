//! Quadrilaterals in the gel's plane, from which the reference mesh is extruded.

use glam::DVec2;

/// A mesh of quadrilaterals.
pub(super) struct Plan {
    pub(super) points_mm: Vec<DVec2>,
    /// Corners, anticlockwise.
    pub(super) quads: Vec<[usize; 4]>,
}

/// A part of a line that has short edges.
#[derive(Clone, Copy)]
pub(super) struct Fine {
    pub(super) from_mm: f64,
    pub(super) to_mm: f64,
    pub(super) edge_mm: f64,
}

/// Growth of the edge length per length away from a part with short edges.
const SLOPE: f64 = 0.4;

/// Divides a line into edges that are short in the given parts, grow linearly away from them, and
/// are nowhere longer than `edge_mm`.
pub(super) fn divide([low_mm, high_mm]: [f64; 2], edge_mm: f64, fine: &[Fine]) -> Vec<f64> {
    const SAMPLES: usize = 2000;
    let wanted_mm = |at: f64| {
        fine.iter().fold(edge_mm, |edge, f| {
            let away_mm = (f.from_mm - at).max(at - f.to_mm).max(0.0);
            edge.min(f.edge_mm + SLOPE * away_mm)
        })
    };
    let step_mm = (high_mm - low_mm) / SAMPLES as f64;
    let mut edges = vec![0.0];
    for sample in 0..SAMPLES {
        let at_mm = low_mm + (sample as f64 + 0.5) * step_mm;
        edges.push(edges[sample] + step_mm / wanted_mm(at_mm));
    }
    let n_edges = edges[SAMPLES].ceil();
    let mut lines_mm = vec![low_mm];
    for line in 1..n_edges as usize {
        let target = edges[SAMPLES] * line as f64 / n_edges;
        let after = edges.partition_point(|&edge| edge < target);
        let part = (target - edges[after - 1]) / (edges[after] - edges[after - 1]);
        lines_mm.push(low_mm + ((after - 1) as f64 + part) * step_mm);
    }
    lines_mm.push(high_mm);
    lines_mm
}

impl Plan {
    /// All rectangles between grid lines.
    pub(super) fn tensor(x_mm: &[f64], y_mm: &[f64]) -> Self {
        let points_mm = y_mm
            .iter()
            .flat_map(|&y| x_mm.iter().map(move |&x| DVec2::new(x, y)))
            .collect();
        let n_x = x_mm.len();
        let quads = (0..y_mm.len() - 1)
            .flat_map(|j| (0..n_x - 1).map(move |i| j * n_x + i))
            .map(|first| [first, first + 1, first + 1 + n_x, first + n_x])
            .collect();
        Self { points_mm, quads }
    }

    /// Rings about a centre: a square with `n_side` quadrilaterals along each side, then circles,
    /// then rings that approach the rectangle. `radii_mm` are the radii of the circles. `outwards`
    /// are fractions of the way from the last circle to the rectangle, up to 1.
    pub(super) fn rings(
        center_mm: DVec2,
        n_side: usize,
        radii_mm: &[f64],
        outwards: &[f64],
        [low_mm, high_mm]: [DVec2; 2],
    ) -> Self {
        // With this size the square's corners are about as far from the first circle as its sides
        // are from its corners.
        let half_mm = 0.55 * radii_mm[0];
        let steps: Vec<f64> = (0..=n_side)
            .map(|i| half_mm * (2.0 * i as f64 / n_side as f64 - 1.0))
            .collect();
        let mut plan = Self::tensor(&steps, &steps);
        plan.points_mm.iter_mut().for_each(|point| *point += center_mm);
        let n_around = 4 * n_side;
        let on_square: Vec<usize> = (0..n_around).map(|at| perimeter(at, n_side)).collect();
        let on_circle = |at: usize, radius_mm: f64| {
            let angle = (at as f64 / n_side as f64 - 1.5) * std::f64::consts::FRAC_PI_2;
            center_mm + radius_mm * DVec2::from_angle(angle)
        };
        let corners = [
            low_mm,
            DVec2::new(high_mm.x, low_mm.y),
            high_mm,
            DVec2::new(low_mm.x, high_mm.y),
        ];
        let on_rectangle = |at: usize| {
            let (side, part) = (at / n_side, (at % n_side) as f64 / n_side as f64);
            corners[side].lerp(corners[(side + 1) % 4], part)
        };
        let last_mm = radii_mm[radii_mm.len() - 1];
        let square_mm: Vec<DVec2> = on_square.iter().map(|&point| plan.points_mm[point]).collect();
        let mut ring = on_square;
        let mut add = |place: &dyn Fn(usize) -> DVec2| {
            let first = plan.points_mm.len();
            plan.points_mm.extend((0..n_around).map(place));
            for at in 0..n_around {
                let next = (at + 1) % n_around;
                plan.quads.push([ring[at], first + at, first + next, ring[next]]);
            }
            ring = (first..first + n_around).collect();
        };
        add(&|at| square_mm[at].midpoint(on_circle(at, radii_mm[0])));
        for &radius_mm in radii_mm {
            add(&|at| on_circle(at, radius_mm));
        }
        for &part in outwards {
            add(&|at| on_circle(at, last_mm).lerp(on_rectangle(at), part));
        }
        plan
    }
}

/// Index of a point on the perimeter of a square of `n * n` cells, anticlockwise from its lowest
/// corner.
fn perimeter(at: usize, n: usize) -> usize {
    let (side, step) = (at / n, at % n);
    let (i, j) = match side {
        0 => (step, 0),
        1 => (n, step),
        2 => (n - step, n),
        _ => (0, n - step),
    };
    j * (n + 1) + i
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area_mm2(plan: &Plan) -> f64 {
        let mut sum = 0.0;
        for quad in &plan.quads {
            let [a, b, c, d] = quad.map(|point| plan.points_mm[point]);
            let area = 0.5 * (c - a).perp_dot(d - b);
            assert!(area > 0.0);
            sum += area;
        }
        sum
    }

    #[test]
    fn quadrilaterals_fill_the_rectangle() {
        let fine = Fine {
            from_mm: 0.0,
            to_mm: 2.0,
            edge_mm: 0.2,
        };
        let lines_mm = divide([-3.0, 9.0], 1.5, &[fine]);
        assert!((area_mm2(&Plan::tensor(&lines_mm, &[0.0, 1.0, 3.0])) - 36.0).abs() < 1e-9);
        let bounds_mm = [DVec2::new(-17.0, -9.0), DVec2::new(17.0, 9.0)];
        let rings = Plan::rings(
            DVec2::new(3.0, 2.0),
            6,
            &[3.6, 4.5, 5.5],
            &[0.2, 0.5, 1.0],
            bounds_mm,
        );
        assert!((area_mm2(&rings) - 34.0 * 18.0).abs() < 1e-9);
    }

    #[test]
    fn edges_are_short_where_asked() {
        let fine = Fine {
            from_mm: 0.0,
            to_mm: 2.0,
            edge_mm: 0.2,
        };
        let lines_mm = divide([-3.0, 9.0], 1.5, &[fine]);
        for pair in lines_mm.windows(2) {
            let edge_mm = pair[1] - pair[0];
            assert!(edge_mm < 1.5 && (pair[0] < 0.0 || pair[1] > 2.0 || edge_mm <= 0.2));
        }
    }
}
