//! Evaluation of a surrogate: its errors, compared with FEM solutions.

mod frame;

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};
use twintac_shape::{Shape, ShapeError, Surfaces};

use crate::{Body, FastGel, FemPress};
use frame::{FrameErrors, PressErrors};

/// Errors of a group of frames, relative to the largest value of each press. A group without frames
/// has no errors.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct GroupErrors {
    /// Number of frames, at least one.
    pub n_frames: usize,
    /// Mean absolute error at the taxel with the largest pressure, %.
    pub nearest_percent: f64,
    /// Mean signed error at that taxel, %.
    pub nearest_bias_percent: f64,
    /// Mean error over all taxels, %.
    pub all_percent: f64,
    /// Mean length of the error of the force, %.
    pub force_percent: f64,
    /// Percentage of frames in which the pressure at the taxel with the largest pressure, or the
    /// force, has an error of more than a tenth of its value in that frame. A value below a quarter
    /// of the press's largest counts as this quarter.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub off_by_a_tenth_percent: Option<f64>,
}

/// Errors of a surrogate on test presses, which it was not trained on. A group is `None` where it
/// has no frame.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Evaluation {
    /// All frames.
    pub overall: Option<GroupErrors>,
    /// By kind of shape.
    pub by_shape: BTreeMap<String, Option<GroupErrors>>,
    /// By depth below the undeformed surface, mm: from a whole number to the next, up to the
    /// largest depth of training presses or of these presses.
    pub by_depth_mm: BTreeMap<u32, Option<GroupErrors>>,
    /// By distance of the shape's origin from the gel's middle, as a fraction of the distance from
    /// the middle to a corner: four equal parts.
    pub by_place: BTreeMap<String, Option<GroupErrors>>,
    /// Frames in which the shape's origin is no farther from an edge of the gel than half of the
    /// gel's height.
    #[serde(default)]
    pub at_edge: Option<GroupErrors>,
    /// Predicted pressure for shapes that do not touch, 0.1 to 1 mm above the gel: the largest at
    /// any taxel, mean over presses and gaps, % of each press's largest pressure.
    #[serde(default)]
    pub untouched_percent: Option<f64>,
    /// Frames with an OOD score of at most 1 (`in-distribution`), and the others
    /// (`out-of-distribution`).
    #[serde(alias = "by_novelty")]
    pub by_ood_score: BTreeMap<String, Option<GroupErrors>>,
}

impl FastGel {
    /// Compares predictions with FEM solutions of test presses.
    ///
    /// # Errors
    /// A press whose shape cannot exist.
    pub fn evaluate(&self, presses: &[FemPress], surfaces: &Surfaces) -> Result<Evaluation, ShapeError> {
        let (mut frames, mut untouched) = (Vec::new(), Vec::new());
        for press in presses {
            let mut errors = PressErrors::of(self, press, surfaces)?;
            frames.append(&mut errors.frames);
            untouched.append(&mut errors.untouched);
        }
        let group = |is_in: &dyn Fn(&FrameErrors<'_>) -> bool| {
            let own: Vec<&FrameErrors<'_>> = frames.iter().filter(|frame| is_in(frame)).collect();
            group_errors(&own)
        };
        let shapes = presses.iter().map(|press| name(&press.shape));
        let quarter = |number: u32| {
            let name = format!("{} to {} %", 25 * number, 25 * (number + 1));
            let is_in = |frame: &FrameErrors<'_>| (4.0 * self.part_to_corner(frame)) as u32 == number;
            (name, group(&is_in))
        };
        let depths = frames.iter().map(|frame| self.whole_depth_mm(frame));
        let deepest_mm = depths
            .max()
            .unwrap_or(0)
            .max(self.ood_score.coverage.deepest_whole_mm());
        let kinds = [("in-distribution", false), ("out-of-distribution", true)];
        Ok(Evaluation {
            overall: group(&|_| true),
            by_shape: shapes
                .map(|shape| {
                    (
                        shape.to_owned(),
                        group(&|frame| name(&frame.press.shape) == shape),
                    )
                })
                .collect(),
            by_depth_mm: (0..=deepest_mm)
                .map(|depth_mm| (depth_mm, group(&|frame| self.whole_depth_mm(frame) == depth_mm)))
                .collect(),
            by_place: (0..4).map(quarter).collect(),
            at_edge: group(&|frame| self.is_at_edge(frame)),
            untouched_percent: mean(untouched.iter().copied()).map(|part| 100.0 * part),
            by_ood_score: kinds
                .map(|(name, is_ood)| (name.to_owned(), group(&|frame| (frame.ood_score > 1.0) == is_ood)))
                .into(),
        })
    }

    /// Learns from held-out presses how large the errors are where few training presses pressed.
    pub(crate) fn calibrate_ood_score(
        &mut self,
        held_out: &[FemPress],
        surfaces: &Surfaces,
    ) -> Result<(), ShapeError> {
        let (mut reader, mut seen) = (self.reader(), Vec::new());
        for press in held_out {
            let body = Body::new(&press.shape, surfaces)?;
            for frame in PressErrors::of(self, press, surfaces)?.frames {
                let inputs = reader.inputs(&[(&body, frame.gel_from_indenter)]);
                seen.push((inputs.to_vec(), frame.of_moment as f32));
            }
        }
        self.ood_score.calibrate(self.layout.grid(), &seen);
        Ok(())
    }

    /// Depth of the shape's origin below the top of the gel's middle, whole mm.
    fn whole_depth_mm(&self, frame: &FrameErrors<'_>) -> u32 {
        (self.center_mm.z - frame.gel_from_indenter.position_mm.z).max(0.0) as u32
    }

    /// Distance of the shape's origin from the gel's middle, as a fraction of the distance from the
    /// middle to a corner, below 1.
    fn part_to_corner(&self, frame: &FrameErrors<'_>) -> f64 {
        let [low_mm, _] = self.bounds_mm();
        let way_mm = (frame.gel_from_indenter.position_mm - self.center_mm).truncate();
        (way_mm.length() / (self.center_mm.truncate() - low_mm).length()).min(0.999)
    }

    fn is_at_edge(&self, frame: &FrameErrors<'_>) -> bool {
        let [low_mm, high_mm] = self.bounds_mm();
        let at_mm = frame.gel_from_indenter.position_mm.truncate();
        let from_edge_mm = (at_mm - low_mm).min(high_mm - at_mm).min_element();
        from_edge_mm <= 0.5 * self.layout.surroundings.height_mm()
    }
}

fn group_errors(frames: &[&FrameErrors<'_>]) -> Option<GroupErrors> {
    let percent = |error: &dyn Fn(&FrameErrors<'_>) -> f64| {
        mean(frames.iter().map(|frame| error(frame))).map(|mean| 100.0 * mean)
    };
    Some(GroupErrors {
        n_frames: frames.len(),
        nearest_percent: percent(&|frame| frame.nearest.abs())?,
        nearest_bias_percent: percent(&|frame| frame.nearest)?,
        all_percent: percent(&|frame| frame.all)?,
        force_percent: percent(&|frame| frame.force)?,
        off_by_a_tenth_percent: percent(&|frame| f64::from(u8::from(frame.of_moment > 0.1))),
    })
}

/// The mean of numbers; `None` without numbers.
fn mean(numbers: impl ExactSizeIterator<Item = f64>) -> Option<f64> {
    let n = numbers.len();
    (n > 0).then(|| numbers.sum::<f64>() / n as f64)
}

fn name(shape: &Shape) -> &'static str {
    match shape {
        Shape::Sphere { .. } => "sphere",
        Shape::Cylinder { .. } => "cylinder",
        Shape::Box { .. } => "box",
        Shape::X { .. } => "x",
        Shape::Ring { .. } => "ring",
        Shape::Triangle { .. } => "triangle",
        Shape::Wedge { .. } => "wedge",
        Shape::Stl { .. } => "stl",
        Shape::Union { .. } => "union",
    }
}
