//! The area over which the gel carries a body.

use glam::DVec2;

use crate::contact::N_CHANNELS;
use crate::distance::REACH_MM;
use crate::surface::SurfaceGrid;

/// Points whose depth inside a body is more than this fraction of the largest depth carry it: under
/// a ball this gives the contact area of the FEM solution.
const CARRYING: f32 = 0.38;

/// Width of the transition between points that do not carry and points that do, as a fraction of
/// the largest depth.
const CHANGE: f32 = 0.24;

/// Smallest remaining height of the gel under a body, as a fraction of its undeformed height: the
/// reach of distances ends there.
const THINNEST: f64 = 0.4;

/// The points of a grid that carry a body.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Footprint<'a> {
    /// Locations that carry, mm, each with the fraction of its area that carries.
    places: &'a [(DVec2, f32)],
    /// Spacing of the points, mm.
    spacing_mm: f32,
    /// Depth of the deepest point inside the body, in units of the reach.
    deepest: f32,
    /// Height of the undeformed gel at that point, mm.
    height_mm: f64,
}

impl<'a> Footprint<'a> {
    /// The footprint of bodies; `None` where nothing touches.
    ///
    /// - `inputs`: network inputs of the grid's points. `[n_points * N_CHANNELS]`
    /// - `places`: is overwritten with the locations that carry.
    pub(crate) fn of(grid: &SurfaceGrid, inputs: &[f32], places: &'a mut Vec<(DVec2, f32)>) -> Option<Self> {
        let points = inputs.as_chunks::<N_CHANNELS>().0;
        let depths = points.iter().map(|point| point[0] - 1.0);
        let deepest_of = depths.clone().zip(&grid.height_mm);
        let (deepest, height_mm) = deepest_of.max_by(|a, b| a.0.total_cmp(&b.0))?;
        if deepest <= 0.0 {
            return None;
        }
        let carries = |inside: f32| ((inside / deepest - CARRYING) / CHANGE + 0.5).clamp(0.0, 1.0);
        places.clear();
        places.extend(
            grid.places()
                .zip(depths.map(carries))
                .filter(|(_, share)| *share > 0.0),
        );
        Some(Self {
            places,
            spacing_mm: grid.spacing_mm as f32,
            deepest,
            height_mm: *height_mm,
        })
    }

    /// Locations that carry, mm, each with the fraction of its area that carries.
    pub(crate) fn places(&self) -> impl Iterator<Item = (DVec2, f32)> + '_ {
        self.places.iter().copied()
    }

    /// Area that carries, mm².
    pub(crate) fn area_mm2(&self) -> f32 {
        self.spacing_mm * self.spacing_mm * self.places().map(|(_, share)| share).sum::<f32>()
    }

    /// Remaining height of the gel under the deepest point, mm.
    pub(crate) fn thickness_mm(&self) -> f64 {
        (self.height_mm - f64::from(self.deepest * REACH_MM)).max(THINNEST * self.height_mm)
    }
}
