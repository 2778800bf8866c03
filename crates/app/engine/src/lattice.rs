//! Locations all over a gel. A mesh that is fine at each of them is fine wherever the user presses.

use glam::DVec2;
use twintac_sensor::Sensor;

/// Distance between the locations in gel heights. At this distance the fine parts of the mesh
/// merge.
const APART: f64 = 0.6;

/// Most locations along an axis.
const MOST: f64 = 12.0;

/// Locations over the gel, its middle first, mm.
pub(crate) fn places_mm(sensor: &Sensor) -> Vec<DVec2> {
    let (solid, surfaces) = (&sensor.gel.solid, &sensor.surfaces);
    let (low, high) = solid.bounds_mm(surfaces);
    let (middle, size) = (0.5 * (low + high).truncate(), (high - low).truncate());
    let counts = (size / (APART * high.z))
        .ceil()
        .clamp(DVec2::ONE, DVec2::splat(MOST));
    let steps = |count: f64| (0..count as u32).map(move |i| (f64::from(i) + 0.5) / count - 0.5);
    let all = steps(counts.x).flat_map(|x| steps(counts.y).map(move |y| middle + size * DVec2::new(x, y)));
    let covered = |place: &DVec2| solid.top_height_mm(place.x, place.y, surfaces).is_some();
    std::iter::once(middle).chain(all.filter(covered)).collect()
}
