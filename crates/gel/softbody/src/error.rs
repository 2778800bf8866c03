//! Errors of this crate.

/// A body that cannot be built.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SoftBodyError {
    /// A mesh without tetrahedra.
    #[error("the mesh has no tetrahedra")]
    Empty,
    /// A mesh without bonded nodes.
    #[error("the mesh has no bonded nodes, so nothing holds it in place")]
    NotBonded,
    /// A reference to a node that does not exist.
    #[error("{place} names node {found}, but there are {n_nodes} nodes")]
    Node {
        /// The tetrahedron or the set.
        place: String,
        /// The index found.
        found: u32,
        /// Number of nodes.
        n_nodes: usize,
    },
    /// A node without a tetrahedron.
    #[error("node {node} belongs to no tetrahedron")]
    Stray {
        /// Its index.
        node: usize,
    },
    /// A tetrahedron that has no volume or is inverted.
    #[error("tetrahedron {tet} has a volume of {volume_mm3:.3e} mm³, expected more than 0")]
    Degenerate {
        /// Its index.
        tet: usize,
        /// Its signed volume, mm³.
        volume_mm3: f64,
    },
    /// An invalid material.
    #[error("material: {0}")]
    Material(#[from] twintac_material::MaterialError),
    /// An invalid setting.
    #[error("solver setting `{field}` is {found}, expected {expected}")]
    Setting {
        /// Name of the field.
        field: &'static str,
        /// What was expected.
        expected: &'static str,
        /// What was found.
        found: f64,
    },
    /// An invalid direction of differentiation.
    #[error("a direction must have a step above 0, and as many Prony terms as the body's material")]
    Direction,
    /// The analysis of the sparse system failed.
    #[error("the system of {n_unknowns} unknowns can't be analysed: {reason}")]
    Analysis {
        /// Size of the system.
        n_unknowns: usize,
        /// Message of the sparse solver.
        reason: String,
    },
}

/// A step that could not be done. The state is as it was before the call.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolveError {
    /// Equilibrium was not reached, even with the smallest sub-steps.
    #[error("no equilibrium beyond {:.1} % of the step: residual {residual:.1e} of the load after {iterations} iterations", fraction * 100.0)]
    NotConverged {
        /// Fraction of the step that converged.
        fraction: f64,
        /// Residual of the failed attempt, divided by the load.
        residual: f64,
        /// Number of Newton iterations of the whole step.
        iterations: u32,
    },
    /// No step along the search direction keeps the volume of every tetrahedron above zero.
    #[error("tetrahedra turn inside out beyond {:.1} % of the step", fraction * 100.0)]
    Inverted {
        /// Fraction of the step that converged.
        fraction: f64,
    },
    /// The tangent could not be factorized.
    #[error("the tangent is singular beyond {:.1} % of the step", fraction * 100.0)]
    Singular {
        /// Fraction of the step that converged.
        fraction: f64,
    },
    /// The indenter and the body would pass through each other: the indenter is too thin for the
    /// mesh, or for the step.
    #[error(
        "the indenter passes {reach_mm:.2} mm through the surface at {at_mm:.3} mm, beyond {:.1} % of the step: it is {thickness_mm:.2} mm thick there, and the edges of the mesh are \
         {edge_mm:.2} mm long. Take shorter edges, or shorter steps", fraction * 100.0
    )]
    PassedThrough {
        /// Fraction of the step that was done before.
        fraction: f64,
        /// A point where they pass through each other, mm.
        at_mm: glam::DVec3,
        /// How far the indenter reaches through, mm.
        reach_mm: f64,
        /// Thickness of the indenter there, mm.
        thickness_mm: f64,
        /// Longest edge of the body's surface there, mm.
        edge_mm: f64,
    },
    /// The surface of the body would slip around the indenter, to its far side, where contact pulls
    /// instead of pressing.
    #[error(
        "the surface slips around the indenter at {at_mm:.3} mm, beyond {:.1} % of the step: the edges of the mesh, {edge_mm:.2} mm long there, are too long for this depth. Take \
         shorter edges, or press less deep", fraction * 100.0
    )]
    Pulled {
        /// Fraction of the step that was done before.
        fraction: f64,
        /// A point of the surface, mm.
        at_mm: glam::DVec3,
        /// Longest edge of the body's surface there, mm.
        edge_mm: f64,
    },
    /// The indenter would enter something rigid.
    #[error("blocked: the indenter would be at least {depth_mm:.3} mm deep in {by} at {at_mm:.3} mm")]
    Blocked {
        /// What it would enter.
        by: Blocker,
        /// A point inside of both, mm.
        at_mm: glam::DVec3,
        /// The depth there, mm; it may be larger elsewhere.
        depth_mm: f64,
    },
    /// The requested force is not reached anywhere within the travel.
    #[error(
        "a force of {wanted_n} N is not reached within {travel_mm} mm of travel: the last position has {reached_n:.4} N"
    )]
    ForceNotReached {
        /// The requested force, N.
        wanted_n: f64,
        /// The force that was found last, N.
        reached_n: f64,
        /// The allowed travel, mm.
        travel_mm: f64,
    },
    /// A pose or time that is not finite, or a negative time step.
    #[error("{what} is {found}, expected {expected}")]
    Input {
        /// The argument.
        what: &'static str,
        /// What was expected.
        expected: String,
        /// What was found.
        found: String,
    },
}

impl SolveError {
    /// Fraction of the step that converged, from 0 to 1; the state is that before the step.
    #[must_use]
    pub fn converged_fraction(&self) -> f64 {
        match self {
            Self::NotConverged { fraction, .. }
            | Self::Inverted { fraction }
            | Self::Singular { fraction }
            | Self::PassedThrough { fraction, .. }
            | Self::Pulled { fraction, .. } => *fraction,
            _ => 0.0,
        }
    }
}

/// Something rigid that an indenter can run into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blocker {
    /// Something that the body is bonded to.
    Bonded,
    /// An obstacle.
    Obstacle,
}

impl std::fmt::Display for Blocker {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Bonded => "what the body is bonded to",
            Self::Obstacle => "an obstacle",
        })
    }
}
