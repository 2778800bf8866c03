//! A weighted sum of tables.

use crate::{DepthTable, PressFrame};

/// Tables with less weight need not reach as deep as their sum does.
const SMALL_WEIGHT: f64 = 0.02;

impl DepthTable {
    /// The weighted sum of tables, frame by frame. The weights should add up to one. Frames that a
    /// table of any weight lacks are left out. Values that are not numbers are taken from the table
    /// with the largest weight; so is the location, except its height.
    ///
    /// # Panics
    /// If there are no tables.
    #[must_use]
    pub fn blend(tables: &[(&Self, f64)]) -> Self {
        let n_frames = tables
            .iter()
            .filter(|(_, weight)| weight.abs() > SMALL_WEIGHT)
            .map(|(table, _)| table.frames.len())
            .min()
            .unwrap_or(0);
        let nearest = nearest(tables);
        let mut blended = Self {
            frames: (0..n_frames).map(|index| frame(tables, nearest, index)).collect(),
            ..nearest.clone()
        };
        blended.gel_from_indenter_at_touch.position_mm.z = tables
            .iter()
            .map(|(table, weight)| weight * table.gel_from_indenter_at_touch.position_mm.z)
            .sum();
        blended
    }
}

fn nearest<'a>(nodes: &[(&'a DepthTable, f64)]) -> &'a DepthTable {
    let mut best = nodes[0];
    for &candidate in nodes {
        if candidate.1 > best.1 {
            best = candidate;
        }
    }
    best.0
}

fn frame(nodes: &[(&DepthTable, f64)], nearest: &DepthTable, frame: usize) -> PressFrame {
    let there: Vec<(&PressFrame, f64)> = nodes
        .iter()
        .filter_map(|(table, weight)| Some((table.frames.get(frame)?, *weight)))
        .collect();
    let total: f64 = there.iter().map(|(_, weight)| weight).sum();
    let sum = |value: &dyn Fn(&PressFrame) -> f64| -> f64 {
        there
            .iter()
            .map(|(frame, weight)| weight / total * value(frame))
            .sum()
    };
    let template = &nearest.frames[frame];
    let n_taxels = template.port_pressure_kpa.len();
    PressFrame {
        depth_mm: sum(&|f| f.depth_mm),
        force_n: sum(&|f| f.force_n),
        port_pressure_kpa: (0..n_taxels).map(|k| sum(&|f| f.port_pressure_kpa[k])).collect(),
        port_slope_kpa_per_mm: (0..n_taxels)
            .map(|k| [0, 1, 2].map(|way| sum(&|f| f.port_slope_kpa_per_mm[k][way])))
            .collect(),
        stress_feature_kpa_per_mm: (0..n_taxels)
            .map(|k| sum(&|f| f.stress_feature_kpa_per_mm[k]))
            .collect(),
        quality: template.quality,
    }
}
