//! The commands, one file each.

mod adapt;
mod calibrate;
mod characterize;
mod cross_validate;
mod dataset;
mod demo;
mod design;
mod export;
mod fast;
mod files;
mod follow;
mod locate;
mod mesh;
mod paper;
mod ports;
mod predict;
mod record;
mod reproduce;
mod sensor;
mod simulate;
mod stages;
mod stream;
mod variation;
mod view;

use anyhow::Result;

use crate::Program;
use crate::arguments::{Command, FastCommand, SensorCommand};

pub(crate) use record::Stopped;

/// Runs a command.
pub(crate) fn run(command: Command, program: &Program) -> Result<()> {
    match command {
        Command::Demo(arguments) => demo::run(&arguments, program),
        Command::Reproduce(arguments) => reproduce::run(&arguments, program),
        Command::Sensor(SensorCommand::Show(arguments)) => sensor::show(&arguments),
        Command::Mesh(arguments) => mesh::run(&arguments),
        Command::Simulate(arguments) => simulate::run(&arguments, program),
        Command::Dataset(arguments) => dataset::run(&arguments),
        Command::Design(arguments) => design::run(&arguments, program),
        Command::Calibrate(arguments) => calibrate::run(&arguments),
        Command::Characterize(arguments) => characterize::run(&arguments),
        Command::Ports(arguments) => ports::run(&arguments),
        Command::View(arguments) => view::run(&arguments),
        Command::Stream(arguments) => stream::run(&arguments),
        Command::Record(arguments) => record::run(&arguments, program),
        Command::Export(arguments) => export::run(&arguments),
        Command::Import(arguments) => reproduce::import(&arguments, program),
        Command::Align(arguments) => stages::align(&arguments, program),
        Command::Train(arguments) => stages::train(&arguments, program),
        Command::Evaluate(arguments) => stages::evaluate(&arguments, program),
        Command::Adapt(arguments) => adapt::run(&arguments, program),
        Command::CrossValidate(arguments) => cross_validate::run(&arguments, program),
        Command::Predict(arguments) => predict::run(&arguments),
        Command::Locate(arguments) => locate::run(&arguments),
        Command::Fast(FastCommand::Train(arguments)) => fast::train(&arguments, program),
        Command::Fast(FastCommand::Variation(arguments)) => variation::run(&arguments),
        Command::Report(arguments) => stages::report(&arguments, program),
    }
}
