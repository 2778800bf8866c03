//! Touches of many sensors, as arrays.

use pyo3::prelude::*;
use twintac::{Touch, TouchId};

use crate::error::unusable;
use crate::given::Given;
use crate::pose::poses;
use crate::shape::Body;

/// The touches of many sensors.
pub(crate) struct Touches {
    pub(crate) touches: Vec<Touch>,
    /// The end of each sensor's touches in the list; `[n_sensors]`.
    pub(crate) ends: Vec<usize>,
}

impl Touches {
    /// - `gel_from_body`: `[n_touches, 7]`, position in mm and quaternion `(x, y, z, w)`; or
    ///   `[n_touches, 3]`, positions of bodies without rotation.
    /// - `body`: indices of the bodies, `[n_touches]`; default: the first body.
    /// - `ends`: the end of each sensor's touches in the list, `[n_sensors]`; default: one touch
    ///   for each sensor.
    pub(crate) fn checked(
        py: Python<'_>,
        gel_from_body: &Given<'_>,
        body: Option<&Given<'_>>,
        ends: Option<&Given<'_>>,
        n_bodies: usize,
    ) -> PyResult<Self> {
        let poses = poses(py, "gel_from_body", gel_from_body)?;
        let n_touches = poses.len();
        let body = match body {
            None => vec![0; n_touches],
            Some(body) => body.integers::<1>("body", "[n_touches]")?.1,
        };
        if body.len() != n_touches {
            let problem = format!(
                "has {} numbers, expected one for each of {n_touches} touches",
                body.len()
            );
            return Err(unusable(py, "body", &problem));
        }
        let touches = poses.into_iter().zip(body).map(|(gel_from_body, body)| {
            let number = u32::try_from(body)
                .ok()
                .filter(|number| (*number as usize) < n_bodies);
            let number = number.ok_or_else(|| {
                unusable(py, "body", &format!("has {body}, expected 0 to {}", n_bodies - 1))
            })?;
            PyResult::Ok(Touch {
                body: number,
                gel_from_body,
            })
        });
        Ok(Self {
            touches: touches.collect::<PyResult<_>>()?,
            ends: match ends {
                Some(ends) => checked_ends(py, &ends.integers::<1>("ends", "[n_sensors]")?.1, n_touches)?,
                None => (1..=n_touches).collect(),
            },
        })
    }
}

/// The identity of each touch, from integers of any type and sign.
pub(crate) fn touch_ids(py: Python<'_>, ids: &Given<'_>, n_touches: usize) -> PyResult<Vec<TouchId>> {
    let ids = ids.integers::<1>("touch_id", "[n_touches]")?.1;
    if ids.len() != n_touches {
        let problem = format!(
            "has {} numbers, expected one for each of {n_touches} touches",
            ids.len()
        );
        return Err(unusable(py, "touch_id", &problem));
    }
    Ok(ids.into_iter().map(|id| TouchId(id.cast_unsigned())).collect())
}

fn checked_ends(py: Python<'_>, ends: &[i64], n_touches: usize) -> PyResult<Vec<usize>> {
    let numbers: Option<Vec<usize>> = ends.iter().map(|end| usize::try_from(*end).ok()).collect();
    let numbers =
        numbers.filter(|numbers| numbers.is_sorted() && numbers.last().copied().unwrap_or(0) == n_touches);
    numbers.ok_or_else(|| {
        let problem = format!("has to grow from 0 or more to the number of touches, {n_touches}");
        unusable(py, "ends", &problem)
    })
}

/// The library's bodies; at least one.
pub(crate) fn bodies(py: Python<'_>, bodies: Vec<Body>) -> PyResult<Vec<twintac::Body>> {
    if bodies.is_empty() {
        return Err(unusable(py, "bodies", "has none, expected at least one"));
    }
    Ok(bodies.into_iter().map(|body| (*body.body).clone()).collect())
}
