//! What stands behind the result: the fit of the bench, training, alignment, the simulation and time spent.

/// Losses over a training run.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct TrainingCurve {
    /// The variant that was trained.
    pub name: String,
    /// Optimiser steps at which losses were noted.
    pub step: Vec<f64>,
    /// Training loss.
    pub training_loss: Vec<f64>,
    /// Validation loss.
    pub validation_loss: Vec<f64>,
}

/// What was fitted about the bench.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct BenchFit {
    /// Fitted quantities such as the indenter's radius and the contact offset.
    pub parameters: Vec<Parameter>,
    /// Fitted gain of each taxel.
    pub gains: Vec<Gain>,
    /// Indenter radius (mm) and the objective's value (%) there.
    pub objective_by_radius: Vec<[f64; 2]>,
}

/// A fitted quantity.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Parameter {
    /// Its name.
    pub name: String,
    /// Its value.
    pub value: f64,
    /// Half the width of its interval of uncertainty.
    pub uncertainty: Option<f64>,
    /// Its unit.
    pub unit: String,
}

/// A fitted gain.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Gain {
    /// The taxel.
    pub taxel: String,
    /// Measured over simulated pressure.
    pub value: f64,
    /// Half the width of its interval of uncertainty.
    pub uncertainty: Option<f64>,
}

/// How the times of one press were matched.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct WarpPath {
    /// Which press.
    pub name: String,
    /// Time of the measured frame, s.
    pub time_s: Vec<f64>,
    /// Simulated time matched to it, minus it, s.
    pub shift_s: Vec<f64>,
}

/// How far the simulation can be trusted.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SimulationQuality {
    /// Frames that were solved to the tolerance.
    pub frames: usize,
    /// Largest relative residual of any accepted frame.
    pub worst_residual: f64,
    /// Largest penetration of the indenter into the gel, mm.
    pub largest_penetration_mm: f64,
    /// Smallest ratio of deformed to undeformed volume of any element; positive means that none is inverted.
    pub smallest_volume_ratio: f64,
    /// What failed, in words.
    pub failures: Vec<String>,
}

/// Time spent in one stage.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Stage {
    /// Its name.
    pub name: String,
    /// Wall time, s.
    pub wall_s: f64,
}
