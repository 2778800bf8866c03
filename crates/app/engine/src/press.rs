//! A gel that one indenter presses, frame by frame.

use std::sync::Arc;

use glam::{DVec2, DVec3};
use twintac_protocol::PressPath;
use twintac_sensor::Sensor;
use twintac_shape::{Pose, SignedDistance};
use twintac_simulate::{Gel, GelState, SimulateSettings};

use crate::arrays::{Array, Arrays};
use crate::error::EngineError;
use crate::lattice::places_mm;
use crate::map::Map;
use crate::request::{Frame, Prepare, Prepared, Quality};

/// Provenance of all numbers of a frame.
pub(crate) const PROVENANCE: &str = "simulated";

/// Largest distance from the indenter at which a node counts as touched, mm.
const TOUCHING_MM: f64 = 0.02;

/// No edges over the radius of a rim are asked for, however sharp it is: it can be anywhere on the
/// gel, so refining the mesh for it would refine all of it.
const EDGES_PER_ROUNDING: f64 = 0.0;

/// Largest motion in one sub-step, mm: twice the solver's default, so that a fast drag takes one
/// sub-step a frame.
const MAX_TRAVEL_MM: f64 = 1.0;

/// A meshed gel, and the indenter that presses it.
pub(crate) struct Press {
    state: GelState,
    indenter: Box<dyn SignedDistance>,
    taxels: Vec<String>,
    map: Option<Map>,
    /// Positions of the nodes of the gel at rest, mm.
    rest_mm: Vec<DVec3>,
    /// Nodes that the indenter can touch, and the surface area of each, mm².
    top: Vec<(usize, f64)>,
}

impl Press {
    pub(crate) fn new(sensor: &Arc<Sensor>, asked: &Prepare) -> Result<Self, EngineError> {
        let settings = settings(asked)?;
        let gel = Gel::new(Arc::clone(sensor), settings);
        let shape = gel.shape(&asked.indenter)?;
        let path = path(&gel, asked)?;
        let state = gel.state_along(shape, &path)?;
        let mesh = state.fields().mesh;
        let areas_mm2 = mesh.node_areas_mm2();
        let top = mesh.sets.top.iter().map(|&node| node as usize);
        Ok(Self {
            top: top.map(|node| (node, areas_mm2[node])).collect(),
            indenter: shape.signed_distance_field(&sensor.surfaces)?,
            taxels: sensor.taxels.iter().map(|taxel| taxel.name.clone()).collect(),
            map: Map::of(sensor, Array::MapKpa),
            rest_mm: mesh.nodes_mm.clone(),
            state,
        })
    }

    /// Writes the mesh and the present state of the gel into the arrays.
    pub(crate) fn show_mesh(&self, arrays: &mut Arrays) -> Prepared {
        let mesh = self.state.fields().mesh;
        arrays.set_indices(Array::SurfaceTriangles, &mesh.boundary_triangles());
        arrays.set_indices(Array::Tets, &mesh.tets);
        arrays.set_points(Array::RestMm, &mesh.nodes_mm);
        self.show(arrays);
        Prepared {
            n_nodes: mesh.nodes_mm.len(),
            n_tets: mesh.tets.len(),
            touch_mm: self.touch_mm(),
        }
    }

    /// Writes the present state of the gel into the arrays, and returns the touched area, mm².
    fn show(&self, arrays: &mut Arrays) -> f64 {
        let fields = self.state.fields();
        arrays.set_points(Array::DisplacementsMm, fields.displacements_mm);
        arrays.set_numbers(Array::PressureKpa, &fields.pressure_kpa);
        arrays.set_numbers(Array::VonMisesKpa, &fields.von_mises_kpa);
        let Some(pose) = self.state.gel_from_indenter() else {
            return 0.0;
        };
        let touches = |node: usize| {
            let place = fields.mesh.nodes_mm[node] + fields.displacements_mm[node];
            let distance = self.indenter.signed_distance(pose.inverse_transform_point(place));
            distance.distance_mm < TOUCHING_MM
        };
        let touched = self.top.iter().filter(|(node, _)| touches(*node));
        touched.map(|(_, area_mm2)| area_mm2).sum()
    }

    pub(crate) fn step(
        &mut self,
        since_s: f64,
        gel_from_indenter: &Pose,
        arrays: &mut Arrays,
    ) -> Result<Frame, EngineError> {
        let frame = self.state.step(since_s, gel_from_indenter)?;
        let contact_mm2 = self.show(arrays);
        let pressure_kpa: Vec<f64> = self
            .taxels
            .iter()
            .map(|taxel| frame.pressure_kpa[taxel])
            .collect();
        if let Some(map) = &mut self.map {
            map.show(&pressure_kpa, arrays);
        }
        Ok(Frame {
            depth_mm: frame.depth_mm,
            force_n: frame.force_n.to_array(),
            torque_n_mm: frame.torque_n_mm.to_array(),
            pressure_kpa,
            quality: Quality::Solved {
                contact_mm2: if frame.force_n == DVec3::ZERO {
                    0.0
                } else {
                    contact_mm2
                },
                converged: frame.converged,
                iterations: frame.quality.iterations,
                residual: frame.quality.residual,
            },
            provenance: PROVENANCE,
        })
    }

    /// Height of the indenter's origin at first contact with the middle of the gel, upright, mm.
    pub(crate) fn touch_mm(&self) -> f64 {
        self.state.touch_mm()
    }

    /// Writes the gel at rest, with its top nodes moved to other locations, mm, into the arrays.
    /// Nothing is known about the stress.
    pub(crate) fn draw_moved(&self, moved: impl Fn(DVec3) -> DVec3, arrays: &mut Arrays) {
        let mut displacements_mm = vec![DVec3::ZERO; self.rest_mm.len()];
        for &(node, _) in &self.top {
            displacements_mm[node] = moved(self.rest_mm[node]) - self.rest_mm[node];
        }
        let none = vec![0.0; self.rest_mm.len()];
        arrays.set_points(Array::DisplacementsMm, &displacements_mm);
        arrays.set_numbers(Array::PressureKpa, &none);
        arrays.set_numbers(Array::VonMisesKpa, &none);
    }

    pub(crate) fn rest(&mut self, arrays: &mut Arrays) {
        self.state.rest();
        self.show(arrays);
    }
}

fn settings(asked: &Prepare) -> Result<SimulateSettings, EngineError> {
    let refused = |field, found, expected| EngineError::Setting {
        field,
        found,
        expected,
    };
    if !(100..=50_000).contains(&asked.max_nodes) {
        let found = asked.max_nodes as f64;
        return Err(refused("max_nodes", found, "a whole number from 100 to 50000"));
    }
    if !(0.01..=100.0).contains(&asked.depth_mm) {
        return Err(refused("depth_mm", asked.depth_mm, "a number from 0.01 to 100"));
    }
    let mut settings = SimulateSettings {
        max_path_nodes: asked.max_nodes,
        edges_per_rounding: EDGES_PER_ROUNDING,
        ..SimulateSettings::default()
    };
    settings.solver.max_travel_mm = MAX_TRAVEL_MM;
    Ok(settings)
}

/// A path that presses everywhere, for which the gel is meshed. Its first pose is in the middle,
/// which defines depth zero.
fn path(gel: &Gel, asked: &Prepare) -> Result<PressPath, EngineError> {
    let places = places_mm(gel.sensor());
    let at = |place: DVec2, z_mm: f64| Pose::from_position(place.extend(z_mm));
    let touch_mm = gel
        .touch(gel.shape(&asked.indenter)?, &at(places[0], 0.0))?
        .position_mm
        .z;
    let poses = places.iter().map(|place| at(*place, touch_mm - asked.depth_mm));
    let timed = poses.enumerate().map(|(index, pose)| (index as f64, pose));
    Ok(PressPath::through(&asked.indenter, timed))
}
