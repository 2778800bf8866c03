//! Where a body is carried by the gel.

use glam::DVec2;

use crate::contact::N_CHANNELS;
use crate::distance::REACH_MM;
use crate::surface::SurfaceGrid;

/// Points that are inside a body by more than this part of the deepest carry it: under a ball that is the area that the finite elements touch.
const CARRYING: f32 = 0.38;

/// Width of the change from points that do not to points that do, as part of the deepest.
const CHANGE: f32 = 0.24;

/// The gel under a body is no thinner than this part of what it was: the reach of distances ends there.
const THINNEST: f64 = 0.4;

/// The points of a grid on which a body stands.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Footprint<'a> {
    grid: &'a SurfaceGrid,
    /// What touches the points. `[n_points * N_CHANNELS]`
    inputs: &'a [f32],
    /// How far the deepest point is inside the body, in units of the reach.
    deepest: f32,
    /// Height of the undeformed gel there, mm.
    height_mm: f64,
}

impl<'a> Footprint<'a> {
    /// Where what touches is carried; `None` where nothing touches.
    pub(crate) fn of(grid: &'a SurfaceGrid, inputs: &'a [f32]) -> Option<Self> {
        let points = inputs.as_chunks::<N_CHANNELS>().0.iter().zip(&grid.height_mm);
        let depths = points.map(|(point, height_mm)| (point[0] - 1.0, *height_mm));
        let (deepest, height_mm) = depths.max_by(|a, b| a.0.total_cmp(&b.0))?;
        (deepest > 0.0).then_some(Self {
            grid,
            inputs,
            deepest,
            height_mm,
        })
    }

    /// Places that carry, mm, and how much of its area each carries.
    pub(crate) fn places(&self) -> impl Iterator<Item = (DVec2, f32)> + '_ {
        let points = self.inputs.as_chunks::<N_CHANNELS>().0;
        let carries = |inside: f32| ((inside / self.deepest - CARRYING) / CHANGE + 0.5).clamp(0.0, 1.0);
        self.grid
            .places()
            .zip(points)
            .map(move |(at, point)| (at, carries(point[0] - 1.0)))
            .filter(|(_, share)| *share > 0.0)
    }

    /// Area that carries, mm².
    pub(crate) fn area_mm2(&self) -> f32 {
        let spacing_mm = self.grid.spacing_mm as f32;
        spacing_mm * spacing_mm * self.places().map(|(_, share)| share).sum::<f32>()
    }

    /// Height of the gel that is left under the deepest point, mm.
    pub(crate) fn thickness_mm(&self) -> f64 {
        (self.height_mm - f64::from(self.deepest * REACH_MM)).max(THINNEST * self.height_mm)
    }
}
