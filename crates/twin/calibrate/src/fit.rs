//! The fit and its result.

use serde::Serialize;
use twintac_simulate::Gel;
use twintac_softbody::Material;

use crate::curve::Curve;
use crate::least_squares::{Solution, minimize, normal_equations};
use crate::problem::{Evaluation, Problem};
use crate::statistics::{Covariance, HARD_TO_TELL, covariance, neighbour_correlation, student_quantile};
use crate::unknown::{Unknown, poissons_ratio};
use crate::{CalibrateError, FitSettings, Parameter};

/// Correlation of neighbouring residuals above which they are not noise.
const NOT_NOISE: f64 = 0.5;

/// Standard deviation of the residuals over the largest measured value, above which the model does
/// not describe the gel.
const TOO_MUCH: f64 = 0.05;

/// Correlation of two unknowns above which a warning is given.
const CORRELATED: f64 = 0.98;

/// An unknown as the fit found it.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FittedUnknown {
    /// Name and owner, with its unit: `shear_modulus_kpa`, `depth_offset_mm of press 1`.
    pub name: String,
    /// The parameter, without its owner.
    pub parameter: Parameter,
    /// Value that the fit started from.
    pub start: f64,
    /// Value found.
    pub value: f64,
    /// Ends of the 95 % confidence interval. They are infinite where the data do not determine the
    /// value.
    pub interval_95: [f64; 2],
    /// Whether the data determine the value: its interval is finite, and the value is not at a
    /// bound of the search.
    pub identified: bool,
}

/// Correlation of two unknowns' errors.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Correlation {
    /// Names of the two unknowns.
    pub between: [String; 2],
    /// From -1 to 1.
    pub correlation: f64,
}

/// A measured signal, and the same signal simulated with the fitted values.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct FittedSignal {
    /// Name of the curve.
    pub curve: String,
    /// Index of the taxel; `None` for a force.
    pub taxel: Option<usize>,
    /// Root mean square of fitted minus measured values, over the largest measured value, %.
    pub deviation_percent: f64,
    /// Correlation of neighbouring residuals: near 0 for noise, near 1 where the model is wrong.
    pub neighbour_correlation: f64,
    /// Time, s; `[n_samples]`.
    #[serde(skip)]
    pub time_s: Vec<f64>,
    /// Measured depth, mm; `[n_samples]`.
    #[serde(skip)]
    pub depth_mm: Vec<f64>,
    /// Measured values, N or kPa; `[n_samples]`.
    #[serde(skip)]
    pub measured: Vec<f64>,
    /// Fitted values, N or kPa; `[n_samples]`.
    #[serde(skip)]
    pub fitted: Vec<f64>,
}

/// The result of a fit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fit {
    /// The material of the gel with the fitted values.
    pub material: Material,
    /// Poisson's ratio of the material at small strain.
    pub poissons_ratio: f64,
    /// The unknowns in the order in which they were requested; gains of taxels come last.
    pub unknowns: Vec<FittedUnknown>,
    /// Correlations of all pairs of unknowns that the data determine.
    pub correlations: Vec<Correlation>,
    /// Ratio of the largest to the smallest singular value of the Jacobian with columns of unit
    /// length. Above 30, some unknowns are hard to separate.
    pub condition: f64,
    /// Standard deviation of the residuals, over the largest measured value of their curve (forces)
    /// or of all curves (readings), %.
    pub noise_percent: f64,
    /// Number of usable samples.
    pub n_samples: usize,
    /// Number of steps of the fit, including rejected steps.
    pub iterations: u32,
    /// Whether the fit ended because no further step promised a smaller error.
    pub converged: bool,
    /// Warnings, in words.
    pub warnings: Vec<String>,
    /// The measured and the fitted signals.
    pub signals: Vec<FittedSignal>,
}

/// Fits the free parameters to the curves. The gel is meshed and solved with its own settings; its
/// material is the initial guess. `tell` is called after each step with the root mean square of the
/// residuals, over the largest measured value.
///
/// Confidence intervals are those of the linearized model, `x ± t s √(JᵀJ)⁻¹ᵢᵢ` with Student's `t`,
/// on the scale on which the unknown is sought (the logarithm for positive values). They are right
/// if the residuals are independent noise of one variance.
///
/// # Errors
/// Invalid curves; parameters that this gel or these curves do not allow; a press that cannot be
/// simulated with the initial values.
pub fn fit(
    gel: &Gel,
    curves: &[Curve],
    free: &[Parameter],
    settings: FitSettings,
    tell: &mut dyn FnMut(f64),
) -> Result<Fit, CalibrateError> {
    let problem = Problem::new(gel, curves, free, settings)?;
    let mut start: Vec<f64> = problem.unknowns.all.iter().map(|unknown| unknown.start).collect();
    let mut first = problem.evaluate(&start)?;
    if guess_gains(&problem, &first, &mut start) {
        first = problem.evaluate(&start)?;
    }
    let solution = minimize(&problem, start.clone(), first, settings.max_iterations, tell)?;
    Ok(report(&problem, &start, &solution))
}

/// Starts each taxel's gain at the value that fits best by itself. Says whether any gain was
/// changed.
fn guess_gains(problem: &Problem, first: &Evaluation, start: &mut [f64]) -> bool {
    let mut any = false;
    for (unknown, start) in problem.unknowns.all.iter().zip(start) {
        if unknown.parameter != Parameter::Gain {
            continue;
        }
        let (mut products, mut squares) = (0.0, 0.0);
        for (curve, model) in problem.curves.iter().zip(&first.model) {
            for (signal, model) in curve.signals.iter().zip(model) {
                if unknown.owner == signal.quantity.taxel() {
                    let pairs = signal.values.iter().zip(model).filter(|(m, _)| m.is_finite());
                    for (measured, model) in pairs {
                        products += measured * model;
                        squares += model * model;
                    }
                }
            }
        }
        if products > 0.0 && squares > 0.0 {
            *start += (products / squares).ln();
            any = true;
        }
    }
    any
}

/// Computes confidence intervals and warnings.
fn report(problem: &Problem, start: &[f64], solution: &Solution) -> Fit {
    let Solution {
        x,
        evaluation,
        jacobian,
        iterations,
        converged,
    } = solution;
    let all = &problem.unknowns.all;
    let n_samples = evaluation.residuals.len();
    let freedom = (n_samples - all.len()) as f64;
    let variance = evaluation.residuals.iter().map(|r| r * r).sum::<f64>() / freedom;
    let normal = normal_equations(jacobian, &evaluation.residuals, all.len()).matrix;
    let known = covariance(
        &faer::Mat::from_fn(all.len(), all.len(), |i, j| normal[i * all.len() + j]),
        variance,
    );
    let quantile = student_quantile(0.975, freedom);
    let mut warnings = Vec::new();
    if !*converged {
        warnings.push(format!("the fit did not converge in {iterations} steps"));
    }
    if variance.sqrt() > TOO_MUCH {
        warnings.push(format!(
            "residuals are {:.1} % of the largest value, expected below {:.0} %: the material law does not describe the gel, or the search ended in a local minimum; start from other values",
            100.0 * variance.sqrt(),
            100.0 * TOO_MUCH
        ));
    }
    let unknowns = fitted_unknowns(all, [start, x], &known, quantile, &mut warnings);
    warnings.extend(hard_to_tell(all, &known));
    let correlations = correlations(all, &known, &mut warnings);
    let signals = signals(problem, evaluation);
    let worst = signals
        .iter()
        .map(|signal| signal.neighbour_correlation)
        .fold(0.0, f64::max);
    if worst > NOT_NOISE {
        warnings.push(format!(
            "residuals are correlated (neighbours by up to {worst:.2}): the model does not describe the data completely, and the intervals are too narrow"
        ));
    }
    let material = problem.unknowns.material(x);
    Fit {
        poissons_ratio: poissons_ratio(&material),
        material,
        unknowns,
        correlations,
        condition: known.condition,
        noise_percent: 100.0 * variance.sqrt(),
        n_samples,
        iterations: *iterations,
        converged: *converged,
        warnings,
        signals,
    }
}

/// The unknowns with their confidence intervals, `quantile` standard errors to each side.
fn fitted_unknowns(
    all: &[Unknown],
    [start, x]: [&[f64]; 2],
    known: &Covariance,
    quantile: f64,
    warnings: &mut Vec<String>,
) -> Vec<FittedUnknown> {
    let mut unknowns = Vec::new();
    for (index, unknown) in all.iter().enumerate() {
        let half = quantile * known.covariance[(index, index)].sqrt();
        let is_untold = known.untold.contains(&index);
        let at_bound = x[index] <= unknown.bounds[0] || x[index] >= unknown.bounds[1];
        if at_bound {
            warnings.push(format!(
                "{} is at the end of its search range, {:.4}: the data do not determine it",
                unknown.name,
                unknown.scale.value(x[index])
            ));
        }
        let interval_95 = if is_untold {
            [f64::NEG_INFINITY, f64::INFINITY]
        } else {
            [x[index] - half, x[index] + half].map(|end| unknown.scale.value(end))
        };
        unknowns.push(FittedUnknown {
            name: unknown.name.clone(),
            parameter: unknown.parameter.clone(),
            start: unknown.scale.value(start[index]),
            value: unknown.scale.value(x[index]),
            interval_95,
            identified: !is_untold && !at_bound,
        });
    }
    unknowns
}

/// A warning if the data do not determine some unknowns, or hardly separate them.
fn hard_to_tell(all: &[Unknown], known: &Covariance) -> Option<String> {
    let names = |indices: &[usize]| -> String {
        let names: Vec<&str> = indices.iter().map(|&i| all[i].name.as_str()).collect();
        names.join(", ")
    };
    if !known.untold.is_empty() {
        Some(format!(
            "the data do not determine {}: fix some of them",
            names(&known.untold)
        ))
    } else if known.condition > HARD_TO_TELL {
        Some(format!(
            "{} are hard to separate: condition {:.0}, expected below {HARD_TO_TELL:.0}",
            names(&known.worst),
            known.condition
        ))
    } else {
        None
    }
}

/// The correlation of each pair of unknowns.
fn correlations(all: &[Unknown], known: &Covariance, warnings: &mut Vec<String>) -> Vec<Correlation> {
    let mut correlations = Vec::new();
    for i in 0..all.len() {
        for j in 0..i {
            let scale = (known.covariance[(i, i)] * known.covariance[(j, j)]).sqrt();
            if scale.is_finite() && scale > 0.0 {
                let correlation = known.covariance[(i, j)] / scale;
                if correlation.abs() > CORRELATED {
                    warnings.push(format!(
                        "{} and {} can hardly be separated: correlation {correlation:.3}",
                        all[j].name, all[i].name
                    ));
                }
                correlations.push(Correlation {
                    between: [all[j].name.clone(), all[i].name.clone()],
                    correlation,
                });
            }
        }
    }
    correlations
}

fn signals(problem: &Problem, evaluation: &Evaluation) -> Vec<FittedSignal> {
    let mut found = Vec::new();
    for (index, (curve, model)) in problem.curves.iter().zip(&evaluation.model).enumerate() {
        for (which, (signal, model)) in curve.signals.iter().zip(model).enumerate() {
            let pairs = signal.values.iter().zip(model).filter(|(m, _)| m.is_finite());
            let residuals: Vec<f64> = pairs.map(|(measured, model)| model - measured).collect();
            let square = residuals.iter().map(|r| r * r).sum::<f64>() / residuals.len().max(1) as f64;
            found.push(FittedSignal {
                curve: curve.name.clone(),
                taxel: signal.quantity.taxel(),
                deviation_percent: 100.0 * square.sqrt() / problem.scales[index][which],
                neighbour_correlation: neighbour_correlation(&residuals),
                time_s: curve.time_s.clone(),
                depth_mm: curve.depth_mm.clone(),
                measured: signal.values.clone(),
                fitted: model.clone(),
            });
        }
    }
    found
}
