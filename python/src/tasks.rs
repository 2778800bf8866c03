//! Tasks for reinforcement learning.

use numpy::ndarray::{Ix1, Ix2};
use numpy::{
    AllowTypeChange, Element, PyArray1, PyArray2, PyArray3, PyArrayLike, PyArrayMethods, PyReadonlyArray,
};
use pyo3::prelude::*;
use twintac::{Answers, Autoreset, Kind, PICTURE_PX};

use crate::error::{OrRaise, unusable};
use crate::fast::{FastGel, PROVENANCE, n_cores};
use crate::sensors::Imperfection;

/// What a step answers: observations, rewards, terminated, truncated, figures; and observations and figures at the end of episodes that ended.
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

/// Many environments of one task, each with a sensor of its own, stepped in one call. `len()` is the number of environments. `twintac.gymnasium` has them as environments
/// of Gymnasium, and says what each task observes, does and rewards.
///
/// - `kind`: `"ExploreShape"`, `"HoldForce"` or `"FollowEdge"`.
/// - `gel`: PhysTac's unless given.
/// - `imperfection`: from what the imperfections of each episode's sensor are drawn; those of a sensor that works unless given.
/// - `autoreset`: when an environment whose episode is over begins the next one: in the next step (`"NextStep"`), which ignores its action and has a reward of zero; in
///   the same step (`"SameStep"`); or when `reset` is called (`"Disabled"`).
/// - `n_threads`: as many as there are cores unless given; results do not depend on it.
///
/// Raises `Error` for a task that is not there, a gel that it cannot use, and if there is no environment.
#[pyclass(module = "twintac")]
pub(crate) struct Tasks {
    tasks: twintac::Tasks,
    autoreset: Autoreset,
    /// What was observed last in episodes that ended, and the figures then.
    last: [Vec<f32>; 2],
}

#[pymethods]
impl Tasks {
    #[new]
    #[pyo3(signature = (kind, n_environments, *, gel=None, imperfection=None, autoreset="NextStep", n_threads=None))]
    fn new(
        py: Python<'_>,
        kind: &str,
        n_environments: usize,
        gel: Option<FastGel>,
        imperfection: Option<Imperfection>,
        autoreset: &str,
        n_threads: Option<usize>,
    ) -> PyResult<Self> {
        let kind: Kind = kind.parse().or_raise(py)?;
        let autoreset = self::autoreset(py, autoreset)?;
        if n_environments == 0 {
            return Err(unusable(py, "n_environments", "is 0, expected at least one"));
        }
        let imperfection = imperfection.map_or_else(twintac::usual_imperfection, |own| own.imperfection);
        let sizes = [n_environments, n_threads.unwrap_or_else(n_cores)];
        let made = py.detach(|| {
            let gel = match gel {
                Some(gel) => gel.gel,
                None => twintac::FastGel::phystac()?.into(),
            };
            Ok::<_, twintac::Error>(twintac::Tasks::new(kind, &gel, &imperfection, sizes, autoreset)?)
        });
        let tasks = made.or_raise(py)?;
        let widths = [tasks.n_observed(), tasks.figures().len()];
        Ok(Self {
            last: widths.map(|width| vec![0.0; n_environments * width]),
            tasks,
            autoreset,
        })
    }

    /// What every number is: simulated.
    #[getter]
    fn provenance(&self) -> &'static str {
        PROVENANCE
    }

    /// Numbers of an observation, each from -10 to 10.
    #[getter]
    fn n_observed(&self) -> usize {
        self.tasks.n_observed()
    }

    /// Numbers of an action, each from -1 to 1.
    #[getter]
    fn n_actions(&self) -> usize {
        self.tasks.n_actions()
    }

    /// Names of what is true in an environment and not observed, with units; `[n_figures]`.
    #[getter]
    fn figures(&self) -> Vec<&str> {
        self.tasks.figures().to_vec()
    }

    /// Gives environments seeds, one for each, from the next reset on; `None` leaves an environment the one that it has.
    fn seed(&mut self, py: Python<'_>, seeds: Vec<Option<u64>>) -> PyResult<()> {
        self.check(py, "seeds", seeds.len())?;
        for (environment, seed) in seeds.into_iter().enumerate() {
            if let Some(seed) = seed {
                self.tasks.seed(environment, seed);
            }
        }
        Ok(())
    }

    /// Begins the next episode of all environments, or of those where `which`, `[n_environments]`, is true. Returns observations, `[n_environments, n_observed]`, and figures,
    /// `[n_environments, n_figures]`; zeros of the others.
    #[pyo3(signature = (which=None))]
    fn reset<'py>(
        &mut self,
        py: Python<'py>,
        which: Option<PyReadonlyArray<'_, bool, Ix1>>,
    ) -> PyResult<Observed<'py>> {
        let n = self.tasks.n_environments();
        let which = which.map_or_else(|| vec![true; n], |which| which.as_array().to_vec());
        self.check(py, "which", which.len())?;
        let widths = [self.tasks.n_observed(), self.tasks.figures().len()];
        let [observed, figures] = widths.map(|width| PyArray2::<f32>::zeros(py, [n, width], false));
        {
            let (mut observed, mut figures) = (observed.readwrite(), figures.readwrite());
            let (observed, figures) = (observed.as_slice_mut()?, figures.as_slice_mut()?);
            let tasks = &mut self.tasks;
            py.detach(|| {
                let rows = observed
                    .chunks_exact_mut(widths[0])
                    .zip(figures.chunks_exact_mut(widths[1]));
                for (environment, (observed, figures)) in
                    rows.enumerate().filter(|(number, _)| which[*number])
                {
                    tasks.reset(environment, observed, figures);
                }
            });
        }
        Ok((observed, figures))
    }

    /// One step of every environment. `actions` is `[n_environments, n_actions]`, each from -1 to 1.
    ///
    /// Returns observations, `[n_environments, n_observed]`; rewards, whether the task is over, and whether time is over, each `[n_environments]`; figures,
    /// `[n_environments, n_figures]`; and, of environments that began anew in the same step, what was observed before and the figures then, or `None` if there are none.
    ///
    /// Raises `Error` for actions of another shape, or that are not finite.
    fn step<'py>(
        &mut self,
        py: Python<'py>,
        actions: PyArrayLike<'_, f32, Ix2, AllowTypeChange>,
    ) -> PyResult<Step<'py>> {
        let n = self.tasks.n_environments();
        let actions = actions.as_array();
        if actions.shape() != [n, self.tasks.n_actions()] {
            let problem = format!(
                "has the shape {:?}, expected {:?}",
                actions.shape(),
                [n, self.tasks.n_actions()]
            );
            return Err(unusable(py, "actions", &problem));
        }
        let actions: Vec<f32> = actions.iter().copied().collect(); // other threads may write into the array meanwhile
        if actions.iter().any(|action| !action.is_finite()) {
            return Err(unusable(py, "actions", "has a number that is not finite"));
        }
        let observed = PyArray2::<f32>::zeros(py, [n, self.tasks.n_observed()], false);
        let figures = PyArray2::<f32>::zeros(py, [n, self.tasks.figures().len()], false);
        let rewards = PyArray1::<f64>::zeros(py, [n], false);
        let [terminated, truncated] = [(), ()].map(|()| PyArray1::<bool>::zeros(py, [n], false));
        {
            let mut arrays = (observed.readwrite(), figures.readwrite(), rewards.readwrite());
            let mut ends = (terminated.readwrite(), truncated.readwrite());
            let [last_observed, last_figures] = &mut self.last;
            let answers = Answers {
                observed: arrays.0.as_slice_mut()?,
                figures: arrays.1.as_slice_mut()?,
                rewards: arrays.2.as_slice_mut()?,
                terminated: ends.0.as_slice_mut()?,
                truncated: ends.1.as_slice_mut()?,
                last_observed,
                last_figures,
            };
            let tasks = &mut self.tasks;
            py.detach(|| tasks.step(&actions, answers));
        }
        let last = self.last(py, &terminated, &truncated)?;
        Ok((observed, rewards, terminated, truncated, figures, last))
    }

    /// A picture of one environment, counted from 0: what is there from above, and what its sensor reads. `[240, 600, 3]`, red, green and blue, 0 to 255.
    fn picture<'py>(&self, py: Python<'py>, environment: usize) -> PyResult<Bound<'py, PyArray3<u8>>> {
        let n = self.tasks.n_environments();
        if environment >= n {
            return Err(unusable(
                py,
                "environment",
                &format!("is {environment}, there are {n}"),
            ));
        }
        let pixels = py.detach(|| self.tasks.picture(environment)).or_raise(py)?;
        let [width, height] = PICTURE_PX;
        PyArray1::from_vec(py, pixels).reshape([height, width, 3])
    }

    fn __len__(&self) -> usize {
        self.tasks.n_environments()
    }
}

impl Tasks {
    /// One of something for each environment.
    fn check(&self, py: Python<'_>, field: &str, n: usize) -> PyResult<()> {
        let expected = self.tasks.n_environments();
        if n == expected {
            return Ok(());
        }
        let problem = format!("has {n} values, expected one for each of {expected} environments");
        Err(unusable(py, field, &problem))
    }

    /// What was observed last where episodes ended and began anew.
    fn last<'py>(
        &self,
        py: Python<'py>,
        terminated: &Bound<'py, PyArray1<bool>>,
        truncated: &Bound<'py, PyArray1<bool>>,
    ) -> PyResult<Option<Observed<'py>>> {
        let any = |ends: &Bound<'py, PyArray1<bool>>| ends.readonly().as_array().iter().any(|end| *end);
        if self.autoreset != Autoreset::SameStep || !(any(terminated) || any(truncated)) {
            return Ok(None);
        }
        let [observed, figures] = &self.last;
        Ok(Some((
            table(py, observed, self.tasks.n_observed())?,
            table(py, figures, self.tasks.figures().len())?,
        )))
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
