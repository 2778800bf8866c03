//! How far a fast gel is from the gel that was solved.

use std::collections::BTreeMap;

use glam::DVec3;
use serde::{Deserialize, Serialize};
use twintac_shape::{Pose, Shape, ShapeError, Surfaces};

use crate::{Body, FastGel, Lesson};

/// Errors of a group of frames, as part of each press's largest value.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GroupErrors {
    /// Number of frames.
    pub n_frames: usize,
    /// Mean error of the taxel that reads most, %.
    pub nearest_percent: f64,
    /// Mean of the same with its sign, %.
    pub nearest_bias_percent: f64,
    /// Mean error over all taxels, %.
    pub all_percent: f64,
    /// Mean length of the error of the force, %.
    pub force_percent: f64,
}

/// How far a fast gel is from the solved gel on presses that it was not taught.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Judgement {
    /// All frames.
    pub overall: GroupErrors,
    /// By kind of shape.
    pub by_shape: BTreeMap<String, GroupErrors>,
    /// By depth below the undeformed surface, mm: from a whole number to the next.
    pub by_depth_mm: BTreeMap<u32, GroupErrors>,
    /// By distance of the shape's origin from the gel's middle, as part of the way to its corner: four equal parts.
    pub by_place: BTreeMap<String, GroupErrors>,
    /// What is read of shapes that do not touch, 0.1 to 1 mm above the gel: the largest at any taxel, mean, % of each press's largest.
    #[serde(default)]
    pub untouched_percent: f64,
    /// Frames whose contact is like what was taught (`familiar`), and others (`new`).
    pub by_novelty: BTreeMap<String, GroupErrors>,
}

/// Gaps between gel and shape at which nothing should be read, mm.
const GAPS_MM: [f64; 4] = [0.1, 0.25, 0.5, 1.0];

/// Errors of one frame, as part of the press's largest value.
struct FrameErrors {
    shape: &'static str,
    depth_mm: f64,
    from_middle: f64,
    novelty: f32,
    nearest: f64,
    all: f64,
    force: f64,
}

impl FastGel {
    /// Compares readings with those of solved presses.
    ///
    /// # Errors
    /// A press whose shape can't be.
    pub fn judge(&self, presses: &[Lesson], surfaces: &Surfaces) -> Result<Judgement, ShapeError> {
        let (mut frames, mut untouched) = (Vec::new(), Vec::new());
        for press in presses {
            self.judge_press(press, surfaces, &mut frames, &mut untouched)?;
        }
        let grouped = |key: &dyn Fn(&FrameErrors) -> String| {
            let mut groups: BTreeMap<String, Vec<&FrameErrors>> = BTreeMap::new();
            for frame in &frames {
                groups.entry(key(frame)).or_default().push(frame);
            }
            groups
                .into_iter()
                .map(|(key, frames)| (key, mean(&frames)))
                .collect()
        };
        let mut by_depth: BTreeMap<u32, Vec<&FrameErrors>> = BTreeMap::new();
        for frame in &frames {
            by_depth
                .entry(frame.depth_mm.max(0.0) as u32)
                .or_default()
                .push(frame);
        }
        let quarter = |frame: &FrameErrors| {
            let quarter = (4.0 * frame.from_middle).min(3.0).floor();
            format!("{:.0} to {:.0} %", 25.0 * quarter, 25.0 * (quarter + 1.0))
        };
        Ok(Judgement {
            untouched_percent: 100.0 * untouched.iter().sum::<f64>() / untouched.len().max(1) as f64,
            overall: mean(&frames.iter().collect::<Vec<_>>()),
            by_shape: grouped(&|frame| frame.shape.to_owned()),
            by_depth_mm: by_depth
                .into_iter()
                .map(|(depth, frames)| (depth, mean(&frames)))
                .collect(),
            by_place: grouped(&quarter),
            by_novelty: grouped(&|frame| if frame.novelty > 1.0 { "new" } else { "familiar" }.to_owned()),
        })
    }

    fn judge_press(
        &self,
        press: &Lesson,
        surfaces: &Surfaces,
        frames: &mut Vec<FrameErrors>,
        untouched: &mut Vec<f64>,
    ) -> Result<(), ShapeError> {
        let body = Body::new(&press.shape, surfaces)?;
        let n_taxels = self.ports_mm.len();
        let ports = |floor_kpa: &[f32]| floor_kpa[..n_taxels].to_vec();
        let read = press.frames.iter().flat_map(|frame| ports(&frame.floor_kpa));
        let largest_kpa = f64::from(read.fold(f32::MIN_POSITIVE, f32::max));
        let largest_n = press.frames.iter().map(|frame| frame.force_n.length());
        let largest_n = largest_n.fold(f64::MIN_POSITIVE, f64::max);
        let corner_mm = self.center_mm.truncate() - self.layout.surroundings.low_mm();
        let mut reader = self.reader();
        let (mut found_kpa, mut wrench) = (vec![0.0; n_taxels], [0.0; 6]);
        for frame in &press.frames {
            let touching = [(&body, frame.gel_from_indenter)];
            reader.read(&touching, &mut found_kpa, &mut wrench);
            let solved_kpa = ports(&frame.floor_kpa);
            let error = |taxel: usize| f64::from(found_kpa[taxel] - solved_kpa[taxel]) / largest_kpa;
            let Some(nearest) = (0..n_taxels).max_by(|a, b| solved_kpa[*a].total_cmp(&solved_kpa[*b])) else {
                continue;
            };
            let position_mm = frame.gel_from_indenter.position_mm;
            let force = glam::Vec3::new(wrench[0], wrench[1], wrench[2]).as_dvec3();
            frames.push(FrameErrors {
                shape: name(&press.shape),
                depth_mm: self.center_mm.z - position_mm.z,
                from_middle: (position_mm - self.center_mm).truncate().length() / corner_mm.length(),
                novelty: reader.novelty(&touching),
                nearest: error(nearest),
                all: (0..n_taxels).map(|taxel| error(taxel).abs()).sum::<f64>() / n_taxels as f64,
                force: force.distance(frame.force_n) / largest_n,
            });
        }
        for (touch, gap_mm) in press
            .touch()
            .into_iter()
            .flat_map(|touch| GAPS_MM.map(|gap_mm| (touch, gap_mm)))
        {
            let above = Pose {
                position_mm: touch.position_mm + gap_mm * DVec3::Z,
                ..touch
            };
            reader.read(&[(&body, above)], &mut found_kpa, &mut wrench);
            let most_kpa = found_kpa.iter().fold(0.0f32, |most, found| most.max(found.abs()));
            untouched.push(f64::from(most_kpa) / largest_kpa);
        }
        Ok(())
    }
}

fn mean(frames: &[&FrameErrors]) -> GroupErrors {
    let percent = |error: &dyn Fn(&FrameErrors) -> f64| {
        100.0 * frames.iter().map(|frame| error(frame)).sum::<f64>() / frames.len().max(1) as f64
    };
    GroupErrors {
        n_frames: frames.len(),
        nearest_percent: percent(&|frame| frame.nearest.abs()),
        nearest_bias_percent: percent(&|frame| frame.nearest),
        all_percent: percent(&|frame| frame.all),
        force_percent: percent(&|frame| frame.force),
    }
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
