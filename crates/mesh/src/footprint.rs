//! Solids that stand on a rectangle: blocks and domes, as a bent box.

use glam::DVec3;
use twintac_shape::{Dome, Solid};

use crate::MeshError;
use crate::settings::within;

/// A box and the way it is bent into a solid.
pub(crate) struct Footprint {
    /// The unbent box: its low and high corner, mm.
    pub(crate) box_mm: [DVec3; 2],
    bend: Bend,
}

enum Bend {
    /// Presses the top edges of a block in until they are round.
    RoundEdges { radius_mm: f64 },
    /// Stretches each column between the board's fittings and the domed top.
    Dome(Dome),
}

impl Footprint {
    /// The footprint of a block or dome; none of a triangle surface.
    pub(crate) fn of(solid: &Solid) -> Result<Option<Self>, MeshError> {
        let footprint = match solid {
            Solid::Block {
                size_mm,
                edge_radius_mm,
            } => {
                let [x, y, z] = *size_mm;
                for (axis, size_mm) in size_mm.iter().enumerate() {
                    within(&format!("size_mm[{axis}]"), *size_mm, 1e-3, 1e4)?;
                }
                within(
                    "edge_radius_mm",
                    *edge_radius_mm,
                    0.0,
                    (0.5 * x).min(0.5 * y).min(z),
                )?;
                let half = DVec3::new(0.5 * x, 0.5 * y, 0.0);
                Self {
                    box_mm: [-half, half + DVec3::Z * z],
                    bend: Bend::RoundEdges {
                        radius_mm: *edge_radius_mm,
                    },
                }
            }
            Solid::Dome(dome) => {
                within("x_mm[1]", dome.x_mm[1], dome.x_mm[0] + 1e-3, 1e4)?;
                within("y_mm[1]", dome.y_mm[1], dome.y_mm[0] + 1e-3, 1e4)?;
                within("crown_mm", dome.crown_mm, 1e-3, 1e4)?;
                Self {
                    box_mm: [
                        DVec3::new(dome.x_mm[0], dome.y_mm[0], 0.0),
                        DVec3::new(dome.x_mm[1], dome.y_mm[1], dome.crown_mm),
                    ],
                    bend: Bend::Dome(dome.clone()),
                }
            }
            Solid::Stl { .. } => return Ok(None),
        };
        Ok(Some(footprint))
    }

    /// Takes a point of the box to the solid. Nothing moves up to the height `base_mm`.
    pub(crate) fn bend_mm(&self, point_mm: DVec3, base_mm: f64) -> DVec3 {
        match &self.bend {
            Bend::RoundEdges { radius_mm } => self.round_edges_mm(point_mm, *radius_mm),
            Bend::Dome(dome) => {
                let above_mm = point_mm.z - base_mm;
                let stretch = (dome_top_mm(dome, point_mm) - base_mm) / (dome.crown_mm - base_mm);
                if above_mm > 0.0 {
                    point_mm.with_z(base_mm + above_mm * stretch)
                } else {
                    point_mm
                }
            }
        }
    }

    /// Takes a point of the solid back to the box, but for the edges' rounding.
    pub(crate) fn unbend_mm(&self, point_mm: DVec3, base_mm: f64) -> DVec3 {
        match &self.bend {
            Bend::RoundEdges { .. } => point_mm,
            Bend::Dome(dome) => {
                let above_mm = point_mm.z - base_mm;
                let squeeze = (dome.crown_mm - base_mm) / (dome_top_mm(dome, point_mm) - base_mm);
                if above_mm > 0.0 && squeeze > 0.0 {
                    point_mm.with_z(base_mm + above_mm * squeeze)
                } else {
                    point_mm
                }
            }
        }
    }

    /// Height up to which the solid fills its whole footprint, mm.
    pub(crate) fn full_height_mm(&self) -> f64 {
        match &self.bend {
            Bend::RoundEdges { radius_mm } => self.box_mm[1].z - radius_mm,
            // The top falls towards the corners, or rises: then it is lowest at the crown.
            Bend::Dome(dome) => {
                let lowest = |drops: [f64; 2]| drops[0].max(drops[1]).max(0.0);
                dome.crown_mm - lowest(dome.drop_x_mm) - lowest(dome.drop_y_mm)
            }
        }
    }

    /// Maps the squares around the top edges to quarter discs, along rays from the edge's axis, so that both flanks of an edge
    /// stay on the solid's surface. Two rounded edges meet at a corner in a mitre.
    fn round_edges_mm(&self, point_mm: DVec3, radius_mm: f64) -> DVec3 {
        let [low, high] = self.box_mm;
        let center = (0.5 * (low + high)).with_z(0.0);
        let half = (0.5 * (high - low)).with_z(high.z);
        let from_center = point_mm - center;
        let core = from_center
            .clamp(radius_mm - half, half - DVec3::splat(radius_mm))
            .with_z(from_center.z.min(half.z - radius_mm));
        let out = from_center - core;
        let aside = out.x.abs().max(out.y.abs());
        let reach = aside.max(out.z);
        if aside == 0.0 || out.z <= 0.0 {
            return point_mm;
        }
        center + core + out * (reach / aside.hypot(out.z))
    }
}

/// Height of a dome's top above a point in plan, mm.
fn dome_top_mm(dome: &Dome, at_mm: DVec3) -> f64 {
    let fall = |at: f64, crown_at: f64, ends: [f64; 2], drops: [f64; 2]| {
        let side = usize::from(at > crown_at);
        let reach = ends[side] - crown_at;
        // A crown over the edge has nothing to fall to on that side.
        if reach == 0.0 {
            0.0
        } else {
            drops[side] * ((at - crown_at) / reach).powi(2)
        }
    };
    dome.crown_mm
        - fall(at_mm.x, dome.crown_at_mm[0], dome.x_mm, dome.drop_x_mm)
        - fall(at_mm.y, dome.crown_at_mm[1], dome.y_mm, dome.drop_y_mm)
}
