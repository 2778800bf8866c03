//! The bent tensor grid that meshes are cut from.

use glam::DVec3;

use crate::axis::{Axis, Core};
use crate::settings::{Cuboid, MeshSettings};
use crate::size::SizeField;
use crate::{Focus, MeshError};

/// Largest number of lattice points of a mesh.
const MOST_POINTS: usize = 20_000_000;

/// Lines along x and y, and planes along z. With inclusions, the positions of lines depend on the
/// height; see [`Axis`].
pub(crate) struct Lattice {
    pub(crate) x: Axis,
    pub(crate) y: Axis,
    pub(crate) z_mm: Vec<f64>,
    /// Index into `z_mm` of the plane below which lines follow the inclusions.
    inclusion_top: usize,
    /// The cells of each inclusion.
    boxes: Vec<IndexBox>,
}

/// A box of cells from `low` to `high`, without `high`.
struct IndexBox {
    low: [usize; 3],
    high: [usize; 3],
}

impl Lattice {
    /// A lattice over the box from `low_mm` to `high_mm`. Focuses are in the coordinates of the
    /// lattice (before bending). The mirror lines keep a margin to the walls.
    pub(crate) fn new(
        [low_mm, high_mm]: [DVec3; 2],
        inclusions: &[Cuboid],
        settings: &MeshSettings,
        margin_mm: f64,
    ) -> Result<Self, MeshError> {
        let smallest_mm = settings.smallest_edge_mm();
        let faces = |axis: usize| {
            let ends = [low_mm[axis], high_mm[axis]];
            distinct_faces(
                inclusions.iter().flat_map(|c| [c.min_mm[axis], c.max_mm[axis]]),
                ends,
                0.05 * smallest_mm,
            )
        };
        let across = |axis: usize| {
            let planes = faces(axis);
            let mut size = SizeField::new(settings.edge_mm, settings.growth);
            for focus in &settings.focuses {
                size.refine(focus.center_mm[axis], focus.radius_mm, focus.edge_mm);
                for stretch in &focus.stretches[axis] {
                    size.refine(
                        focus.center_mm[axis] + stretch.offset_mm,
                        stretch.reach_mm,
                        stretch.edge_mm,
                    );
                }
            }
            size.separate(&planes);
            let focus = settings.focuses.first().map(|focus: &Focus| Core {
                center_mm: focus.center_mm[axis],
                radius_mm: focus.radius_mm,
                edge_mm: focus.edge_mm,
                growth: settings.growth,
                stretches: &focus.stretches[axis],
                lines_mm: &focus.lines_mm[axis],
            });
            Axis::new([low_mm[axis], high_mm[axis]], focus, &planes, &size, margin_mm)
        };
        let (x, y) = (across(0)?, across(1)?);

        let planes = faces(2);
        let mut size = SizeField::new(settings.edge_mm, settings.growth);
        size.refine(high_mm.z, 0.0, settings.edge_mm * settings.top_edge_ratio);
        for focus in &settings.focuses {
            size.refine(focus.center_mm.z, 0.0, focus.edge_mm);
        }
        let mut z_mm = vec![low_mm.z];
        for pair in planes.windows(2) {
            size.divide(pair[0], pair[1], &mut z_mm)?;
        }

        let points = x.ideal_mm.len() * y.ideal_mm.len() * z_mm.len();
        if points > MOST_POINTS {
            return Err(MeshError::TooFine {
                found: points,
                most: MOST_POINTS,
            });
        }
        let plane_at = |at_mm: f64| {
            (0..z_mm.len())
                .min_by(|&a, &b| (z_mm[a] - at_mm).abs().total_cmp(&(z_mm[b] - at_mm).abs()))
                .expect("a lattice has two planes at least")
        };
        let boxes: Vec<IndexBox> = inclusions
            .iter()
            .map(|cuboid| {
                let at = |p: DVec3| [x.line_at(p.x), y.line_at(p.y), plane_at(p.z)];
                IndexBox {
                    low: at(cuboid.min_mm),
                    high: at(cuboid.max_mm),
                }
            })
            .collect();
        let inclusion_top = boxes.iter().map(|b| b.high[2]).max().unwrap_or(0);
        Ok(Self {
            x,
            y,
            z_mm,
            inclusion_top,
            boxes,
        })
    }

    /// The same lattice with snapped lines up to the top, so that no line leans.
    pub(crate) fn upright(mut self) -> Self {
        for axis in [&mut self.x, &mut self.y] {
            axis.ideal_mm.clone_from(&axis.snapped_mm);
        }
        self
    }

    /// Number of points along each axis.
    pub(crate) fn points(&self) -> [usize; 3] {
        [self.x.ideal_mm.len(), self.y.ideal_mm.len(), self.z_mm.len()]
    }

    /// Position of a lattice point, mm.
    pub(crate) fn position_mm(&self, [i, j, k]: [usize; 3]) -> DVec3 {
        let z_mm = self.z_mm[k];
        let share = self.inclusion_share(z_mm);
        DVec3::new(self.x.at_mm(i, share), self.y.at_mm(j, share), z_mm)
    }

    /// Weight of the snapped lines at a height: 1 up to the top of the inclusions, from there
    /// falling to 0 half-way to the top of the lattice.
    fn inclusion_share(&self, z_mm: f64) -> f64 {
        let from_mm = self.z_mm[self.inclusion_top];
        let to_mm = 0.5 * (from_mm + self.z_mm[self.z_mm.len() - 1]);
        if self.boxes.is_empty() {
            0.0
        } else {
            ((to_mm - z_mm) / (to_mm - from_mm)).clamp(0.0, 1.0)
        }
    }

    /// Height of the tallest inclusion, mm; that of the board if there is none.
    pub(crate) fn inclusion_top_mm(&self) -> f64 {
        self.z_mm[self.inclusion_top]
    }

    /// The inclusions as the lattice represents them: merged faces are in one plane, boxes without
    /// a cell are missing.
    pub(crate) fn inclusions(&self) -> Vec<Cuboid> {
        let at_mm =
            |[i, j, k]: [usize; 3]| DVec3::new(self.x.snapped_mm[i], self.y.snapped_mm[j], self.z_mm[k]);
        let cuboid = |b: &IndexBox| Cuboid {
            min_mm: at_mm(b.low),
            max_mm: at_mm(b.high),
        };
        self.boxes
            .iter()
            .map(cuboid)
            .filter(|c| c.min_mm.cmplt(c.max_mm).all())
            .collect()
    }

    /// Whether a cell, given by its lowest point, is in an inclusion.
    pub(crate) fn is_inclusion(&self, cell: [usize; 3]) -> bool {
        self.boxes
            .iter()
            .any(|b| (0..3).all(|axis| (b.low[axis]..b.high[axis]).contains(&cell[axis])))
    }

    /// Whether a point is on the board, or on or in an inclusion.
    pub(crate) fn is_bonded(&self, point: [usize; 3]) -> bool {
        let in_box = |b: &IndexBox| (0..3).all(|axis| (b.low[axis]..=b.high[axis]).contains(&point[axis]));
        point[2] == 0 || self.boxes.iter().any(in_box)
    }
}

/// Sorted faces strictly between the ends, and the ends. Of faces closer than the tolerance only
/// the first is kept.
fn distinct_faces(faces: impl Iterator<Item = f64>, ends: [f64; 2], tolerance_mm: f64) -> Vec<f64> {
    let mut inner: Vec<f64> = faces
        .filter(|&f| f > ends[0] + tolerance_mm && f < ends[1] - tolerance_mm)
        .collect();
    inner.sort_by(f64::total_cmp);
    inner.dedup_by(|later, kept| *later - *kept < tolerance_mm);
    let mut planes = vec![ends[0]];
    planes.extend(inner);
    planes.push(ends[1]);
    planes
}
