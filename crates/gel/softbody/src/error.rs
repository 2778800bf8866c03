//! Errors of this crate.

/// A body that can't be built.
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
        /// Which tetrahedron or set.
        place: String,
        /// The index found.
        found: u32,
        /// Number of nodes.
        n_nodes: usize,
    },
    /// A node without tetrahedron.
    #[error("node {node} belongs to no tetrahedron")]
    Stray {
        /// Its index.
        node: usize,
    },
    /// A tetrahedron without volume, or inside out.
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
        /// The offending field.
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
        /// What the sparse solver said.
        reason: String,
    },
}

/// A step that could not be taken. The state stays as it was before the call.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SolveError {
    /// Equilibrium was not reached, however small the sub-steps.
    #[error("no equilibrium beyond {:.1} % of the step: residual {residual:.1e} of the load after {iterations} iterations", fraction * 100.0)]
    NotConverged {
        /// Part of the step that did converge.
        fraction: f64,
        /// Residual of the failed try over the load.
        residual: f64,
        /// Newton iterations spent on the whole step.
        iterations: u32,
    },
    /// No step along the search direction keeps every tetrahedron's volume above zero.
    #[error("tetrahedra turn inside out beyond {:.1} % of the step", fraction * 100.0)]
    Inverted {
        /// Part of the step that did converge.
        fraction: f64,
    },
    /// The tangent could not be factorised.
    #[error("the tangent is singular beyond {:.1} % of the step", fraction * 100.0)]
    Singular {
        /// Part of the step that did converge.
        fraction: f64,
    },
    /// The indenter and the body would pass through each other: the indenter is too thin for the mesh, or for the step.
    #[error(
        "the indenter passes {reach_mm:.2} mm through the surface at {at_mm:.3} mm, beyond {:.1} % of the step: it is {thickness_mm:.2} mm thick there, and the edges of the mesh are \
         {edge_mm:.2} mm long. Take shorter edges, or shorter steps", fraction * 100.0
    )]
    PassedThrough {
        /// Part of the step that was taken before.
        fraction: f64,
        /// A place where they pass through each other, mm.
        at_mm: glam::DVec3,
        /// How far, mm.
        reach_mm: f64,
        /// Thickness of the indenter there, mm.
        thickness_mm: f64,
        /// Longest edge of the body's surface there, mm.
        edge_mm: f64,
    },
    /// The indenter would enter something rigid.
    #[error("blocked: the indenter would be at least {depth_mm:.3} mm deep in {by} at {at_mm:.3} mm")]
    Blocked {
        /// What it would reach into.
        by: Blocker,
        /// A point inside both, mm.
        at_mm: glam::DVec3,
        /// The depth there, mm; elsewhere it may be deeper.
        depth_mm: f64,
    },
    /// The force asked for is not met anywhere within the travel.
    #[error(
        "a force of {wanted_n} N is not met within {travel_mm} mm of travel: {reached_n:.4} N where it was sought last"
    )]
    ForceNotReached {
        /// The force asked for, N.
        wanted_n: f64,
        /// The force last found, N.
        reached_n: f64,
        /// Travel that was allowed, mm.
        travel_mm: f64,
    },
    /// A pose or time that is not finite, or a negative time step.
    #[error("{what} is {found}, expected {expected}")]
    Input {
        /// Which argument.
        what: &'static str,
        /// What was expected.
        expected: String,
        /// What was found.
        found: String,
    },
}

impl SolveError {
    /// Part of the step that did converge, from 0 to 1; the state is that before the step.
    #[must_use]
    pub fn converged_fraction(&self) -> f64 {
        match self {
            Self::NotConverged { fraction, .. }
            | Self::Inverted { fraction }
            | Self::Singular { fraction }
            | Self::PassedThrough { fraction, .. } => *fraction,
            _ => 0.0,
        }
    }
}

/// Something rigid that an indenter can meet.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blocker {
    /// What the body is bonded to.
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
