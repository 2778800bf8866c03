//! Tasks for reinforcement learning.

use numpy::{Element, PyArray1, PyArray2, PyArray3, PyArrayMethods};
use pyo3::prelude::*;
use twintac::{Answers, Autoreset, Kind, PICTURE_PX};

use crate::error::{OrRaise, unusable};
use crate::fast::{FastGel, PROVENANCE};
use crate::given::{Array, Given, threads};
use crate::pickle::refused;
use crate::pool::in_parallel;
use crate::sensors::SensorVariation;
use crate::shared::Shared;

/// The result of a step: observations, rewards, terminated, truncated, figures; and observations
/// and figures at the end of episodes that ended.
type Step<'py> = (
    Bound<'py, PyArray2<f32>>,
    Bound<'py, PyArray1<f64>>,
    Bound<'py, PyArray1<bool>>,
    Bound<'py, PyArray1<bool>>,
    Bound<'py, PyArray2<f32>>,
    Option<Observed<'py>>,
);

/// Observations and figures.
type Observed<'py> = (Bound<'py, PyArray2<f32>>, Bound<'py, PyArray2<f32>>);

/// Many environments of one task of reinforcement learning, each with its own sensor, stepped in
/// one call. `len()` is the number of environments. `twintac.gymnasium` has them as Gymnasium
/// environments, and describes observations, actions and rewards of each task.
///
/// - `kind`: the task: `"ExploreShape"`, `"HoldForce"` or `"FollowEdge"`.
/// - `n_environments`: number of environments, from 1 to as many as give ten million readings:
///   1,250,000 with sensors of eight taxels.
/// - `gel`: the surrogate of the gel; PhysTac's unless given.
/// - `variation`: the sensor variation from which the sensor of each episode is drawn; that of
///   working sensors unless given.
/// - `autoreset`: when an environment whose episode has ended begins the next one: in the next step
///   (`"NextStep"`), which ignores its action and has a reward of zero; in the same step
///   (`"SameStep"`); or when `reset` is called (`"Disabled"`).
/// - `n_threads`: number of threads, at most 1024; as many as there are cores unless given. Results
///   do not depend on it.
///
/// Raises `Error` for a task that does not exist, for a gel that the task cannot use, and for a
/// number out of its range.
#[pyclass(frozen, module = "twintac")]
pub(crate) struct Tasks {
    running: Shared<Running>,
    kind: &'static str,
    autoreset: Autoreset,
    n_environments: usize,
    n_observed: usize,
    n_actions: usize,
    figures: &'static [&'static str],
    n_threads: usize,
}

/// What steps change.
struct Running {
    tasks: twintac::Tasks,
    /// Last observations of episodes that ended, and their figures.
    last: [Vec<f32>; 2],
}

#[pymethods]
impl Tasks {
    #[new]
    #[pyo3(signature = (kind, n_environments, *, gel=None, variation=None, autoreset="NextStep", n_threads=None))]
    fn new(
        py: Python<'_>,
        kind: &str,
        n_environments: Given<'_>,
        gel: Option<FastGel>,
        variation: Option<SensorVariation>,
        autoreset: &str,
        n_threads: Option<Given<'_>>,
    ) -> PyResult<Self> {
        let kind: Kind = kind.parse().or_raise(py)?;
        let autoreset = self::autoreset(py, autoreset)?;
        let n_environments = n_environments.count("n_environments", 1..=twintac::most_sensors(0))?;
        let n_threads = threads(n_threads)?;
        let variation = variation.map_or_else(twintac::usual_variation, |own| own.variation);
        let sizes = [n_environments, n_threads];
        let made = py.detach(|| {
            let gel = match gel {
                Some(gel) => gel.gel,
                None => twintac::FastGel::phystac()?.into(),
            };
            Ok::<_, twintac::Error>(twintac::Tasks::new(kind, &gel, &variation, sizes, autoreset)?)
        });
        let tasks = made.or_raise(py)?;
        let (n_observed, figures) = (tasks.n_observed(), tasks.figures());
        let widths = [n_observed, figures.len()];
        Ok(Self {
            kind: kind.name(),
            autoreset,
            n_environments,
            n_observed,
            n_actions: tasks.n_actions(),
            figures,
            n_threads,
            running: Shared::new(Running {
                last: widths.map(|width| vec![0.0; n_environments * width]),
                tasks,
            }),
        })
    }

    /// Provenance of all numbers: `"simulated"`.
    #[getter]
    fn provenance(&self) -> &'static str {
        PROVENANCE
    }

    /// Length of an observation. Each of its numbers is from -10 to 10.
    #[getter]
    fn n_observed(&self) -> usize {
        self.n_observed
    }

    /// Length of an action. Each of its numbers is from -1 to 1.
    #[getter]
    fn n_actions(&self) -> usize {
        self.n_actions
    }

    /// Names, with units, of the figures: true values of an environment that are not observed;
    /// `[n_figures]`.
    #[getter]
    fn figures(&self) -> Vec<&str> {
        self.figures.to_vec()
    }

    /// Sets the seeds of the environments. They take effect at the next reset.
    ///
    /// - `seeds`: a seed for each environment, from 0 to 2⁶⁴ - 1; with `None`, an environment keeps
    ///   its seed.
    ///
    /// Raises `Error` for another number of seeds, and for a seed out of this range.
    fn seed(&self, py: Python<'_>, seeds: Given<'_>) -> PyResult<()> {
        let seeds = seeds.seeds("seeds", self.n_environments)?;
        self.running.look(py, |running| {
            for (environment, seed) in seeds.into_iter().enumerate() {
                if let Some(seed) = seed {
                    running.tasks.seed(environment, seed);
                }
            }
        })
    }

    /// Begins the next episode of environments.
    ///
    /// - `which`: whether each environment is reset, `[n_environments]`; all of them unless given.
    ///
    /// Returns observations, `[n_environments, n_observed]`, and figures,
    /// `[n_environments, n_figures]`. They are zero for environments that are not reset.
    #[pyo3(signature = (which=None))]
    fn reset<'py>(&self, py: Python<'py>, which: Option<Given<'_>>) -> PyResult<Observed<'py>> {
        let n = self.n_environments;
        let which = which.map_or_else(|| Ok(vec![true; n]), |which| which.flags("which", n))?;
        let widths = [self.n_observed, self.figures.len()];
        let [observed, figures] = widths.map(|width| PyArray2::<f32>::zeros(py, [n, width], false));
        {
            let (mut observed, mut figures) = (observed.readwrite(), figures.readwrite());
            let (observed, figures) = (observed.as_slice_mut()?, figures.as_slice_mut()?);
            self.running.work(py, |Running { tasks, .. }| {
                let rows = observed
                    .chunks_exact_mut(widths[0])
                    .zip(figures.chunks_exact_mut(widths[1]));
                for (environment, (observed, figures)) in
                    rows.enumerate().filter(|(number, _)| which[*number])
                {
                    tasks.reset(environment, observed, figures);
                }
            })?;
        }
        Ok((observed, figures))
    }

    /// Computes one step of every environment.
    ///
    /// - `actions`: the actions, each number from -1 to 1; `[n_environments, n_actions]`.
    ///
    /// Returns observations, `[n_environments, n_observed]`; rewards, `[n_environments]`; whether
    /// the task has ended, `[n_environments]`; whether the time limit has ended the episode,
    /// `[n_environments]`; figures, `[n_environments, n_figures]`; and the last observations and
    /// figures of environments that began a new episode in the same step, or `None` if there are
    /// none.
    ///
    /// Raises `Error` for actions of another shape, or that are not finite.
    fn step<'py>(&self, py: Python<'py>, actions: Given<'_>) -> PyResult<Step<'py>> {
        let n = self.n_environments;
        let expected = [n, self.n_actions];
        let actions: Array<2> = actions.numbers("actions", &format!("{expected:?}"))?;
        if actions.shape != expected {
            let problem = format!("has the shape {:?}, expected {expected:?}", actions.shape);
            return Err(unusable(py, "actions", &problem));
        }
        let actions: Vec<f32> = actions.values.iter().map(|action| *action as f32).collect();
        if actions.iter().any(|action| !action.is_finite()) {
            return Err(unusable(py, "actions", "has a number that is not finite"));
        }
        let observed = PyArray2::<f32>::zeros(py, [n, self.n_observed], false);
        let figures = PyArray2::<f32>::zeros(py, [n, self.figures.len()], false);
        let rewards = PyArray1::<f64>::zeros(py, [n], false);
        let last;
        let [terminated, truncated] = [(), ()].map(|()| PyArray1::<bool>::zeros(py, [n], false));
        {
            let mut arrays = (observed.readwrite(), figures.readwrite(), rewards.readwrite());
            let mut ends = (terminated.readwrite(), truncated.readwrite());
            let (observed, figures) = (arrays.0.as_slice_mut()?, arrays.1.as_slice_mut()?);
            let (rewards, terminated) = (arrays.2.as_slice_mut()?, ends.0.as_slice_mut()?);
            let truncated = ends.1.as_slice_mut()?;
            last = self.running.work(py, |Running { tasks, last }| {
                let [last_observed, last_figures] = last;
                let answers = Answers {
                    observed,
                    figures,
                    rewards,
                    terminated,
                    truncated,
                    last_observed,
                    last_figures,
                };
                let step = || tasks.step(&actions, answers);
                // A single thread needs no pool.
                if self.n_threads > 1 {
                    in_parallel(step)
                } else {
                    step()
                }
                let any_ended = terminated.iter().chain(truncated.iter()).any(|ends| *ends);
                (self.autoreset == Autoreset::SameStep && any_ended).then(|| last.clone())
            })?;
        }
        let last = last.map(|[observed, figures]| {
            PyResult::Ok((
                table(py, &observed, self.n_observed)?,
                table(py, &figures, self.figures.len())?,
            ))
        });
        Ok((
            observed,
            rewards,
            terminated,
            truncated,
            figures,
            last.transpose()?,
        ))
    }

    /// Draws one environment: the scene from above, and the readings of its sensor.
    ///
    /// - `environment`: index of the environment, from 0.
    ///
    /// Returns red, green and blue of each pixel, 0 to 255; `[240, 600, 3]`.
    ///
    /// Raises `Error` for an index out of range.
    fn picture<'py>(&self, py: Python<'py>, environment: Given<'_>) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let environment = environment.count("environment", 0..=self.n_environments - 1)?;
        let pixels = self
            .running
            .work(py, |running| running.tasks.picture(environment))?;
        let pixels = pixels.or_raise(py)?;
        let [width, height] = PICTURE_PX;
        PyArray1::from_vec(py, pixels).reshape([height, width, 3])
    }

    /// Raises `TypeError`: a `Tasks` cannot be pickled or copied.
    fn __reduce__(&self) -> PyResult<()> {
        refused(
            "Tasks",
            "make them in each process, of the same task, gel and variation",
        )
    }

    fn __len__(&self) -> usize {
        self.n_environments
    }

    fn __repr__(&self) -> String {
        format!(
            "<Tasks: {} environments of {}, {PROVENANCE}>",
            self.n_environments, self.kind
        )
    }
}

fn table<'py, T: Element + Copy>(
    py: Python<'py>,
    numbers: &[T],
    n_columns: usize,
) -> PyResult<Bound<'py, PyArray2<T>>> {
    PyArray1::from_slice(py, numbers).reshape([numbers.len() / n_columns, n_columns])
}

fn autoreset(py: Python<'_>, name: &str) -> PyResult<Autoreset> {
    match name {
        "NextStep" => Ok(Autoreset::NextStep),
        "SameStep" => Ok(Autoreset::SameStep),
        "Disabled" => Ok(Autoreset::Disabled),
        _ => {
            let problem = format!("is `{name}`, expected NextStep, SameStep or Disabled");
            Err(unusable(py, "autoreset", &problem))
        }
    }
}
