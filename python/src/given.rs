//! Arguments as Python passes them. They become arrays, counts and seeds together with their name,
//! so that an error can name the argument.

use std::ops::RangeInclusive;

use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArray, PyUntypedArrayMethods};
use pyo3::prelude::*;
use pyo3::types::PyBool;

use crate::error::unusable;

/// Most threads of a batch.
const MOST_THREADS: usize = 1024;

/// Number of characters of an argument that an error shows.
const SHOWN: usize = 40;

/// An argument that has not been checked yet.
#[derive(FromPyObject)]
#[pyo3(transparent)]
pub(crate) struct Given<'py>(Bound<'py, PyAny>);

/// An array of numbers, with its shape.
pub(crate) struct Array<const N: usize> {
    pub(crate) shape: [usize; N],
    pub(crate) values: Vec<f64>,
}

impl Array<2> {
    /// Its rows.
    pub(crate) fn rows(&self) -> impl Iterator<Item = &[f64]> {
        self.values.chunks_exact(self.shape[1].max(1))
    }
}

impl Given<'_> {
    /// Numbers of any type and memory layout, converted to `f64`; masked values are NaN. `expected`
    /// states shape and unit for errors: `[n_poses, 3], mm`.
    pub(crate) fn numbers<const N: usize>(&self, field: &str, expected: &str) -> PyResult<Array<N>> {
        let py = self.0.py();
        let refused = |problem: String| unusable(py, field, &format!("{problem}, expected {expected}"));
        let is_plain = self.0.get_type().is(py.get_type::<PyUntypedArray>());
        let array = match self.0.cast::<PyArrayDyn<f64>>() {
            Ok(array) if is_plain => array.clone(),
            _ => self.converted().map_err(|why| refused(self.misfit(&why)))?,
        };
        let shape = <[usize; N]>::try_from(array.shape());
        let shape = shape.map_err(|_| refused(format!("has the shape {:?}", array.shape())))?;
        let values = array.readonly().as_array().iter().copied().collect();
        Ok(Array { shape, values })
    }

    /// The numbers after a conversion by NumPy.
    fn converted(&self) -> PyResult<Bound<'_, PyArrayDyn<f64>>> {
        let numpy = self.0.py().import("numpy")?;
        let given = if self.0.hasattr("mask")? && self.0.hasattr("filled")? {
            let floats = self.0.call_method1("astype", ("float64",))?;
            floats.call_method1("filled", (f64::NAN,))?
        } else {
            self.0.clone()
        };
        let array = numpy.call_method1("asarray", (given,))?;
        let kind = array.getattr("dtype")?;
        if !matches!(
            &*kind.getattr("kind")?.extract::<String>()?,
            "b" | "i" | "u" | "f" | "O"
        ) {
            let problem = format!("has values of type {kind}");
            return Err(pyo3::exceptions::PyTypeError::new_err(problem));
        }
        Ok(array.call_method1("astype", ("float64",))?.cast_into()?)
    }

    fn misfit(&self, why: &PyErr) -> String {
        format!(
            "is {}, which is no array of numbers ({})",
            self.shown(),
            why.value(self.0.py())
        )
    }

    /// Exactly `N` numbers.
    pub(crate) fn few<const N: usize>(&self, field: &str, unit: &str) -> PyResult<[f64; N]> {
        let expected = format!("{N} numbers{unit}");
        let array: Array<1> = self.numbers(field, &expected)?;
        let refused = |values: Vec<f64>| {
            let problem = format!("has {} numbers, expected {expected}", values.len());
            unusable(self.0.py(), field, &problem)
        };
        <[f64; N]>::try_from(array.values).map_err(refused)
    }

    /// An integer in a range, of Python or of NumPy.
    pub(crate) fn integer(&self, field: &str, range: RangeInclusive<u64>) -> PyResult<u64> {
        let is_flag = self.0.is_instance_of::<PyBool>();
        let found = self
            .0
            .extract::<u64>()
            .ok()
            .filter(|found| !is_flag && range.contains(found));
        found.ok_or_else(|| {
            let problem = format!(
                "is {}, expected an integer from {} to {}",
                self.shown(),
                range.start(),
                range.end()
            );
            unusable(self.0.py(), field, &problem)
        })
    }

    /// The same as a `usize`.
    pub(crate) fn count(&self, field: &str, range: RangeInclusive<usize>) -> PyResult<usize> {
        let range = *range.start() as u64..=*range.end() as u64;
        Ok(self.integer(field, range)? as usize)
    }

    /// An integer of 0 or more.
    pub(crate) fn seed(&self, field: &str) -> PyResult<u64> {
        self.integer(field, 0..=u64::MAX)
    }

    /// A seed for each of `n`, or `None`.
    pub(crate) fn seeds(&self, field: &str, n: usize) -> PyResult<Vec<Option<u64>>> {
        let py = self.0.py();
        let refused = |problem: String| {
            let expected = "expected a list with a seed, or None, for each";
            unusable(py, field, &format!("{problem}, {expected} of {n} environments"))
        };
        let each = self
            .0
            .try_iter()
            .map_err(|_| refused(format!("is {}", self.shown())))?;
        let seed = |seed: PyResult<Bound<'_, PyAny>>| {
            let seed = seed?;
            if seed.is_none() {
                Ok(None)
            } else {
                Given(seed).seed(field).map(Some)
            }
        };
        let seeds = each.map(seed).collect::<PyResult<Vec<_>>>()?;
        if seeds.len() == n {
            return Ok(seeds);
        }
        Err(refused(format!("has {} values", seeds.len())))
    }

    /// Integers of any type. `expected` states the shape, such as `[n_touches]`. Other numbers are
    /// refused, not rounded.
    pub(crate) fn integers<const N: usize>(
        &self,
        field: &str,
        expected: &str,
    ) -> PyResult<([usize; N], Vec<i64>)> {
        let py = self.0.py();
        let refused =
            |problem: String| unusable(py, field, &format!("{problem}, expected integers {expected}"));
        let array = py.import("numpy")?.call_method1("asarray", (&self.0,));
        let array = array.map_err(|why| refused(self.misfit(&why)))?;
        let kind = array.getattr("dtype")?;
        let is_empty = array.getattr("size")?.extract::<usize>()? == 0;
        if !matches!(&*kind.getattr("kind")?.extract::<String>()?, "i" | "u") && !is_empty {
            return Err(refused(format!("has numbers of type {kind}")));
        }
        let array = array.call_method1("astype", ("int64",))?;
        let array: Bound<'_, PyArrayDyn<i64>> = array.cast_into()?;
        let shape = <[usize; N]>::try_from(array.shape());
        let shape = shape.map_err(|_| refused(format!("has the shape {:?}", array.shape())))?;
        Ok((shape, array.readonly().as_array().iter().copied().collect()))
    }

    /// True or false for each of `n`.
    pub(crate) fn flags(&self, field: &str, n: usize) -> PyResult<Vec<bool>> {
        let py = self.0.py();
        let refused =
            |problem: String| unusable(py, field, &format!("{problem}, expected [{n}] of True and False"));
        let array = py.import("numpy")?.call_method1("asarray", (&self.0,))?;
        let flags = array.cast_into::<PyArrayDyn<bool>>();
        let flags = flags.map_err(|_| refused(format!("is {}", self.shown())))?;
        if flags.shape() != [n] {
            return Err(refused(format!("has the shape {:?}", flags.shape())));
        }
        Ok(flags.readonly().as_array().iter().copied().collect())
    }

    /// The argument as text for an error.
    fn shown(&self) -> String {
        let text = self
            .0
            .repr()
            .map_or_else(|_| "not to be shown".to_owned(), |text| text.to_string());
        let text = text.split_whitespace().collect::<Vec<_>>().join(" ");
        if text.chars().count() <= SHOWN {
            return text;
        }
        text.chars().take(SHOWN).chain("...".chars()).collect()
    }
}

/// The given number of threads, or the number of cores.
pub(crate) fn threads(given: Option<Given<'_>>) -> PyResult<usize> {
    match given {
        Some(given) => given.count("n_threads", 1..=MOST_THREADS),
        None => Ok(std::thread::available_parallelism()
            .map_or(1, usize::from)
            .min(MOST_THREADS)),
    }
}

/// Checks a time between frames.
pub(crate) fn since(py: Python<'_>, since_previous_s: f64) -> PyResult<()> {
    if (0.0..=LONGEST_S).contains(&since_previous_s) {
        return Ok(());
    }
    let problem = format!("is {since_previous_s}, expected 0 to {LONGEST_S} s");
    Err(unusable(py, "since_previous_s", &problem))
}

/// Longest time between two frames, s: about 30 years.
const LONGEST_S: f64 = 1e9;
