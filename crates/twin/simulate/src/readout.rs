//! The quantities computed at each taxel of a pressed gel: the pressure at its port, and the stress
//! feature of the TwinTac paper.

use glam::{DVec2, DVec3};
use twintac_mesh::TetMesh;
use twintac_sensor::{Sensor, Taxel};

use crate::SimulateError;

/// Rings of samples on a port's disc.
const RINGS: u32 = 3;

/// How far a port may lie outside the mesh, whose linear facets cut off round parts, mm.
const PORT_TOLERANCE_MM: f64 = 0.05;

/// Weights of nodes that give the mean of a nodal field over a port.
#[derive(Clone, Debug)]
pub struct PortReadout {
    weights: Vec<(usize, f64)>,
}

impl PortReadout {
    /// The port of a taxel on a mesh.
    ///
    /// # Errors
    /// A port that is outside of the mesh.
    pub fn of_taxel(mesh: &TetMesh, taxel: &Taxel) -> Result<Self, SimulateError> {
        Self::new(mesh, &taxel.name, taxel.position_mm, taxel.port_radius_mm)
    }

    /// Samples a disc (normal z) at points of equal area and distributes each over its
    /// tetrahedron's nodes. Parts of the disc beside the gel are left out, because no gel presses
    /// on them.
    pub(crate) fn new(
        mesh: &TetMesh,
        name: &str,
        center_mm: DVec3,
        radius_mm: f64,
    ) -> Result<Self, SimulateError> {
        let around = mesh.neighbourhood(center_mm, radius_mm + PORT_TOLERANCE_MM);
        let located = |sample: &DVec2| around.locate(center_mm + sample.extend(0.0), PORT_TOLERANCE_MM);
        if located(&DVec2::ZERO).is_none() {
            return Err(SimulateError::PortOutside {
                place: name.to_owned(),
                distance_mm: PORT_TOLERANCE_MM,
            });
        }
        let samples: Vec<_> = disc_samples(radius_mm).iter().filter_map(located).collect();
        let share = 1.0 / samples.len() as f64;
        let mut weights = std::collections::BTreeMap::new();
        for (tet, barycentric) in samples {
            for (node, weight) in mesh.tets[tet].iter().zip(barycentric) {
                *weights.entry(*node as usize).or_insert(0.0) += weight * share;
            }
        }
        Ok(Self {
            weights: weights.into_iter().collect(),
        })
    }

    /// Mean of a nodal field over the port.
    #[must_use]
    pub fn read(&self, nodal: &[f64]) -> f64 {
        self.weights
            .iter()
            .map(|&(node, weight)| weight * nodal[node])
            .sum()
    }
}

/// Step of the location and of the radius of a port for its pressure derivatives, mm.
const SLOPE_STEP_MM: f64 = 0.25;

/// Derivatives of a port's pressure with respect to its x, y and radius.
#[derive(Clone, Debug)]
pub(crate) struct PortSlopes {
    /// The port one step behind and one step ahead for x, y and radius; `None` where the mesh ends
    /// before.
    ways: [Option<[PortReadout; 2]>; 3],
}

impl PortSlopes {
    pub(crate) fn of_taxel(mesh: &TetMesh, taxel: &Taxel) -> Self {
        let (center_mm, radius_mm) = (taxel.position_mm, taxel.port_radius_mm);
        let port = |moved_mm: DVec3, wider_mm: f64| {
            PortReadout::new(mesh, &taxel.name, center_mm + moved_mm, radius_mm + wider_mm).ok()
        };
        let narrower_mm = SLOPE_STEP_MM.min(radius_mm);
        let way = |behind: Option<PortReadout>, ahead: Option<PortReadout>| Some([behind?, ahead?]);
        let [x_mm, y_mm] = [DVec3::X, DVec3::Y].map(|axis| SLOPE_STEP_MM * axis);
        Self {
            ways: [
                way(port(-x_mm, 0.0), port(x_mm, 0.0)),
                way(port(-y_mm, 0.0), port(y_mm, 0.0)),
                way(
                    port(DVec3::ZERO, -narrower_mm),
                    port(DVec3::ZERO, 2.0 * SLOPE_STEP_MM - narrower_mm),
                ),
            ],
        }
    }

    /// Central differences, kPa/mm; zero where the mesh does not reach.
    pub(crate) fn read(&self, nodal_kpa: &[f64]) -> [f64; 3] {
        self.ways.each_ref().map(|way| {
            way.as_ref().map_or(0.0, |[behind, ahead]| {
                (ahead.read(nodal_kpa) - behind.read(nodal_kpa)) / (2.0 * SLOPE_STEP_MM)
            })
        })
    }
}

/// Centres of cells of equal area on a disc: one in the middle, 8 in the first ring around it, 16
/// in the next.
fn disc_samples(radius_mm: f64) -> Vec<DVec2> {
    let mut samples = vec![DVec2::ZERO];
    let rings = f64::from(2 * RINGS - 1);
    for ring in 1..RINGS {
        let count = 8 * ring;
        // The root mean square radius of the ring's cells, so that the second moment is that of the
        // disc.
        let distance_mm = radius_mm * f64::from(4 * ring * ring + 1).sqrt() / rings;
        samples.extend((0..count).map(|i| {
            let angle = std::f64::consts::TAU * (f64::from(i) + 0.5) / f64::from(count);
            distance_mm * DVec2::from_angle(angle)
        }));
    }
    samples
}

/// The surface nodes above one taxel.
pub(crate) struct StressCluster {
    taxel_mm: DVec3,
    nodes: Vec<(usize, f64)>,
}

impl StressCluster {
    /// Nodes of the pressed surface that are closer (in plan) to this taxel than to any other, and
    /// within half the pitch of it along x and y. They are weighted by their share of the surface,
    /// so that a graded mesh gives what a uniform one would.
    pub(crate) fn for_each_taxel(mesh: &TetMesh, sensor: &Sensor) -> Vec<Self> {
        let areas_mm2 = mesh.node_areas_mm2();
        let plan: Vec<DVec2> = sensor
            .taxels
            .iter()
            .map(|taxel| taxel.position_mm.truncate())
            .collect();
        let half_pitch_mm = 0.5 * smallest_distance_mm(&plan);
        let mut clusters: Vec<Self> = sensor
            .taxels
            .iter()
            .map(|taxel| Self {
                taxel_mm: taxel.position_mm,
                nodes: Vec::new(),
            })
            .collect();
        for &node in &mesh.sets.top {
            let at = mesh.nodes_mm[node as usize].truncate();
            let nearest =
                (0..plan.len()).min_by(|&a, &b| at.distance(plan[a]).total_cmp(&at.distance(plan[b])));
            if let Some(taxel) = nearest
                && (at - plan[taxel]).abs().max_element() <= half_pitch_mm
            {
                clusters[taxel]
                    .nodes
                    .push((node as usize, areas_mm2[node as usize]));
            }
        }
        clusters
    }

    /// The feature, kPa/mm: the mean over the cluster of von Mises stress over distance to the
    /// taxel (arXiv 2509.10063, equation 6).
    pub(crate) fn read(&self, von_mises_kpa: &[f64], positions_mm: &dyn Fn(usize) -> DVec3) -> f64 {
        let area_mm2: f64 = self.nodes.iter().map(|&(_, area)| area).sum();
        if area_mm2 == 0.0 {
            return 0.0;
        }
        let sum: f64 = self
            .nodes
            .iter()
            .map(|&(node, area)| area * von_mises_kpa[node] / positions_mm(node).distance(self.taxel_mm))
            .sum();
        sum / area_mm2
    }
}

fn smallest_distance_mm(points: &[DVec2]) -> f64 {
    let mut smallest = f64::INFINITY;
    for (i, a) in points.iter().enumerate() {
        for b in &points[i + 1..] {
            smallest = smallest.min(a.distance(*b));
        }
    }
    // A single taxel has the whole surface above it.
    smallest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn disc_samples_have_equal_area_moments() {
        let samples = disc_samples(2.0);
        let mean: DVec2 = samples.iter().sum::<DVec2>() / samples.len() as f64;
        assert!(mean.length() < 1e-12);
        // The mean square radius of a disc is r²/2.
        let square = samples.iter().map(|s| s.length_squared()).sum::<f64>() / samples.len() as f64;
        assert!((square - 2.0).abs() < 0.01, "{square}");
    }
}
