//! What a page asks for, and what it is answered.

use serde::{Deserialize, Serialize};
use twintac_line::Serial;
use twintac_shape::Pose;

use crate::desk::DeskFrame;

/// What a page asks for.
#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "kebab-case", deny_unknown_fields)]
pub(crate) enum Request {
    /// Keeps a file that descriptions name: its bytes follow the request.
    Keep {
        /// Its name.
        name: String,
    },
    /// Reads the description of a sensor, which takes the place of the one before.
    Open {
        /// The name of the file, for errors.
        file: String,
        /// Its text, TOML.
        text: String,
    },
    /// Adds an indenter to the sensor, in the place of one of its name.
    Add {
        /// The name of the file, for errors.
        file: String,
        /// Its text, TOML.
        text: String,
    },
    /// Makes the surface of an indenter, to be drawn.
    Outline {
        /// The indenter's name.
        indenter: String,
    },
    /// Meshes the gel for an indenter that presses anywhere on it.
    Prepare(Prepare),
    /// Takes the indenter to a pose.
    Step {
        /// Time since the last frame, s.
        since_s: f64,
        /// Where to.
        gel_from_indenter: Pose,
    },
    /// Lets go of the gel: it is at rest, and remembers nothing.
    Rest {},
    /// What the program offers that the engine is part of.
    Offer {},
    /// Reads the description of a line, TOML. What comes over that line is a sensor on the desk, in the place of one before.
    Listen {
        /// The name of the file, for errors.
        file: String,
        /// Its text, TOML.
        text: String,
    },
    /// What the sensor on the desk reads. Bytes of its line follow the request, if there is a line.
    Hear {},
    /// Takes the next frames of the sensor on the desk for untouched.
    Zero {},
}

/// How a gel is meshed.
#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub(crate) struct Prepare {
    /// The indenter's name.
    pub(crate) indenter: String,
    /// How deep it will press, mm: the mesh is as fine as that needs.
    pub(crate) depth_mm: f64,
    /// Most nodes of the mesh. One that is refined at the indenter's rim has up to two thirds more.
    pub(crate) max_nodes: usize,
}

/// What comes back.
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
    /// What the program offers.
    Offer(Offer),
    /// A line is described.
    Line(Serial),
    /// What the sensor on the desk reads.
    Desk(DeskFrame),
}

/// What the program offers that the engine is part of.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Offer {
    /// The description to begin with, if one was chosen: the name of its file, and its text.
    pub sensor: Option<[String; 2]>,
    /// Where frames of a sensor on the desk come from, if there is one.
    pub source: Option<String>,
}

/// A mesh.
#[derive(Debug, Serialize)]
pub(crate) struct Prepared {
    /// Nodes.
    pub(crate) n_nodes: usize,
    /// Tetrahedra.
    pub(crate) n_tets: usize,
    /// Height of the indenter's origin where it first touches the middle of the gel, upright, mm: depths count from there.
    pub(crate) touch_mm: f64,
}

/// One moment of a press. Forces act on the gel, in its frame.
#[derive(Debug, Serialize)]
pub(crate) struct Frame {
    /// How far the indenter is below first touch, mm.
    pub(crate) depth_mm: f64,
    /// Force of the indenter, N.
    pub(crate) force_n: [f64; 3],
    /// Torque of the indenter about its origin, N mm.
    pub(crate) torque_n_mm: [f64; 3],
    /// Pressure at the port of each taxel, kPa, in their order.
    pub(crate) pressure_kpa: Vec<f64>,
    /// Area of the gel's surface that the indenter touches, mm², as it was at rest.
    pub(crate) contact_mm2: f64,
    /// Whether the forces are balanced.
    pub(crate) converged: bool,
    /// Newton iterations.
    pub(crate) iterations: u32,
    /// Unbalanced forces over the load.
    pub(crate) residual: f64,
    /// How a number of this frame came about.
    pub(crate) provenance: &'static str,
}

/// What is answered where something is wrong.
#[derive(Serialize)]
pub(crate) struct Refused {
    /// One error, in words.
    pub(crate) error: String,
}
