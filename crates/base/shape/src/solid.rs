//! What a gel can look like. A gel stands on the plane z = 0 (the printed circuit board).

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use crate::block::Block;
use crate::shape::{above_zero, between};
use crate::{Distance, Dome, ShapeError, SignedDistance, Surfaces, TriangleSurface};

/// The undeformed gel.
///
/// What a [`Solid::Stl`] looks like stands in the [`Surfaces`] that its methods take; one whose surface is
/// not among them is empty.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Solid {
    /// A block.
    Block {
        /// Full size along x, y and z, mm.
        size_mm: [f64; 3],
        /// Where the footprint's centre is, mm: [x, y].
        #[serde(default)]
        center_mm: [f64; 2],
        /// Rounding of the top edges, mm; 0 leaves them sharp. Two rounded edges meet in a mitre.
        #[serde(default)]
        edge_radius_mm: f64,
    },
    /// A block with a domed top.
    Dome(Dome),
    /// A closed triangle surface in an STL file, path relative to the file that names it.
    Stl {
        /// Path of the STL file.
        path: String,
    },
}

impl Solid {
    /// Whether there can be such a solid.
    ///
    /// # Errors
    /// The first field whose value is out of range.
    pub fn validate(&self) -> Result<(), ShapeError> {
        match self {
            Self::Block {
                size_mm,
                edge_radius_mm,
                ..
            } => {
                for (axis, size) in size_mm.iter().enumerate() {
                    above_zero(&format!("size_mm[{axis}]"), *size)?;
                }
                let most_mm = (0.5 * size_mm[0]).min(0.5 * size_mm[1]).min(size_mm[2]);
                between("edge_radius_mm", *edge_radius_mm, 0.0, most_mm)
            }
            Self::Dome(dome) => {
                for (name, ends) in [("x_mm", dome.x_mm), ("y_mm", dome.y_mm)] {
                    above_zero(&format!("{name}[1]"), ends[1] - ends[0]).map_err(|error| ShapeError {
                        expected: format!("more than {name}[0]"),
                        ..error
                    })?;
                }
                above_zero("crown_mm", dome.crown_mm)?;
                between("crown_at_mm[0]", dome.crown_at_mm[0], dome.x_mm[0], dome.x_mm[1])?;
                between("crown_at_mm[1]", dome.crown_at_mm[1], dome.y_mm[0], dome.y_mm[1])?;
                for (side, drop_mm) in dome.drop_y_mm.iter().enumerate() {
                    between(&format!("drop_y_mm[{side}]"), *drop_mm, 0.0, 0.99 * dome.crown_mm)?;
                }
                let left_mm = 0.99 * dome.crown_mm - dome.drop_y_mm[0].max(dome.drop_y_mm[1]);
                for (side, drop_mm) in dome.drop_x_mm.iter().enumerate() {
                    between(&format!("drop_x_mm[{side}]"), *drop_mm, 0.0, left_mm)?;
                }
                Ok(())
            }
            Self::Stl { path } if path.is_empty() => {
                Err(ShapeError::new("path", "empty", "the path of an STL file"))
            }
            Self::Stl { .. } => Ok(()),
        }
    }

    /// Signed distance to the gel's surface, mm; `None` for an empty solid.
    ///
    /// Exact, but for a lower bound at the outside of a block's corner ridges, and for domes further below
    /// their top than its radius of curvature.
    #[must_use]
    pub fn signed_distance(&self, point_mm: DVec3, surfaces: &Surfaces) -> Option<Distance> {
        match self {
            Self::Block { center_mm, .. } => Some(
                self.block()?
                    .signed_distance(point_mm - DVec2::from(*center_mm).extend(0.0)),
            ),
            Self::Dome(dome) => Some(dome.signed_distance(point_mm)),
            Self::Stl { path } => Some(surfaces.get(path)?.signed_distance(point_mm)),
        }
    }

    /// Whether a point is in the gel or at most `tolerance_mm` outside.
    #[must_use]
    pub fn contains(&self, point_mm: DVec3, tolerance_mm: f64, surfaces: &Surfaces) -> bool {
        self.signed_distance(point_mm, surfaces)
            .is_some_and(|found| found.distance_mm <= tolerance_mm)
    }

    /// Height of the gel's top above a place of its plane, mm; `None` beside the gel.
    #[must_use]
    pub fn top_height_mm(&self, x_mm: f64, y_mm: f64, surfaces: &Surfaces) -> Option<f64> {
        let at = DVec2::new(x_mm, y_mm);
        match self {
            Self::Block { center_mm, .. } => self.block()?.top_height_mm(at - DVec2::from(*center_mm)),
            Self::Dome(dome) => dome.top_height_mm(x_mm, y_mm),
            Self::Stl { path } => surfaces.get(path)?.top_height_mm(at),
        }
    }

    /// Smallest box, as (minimum, maximum) corners, that holds the gel, mm; of no size for an empty solid.
    #[must_use]
    pub fn bounds_mm(&self, surfaces: &Surfaces) -> (DVec3, DVec3) {
        match self {
            Self::Block {
                size_mm, center_mm, ..
            } => {
                let center = DVec2::from(*center_mm).extend(0.0);
                let half = 0.5 * DVec3::from(*size_mm).with_z(0.0);
                (center - half, center + half.with_z(size_mm[2]))
            }
            Self::Dome(dome) => dome.bounds_mm(),
            Self::Stl { path } => surfaces
                .get(path)
                .map_or((DVec3::ZERO, DVec3::ZERO), |surface| surface.bounds_mm()),
        }
    }

    /// Volume, mm³, with whatever is embedded in the gel; exact.
    #[must_use]
    pub fn volume_mm3(&self, surfaces: &Surfaces) -> f64 {
        match self {
            Self::Block { .. } => self.block().map_or(0.0, |block| block.volume_mm3()),
            Self::Dome(dome) => dome.volume_mm3(),
            Self::Stl { path } => surfaces
                .get(path)
                .map_or(0.0, |surface| TriangleSurface::volume_mm3(surface)),
        }
    }

    fn block(&self) -> Option<Block> {
        match self {
            Self::Block {
                size_mm,
                edge_radius_mm,
                ..
            } => Some(Block {
                size_mm: DVec3::from(*size_mm),
                edge_radius_mm: *edge_radius_mm,
            }),
            _ => None,
        }
    }
}
