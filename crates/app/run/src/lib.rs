//! Runs: from a sensor's description and its recordings to a judged twin and a report, stage by stage.

pub mod bench;
pub mod built_in;
pub mod cache;
pub mod calibration;
mod depth_tables;
pub mod mesh;
pub mod metrics;
pub mod progress;
mod report;
pub mod run;
pub mod sensor_file;
pub mod settings;
pub mod stages;
