//! The lines of a mesh along x or y.

use crate::size::SizeField;
use crate::{Focus, MeshError};

/// Lines across one axis: where the contact wants them, and where the inclusions want them.
///
/// The two can't agree in a tensor grid, as an inclusion's face may lie anywhere under the press. So the ideal lines hold in the
/// upper gel, the snapped ones from the board to the top of the inclusions, and in between the lines lean.
pub(crate) struct Axis {
    /// Lines laid outwards from the focus, mm.
    pub(crate) ideal_mm: Vec<f64>,
    /// The same lines, moved so that one lies in each face of the inclusions, mm.
    pub(crate) snapped_mm: Vec<f64>,
    /// The line about which cells are cut in mirrored ways.
    pub(crate) mirror: usize,
}

impl Axis {
    /// Lines from `low` to `high`, outwards from the focus given as (its place on this axis, the focus), or else from the middle. The
    /// mirror line keeps a margin to both ends.
    pub(crate) fn new(
        [low_mm, high_mm]: [f64; 2],
        focus: Option<(f64, &Focus)>,
        faces_mm: &[f64],
        size: &SizeField,
        margin_mm: f64,
    ) -> Result<Self, MeshError> {
        let core_mm = match focus {
            Some((center_mm, focus)) => core([low_mm, high_mm], center_mm, focus),
            None => vec![0.5 * (low_mm + high_mm)],
        };
        let center_mm = focus.map_or(0.5 * (low_mm + high_mm), |(center_mm, _)| center_mm);
        let mut ideal_mm = vec![low_mm];
        match (core_mm.first(), core_mm.last()) {
            (Some(&first_mm), Some(&last_mm)) => {
                size.divide(low_mm, first_mm, &mut ideal_mm)?;
                ideal_mm.extend(&core_mm[1..]);
                size.divide(last_mm, high_mm, &mut ideal_mm)?;
            }
            _ => size.divide(low_mm, high_mm, &mut ideal_mm)?,
        }
        let mirror = nearest(
            &ideal_mm,
            center_mm.max(low_mm + margin_mm).min(high_mm - margin_mm),
        );
        let snapped_mm = snap(&ideal_mm, faces_mm, mirror)?;
        Ok(Self {
            ideal_mm,
            snapped_mm,
            mirror,
        })
    }

    /// Position of a line where the inclusions have the given say, from 0 to 1.
    pub(crate) fn at_mm(&self, line: usize, inclusion_share: f64) -> f64 {
        self.ideal_mm[line] + inclusion_share * (self.snapped_mm[line] - self.ideal_mm[line])
    }

    /// The snapped line in a face (or at an end of the axis).
    pub(crate) fn line_at(&self, face_mm: f64) -> usize {
        nearest(&self.snapped_mm, face_mm)
    }
}

/// Evenly spaced lines across the focus, those left out that would be within half an edge of an end.
fn core([low_mm, high_mm]: [f64; 2], center_mm: f64, focus: &Focus) -> Vec<f64> {
    let half = (focus.radius_mm / focus.edge_mm - 1e-9).ceil().clamp(1.0, 2000.0) as i32;
    let margin_mm = 0.5 * focus.edge_mm;
    (-half..=half)
        .map(|step| center_mm + f64::from(step) * focus.edge_mm)
        .filter(|&line_mm| line_mm > low_mm + margin_mm && line_mm < high_mm - margin_mm)
        .collect()
}

/// Moves lines so that one lies in every face: the choice of lines that moves them least, the lines between spread evenly.
fn snap(lines_mm: &[f64], faces_mm: &[f64], mirror: usize) -> Result<Vec<f64>, MeshError> {
    let last = lines_mm.len() - 1;
    let inner: Vec<f64> = faces_mm
        .iter()
        .copied()
        .filter(|&f| f > lines_mm[0] && f < lines_mm[last])
        .collect();
    if inner.len() + 2 > lines_mm.len() {
        return Err(MeshError::Setting {
            field: "edge_mm".to_owned(),
            expected: format!(
                "edges short enough for a line in each of {} faces of inclusions",
                inner.len()
            ),
            found: format!("{} lines", lines_mm.len()),
        });
    }
    let chosen = choose(lines_mm, &inner, mirror);
    let mut anchors = vec![(0, lines_mm[0])];
    anchors.extend(chosen.into_iter().zip(inner));
    anchors.push((last, lines_mm[last]));
    let mut snapped_mm = Vec::with_capacity(lines_mm.len());
    for pair in anchors.windows(2) {
        let ((from, from_mm), (to, to_mm)) = (pair[0], pair[1]);
        let stretch = (to_mm - from_mm) / (lines_mm[to] - lines_mm[from]);
        snapped_mm.extend((from..to).map(|i| from_mm + stretch * (lines_mm[i] - lines_mm[from])));
    }
    snapped_mm.push(lines_mm[last]);
    Ok(snapped_mm)
}

/// A line for each face, in order and no line twice, with the smallest sum of squared distances (dynamic programming).
fn choose(lines_mm: &[f64], faces_mm: &[f64], mirror: usize) -> Vec<usize> {
    let n = lines_mm.len();
    let cost = |line: usize, face_mm: f64| {
        let inward = (lines_mm[line] - lines_mm[mirror]).abs() < (face_mm - lines_mm[mirror]).abs();
        // Of two equally near lines the outer one, on both sides of the mirror.
        (lines_mm[line] - face_mm).powi(2) * if inward { 1.0 + 1e-9 } else { 1.0 }
    };
    // best[f][l]: least cost of the first f faces with lines below l; came[f][l]: the line of face f then.
    let mut best = vec![vec![0.0; n + 1]];
    let mut came: Vec<Vec<usize>> = Vec::new();
    for (f, &face_mm) in faces_mm.iter().enumerate() {
        let mut row = vec![f64::INFINITY; n + 1];
        let mut from = vec![0; n + 1];
        for line in 1..n - 1 {
            let total = best[f][line] + cost(line, face_mm);
            (row[line + 1], from[line + 1]) = if total < row[line] {
                (total, line)
            } else {
                (row[line], from[line])
            };
        }
        (row[n], from[n]) = (row[n - 1], from[n - 1]);
        best.push(row);
        came.push(from);
    }
    let mut chosen = vec![0; faces_mm.len()];
    let mut below = n;
    for f in (0..faces_mm.len()).rev() {
        below = came[f][below];
        chosen[f] = below;
    }
    chosen
}

fn nearest(lines_mm: &[f64], at_mm: f64) -> usize {
    (0..lines_mm.len())
        .min_by(|&a, &b| {
            (lines_mm[a] - at_mm)
                .abs()
                .total_cmp(&(lines_mm[b] - at_mm).abs())
        })
        .unwrap_or(0)
}
