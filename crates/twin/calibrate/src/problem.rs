//! Residuals of simulated against measured curves, and their derivatives.

use rayon::prelude::*;
use twintac_simulate::{Gel, Keyframe, PressPlace, RatedFrame, SimulateError};
use twintac_softbody::Direction;

use crate::curve::{Curve, Quantity};
use crate::frames::Frames;
use crate::unknown::Unknowns;
use crate::{CalibrateError, Parameter};

/// Depths farther above the gel than this are simulated as this one, mm: nothing changes there.
const ABOVE_MM: f64 = -0.05;

/// Step of the difference quotient by the coefficient of friction: what the solver leaves unbalanced is small beside what it does.
const FRICTION_DIFFERENCE: f64 = 0.05;

/// Settings of a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitSettings {
    /// Frames simulated of each curve, about: samples between them are interpolated.
    pub most_frames: usize,
    /// Steps of the fit at most.
    pub max_iterations: u32,
}

impl Default for FitSettings {
    fn default() -> Self {
        Self {
            most_frames: 40,
            max_iterations: 30,
        }
    }
}

/// The curves and the unknowns of a fit.
pub(crate) struct Problem<'a> {
    pub(crate) gel: &'a Gel,
    pub(crate) curves: &'a [Curve],
    pub(crate) unknowns: Unknowns,
    /// The simulated frames of each curve.
    frames: Vec<Frames>,
    /// Scales of the residuals, by curve and signal: the largest force of a curve, N, or the largest reading of all, kPa.
    pub(crate) scales: Vec<Vec<f64>>,
}

/// All curves at one guess.
pub(crate) struct Evaluation {
    /// The modelled signals. `[n_curves][n_signals][n_samples]`
    pub(crate) model: Vec<Vec<Vec<f64>>>,
    /// Model less measured in units of the signals' scales, of all usable samples.
    pub(crate) residuals: Vec<f64>,
    /// Their derivatives. `[n_residuals][n_unknowns]`
    pub(crate) jacobian: Vec<Vec<f64>>,
}

impl<'a> Problem<'a> {
    pub(crate) fn new(
        gel: &'a Gel,
        curves: &'a [Curve],
        free: &[Parameter],
        settings: FitSettings,
    ) -> Result<Self, CalibrateError> {
        for curve in curves {
            curve.check()?;
        }
        let unknowns = Unknowns::new(gel.material(), curves, free, &|taxel| {
            gel.sensor().taxels[taxel].name.clone()
        })?;
        let usable = |signal: &crate::Signal| signal.values.iter().filter(|value| value.is_finite()).count();
        let found: usize = curves.iter().flat_map(|curve| &curve.signals).map(usable).sum();
        if unknowns.all.is_empty() || found <= unknowns.all.len() {
            return Err(CalibrateError::TooFew {
                found,
                unknowns: unknowns.all.len(),
            });
        }
        let peak = |values: &[f64]| {
            values
                .iter()
                .filter(|v| v.is_finite())
                .fold(0.0, |a, b| f64::max(a, b.abs()))
        };
        let readings = curves.iter().flat_map(|curve| &curve.signals);
        let largest_kpa = readings
            .filter(|signal| signal.quantity != Quantity::Force)
            .map(|signal| peak(&signal.values))
            .fold(0.0, f64::max);
        let scale = |signal: &crate::Signal| match signal.quantity {
            Quantity::Force => peak(&signal.values),
            Quantity::Taxel(_) => largest_kpa,
        };
        let scales: Vec<Vec<f64>> = curves
            .iter()
            .map(|curve| curve.signals.iter().map(scale).collect())
            .collect();
        if let Some(curve) = scales.iter().position(|scales| scales.contains(&0.0)) {
            return Err(CalibrateError::Curve {
                curve: curves[curve].name.clone(),
                problem: "measured nothing but zeros".into(),
            });
        }
        Ok(Self {
            gel,
            curves,
            frames: curves
                .iter()
                .map(|curve| Frames::new(curve, settings.most_frames))
                .collect(),
            unknowns,
            scales,
        })
    }

    /// Simulates all curves, each on a thread.
    pub(crate) fn evaluate(&self, x: &[f64]) -> Result<Evaluation, CalibrateError> {
        let indices: Vec<usize> = (0..self.curves.len()).collect();
        let presses = indices
            .par_iter()
            .with_max_len(1)
            .map(|&curve| self.press(curve, x))
            .collect::<Result<Vec<_>, _>>()?;
        let mut evaluation = Evaluation {
            model: Vec::new(),
            residuals: Vec::new(),
            jacobian: Vec::new(),
        };
        for (curve, (directions, frames)) in presses.iter().enumerate() {
            let signals = 0..self.curves[curve].signals.len();
            let model =
                signals.map(|signal| self.compare(curve, signal, x, directions, frames, &mut evaluation));
            let model = model.collect();
            evaluation.model.push(model);
        }
        Ok(evaluation)
    }

    /// One press, with the indices of the unknowns that its rates are for. The rates by material and depth are those of a gel without friction, which
    /// cannot be differentiated: friction changes how much is carried, and little of how that changes.
    fn press(&self, index: usize, x: &[f64]) -> Result<(Vec<usize>, Vec<RatedFrame>), CalibrateError> {
        let curve = &self.curves[index];
        let place = PressPlace {
            indenter: String::new(),
            shape: curve.shape.clone(),
            x_mm: curve.x_mm,
            y_mm: curve.y_mm,
            rotation: curve.rotation,
            depth_mm: curve.depth_mm.iter().copied().fold(0.0, f64::max),
            enough_force_n: None,
        };
        let deeper_mm = self.unknowns.value(&Parameter::DepthOffset, Some(index), x, 0.0);
        let keyframes: Vec<Keyframe> = self.frames[index]
            .rows
            .iter()
            .map(|&row| Keyframe {
                time_s: curve.time_s[row],
                depth_mm: curve.depth_mm[row].max(ABOVE_MM - deeper_mm),
            })
            .collect();
        let found = (0..self.unknowns.all.len())
            .filter_map(|unknown| Some((unknown, self.unknowns.direction(unknown, index, x)?)));
        let (mut unknowns, directions): (Vec<usize>, Vec<Direction>) = found.unzip();
        let gel = self.gel.clone().with_material(self.unknowns.material(x));
        let press = |friction: f64, directions: &[Direction]| {
            let rough = gel.clone().with_friction(friction);
            let frames = rough
                .mesh(&place)
                .and_then(|mesh| mesh.press_with_rates(&keyframes, deeper_mm, directions));
            frames.map_err(|error: SimulateError| CalibrateError::Simulate {
                curve: curve.name.clone(),
                error,
            })
        };
        let mut frames = press(0.0, &directions)?;
        let free = self
            .unknowns
            .all
            .iter()
            .position(|unknown| unknown.parameter == Parameter::Friction);
        let friction = self.unknowns.value(&Parameter::Friction, None, x, curve.friction);
        if friction > 0.0 {
            for (frame, rough) in frames.iter_mut().zip(press(friction, &[])?) {
                frame.force_n = rough.force_n;
                frame.port_pressure_kpa = rough.port_pressure_kpa;
            }
        }
        if let Some(free) = free {
            unknowns.push(free);
            let rougher = press(friction + FRICTION_DIFFERENCE, &[])?;
            for (frame, rougher) in frames.iter_mut().zip(rougher) {
                let rate = |more: f64, value: f64| (more - value) / FRICTION_DIFFERENCE;
                let pressures = rougher.port_pressure_kpa.iter().zip(&frame.port_pressure_kpa);
                let rates = pressures.map(|(more, value)| rate(*more, *value)).collect();
                frame.port_pressure_rates_kpa.push(rates);
                frame.force_rates_n.push(rate(rougher.force_n, frame.force_n));
            }
        }
        Ok((unknowns, frames))
    }

    /// Adds the residuals of a signal; returns the modelled signal.
    fn compare(
        &self,
        curve: usize,
        signal: usize,
        x: &[f64],
        pressed: &[usize],
        frames: &[RatedFrame],
        evaluation: &mut Evaluation,
    ) -> Vec<f64> {
        let signal_scale = self.scales[curve][signal];
        let signal = &self.curves[curve].signals[signal];
        let unknowns = &self.unknowns;
        let (of_scale, owner, offset) = match signal.quantity {
            Quantity::Force => (
                Parameter::ForceScale,
                None,
                unknowns.value(&Parameter::ForceOffset, Some(curve), x, 0.0),
            ),
            Quantity::Taxel(taxel) => (Parameter::Gain, Some(taxel), 0.0),
        };
        let scale = unknowns.value(&of_scale, owner, x, 1.0);
        let value = |frame: usize| match signal.quantity {
            Quantity::Force => frames[frame].force_n,
            Quantity::Taxel(taxel) => frames[frame].port_pressure_kpa[taxel],
        };
        let rate = |frame: usize, direction: usize| match signal.quantity {
            Quantity::Force => frames[frame].force_rates_n[direction],
            Quantity::Taxel(taxel) => frames[frame].port_pressure_rates_kpa[direction][taxel],
        };
        let interpolation = &self.frames[curve];
        let mut model = Vec::with_capacity(signal.values.len());
        for (sample, measured) in signal.values.iter().enumerate() {
            let bare = interpolation.sample(sample, value);
            model.push(scale * bare + offset);
            if !measured.is_finite() {
                continue;
            }
            let mut row = vec![0.0; unknowns.all.len()];
            for (direction, &unknown) in pressed.iter().enumerate() {
                let bare_rate = interpolation.sample(sample, |frame| rate(frame, direction));
                row[unknown] = scale * bare_rate / signal_scale;
            }
            for (entry, (unknown, x)) in row.iter_mut().zip(unknowns.all.iter().zip(x)) {
                if unknown.parameter == of_scale && unknown.owner == owner {
                    *entry = unknown.scale.rate(*x) * bare / signal_scale;
                } else if unknown.parameter == Parameter::ForceOffset
                    && signal.quantity == Quantity::Force
                    && unknown.owner == Some(curve)
                {
                    *entry = unknown.scale.rate(*x) / signal_scale;
                }
            }
            evaluation
                .residuals
                .push((scale * bare + offset - measured) / signal_scale);
            evaluation.jacobian.push(row);
        }
        model
    }
}
