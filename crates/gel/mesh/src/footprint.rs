//! Solids with a rectangular footprint, which are a bent box: blocks and domes.

use glam::DVec3;
use twintac_shape::{Dome, Solid, Surfaces};

/// A box, and how it is bent into a solid.
pub(crate) struct Footprint {
    /// The box before it is bent: its low and high corner, mm.
    pub(crate) box_mm: [DVec3; 2],
    bend: Bend,
}

enum Bend {
    /// Moves the top edges of a block inwards until they are round.
    RoundEdges { radius_mm: f64 },
    /// Stretches each column between the inclusions on the board and the domed top.
    Dome(Dome),
}

impl Footprint {
    /// The footprint of a valid block or dome; `None` for a triangle surface.
    pub(crate) fn of(solid: &Solid) -> Option<Self> {
        let bend = match solid {
            Solid::Block { edge_radius_mm, .. } => Bend::RoundEdges {
                radius_mm: *edge_radius_mm,
            },
            Solid::Dome(dome) => Bend::Dome(dome.clone()),
            Solid::Stl { .. } => return None,
        };
        let (low_mm, high_mm) = solid.bounds_mm(&Surfaces::new());
        Some(Self {
            box_mm: [low_mm, high_mm],
            bend,
        })
    }

    /// Maps a point of the box to the solid. Points up to the height `base_mm` do not move.
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

    /// Maps a point of the solid back to the box. It does not undo the rounding of edges.
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

    /// Radius of the rounded top edges, mm.
    pub(crate) fn edge_radius_mm(&self) -> f64 {
        match &self.bend {
            Bend::RoundEdges { radius_mm } => *radius_mm,
            Bend::Dome(_) => 0.0,
        }
    }

    /// Height up to which the solid fills its whole footprint, mm.
    pub(crate) fn full_height_mm(&self) -> f64 {
        match &self.bend {
            Bend::RoundEdges { radius_mm } => self.box_mm[1].z - radius_mm,
            Bend::Dome(dome) => {
                let deepest_mm = |drops_mm: [f64; 2]| drops_mm[0].max(drops_mm[1]);
                dome.crown_mm - deepest_mm(dome.drop_x_mm) - deepest_mm(dome.drop_y_mm)
            }
        }
    }

    /// Maps the squares around the top edges to quarter discs, along rays from the axis of the
    /// edge, so that both sides of an edge stay on the surface of the solid. Two rounded edges meet
    /// at a corner in a mitre.
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

/// Height of a dome's top above a point of the plan, mm; beside the dome, that of its nearest edge.
fn dome_top_mm(dome: &Dome, at_mm: DVec3) -> f64 {
    let x_mm = at_mm.x.max(dome.x_mm[0]).min(dome.x_mm[1]);
    let y_mm = at_mm.y.max(dome.y_mm[0]).min(dome.y_mm[1]);
    dome.top_height_mm(x_mm, y_mm).unwrap_or(dome.crown_mm)
}
