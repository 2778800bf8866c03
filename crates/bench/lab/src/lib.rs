//! Emulated bench: an imperfect sensor that an imperfect robot presses, in software.
//!
//! The emulator takes the place of a sensor, a robot and a force sensor that are not available. It
//! has its own physics and its own imperfections, which an [`EmulatorConfiguration`] lists (a TOML
//! file in `emulators/`). It does not know the digital twin that is
//! evaluated against it, and differs from it on purpose: a finer mesh, another material law with
//! viscoelastic relaxation, taxels whose positions and gains differ a little from the drawing,
//! noise, quantization, clocks with delay and jitter, and a robot with position errors. Recordings
//! of the emulator have the provenance `emulated`.
//!
//! In: the description of a sensor, an [`EmulatorConfiguration`], and planned presses or loads.
//! Out: recordings, with times in s, poses in mm, forces in N and pressures in kPa.
//!
//! - [`Lab::new`] makes one imperfect sensor. Everything random comes from the seed of the
//!   configuration.
//! - [`Lab::press`] computes and records a planned press directly, without a robot or devices.
//!   [`Lab::load`] does this for a weight that is put on the gel.
//! - [`Lab::live`] is the physics of the emulated devices (`twintac-emulate`) while a robot moves:
//!   the devices read it over their own protocols.
//!
//! # How it works
//!
//! ```text
//! emulator           the emulator configuration
//! lab                a sensor that is cast and installed as the configuration says
//! keyframes, course  a direct press: the gel with its relaxation, solved at chosen moments and
//!                    interpolated over time between them
//! live               a press through the devices: tables of the gel without relaxation, and a
//!                    fading memory for the relaxation
//! ways               with friction: the response of the gel while the press goes in and while it
//!                    goes back
//! mounting           the frames of gel and robot: tilt, height
//! port, chain        a port and the air in it; drift, noise, lag and quantization of a reading
//! load, frames       a weight on the gel; the frames of a press as they are recorded
//! ```
//!
//! **Frames.** Poses are planned and recorded in the frame of the bench. This frame is level, and
//! the top of the gel's middle has the described height, because a real setup is calibrated by
//! touching the gel there. The frame of a tilted sensor or of a thicker gel differs from it. The
//! robot comes down along the bench's z axis. The height of each touch is recorded as it is.
//!
//! **Ports.** Trapped air follows Boyle's law. The resistance of the gel to the bulge into the port
//! is that of half a circular crack (Sneddon, 1946). The gel beside a port is bonded to the board,
//! so this is exact for small bulges of an incompressible gel. The law has a closed form, which
//! differs from that of the twin.
//!
//! **Friction.** With friction the response depends on the history of the press. A direct press
//! carries the history from step to step of the solver. For a press through the devices each
//! location has a second table for the way back. A press that turns at another depth than the table
//! uses a loop that is scaled to its turning point.
//!
//! **Two ways to a recording.** Direct presses and presses through the devices share the material,
//! the mesh settings, the ports and the installation. They differ in how relaxation is computed: in
//! the material of the gel for direct presses, and as a linear memory of the table's values for
//! presses through the devices.
//!
//! **Resolution.** The field `depth_step_mm` of [`EmulatedGel`] is the depth between computed
//! moments. Readings between them are interpolated, which rounds a sharp turn of the motion. At 0.4
//! mm, as in the default configuration, this changes readings by 0.2 to 1 % of a press's largest
//! reading on average. It accounts for about 0.15 percentage points of the error of about one
//! percent of a twin of the default emulated bench. A step of 0.1 mm removes most of this.
//!
//! # What it does not depend on
//!
//! The emulator does not depend on the twin (`digitac`), nor the twin on the emulator. Both use the
//! same solver (`twintac-softbody`), but not the same settings, material or mesh.

mod chain;
mod course;
mod emulator;
mod error;
mod frames;
mod keyframes;
mod lab;
mod live;
mod load;
mod mounting;
mod port;
mod ways;

pub use emulator::{
    EmulatedClimate, EmulatedGel, EmulatedInstallation, EmulatedReadout, EmulatedRobot,
    EmulatorConfiguration, Relaxation,
};
pub use error::LabError;
pub use lab::Lab;
pub use live::{LiveGel, LiveTable, Selector};
