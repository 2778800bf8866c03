//! Shapes of gels. A gel stands on the plane z = 0 (the printed circuit board).

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use crate::block::Block;
use crate::shape_error::between;
use crate::{Distance, Dome, ShapeError, SignedDistance, SurfaceFile, Surfaces, TriangleSurface};

/// Smallest and largest size of a gel along each axis, mm.
const SIZES_MM: [f64; 2] = [0.1, 1e3];
/// Largest distance of a gel's edge from the origin of its plane, mm.
const FARTHEST_MM: f64 = 1e4;

/// The undeformed gel.
///
/// The methods look up the surface of a [`Solid::Stl`] in the [`Surfaces`] that they are given.
/// They panic if it is not there; it always is for a sensor that was read from its description.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Solid {
    /// A block.
    Block {
        /// Full size along x, y and z, mm.
        size_mm: [f64; 3],
        /// Centre of the footprint, mm: [x, y].
        #[serde(default)]
        center_mm: [f64; 2],
        /// Radius of the top edges, mm; 0 leaves them sharp. Two rounded edges meet in a mitre.
        #[serde(default)]
        edge_radius_mm: f64,
    },
    /// A block with a domed top.
    Dome(Dome),
    /// A closed triangle surface in an STL file that stands on z = 0. If it has several bodies,
    /// none may overlap or touch another.
    Stl(SurfaceFile),
}

impl Solid {
    /// Checks that such a gel is possible.
    ///
    /// # Errors
    /// The first field whose value is out of range.
    pub fn validate(&self) -> Result<(), ShapeError> {
        match self {
            Self::Block {
                size_mm,
                center_mm,
                edge_radius_mm,
            } => {
                for (axis, size) in size_mm.iter().enumerate() {
                    between(&format!("size_mm[{axis}]"), *size, SIZES_MM[0], SIZES_MM[1])?;
                }
                for (axis, at) in center_mm.iter().enumerate() {
                    between(&format!("center_mm[{axis}]"), *at, -FARTHEST_MM, FARTHEST_MM)?;
                }
                let most_mm = (0.5 * size_mm[0]).min(0.5 * size_mm[1]).min(size_mm[2]);
                between("edge_radius_mm", *edge_radius_mm, 0.0, most_mm)
            }
            Self::Dome(dome) => {
                for (name, ends) in [("x_mm", dome.x_mm), ("y_mm", dome.y_mm)] {
                    between(&format!("{name}[0]"), ends[0], -FARTHEST_MM, FARTHEST_MM)?;
                    let [least, most] = SIZES_MM.map(|size_mm| ends[0] + size_mm);
                    between(&format!("{name}[1]"), ends[1], least, most)?;
                }
                between("crown_mm", dome.crown_mm, SIZES_MM[0], SIZES_MM[1])?;
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
            Self::Stl(file) => file.validate(),
        }
    }

    /// Signed distance to the gel's surface, mm.
    ///
    /// Exact, with two exceptions: it is a lower bound outside of a block next to its corner
    /// ridges, and inside of a dome at points further below the top than its smallest radius of
    /// curvature.
    #[must_use]
    pub fn signed_distance(&self, point_mm: DVec3, surfaces: &Surfaces) -> Distance {
        match *self {
            Self::Block {
                size_mm,
                center_mm,
                edge_radius_mm,
            } => {
                block(size_mm, edge_radius_mm).signed_distance(point_mm - DVec2::from(center_mm).extend(0.0))
            }
            Self::Dome(ref dome) => dome.signed_distance(point_mm),
            Self::Stl(ref file) => surface(file, surfaces).signed_distance(point_mm),
        }
    }

    /// Whether a point is inside of the gel or at most `tolerance_mm` outside.
    #[must_use]
    pub fn contains(&self, point_mm: DVec3, tolerance_mm: f64, surfaces: &Surfaces) -> bool {
        self.signed_distance(point_mm, surfaces).distance_mm <= tolerance_mm
    }

    /// Height of the gel's top above a location of its plane, mm; `None` beside the gel.
    #[must_use]
    pub fn top_height_mm(&self, x_mm: f64, y_mm: f64, surfaces: &Surfaces) -> Option<f64> {
        let at = DVec2::new(x_mm, y_mm);
        match *self {
            Self::Block {
                size_mm,
                center_mm,
                edge_radius_mm,
            } => block(size_mm, edge_radius_mm).top_height_mm(at - DVec2::from(center_mm)),
            Self::Dome(ref dome) => dome.top_height_mm(x_mm, y_mm),
            Self::Stl(ref file) => surface(file, surfaces).top_height_mm(at),
        }
    }

    /// Smallest box that contains the gel, as (minimum, maximum) corners, mm.
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
            Self::Stl(file) => surface(file, surfaces).bounds_mm(),
        }
    }

    /// Volume, mm³, including whatever is embedded in the gel; exact.
    #[must_use]
    pub fn volume_mm3(&self, surfaces: &Surfaces) -> f64 {
        match *self {
            Self::Block {
                size_mm,
                edge_radius_mm,
                ..
            } => block(size_mm, edge_radius_mm).volume_mm3(),
            Self::Dome(ref dome) => dome.volume_mm3(),
            Self::Stl(ref file) => surface(file, surfaces).volume_mm3(),
        }
    }
}

fn block(size_mm: [f64; 3], edge_radius_mm: f64) -> Block {
    Block {
        size_mm: DVec3::from(size_mm),
        edge_radius_mm,
    }
}

fn surface<'a>(file: &SurfaceFile, surfaces: &'a Surfaces) -> &'a TriangleSurface {
    surfaces
        .get(&*file.name())
        .expect("surfaces are read with what names them")
}
