//! Errors of a simulated press.

use twintac_softbody::SolveError;

/// Why the solver could not take a step, and which setting may help.
pub(crate) fn reason(error: &SolveError) -> String {
    match error {
        SolveError::PassedThrough { .. } | SolveError::Pulled { .. } => {
            format!("{error}: settings `contact_edge_mm` and `max_nodes`")
        }
        _ => error.to_string(),
    }
}

/// A press that could not be set up. A press that starts and then does not converge is not an
/// error: its table ends at the last converged depth, with the reason.
#[derive(Debug, thiserror::Error)]
pub enum SimulateError {
    /// The gel could not be meshed.
    #[error("the gel can't be meshed: {0}")]
    Mesh(#[from] twintac_mesh::MeshError),
    /// The finite-element model could not be built.
    #[error("the gel's model can't be built: {0}")]
    SoftBody(#[from] twintac_softbody::SoftBodyError),
    /// The indenter is not a possible shape.
    #[error("the indenter can't be built: {0}")]
    Shape(#[from] twintac_shape::ShapeError),
    /// A frame could not be reached, and the caller needs every frame of the press.
    #[error("the gel can't be pressed {depth_mm:.3} mm deep: {}", reason(error))]
    Press {
        /// Depth below first touch, mm.
        depth_mm: f64,
        /// Why.
        error: SolveError,
    },
    /// The indenter would come down beside the gel.
    #[error("the indenter at x = {x_mm:.2} mm, y = {y_mm:.2} mm does not touch the gel")]
    NoTouch {
        /// x of the press, mm.
        x_mm: f64,
        /// y of the press, mm.
        y_mm: f64,
    },
    /// A force above the sensor's limit.
    #[error(
        "`force_n` is {force_n} N, the sensor withstands {limit_n} N at most (`limits.force_n` of its description); ask for less"
    )]
    ForceLimit {
        /// The force that was asked for, N.
        force_n: f64,
        /// The largest force of the description, N.
        limit_n: f64,
    },
    /// The sensor's description has no such indenter.
    #[error("there is no indenter `{asked_for}`; the sensor has {}", described.join(", "))]
    NoIndenter {
        /// The name that was asked for.
        asked_for: String,
        /// The names in the description.
        described: Vec<String>,
    },
    /// A point of a path has the name of a taxel.
    #[error("the point `{point}` has the name of a taxel; give it another name")]
    PointIsTaxel {
        /// The name.
        point: String,
    },
    /// A taxel's port, or a point, reaches outside the mesh.
    #[error("`{place}` reaches more than {distance_mm:.2} mm outside the gel's mesh")]
    PortOutside {
        /// The taxel's or the point's name.
        place: String,
        /// How far out, mm.
        distance_mm: f64,
    },
}
