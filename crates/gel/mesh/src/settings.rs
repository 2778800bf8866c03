//! Edge lengths of a mesh, and boxes that are left out.

use glam::DVec3;
use serde::{Deserialize, Serialize};

use crate::MeshError;

/// Settings of the generator.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct MeshSettings {
    /// Edge length away from all focuses, inclusions and rounded edges, mm. Default 1.
    pub edge_mm: f64,
    /// Edge length along z at the pressed surface, divided by `edge_mm`, in (0, 1]. Default 1: no
    /// grading towards the surface.
    pub top_edge_ratio: f64,
    /// Largest ratio of the lengths of neighbouring edges where the mesh coarsens, in [1.05, 2].
    /// Default 1.25.
    pub growth: f64,
    /// Where a finer mesh is needed. The lines of the mesh are built outwards from the centre of
    /// the **first** focus, which is the centre of contact. Within its radius the surface pattern
    /// depends on its radius and edge length only, not on its position, so that moving a press does
    /// not change its discretization.
    pub focuses: Vec<Focus>,
}

/// A disc, parallel to the board, at which edges are short. Away from it, also along z, they grow
/// by the factor [`MeshSettings::growth`].
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Focus {
    /// Centre, mm.
    pub center_mm: DVec3,
    /// Radius, mm.
    pub radius_mm: f64,
    /// Edge length on the disc, mm.
    pub edge_mm: f64,
    /// Where edges must be shorter still, along x and along y, for example under the rounded rim of
    /// a punch.
    #[serde(default)]
    pub stretches: [Vec<Stretch>; 2],
    /// Where there must be a line of the mesh, along x and along y, relative to the centre, mm; for
    /// example where the flat underside of a punch ends and its rounded rim begins. A line that is
    /// closer than half an edge to the centre, to the radius or to the line before it is left out.
    /// Only those of the first focus count.
    #[serde(default)]
    pub lines_mm: [Vec<f64>; 2],
}

/// A stretch of short edges along one axis.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Stretch {
    /// Its middle, relative to the centre of its focus, mm.
    pub offset_mm: f64,
    /// Half its length, mm.
    pub reach_mm: f64,
    /// Longest edge along this axis, mm.
    pub edge_mm: f64,
}

/// A rigid box inside of the gel, with faces parallel to the axes. The part outside of the solid is
/// ignored.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cuboid {
    /// Corner with the smallest coordinates, mm.
    pub min_mm: DVec3,
    /// Corner with the largest coordinates, mm.
    pub max_mm: DVec3,
}

impl Default for MeshSettings {
    fn default() -> Self {
        Self {
            edge_mm: 1.0,
            top_edge_ratio: 1.0,
            growth: 1.25,
            focuses: Vec::new(),
        }
    }
}

impl MeshSettings {
    /// The same distribution of edge lengths, all multiplied by `factor`.
    #[must_use]
    pub fn scaled(&self, factor: f64) -> Self {
        let mut scaled = self.clone();
        scaled.edge_mm *= factor;
        for focus in &mut scaled.focuses {
            focus.edge_mm *= factor;
            let stretches = focus.stretches.iter_mut().flatten();
            stretches.for_each(|stretch| stretch.edge_mm *= factor);
        }
        scaled
    }

    pub(crate) fn smallest_edge_mm(&self) -> f64 {
        let stretches = self
            .focuses
            .iter()
            .flat_map(|focus| focus.stretches.iter().flatten());
        let edges_mm = self
            .focuses
            .iter()
            .map(|focus| focus.edge_mm)
            .chain(stretches.map(|stretch| stretch.edge_mm));
        edges_mm.fold(self.edge_mm, f64::min)
    }

    pub(crate) fn check(&self) -> Result<(), MeshError> {
        within("edge_mm", self.edge_mm, 1e-4, 1e4)?;
        within("top_edge_ratio", self.top_edge_ratio, 1e-3, 1.0)?;
        within("growth", self.growth, 1.05, 2.0)?;
        for (index, focus) in self.focuses.iter().enumerate() {
            let name = |field: &str| format!("focuses[{index}].{field}");
            within(&name("edge_mm"), focus.edge_mm, 1e-4, 1e4)?;
            within(&name("radius_mm"), focus.radius_mm, 0.0, 1e4)?;
            within(&name("center_mm"), focus.center_mm.abs().max_element(), 0.0, 1e4)?;
            for stretch in focus.stretches.iter().flatten() {
                within(&name("stretches.edge_mm"), stretch.edge_mm, 1e-4, 1e4)?;
                within(&name("stretches.reach_mm"), stretch.reach_mm, 0.0, 1e4)?;
                within(&name("stretches.offset_mm"), stretch.offset_mm, -1e4, 1e4)?;
            }
            for &line_mm in focus.lines_mm.iter().flatten() {
                within(&name("lines_mm"), line_mm, -1e4, 1e4)?;
            }
            if focus.center_mm.is_nan() {
                return within(&name("center_mm"), f64::NAN, 0.0, 1e4);
            }
        }
        Ok(())
    }
}

impl Cuboid {
    /// Distance from a point to the surface, negative inside, mm.
    pub(crate) fn distance_mm(&self, point_mm: DVec3) -> f64 {
        let beyond = (self.min_mm - point_mm).max(point_mm - self.max_mm);
        beyond.max(DVec3::ZERO).length() + beyond.max_element().min(0.0)
    }

    /// Checks that this is a box that overlaps a solid and has gel above it; the solid fills its
    /// footprint up to `whole_to_mm`.
    pub(crate) fn check(
        &self,
        index: usize,
        [low, high]: [DVec3; 2],
        whole_to_mm: f64,
    ) -> Result<(), MeshError> {
        let (min, max) = (self.min_mm, self.max_mm);
        let reaches = format!("reaches from {min} to {max} mm");
        let expected = if !(min.is_finite() && max.is_finite() && min.cmplt(max).all()) {
            "min_mm below max_mm".to_owned()
        } else if !(min.cmplt(high).all() && max.cmpgt(low).all()) {
            format!("to overlap the solid, {low} to {high} mm")
        } else if max.z > 0.98 * whole_to_mm {
            format!("gel above it: the solid is whole up to {whole_to_mm:.3} mm")
        } else {
            return Ok(());
        };
        Err(MeshError::Inclusion {
            index,
            expected,
            found: reaches,
        })
    }
}

/// Checks that a number is in a range; NaN is not.
pub(crate) fn within(field: &str, value: f64, least: f64, most: f64) -> Result<(), MeshError> {
    if (least..=most).contains(&value) {
        return Ok(());
    }
    Err(MeshError::Setting {
        field: field.to_owned(),
        expected: format!("a number from {least} to {most}"),
        found: value.to_string(),
    })
}
