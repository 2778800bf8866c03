//! Residuals of simulated against measured curves, and their derivatives.

use rayon::prelude::*;
use twintac_simulate::{Gel, Keyframe, PressPlace, RatedFrame, SimulateError};
use twintac_softbody::Direction;

use crate::curve::{Curve, Quantity};
use crate::frames::Frames;
use crate::unknown::Unknowns;
use crate::{CalibrateError, Parameter};

/// Depths farther above the gel than this are simulated at this depth, mm, because nothing changes
/// there.
const ABOVE_MM: f64 = -0.05;

/// Step of the difference quotient with respect to the coefficient of friction. It is large enough
/// that the solver's remaining imbalance is small beside the change.
const FRICTION_DIFFERENCE: f64 = 0.05;

/// Settings of a fit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FitSettings {
    /// Approximate number of simulated frames of each curve. Samples between them are interpolated.
    pub most_frames: usize,
    /// Largest number of steps of the fit.
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
    /// Scales of the residuals, by curve and signal: the largest force of a curve, N, or the
    /// largest reading of all, kPa.
    pub(crate) scales: Vec<Vec<f64>>,
}

/// All curves at one point of the search.
pub(crate) struct Evaluation {
    /// The simulated frames; `[n_curves][n_frames]`.
    presses: Vec<Vec<RatedFrame>>,
    /// The modelled signals; `[n_curves][n_signals][n_samples]`.
    pub(crate) model: Vec<Vec<Vec<f64>>>,
    /// Modelled minus measured values in units of the signals' scales, for all usable samples.
    pub(crate) residuals: Vec<f64>,
    /// Whether the frames contain their derivatives, so that these need no further presses.
    pub(crate) has_rates: bool,
}

/// Derivatives of the frames of a press with respect to some of the unknowns.
struct Rates {
    /// Indices of these unknowns.
    unknowns: Vec<usize>,
    /// `[n_frames][n_unknowns]`, N per unit of the unknown's coordinate.
    force_n: Vec<Vec<f64>>,
    /// `[n_frames][n_unknowns][n_taxels]`, kPa per unit of the unknown's coordinate.
    port_pressure_kpa: Vec<Vec<Vec<f64>>>,
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

    /// Number of frames that are simulated.
    pub(crate) fn n_frames(&self) -> usize {
        self.frames.iter().map(|frames| frames.rows.len()).sum()
    }

    /// Simulates all curves, each on a thread.
    pub(crate) fn evaluate(&self, x: &[f64]) -> Result<Evaluation, CalibrateError> {
        let presses = self.each_curve(|curve| match self.friction(curve, x) {
            0.0 => self.press(curve, x, 0.0, &self.directions(curve, x).1), // together with its derivatives
            friction => self.press(curve, x, friction, &[]),
        })?;
        let (mut model, mut residuals) = (Vec::new(), Vec::new());
        for (index, (curve, frames)) in self.curves.iter().zip(&presses).enumerate() {
            let mut of_curve = Vec::new();
            for (which, signal) in curve.signals.iter().enumerate() {
                let [scale, offset] = self.scale_and_offset(index, signal.quantity, x);
                let value = |frame: usize| signal.quantity.of(&frames[frame]);
                let bare = (0..signal.values.len()).map(|sample| self.frames[index].sample(sample, value));
                let values: Vec<f64> = bare.map(|bare| scale * bare + offset).collect();
                let pairs = values.iter().zip(&signal.values);
                let usable = pairs.filter(|(_, measured)| measured.is_finite());
                residuals
                    .extend(usable.map(|(model, measured)| (model - measured) / self.scales[index][which]));
                of_curve.push(values);
            }
            model.push(of_curve);
        }
        let mut all = self.unknowns.all.iter();
        let is_rough = all.any(|unknown| unknown.parameter == Parameter::Friction)
            || (0..self.curves.len()).any(|curve| self.friction(curve, x) > 0.0);
        Ok(Evaluation {
            presses,
            model,
            residuals,
            has_rates: !is_rough,
        })
    }

    /// The derivatives of the residuals at the point where they were evaluated;
    /// `[n_residuals][n_unknowns]`.
    pub(crate) fn jacobian(&self, x: &[f64], at: &Evaluation) -> Result<Vec<Vec<f64>>, CalibrateError> {
        let rates = self.each_curve(|curve| self.rates(curve, x, &at.presses[curve]))?;
        let mut jacobian = Vec::new();
        for (curve, rates) in rates.iter().enumerate() {
            for which in 0..self.curves[curve].signals.len() {
                self.rows(curve, which, x, rates, &at.presses[curve], &mut jacobian);
            }
        }
        Ok(jacobian)
    }

    /// Calls `work` for all curves, each on a thread.
    fn each_curve<T: Send>(
        &self,
        work: impl Fn(usize) -> Result<T, CalibrateError> + Sync,
    ) -> Result<Vec<T>, CalibrateError> {
        let indices: Vec<usize> = (0..self.curves.len()).collect();
        indices
            .par_iter()
            .with_max_len(1)
            .map(|&curve| work(curve))
            .collect()
    }

    fn friction(&self, curve: usize, x: &[f64]) -> f64 {
        let given = self.curves[curve].friction;
        self.unknowns.value(&Parameter::Friction, None, x, given)
    }

    /// The unknowns for which a press has derivatives, and the directions of these derivatives.
    fn directions(&self, curve: usize, x: &[f64]) -> (Vec<usize>, Vec<Direction>) {
        let direction = |unknown| Some((unknown, self.unknowns.direction(unknown, curve, x)?));
        (0..x.len()).filter_map(direction).unzip()
    }

    /// Factor and offset of a simulated signal.
    fn scale_and_offset(&self, curve: usize, quantity: Quantity, x: &[f64]) -> [f64; 2] {
        let value = |parameter, owner, otherwise| self.unknowns.value(&parameter, owner, x, otherwise);
        match quantity {
            Quantity::Force => [
                value(Parameter::ForceScale, None, 1.0),
                value(Parameter::ForceOffset, Some(curve), 0.0),
            ],
            Quantity::Taxel(taxel) => [value(Parameter::Gain, Some(taxel), 1.0), 0.0],
        }
    }

    /// Simulates one press.
    fn press(
        &self,
        index: usize,
        x: &[f64],
        friction: f64,
        directions: &[Direction],
    ) -> Result<Vec<RatedFrame>, CalibrateError> {
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
        let gel = self.gel.clone().with_material(self.unknowns.material(x));
        let mesh = gel.with_friction(friction).mesh(&place);
        let frames = mesh.and_then(|mesh| mesh.press_with_rates(&keyframes, deeper_mm, directions));
        frames.map_err(|error: SimulateError| CalibrateError::Simulate {
            curve: curve.name.clone(),
            error,
        })
    }

    /// The derivatives of a simulated press. Those with respect to material and depth are those of
    /// a gel without friction, because a press with friction cannot be differentiated. Friction
    /// changes the forces, but changes their derivatives little.
    fn rates(&self, index: usize, x: &[f64], pressed: &[RatedFrame]) -> Result<Rates, CalibrateError> {
        let (unknowns, directions) = self.directions(index, x);
        let friction = self.friction(index, x);
        let smooth = match friction {
            0.0 => pressed.to_vec(),
            _ => self.press(index, x, 0.0, &directions)?,
        };
        let (force_n, port_pressure_kpa) = smooth
            .into_iter()
            .map(|frame| (frame.force_rates_n, frame.port_pressure_rates_kpa))
            .unzip();
        let mut rates = Rates {
            unknowns,
            force_n,
            port_pressure_kpa,
        };
        let mut all = self.unknowns.all.iter();
        if let Some(free) = all.position(|unknown| unknown.parameter == Parameter::Friction) {
            let rougher = self.press(index, x, friction + FRICTION_DIFFERENCE, &[])?;
            rates.unknowns.push(free);
            for (frame, (rougher, pressed)) in rougher.iter().zip(pressed).enumerate() {
                let rate = |more: f64, value: f64| (more - value) / FRICTION_DIFFERENCE;
                let pressures = rougher.port_pressure_kpa.iter().zip(&pressed.port_pressure_kpa);
                let of_ports = pressures.map(|(more, value)| rate(*more, *value)).collect();
                rates.port_pressure_kpa[frame].push(of_ports);
                rates.force_n[frame].push(rate(rougher.force_n, pressed.force_n));
            }
        }
        Ok(rates)
    }

    /// Appends the derivatives of a signal's residuals.
    fn rows(
        &self,
        curve: usize,
        which: usize,
        x: &[f64],
        rates: &Rates,
        pressed: &[RatedFrame],
        jacobian: &mut Vec<Vec<f64>>,
    ) {
        let signal = &self.curves[curve].signals[which];
        let signal_scale = self.scales[curve][which];
        let (of_scale, owner) = match signal.quantity {
            Quantity::Force => (Parameter::ForceScale, None),
            Quantity::Taxel(taxel) => (Parameter::Gain, Some(taxel)),
        };
        let [scale, _] = self.scale_and_offset(curve, signal.quantity, x);
        let rate = |frame: usize, direction: usize| match signal.quantity {
            Quantity::Force => rates.force_n[frame][direction],
            Quantity::Taxel(taxel) => rates.port_pressure_kpa[frame][direction][taxel],
        };
        let interpolation = &self.frames[curve];
        let usable = (0..signal.values.len()).filter(|&sample| signal.values[sample].is_finite());
        jacobian.extend(usable.map(|sample| {
            let mut row = vec![0.0; x.len()];
            for (direction, &unknown) in rates.unknowns.iter().enumerate() {
                let bare_rate = interpolation.sample(sample, |frame| rate(frame, direction));
                row[unknown] = scale * bare_rate / signal_scale;
            }
            for (entry, (unknown, x)) in row.iter_mut().zip(self.unknowns.all.iter().zip(x)) {
                if unknown.parameter == of_scale && unknown.owner == owner {
                    let bare = interpolation.sample(sample, |frame| signal.quantity.of(&pressed[frame]));
                    *entry = unknown.scale.rate(*x) * bare / signal_scale;
                } else if unknown.parameter == Parameter::ForceOffset
                    && signal.quantity == Quantity::Force
                    && unknown.owner == Some(curve)
                {
                    *entry = unknown.scale.rate(*x) / signal_scale;
                }
            }
            row
        }));
    }
}

impl Quantity {
    /// The value of the quantity in a frame, N or kPa.
    fn of(self, frame: &RatedFrame) -> f64 {
        match self {
            Self::Force => frame.force_n,
            Self::Taxel(taxel) => frame.port_pressure_kpa[taxel],
        }
    }
}
