//! Requests of a page, and their answers.

use serde::{Deserialize, Serialize};
use twintac_line::Serial;
use twintac_shape::{Pose, Shape};

use crate::desk::DeskFrame;

/// A request.
#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum Request {
    /// Stores a file that descriptions name. Its bytes follow the request.
    Keep {
        /// Its name.
        name: String,
    },
    /// Opens the description of a sensor; it replaces the one before.
    Open {
        /// The name of the file, for error messages.
        file: String,
        /// Its text, TOML.
        text: String,
    },
    /// Adds an indenter to the sensor; it replaces one of the same name.
    Add {
        /// The name of the file, for error messages.
        file: String,
        /// Its text, TOML.
        text: String,
    },
    /// Makes the surface of a shape for drawing.
    Outline {
        /// Its shape.
        shape: Shape,
    },
    /// Meshes the gel for an indenter that can press anywhere on it.
    Prepare(Prepare),
    /// Moves the indenter to a pose.
    Step {
        /// Time since the last frame, s.
        since_s: f64,
        /// The new pose.
        gel_from_indenter: Pose,
    },
    /// Presses several shapes at once, by the surrogate of the gel. The drawn gel is that of the
    /// last mesh.
    Touch {
        /// The stored file of the surrogate.
        surrogate: String,
        /// The shapes. The depth and the torque of the answer are those of the first.
        bodies: Vec<Placed>,
    },
    /// Removes the indenter: the gel is at rest, without any memory of before.
    Rest {},
    /// Asks what the surrounding program provides.
    Offer {},
    /// Reads the description of a line (TOML). The connected sensor is then the one on that line;
    /// it replaces one before.
    Listen {
        /// The name of the file, for error messages.
        file: String,
        /// Its text, TOML.
        text: String,
    },
    /// Asks for the state of the connected sensor. If it has a line, the line's new bytes follow
    /// the request.
    Hear {},
    /// Measures the zero of the connected sensor again, from its next frames.
    Zero {},
}

/// How the gel is meshed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Prepare {
    /// The indenter's name.
    pub(crate) indenter: String,
    /// Largest depth of the presses, mm: the mesh is as fine as that needs.
    pub(crate) depth_mm: f64,
    /// Most nodes of the mesh.
    pub(crate) max_nodes: usize,
}

/// A shape at a pose.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Placed {
    /// The shape, as an indenter of the sensor has it.
    pub(crate) shape: Shape,
    /// Its pose.
    pub(crate) gel_from_indenter: Pose,
}

/// An answer.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub(crate) enum Reply {
    /// Done.
    Done {},
    /// A sensor was opened, or has one more indenter.
    Sensor(Box<crate::sensor_reply::SensorReply>),
    /// The gel was meshed.
    Prepared(Prepared),
    /// The indenter was moved.
    Frame(Frame),
    /// What the surrounding program provides.
    Offer(Offer),
    /// A line was described.
    Line(Serial),
    /// The state of the connected sensor.
    Desk(DeskFrame),
}

/// What the surrounding program provides.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Offer {
    /// The description to open first, if one was chosen: the name of its file, and its text.
    pub sensor: Option<[String; 2]>,
    /// Where frames of the connected sensor come from, if there is one.
    pub source: Option<String>,
}

/// A mesh.
#[derive(Debug, Serialize)]
pub(crate) struct Prepared {
    /// Number of nodes.
    pub(crate) n_nodes: usize,
    /// Number of tetrahedra.
    pub(crate) n_tets: usize,
    /// Height of the indenter's origin at first contact with the middle of the gel, upright, mm.
    /// Depths count from there.
    pub(crate) touch_mm: f64,
}

/// One frame of a press. Forces act on the gel, in its frame of reference.
#[derive(Debug, Serialize)]
pub(crate) struct Frame {
    /// Depth of the indenter below first contact, mm.
    pub(crate) depth_mm: f64,
    /// Force of the indenter, N.
    pub(crate) force_n: [f64; 3],
    /// Torque of the indenter about its origin, N mm.
    pub(crate) torque_n_mm: [f64; 3],
    /// Pressure at the port of each taxel, kPa, in the order of the taxels.
    pub(crate) pressure_kpa: Vec<f64>,
    /// How the frame was computed.
    #[serde(flatten)]
    pub(crate) quality: Quality,
    /// Provenance of the numbers.
    pub(crate) provenance: &'static str,
}

/// How a frame was computed, and how well.
#[derive(Debug, Serialize)]
#[serde(untagged)]
pub(crate) enum Quality {
    /// By finite elements.
    Solved {
        /// Area of the gel's surface that the indenter touches, mm², measured at rest.
        contact_mm2: f64,
        /// Whether the solver converged: the forces are balanced.
        converged: bool,
        /// Newton iterations.
        iterations: u32,
        /// Residual: unbalanced forces divided by the load.
        residual: f64,
    },
    /// By the surrogate.
    Surrogate {
        /// Out-of-distribution score: above 1, the numbers may be wrong.
        ood_score: f32,
    },
}

/// The answer to a wrong request.
#[derive(Serialize)]
pub(crate) struct Refused {
    /// The error in words.
    pub(crate) error: String,
}
