//! A press that was solved on one mesh, by either program, and how far two of them differ.

use std::collections::BTreeMap;

use serde::{Deserialize, Serialize};

/// A pressure error is relative to the taxel's own pressure above this fraction of the largest
/// pressure at a taxel.
const MEANINGFUL: f64 = 0.05;

/// One press on one mesh.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Pressed {
    /// Name of the case.
    pub(super) case: String,
    /// Elements of the gel.
    pub(super) n_elements: usize,
    /// Nodes of the gel.
    pub(super) n_nodes: usize,
    /// One frame for each depth.
    pub(super) frames: Vec<PressedFrame>,
}

/// The gel at one depth.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct PressedFrame {
    pub(super) depth_mm: f64,
    /// Force on the board, N.
    pub(super) force_n: f64,
    /// Largest penetration of a node of the gel's top into the indenter, mm.
    pub(super) penetration_mm: f64,
    /// Mean of -tr(σ)/3 over each taxel's port, kPa.
    pub(super) pressure_kpa: BTreeMap<String, f64>,
    /// -tr(σ)/3 at points along the board, kPa.
    pub(super) line_kpa: Vec<f64>,
}

/// How far a frame is from a reference, %.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Difference {
    /// Force, relative to that of the reference.
    pub(super) force: f64,
    /// Size at the taxel where it is largest, relative to the pressure there if that is large
    /// enough, else to the largest pressure at any taxel.
    pub(super) worst_taxel: f64,
    /// Root mean square along the board, relative to the largest pressure there.
    pub(super) along_board: f64,
}

impl Pressed {
    /// The mean of forces and pressures of the same press on several meshes; `None` without meshes
    /// or if they have other depths. The numbers of elements and nodes are those of the finest
    /// mesh.
    pub(super) fn mean(meshes: &[&Self]) -> Option<Self> {
        let mut mean = (*meshes.iter().max_by_key(|mesh| mesh.n_elements)?).clone();
        if meshes.iter().any(|mesh| mesh.frames.len() != mean.frames.len()) {
            return None;
        }
        for (index, frame) in mean.frames.iter_mut().enumerate() {
            let frames: Vec<&PressedFrame> = meshes.iter().map(|mesh| &mesh.frames[index]).collect();
            let mean_of = |value: &dyn Fn(&PressedFrame) -> f64| {
                frames.iter().map(|frame| value(frame)).sum::<f64>() / frames.len() as f64
            };
            frame.force_n = mean_of(&|frame| frame.force_n);
            frame.penetration_mm = mean_of(&|frame| frame.penetration_mm);
            for (taxel, kpa) in &mut frame.pressure_kpa {
                *kpa = mean_of(&|frame| frame.pressure_kpa.get(taxel).copied().unwrap_or(f64::NAN));
            }
            for (point, kpa) in frame.line_kpa.iter_mut().enumerate() {
                *kpa = mean_of(&|frame| frame.line_kpa[point]);
            }
        }
        Some(mean)
    }

    /// The largest difference from another mesh, of all depths that both have.
    pub(super) fn largest_difference(&self, reference: &Self) -> Difference {
        let frames = self.frames.iter().zip(&reference.frames);
        frames.map(|(frame, reference)| frame.difference(reference)).fold(
            Difference::default(),
            |largest, one| Difference {
                force: larger(largest.force, one.force),
                worst_taxel: larger(largest.worst_taxel, one.worst_taxel),
                along_board: larger(largest.along_board, one.along_board),
            },
        )
    }
}

impl PressedFrame {
    /// How far this frame is from a reference at the same depth.
    pub(super) fn difference(&self, reference: &Self) -> Difference {
        let largest_kpa = reference.pressure_kpa.values().copied().fold(0.0, larger);
        let worst_taxel = reference.pressure_kpa.iter().map(|(taxel, &theirs_kpa)| {
            let ours_kpa = self.pressure_kpa.get(taxel).copied().unwrap_or(f64::NAN);
            let is_meaningful = theirs_kpa.abs() > MEANINGFUL * largest_kpa;
            let whole_kpa = if is_meaningful {
                theirs_kpa.abs()
            } else {
                largest_kpa
            };
            percent(ours_kpa - theirs_kpa, whole_kpa)
        });
        let pairs = self.line_kpa.iter().zip(&reference.line_kpa);
        let squares: f64 = pairs.map(|(ours, theirs)| (ours - theirs).powi(2)).sum();
        let root_mean_square_kpa = (squares / reference.line_kpa.len() as f64).sqrt();
        Difference {
            force: percent(self.force_n - reference.force_n, reference.force_n),
            worst_taxel: worst_taxel.fold(0.0, larger),
            along_board: percent(
                root_mean_square_kpa,
                reference.line_kpa.iter().copied().fold(0.0, larger),
            ),
        }
    }
}

/// The larger size of two values; NaN if one of them is.
fn larger(size: f64, value: f64) -> f64 {
    if value.abs() <= size {
        size
    } else {
        value.abs() + 0.0 * size
    }
}

fn percent(part: f64, whole: f64) -> f64 {
    100.0 * part / whole
}

#[cfg(test)]
mod tests {
    use super::*;

    fn on_mesh(n_elements: usize, force_n: f64, kpa: f64) -> Pressed {
        Pressed {
            case: "case".into(),
            n_elements,
            n_nodes: 2 * n_elements,
            frames: vec![PressedFrame {
                depth_mm: 1.0,
                force_n,
                penetration_mm: 0.0,
                pressure_kpa: [("t0".to_owned(), kpa)].into(),
                line_kpa: vec![2.0 * kpa],
            }],
        }
    }

    #[test]
    fn the_mean_of_meshes_is_of_each_value() {
        let meshes = [on_mesh(100, 1.0, 10.0), on_mesh(300, 2.0, 20.0)];
        let mean = Pressed::mean(&meshes.each_ref()).unwrap();
        assert_eq!(mean.n_elements, 300);
        assert_eq!(mean.frames[0].force_n, 1.5);
        assert_eq!(mean.frames[0].pressure_kpa["t0"], 15.0);
        assert_eq!(mean.frames[0].line_kpa, [30.0]);
        let difference = meshes[0].largest_difference(&mean);
        for percent in [difference.force, difference.worst_taxel, difference.along_board] {
            assert!((percent - 100.0 / 3.0).abs() < 1e-9, "{difference:?}");
        }
        assert!(Pressed::mean(&[]).is_none());
    }

    #[test]
    fn small_pressures_count_as_part_of_the_largest() {
        let frame = |force_n: f64, [near_kpa, far_kpa]: [f64; 2], line_kpa: [f64; 2]| PressedFrame {
            depth_mm: 1.0,
            force_n,
            penetration_mm: 0.0,
            pressure_kpa: [("near".to_owned(), near_kpa), ("far".to_owned(), far_kpa)].into(),
            line_kpa: line_kpa.to_vec(),
        };
        let reference = frame(1.0, [10.0, 0.1], [10.0, 0.0]);
        let near = frame(0.98, [10.5, 0.3], [10.0, 1.0]).difference(&reference);
        assert!((near.force + 2.0).abs() < 1e-9 && (near.worst_taxel - 5.0).abs() < 1e-9);
        assert!((near.along_board - 10.0 / 2_f64.sqrt()).abs() < 1e-9);
        let far = frame(1.0, [10.0, 0.3], [10.0, 0.0]).difference(&reference);
        assert!((far.worst_taxel - 2.0).abs() < 1e-9);
        let broken = frame(1.0, [f64::NAN, 0.1], [10.0, 0.0]).difference(&reference);
        assert!(broken.worst_taxel.is_nan());
    }
}
