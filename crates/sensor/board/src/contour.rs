//! The regions where a field on grid points is positive, as polygons.

use std::collections::BTreeMap;

use glam::DVec2;

use crate::route::Grid;
use crate::shapes::to_segment;

/// A point is kept if its distance from the line between its neighbours is larger than this, mm.
const STRAIGHT_MM: f64 = 0.003;
/// Smaller polygons are left out, mm².
const SMALLEST_MM2: f64 = 0.3;

/// A border without holes: holes are connected to it by slits.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Polygon {
    pub(crate) points: Vec<DVec2>,
}

impl Polygon {
    /// Whether a point is inside.
    pub(crate) fn holds(&self, point: DVec2) -> bool {
        is_inside(&self.points, point)
    }
}

fn is_inside(points: &[DVec2], point: DVec2) -> bool {
    let crossed = edges(points).filter(|(from, to)| {
        (from.y > point.y) != (to.y > point.y)
            && point.x < from.x + (point.y - from.y) / (to.y - from.y) * (to.x - from.x)
    });
    crossed.count() % 2 == 1
}

fn edges(points: &[DVec2]) -> impl Iterator<Item = (DVec2, DVec2)> + '_ {
    let next = points.iter().cycle().skip(1);
    points.iter().zip(next).map(|(from, to)| (*from, *to))
}

/// Twice the area; positive if the border runs counter-clockwise.
fn doubled_area(points: &[DVec2]) -> f64 {
    edges(points).map(|(from, to)| from.perp_dot(to)).sum()
}

/// A crossing of the border between two neighbouring grid points: the lower point, and whether the
/// other one is above it (else to its right).
type Crossing = (usize, bool);

/// The borders of the regions where the field is positive. The positive side is to the left.
pub(crate) fn loops(grid: &Grid, field: &[f64]) -> Vec<Vec<DVec2>> {
    let mut next: BTreeMap<Crossing, Crossing> = BTreeMap::new();
    for row in 0..grid.rows - 1 {
        for column in 0..grid.columns - 1 {
            for (from, to) in lines(grid, field, row * grid.columns + column) {
                next.insert(from, to);
            }
        }
    }
    let mut found = Vec::new();
    while let Some((&start, _)) = next.first_key_value() {
        let mut points = Vec::new();
        let mut here = start;
        while let Some(there) = next.remove(&here) {
            points.push(place(grid, field, here));
            here = there;
        }
        found.push(points);
    }
    found
}

fn place(grid: &Grid, field: &[f64], (node, is_up): Crossing) -> DVec2 {
    let other = if is_up { node + grid.columns } else { node + 1 };
    let (low, high) = (field[node], field[other]);
    let part = (low / (low - high)).clamp(0.02, 0.98); // so that no two points of a border coincide
    grid.at(node).lerp(grid.at(other), part)
}

/// The lines of the border in one grid square, whose lowest corner is `node`.
fn lines(grid: &Grid, field: &[f64], node: usize) -> Vec<(Crossing, Crossing)> {
    let corners = [node, node + 1, node + 1 + grid.columns, node + grid.columns];
    let is_in = corners.map(|corner| field[corner] > 0.0);
    let (below, right) = ((node, false), (node + 1, true));
    let (above, left) = ((node + grid.columns, false), (node, true));
    match is_in {
        [true, false, false, false] => vec![(below, left)],
        [false, true, false, false] => vec![(right, below)],
        [false, false, true, false] => vec![(above, right)],
        [false, false, false, true] => vec![(left, above)],
        [true, true, false, false] => vec![(right, left)],
        [false, true, true, false] => vec![(above, below)],
        [false, false, true, true] => vec![(left, right)],
        [true, false, false, true] => vec![(below, above)],
        [true, true, true, false] => vec![(above, left)],
        [false, true, true, true] => vec![(left, below)],
        [true, false, true, true] => vec![(below, right)],
        [true, true, false, true] => vec![(right, above)],
        // Regions that touch only at a diagonal are not connected.
        [true, false, true, false] => vec![(below, left), (above, right)],
        [false, true, false, true] => vec![(right, below), (left, above)],
        [true, true, true, true] | [false, false, false, false] => Vec::new(),
    }
}

/// Polygons from borders and the holes in them.
pub(crate) fn polygons(loops: Vec<Vec<DVec2>>) -> Vec<Polygon> {
    let simple = loops.into_iter().map(|points| straightened(&points));
    let (outer, holes): (Vec<_>, Vec<_>) = simple
        .filter(|points| points.len() > 2)
        .partition(|points| doubled_area(points) > 0.0);
    let outer: Vec<Vec<DVec2>> = outer
        .into_iter()
        .filter(|points| doubled_area(points) > 2.0 * SMALLEST_MM2)
        .collect();
    // A hole belongs to the smallest border around it.
    let mut holes_of: Vec<Vec<Vec<DVec2>>> = vec![Vec::new(); outer.len()];
    for hole in holes {
        let around = (0..outer.len()).filter(|border| is_inside(&outer[*border], hole[0]));
        let area = |border: &usize| doubled_area(&outer[*border]);
        if let Some(border) = around.min_by(|one, two| area(one).total_cmp(&area(two))) {
            holes_of[border].push(hole);
        }
    }
    let joined = outer.into_iter().zip(holes_of);
    joined
        .map(|(border, holes)| Polygon {
            points: with_slits(border, holes),
        })
        .collect()
}

/// Connects holes to their border by horizontal slits to the left of each hole's leftmost point.
fn with_slits(mut border: Vec<DVec2>, mut holes: Vec<Vec<DVec2>>) -> Vec<DVec2> {
    for hole in &mut holes {
        let leftmost = (0..hole.len()).min_by(|one, two| hole[*one].x.total_cmp(&hole[*two].x));
        hole.rotate_left(leftmost.unwrap_or_default());
    }
    holes.sort_by(|one, two| one[0].x.total_cmp(&two[0].x).then(one[0].y.total_cmp(&two[0].y)));
    for hole in holes {
        let start = hole[0];
        let hits = edges(&border).enumerate().filter_map(|(index, (from, to))| {
            let spans = (from.y > start.y) != (to.y > start.y);
            let x = from.x + (start.y - from.y) / (to.y - from.y) * (to.x - from.x);
            (spans && x <= start.x).then_some((x, index))
        });
        let Some((x, index)) = hits.max_by(|one, two| one.0.total_cmp(&two.0)) else {
            continue;
        };
        let hit = DVec2::new(x, start.y);
        let slit = std::iter::once(hit).chain(hole).chain([start, hit]);
        let slit: Vec<DVec2> = slit.collect();
        border.splice(index + 1..index + 1, slit);
    }
    border
}

/// The border without points that lie on the line between others.
fn straightened(points: &[DVec2]) -> Vec<DVec2> {
    if points.len() < 4 {
        return points.to_vec();
    }
    // Two points that are always kept: the first one, and the one farthest from it.
    let farthest = (0..points.len())
        .max_by(|one, two| {
            let from = |index: &usize| points[*index].distance(points[0]);
            from(one).total_cmp(&from(two))
        })
        .unwrap_or_default();
    let mut stays = vec![false; points.len() + 1];
    (stays[0], stays[farthest]) = (true, true);
    let at = |index: usize| points[index % points.len()];
    let mut spans = vec![(0, farthest), (farthest, points.len())];
    while let Some((from, to)) = spans.pop() {
        let off = |index: usize| to_segment(at(index), at(from), at(to));
        let worst = (from + 1..to).max_by(|one, two| off(*one).total_cmp(&off(*two)));
        if let Some(worst) = worst.filter(|worst| off(*worst) > STRAIGHT_MM) {
            stays[worst] = true;
            spans.extend([(from, worst), (worst, to)]);
        }
    }
    let all = points.iter().zip(stays);
    all.filter(|(_, stays)| *stays).map(|(point, _)| *point).collect()
}
