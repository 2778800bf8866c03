//! Errors of a surrogate at one frame, compared with the FEM solution.

use glam::DVec3;
use twintac_shape::{Pose, ShapeError, Surfaces};

use crate::{Body, FastGel, FemPress};

/// Gaps between gel and shape at which all pressures should be zero, mm.
const GAPS_MM: [f64; 4] = [0.1, 0.25, 0.5, 1.0];

/// In relative errors, a value below this fraction of a press's largest value counts as this
/// fraction.
const LEAST_OF_PRESS: f64 = 0.25;

/// Errors of one frame of a press.
pub(super) struct FrameErrors<'a> {
    pub(super) press: &'a FemPress,
    pub(super) gel_from_indenter: Pose,
    pub(super) ood_score: f32,
    /// Signed error of the pressure at the taxel with the largest pressure, as a fraction of the
    /// press's largest pressure.
    pub(super) nearest: f64,
    /// Mean absolute error over all taxels, as the same fraction.
    pub(super) all: f64,
    /// Length of the error of the force, as a fraction of the press's largest force.
    pub(super) force: f64,
    /// The larger of the errors of the nearest taxel and of the force, relative to their values at
    /// this frame.
    pub(super) of_moment: f64,
}

/// Errors of a press.
pub(super) struct PressErrors<'a> {
    pub(super) frames: Vec<FrameErrors<'a>>,
    /// Predicted pressure while the shape hovers: the largest at any taxel, as a fraction of the
    /// press's largest pressure, for each gap.
    pub(super) untouched: Vec<f64>,
}

impl<'a> PressErrors<'a> {
    pub(super) fn of(gel: &FastGel, press: &'a FemPress, surfaces: &Surfaces) -> Result<Self, ShapeError> {
        let body = Body::new(&press.shape, surfaces)?;
        let n_taxels = gel.n_taxels();
        let read = press.frames.iter().flat_map(|frame| &frame.floor_kpa[..n_taxels]);
        let largest_kpa = f64::from(read.copied().fold(f32::MIN_POSITIVE, f32::max));
        let largest_n = press.frames.iter().map(|frame| frame.force_n.length());
        let largest_n = largest_n.fold(f64::MIN_POSITIVE, f64::max);
        let mut reader = gel.reader();
        let (mut found_kpa, mut wrench) = (vec![0.0; n_taxels], [0.0; 6]);
        let mut frames = Vec::new();
        for frame in &press.frames {
            let touching = [(&body, frame.gel_from_indenter)];
            reader.read(&touching, &mut found_kpa, &mut wrench);
            let solved_kpa = &frame.floor_kpa[..n_taxels];
            let error = |taxel: usize| f64::from(found_kpa[taxel] - solved_kpa[taxel]) / largest_kpa;
            let Some(nearest) = (0..n_taxels).max_by(|a, b| solved_kpa[*a].total_cmp(&solved_kpa[*b])) else {
                continue;
            };
            let force_n = glam::Vec3::new(wrench[0], wrench[1], wrench[2]).as_dvec3();
            let force = force_n.distance(frame.force_n) / largest_n;
            let share = |value: f64, largest: f64| (value / largest).max(LEAST_OF_PRESS);
            let of_pressure = error(nearest).abs() / share(f64::from(solved_kpa[nearest]), largest_kpa);
            let of_force = force / share(frame.force_n.length(), largest_n);
            frames.push(FrameErrors {
                press,
                gel_from_indenter: frame.gel_from_indenter,
                ood_score: reader.ood_score(&touching),
                nearest: error(nearest),
                all: (0..n_taxels).map(|taxel| error(taxel).abs()).sum::<f64>() / n_taxels as f64,
                force,
                of_moment: of_pressure.max(of_force),
            });
        }
        let mut untouched = Vec::new();
        if let Some(touch) = press.touch() {
            for gap_mm in GAPS_MM {
                let above = Pose {
                    position_mm: touch.position_mm + gap_mm * DVec3::Z,
                    ..touch
                };
                reader.read(&[(&body, above)], &mut found_kpa, &mut wrench);
                let most_kpa = found_kpa.iter().fold(0.0f32, |most, found| most.max(found.abs()));
                untouched.push(f64::from(most_kpa) / largest_kpa);
            }
        }
        Ok(Self { frames, untouched })
    }
}
