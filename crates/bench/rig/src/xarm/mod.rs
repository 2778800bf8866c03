//! UFACTORY xArm: a robot arm that takes commands by TCP and sends reports on separate sockets.
//!
//! Source: the manufacturer's own client, xArm-Python-SDK (`x_config.py`, `uxbus_cmd.py`,
//! `uxbus_cmd_tcp.py`, `report.py`).

mod answer;
mod bytes;
mod client;
mod codec;
mod command;
mod errors;
mod frame_reader;
mod pose_stream;
mod real_time_report;
mod report;
mod report_reader;
mod servo;
mod state;
mod wire;

pub use answer::Answer;
pub use client::Client;
pub use codec::{FEEDBACK, Incoming, LARGEST_FRAME_BYTES, PORT, PROTOCOL, Request, Response, splitter};
pub use command::{Command, MoveTo, SetState};
pub use errors::ControllerCode;
pub use pose_stream::LONGEST_STEP_MM;
pub use real_time_report::RealTimeReport;
pub use report::{LARGEST_REPORT_BYTES, Report, ReportPort, RobotStatus, RobotWrench, report_splitter};
pub use report_reader::ReportReader;
pub use state::{Mode, MotionState, ResponseState};
pub use wire::{Pair, Wire};
