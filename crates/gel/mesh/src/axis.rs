//! The grid lines of a mesh along x or y.

use crate::size::SizeField;
use crate::{MeshError, Stretch};

/// The extent of a focus along one axis.
pub(crate) struct Core<'a> {
    pub(crate) center_mm: f64,
    pub(crate) radius_mm: f64,
    pub(crate) edge_mm: f64,
    pub(crate) growth: f64,
    pub(crate) stretches: &'a [Stretch],
    pub(crate) lines_mm: &'a [f64],
}

/// The lines of one axis, in two versions: ideal for the contact, and snapped to the faces of the
/// inclusions.
///
/// One tensor grid cannot be both, because the face of an inclusion may be anywhere under the
/// press. The ideal lines are used in the upper gel, the snapped ones from the board to the top of
/// the inclusions. In between the lines lean from one to the other.
pub(crate) struct Axis {
    /// Lines, built outwards from the focus, mm.
    pub(crate) ideal_mm: Vec<f64>,
    /// The same lines, moved so that one is in each face of the inclusions, mm.
    pub(crate) snapped_mm: Vec<f64>,
    /// Index of the line about which the cuts of cells are mirrored.
    pub(crate) mirror: usize,
}

impl Axis {
    /// Lines from `low` to `high`, built outwards from the focus, or from the middle without one.
    /// The mirror line is at least the margin away from both ends.
    pub(crate) fn new(
        [low_mm, high_mm]: [f64; 2],
        focus: Option<Core<'_>>,
        faces_mm: &[f64],
        size: &SizeField,
        margin_mm: f64,
    ) -> Result<Self, MeshError> {
        let middle_mm = 0.5 * (low_mm + high_mm);
        let (center_mm, core_mm) = match focus {
            Some(core) => (core.center_mm, core.lines_mm([low_mm, high_mm])?),
            None => (middle_mm, vec![middle_mm]),
        };
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

    /// Position of a line, mm; `inclusion_share` (0 to 1) is the weight of the snapped version.
    pub(crate) fn at_mm(&self, line: usize, inclusion_share: f64) -> f64 {
        self.ideal_mm[line] + inclusion_share * (self.snapped_mm[line] - self.ideal_mm[line])
    }

    /// Index of the snapped line in a face (or at an end of the axis).
    pub(crate) fn line_at(&self, face_mm: f64) -> usize {
        nearest(&self.snapped_mm, face_mm)
    }
}

impl Core<'_> {
    /// Lines over the focus, evenly spaced except at its stretches and lines. Lines closer than
    /// half an edge to an end of the axis are left out.
    fn lines_mm(&self, [low_mm, high_mm]: [f64; 2]) -> Result<Vec<f64>, MeshError> {
        let [below_mm, above_mm] = [self.side_mm(-1.0)?, self.side_mm(1.0)?];
        let offsets_mm = below_mm
            .iter()
            .skip(1)
            .rev()
            .map(|away_mm| -away_mm)
            .chain(above_mm);
        let margin_mm = 0.5 * self.edge_mm;
        Ok(offsets_mm
            .map(|offset_mm| self.center_mm + offset_mm)
            .filter(|&line_mm| line_mm > low_mm + margin_mm && line_mm < high_mm - margin_mm)
            .collect())
    }

    /// Distances of the lines on one side from the centre; the first is 0.
    fn side_mm(&self, sign: f64) -> Result<Vec<f64>, MeshError> {
        let n_edges = (self.radius_mm / self.edge_mm - 1e-9).ceil().clamp(1.0, 2000.0);
        if self.stretches.is_empty() && self.lines_mm.is_empty() {
            return Ok((0..=n_edges as u32)
                .map(|line| f64::from(line) * self.edge_mm)
                .collect());
        }
        let mut size = SizeField::new(self.edge_mm, self.growth);
        for stretch in self.stretches {
            size.refine(sign * stretch.offset_mm, stretch.reach_mm, stretch.edge_mm);
        }
        let mut lines_mm = vec![0.0];
        let mut from_mm = 0.0;
        for to_mm in self.asked_mm(sign, &size) {
            size.divide(from_mm, to_mm, &mut lines_mm)?;
            from_mm = to_mm;
        }
        Ok(lines_mm)
    }

    /// Distances from the centre, in order, at which there must be a line on one side. The last is
    /// the radius, or half an edge if the radius is smaller.
    fn asked_mm(&self, sign: f64, size: &SizeField) -> Vec<f64> {
        let mut sorted_mm: Vec<f64> = self.lines_mm.iter().map(|line_mm| sign * line_mm).collect();
        sorted_mm.sort_by(f64::total_cmp);
        let radius_mm = self.radius_mm.max(0.5 * size.edge_mm(self.radius_mm));
        let mut asked_mm = Vec::new();
        let mut before_mm = 0.0;
        for line_mm in sorted_mm {
            let apart_mm = 0.5 * size.edge_mm(line_mm);
            if line_mm > before_mm + apart_mm && line_mm < radius_mm - apart_mm {
                asked_mm.push(line_mm);
                before_mm = line_mm;
            }
        }
        asked_mm.push(radius_mm);
        asked_mm
    }
}

/// Moves lines so that one is in every face. The lines are chosen so that they move least; the
/// lines between them are spread evenly.
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

/// A line for each face, in order and without repetition, with the smallest sum of squared
/// distances (dynamic programming).
fn choose(lines_mm: &[f64], faces_mm: &[f64], mirror: usize) -> Vec<usize> {
    let n = lines_mm.len();
    let cost = |line: usize, face_mm: f64| {
        let inward = (lines_mm[line] - lines_mm[mirror]).abs() < (face_mm - lines_mm[mirror]).abs();
        // Of two equally near lines the outer one is taken, on both sides of the mirror line.
        (lines_mm[line] - face_mm).powi(2) * if inward { 1.0 + 1e-9 } else { 1.0 }
    };
    // `best[f][l]`: lowest cost of the first `f` faces with lines below `l`. `came[f][l]`: the line
    // of face `f` in that case.
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
        .expect("an axis has two lines at least")
}
