//! Rigid shapes of indenters.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::{DVec2, DVec3};
use serde::{Deserialize, Serialize};

use crate::prism::{Placement, Prism};
use crate::profile::Profile;
use crate::shape_error::{above_zero, between};
use crate::union::Union;
use crate::{Distance, Pose, ShapeError, SignedDistance, SurfaceFile, Surfaces, TriangleSurface};

/// A rigid indenter. `edge_radius_mm` rounds every convex edge without moving any face: the sharp
/// shape is made smaller by the radius and then grown by it in all directions. Prismatic shapes
/// have their profile in the xy plane and stand on z = 0, `height_mm` tall.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
pub enum Shape {
    /// A ball.
    Sphere {
        /// Radius, mm.
        radius_mm: f64,
    },
    /// A flat-ended upright cylinder.
    Cylinder {
        /// Radius, mm.
        radius_mm: f64,
        /// Height, mm.
        height_mm: f64,
        /// Edge rounding, mm.
        edge_radius_mm: f64,
    },
    /// A box.
    Box {
        /// Full size along x, y and z, mm.
        size_mm: [f64; 3],
        /// Edge rounding, mm.
        edge_radius_mm: f64,
    },
    /// Two crossed bars in the shape of an X (a plus turned by 45°).
    X {
        /// Length of each bar, mm.
        length_mm: f64,
        /// Width of each bar, mm.
        width_mm: f64,
        /// Height, mm.
        height_mm: f64,
        /// Rounding of the edges, and of the concave corners between the bars as far as there is
        /// room, mm.
        edge_radius_mm: f64,
    },
    /// An upright tube.
    Ring {
        /// Outer radius, mm.
        outer_radius_mm: f64,
        /// Inner radius, mm.
        inner_radius_mm: f64,
        /// Height, mm.
        height_mm: f64,
        /// Edge rounding, mm.
        edge_radius_mm: f64,
    },
    /// An upright equilateral prism, centroid at the origin, one corner towards +x.
    Triangle {
        /// Side length, mm.
        side_mm: f64,
        /// Height, mm.
        height_mm: f64,
        /// Edge rounding, mm.
        edge_radius_mm: f64,
    },
    /// A wedge like a roof upside down: it touches with its ridge, which lies along y.
    Wedge {
        /// Full opening angle at the ridge, radians.
        angle_rad: f64,
        /// Length of the ridge along y, mm.
        length_mm: f64,
        /// Height from ridge to base, mm.
        height_mm: f64,
        /// Rounding of the ridge and edges, mm.
        edge_radius_mm: f64,
    },
    /// A closed triangle surface in an STL file; its lowest point is moved to z = 0. Cavities count
    /// as filled, because no gel can get into them.
    Stl(SurfaceFile),
    /// Several shapes joined rigidly, which may overlap. Their poses are in the frame of the union,
    /// whose origin need not be its lowest point.
    Union {
        /// The shapes, at least one.
        parts: Vec<Part>,
    },
}

/// A shape as part of a [`Shape::Union`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Part {
    /// The part's shape.
    pub shape: Shape,
    /// Pose of the part in the frame of the union.
    #[serde(default)]
    pub whole_from_part: Pose,
}

/// Smallest half width of a shape, mm. A thinner shape would lie between the nodes of any mesh of a
/// gel.
const THINNEST_MM: f64 = 0.05;
/// Largest length of a shape, mm: enough for a floor or a table.
const LONGEST_MM: f64 = 1e6;

/// Checks a length that consists of this number of half widths.
fn length(field: &str, found: f64, half_widths: f64) -> Result<(), ShapeError> {
    between(field, found, half_widths * THINNEST_MM, LONGEST_MM).map_err(|error| ShapeError {
        expected: format!("{} (lengths are in mm)", error.expected),
        ..error
    })
}

/// Checks a rounding: it must leave something of each of these half widths.
fn rounding(found: f64, half_widths_mm: &[f64]) -> Result<(), ShapeError> {
    let most = half_widths_mm.iter().copied().fold(f64::INFINITY, f64::min);
    if found >= 0.0 && found < most {
        return Ok(());
    }
    Err(ShapeError::new(
        "edge_radius_mm",
        found.to_string(),
        format!("at least 0 and less than {most}"),
    ))
}

impl Shape {
    /// Checks that such a shape is possible.
    ///
    /// # Errors
    /// The first field whose value is out of range.
    pub fn validate(&self) -> Result<(), ShapeError> {
        match *self {
            Self::Sphere { radius_mm } => length("radius_mm", radius_mm, 1.0),
            Self::Cylinder {
                radius_mm,
                height_mm,
                edge_radius_mm,
            } => {
                length("radius_mm", radius_mm, 1.0)?;
                length("height_mm", height_mm, 2.0)?;
                rounding(edge_radius_mm, &[radius_mm, 0.5 * height_mm])
            }
            Self::Box {
                size_mm,
                edge_radius_mm,
            } => {
                for (axis, size) in size_mm.iter().enumerate() {
                    length(&format!("size_mm[{axis}]"), *size, 2.0)?;
                }
                rounding(edge_radius_mm, &size_mm.map(|size| 0.5 * size))
            }
            Self::X {
                length_mm,
                width_mm,
                height_mm,
                edge_radius_mm,
            } => {
                length("width_mm", width_mm, 2.0)?;
                length("height_mm", height_mm, 2.0)?;
                length("length_mm", length_mm, 2.0)?;
                if length_mm <= width_mm {
                    let expected = format!("more than the width of {width_mm}");
                    return Err(ShapeError::new("length_mm", length_mm.to_string(), expected));
                }
                rounding(edge_radius_mm, &[0.5 * width_mm, 0.5 * height_mm])
            }
            Self::Ring {
                outer_radius_mm,
                inner_radius_mm,
                height_mm,
                edge_radius_mm,
            } => {
                above_zero("inner_radius_mm", inner_radius_mm)?;
                length("outer_radius_mm", outer_radius_mm, 1.0)?;
                length("height_mm", height_mm, 2.0)?;
                if outer_radius_mm <= inner_radius_mm {
                    let expected = format!("more than the inner radius of {inner_radius_mm}");
                    return Err(ShapeError::new(
                        "outer_radius_mm",
                        outer_radius_mm.to_string(),
                        expected,
                    ));
                }
                rounding(
                    edge_radius_mm,
                    &[0.5 * (outer_radius_mm - inner_radius_mm), 0.5 * height_mm],
                )
            }
            Self::Triangle {
                side_mm,
                height_mm,
                edge_radius_mm,
            } => {
                length("side_mm", side_mm, 2.0)?;
                length("height_mm", height_mm, 2.0)?;
                rounding(edge_radius_mm, &[side_mm / INRADIUS_TO_SIDE, 0.5 * height_mm])
            }
            Self::Wedge {
                angle_rad,
                length_mm,
                height_mm,
                edge_radius_mm,
            } => {
                if !(angle_rad > 0.0 && angle_rad < PI) {
                    return Err(ShapeError::new(
                        "angle_rad",
                        angle_rad.to_string(),
                        "more than 0 and less than π",
                    ));
                }
                length("length_mm", length_mm, 2.0)?;
                length("height_mm", height_mm, 2.0)?;
                rounding(edge_radius_mm, &[0.5 * length_mm, 0.5 * height_mm])
            }
            Self::Stl(ref file) => file.validate(),
            Self::Union { ref parts } if parts.is_empty() => {
                Err(ShapeError::new("parts", "empty", "one shape or more"))
            }
            Self::Union { ref parts } => {
                for (index, part) in parts.iter().enumerate() {
                    part.validate()
                        .map_err(|error| error.within(&format!("parts[{index}]")))?;
                }
                Ok(())
            }
        }
    }

    /// The triangle surfaces that the shape consists of, each with the name of the field of its
    /// path.
    #[must_use]
    pub fn surface_files(&self) -> Vec<(String, &SurfaceFile)> {
        match self {
            Self::Stl(file) => vec![("path".to_owned(), file)],
            Self::Union { parts } => {
                let mut files = Vec::new();
                for (index, part) in parts.iter().enumerate() {
                    let of_part = part.shape.surface_files().into_iter();
                    files
                        .extend(of_part.map(|(field, file)| (format!("parts[{index}].shape.{field}"), file)));
                }
                files
            }
            _ => Vec::new(),
        }
    }

    /// Replaces the paths of the triangle surfaces that the shape consists of.
    pub fn rename_surfaces(&mut self, rename: &dyn Fn(&str) -> String) {
        match self {
            Self::Stl(file) => file.path = rename(&file.path),
            Self::Union { parts } => parts
                .iter_mut()
                .for_each(|part| part.shape.rename_surfaces(rename)),
            _ => {}
        }
    }

    /// The shape as an exact signed distance, with its origin at the point of first contact (for
    /// triangle surfaces: at the height of their lowest point).
    ///
    /// # Errors
    /// Those of [`Shape::validate`], and an STL file that is not in `surfaces`.
    // long: a paragraph for each kind of shape
    pub fn signed_distance_field(&self, surfaces: &Surfaces) -> Result<Box<dyn SignedDistance>, ShapeError> {
        self.validate()?;
        let upright = |profile: Profile, height_mm: f64, radius_mm: f64| Prism {
            profile,
            half_length_mm: 0.5 * height_mm - radius_mm,
            radius_mm,
            placement: Placement::Upright,
        };
        Ok(match *self {
            Self::Sphere { radius_mm } => Box::new(Ball { radius_mm }),
            Self::Cylinder {
                radius_mm,
                height_mm,
                edge_radius_mm: edge,
            } => Box::new(upright(
                Profile::Disc {
                    radius_mm: radius_mm - edge,
                },
                height_mm,
                edge,
            )),
            Self::Box {
                size_mm: [x, y, z],
                edge_radius_mm: edge,
            } => {
                let half = DVec2::new(0.5 * x - edge, 0.5 * y - edge);
                Box::new(upright(Profile::rectangle(half), z, edge))
            }
            Self::X {
                length_mm,
                width_mm,
                height_mm,
                edge_radius_mm: edge,
            } => {
                let (half_length_mm, half_width_mm) = (0.5 * length_mm - edge, 0.5 * width_mm - edge);
                let profile = Profile::X {
                    half_length_mm,
                    half_width_mm,
                    hollow_radius_mm: (2.0 * edge).min(half_length_mm - half_width_mm),
                };
                Box::new(upright(profile, height_mm, edge))
            }
            Self::Ring {
                outer_radius_mm,
                inner_radius_mm,
                height_mm,
                edge_radius_mm: edge,
            } => {
                let profile = Profile::Annulus {
                    inner_radius_mm: inner_radius_mm + edge,
                    outer_radius_mm: outer_radius_mm - edge,
                };
                Box::new(upright(profile, height_mm, edge))
            }
            Self::Triangle {
                side_mm,
                height_mm,
                edge_radius_mm: edge,
            } => {
                let corner_mm = 2.0 * (side_mm / INRADIUS_TO_SIDE - edge);
                let corner = |third: f64| corner_mm * DVec2::from_angle(third * 2.0 * PI / 3.0);
                let corners_mm = [0.0, 1.0, 2.0].map(corner).to_vec();
                Box::new(upright(Profile::Convex { corners_mm }, height_mm, edge))
            }
            Self::Wedge {
                angle_rad,
                length_mm,
                height_mm,
                edge_radius_mm: edge,
            } => {
                let top_mm = height_mm - edge;
                let half_mm = (top_mm - edge) * (0.5 * angle_rad).tan();
                let corners_mm = vec![
                    DVec2::new(0.0, edge),
                    DVec2::new(half_mm, top_mm),
                    DVec2::new(-half_mm, top_mm),
                ];
                Box::new(Prism {
                    profile: Profile::Convex { corners_mm },
                    half_length_mm: 0.5 * length_mm - edge,
                    radius_mm: edge,
                    placement: Placement::Lying,
                })
            }
            Self::Stl(ref file) => {
                let surface = surfaces.get(&*file.name()).ok_or_else(|| {
                    ShapeError::new(
                        "path",
                        format!("`{}`, which is not loaded", file.name()),
                        "an STL file of this description",
                    )
                })?;
                Box::new(Lowered::new(surface))
            }
            Self::Union { ref parts } => {
                let placed = parts.iter().map(|part| {
                    let distance = part.shape.signed_distance_field(surfaces)?;
                    Ok((part.whole_from_part, distance))
                });
                Box::new(Union::new(placed.collect::<Result<_, ShapeError>>()?))
            }
        })
    }
}

impl Part {
    fn validate(&self) -> Result<(), ShapeError> {
        self.shape.validate().map_err(|error| error.within("shape"))?;
        let Pose {
            position_mm,
            rotation,
        } = self.whole_from_part;
        if !position_mm.is_finite() || !rotation.is_normalized() {
            let found = format!("{position_mm} mm turned by {rotation}");
            return Err(ShapeError::new(
                "whole_from_part",
                found,
                "a finite position and a unit quaternion",
            ));
        }
        Ok(())
    }
}

/// Side of an equilateral triangle divided by the radius of its inscribed circle, `2 √3`.
const INRADIUS_TO_SIDE: f64 = 3.464_101_615_137_754_6;

struct Ball {
    radius_mm: f64,
}

impl SignedDistance for Ball {
    fn signed_distance(&self, point_mm: DVec3) -> Distance {
        let from_center = point_mm - DVec3::Z * self.radius_mm;
        let length_mm = from_center.length();
        let gradient = if length_mm > f64::MIN_POSITIVE {
            from_center / length_mm
        } else {
            -DVec3::Z
        };
        Distance {
            distance_mm: length_mm - self.radius_mm,
            gradient,
        }
    }

    fn bounds_mm(&self) -> (DVec3, DVec3) {
        let half = DVec3::splat(self.radius_mm);
        (-half.with_z(0.0), half.with_z(2.0 * self.radius_mm))
    }
}

/// A triangle surface that is moved along z until its lowest point is at 0, with its cavities
/// filled.
struct Lowered {
    surface: Arc<TriangleSurface>,
    /// Its bodies, if there is more than one.
    bodies: Vec<BodyOf>,
}

/// One body of a triangle surface.
struct BodyOf {
    surface: Arc<TriangleSurface>,
    body: usize,
}

impl Lowered {
    fn new(surface: &Arc<TriangleSurface>) -> Self {
        let surface = match surface.has_cavities() {
            true => &Arc::new(surface.with_distances_of_filled()),
            false => surface,
        };
        let several = (0..surface.n_bodies()).filter(|_| surface.n_bodies() > 1);
        let bodies = several.map(|body| BodyOf {
            surface: Arc::clone(surface),
            body,
        });
        Self {
            bodies: bodies.collect(),
            surface: Arc::clone(surface),
        }
    }

    fn lowest_mm(&self) -> f64 {
        self.surface.bounds_mm().0.z
    }
}

impl SignedDistance for Lowered {
    fn signed_distance(&self, point_mm: DVec3) -> Distance {
        self.surface
            .signed_distance(point_mm + DVec3::Z * self.lowest_mm())
    }

    fn bounds_mm(&self) -> (DVec3, DVec3) {
        let (low, high) = self.surface.bounds_mm();
        (low.with_z(0.0), high.with_z(high.z - low.z))
    }

    fn parts(&self) -> Vec<(Pose, &dyn SignedDistance)> {
        let lowered = Pose::from_position(-DVec3::Z * self.lowest_mm());
        let bodies = self.bodies.iter();
        bodies
            .map(|body| (lowered, body as &dyn SignedDistance))
            .collect()
    }
}

impl SignedDistance for BodyOf {
    fn signed_distance(&self, point_mm: DVec3) -> Distance {
        self.surface.distance_to_body(self.body, point_mm)
    }

    fn bounds_mm(&self) -> (DVec3, DVec3) {
        self.surface.bounds_of_body_mm(self.body)
    }
}
