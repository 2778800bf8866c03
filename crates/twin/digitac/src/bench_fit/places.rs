//! The distinct locations of a recording, so that each is simulated once.

use glam::{DQuat, DVec2};
use twintac_config::{Checked, Ranges};
use twintac_depth_table::{DepthTableRequest, DepthTableSource};
use twintac_recording::{Control, Press, Recording};
use twintac_shape::Pose;

use super::BenchEstimate;
use crate::DigitacError;

/// Locations closer than this count as one, mm.
const SAME_PLACE_MM: f64 = 0.01;
/// Rotations closer than this count as one, radians.
const SAME_TURN_RAD: f64 = 0.001;
/// Ratio of simulated to pressed force.
const FORCE_MARGIN: f64 = 1.1;

/// The depths to which locations are simulated.
#[derive(Clone, Copy, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PlaceSettings {
    /// Simulated minus pressed depth, mm: a margin for corrections of the contact height. Presses
    /// near the base of a gel cost the most.
    pub margin_mm: f64,
    /// Largest simulated depth where the force was prescribed instead of the pose, mm.
    pub force_control_depth_mm: f64,
}

impl Default for PlaceSettings {
    fn default() -> Self {
        Self {
            margin_mm: 0.15,
            force_control_depth_mm: 3.0,
        }
    }
}

impl Checked for PlaceSettings {
    fn check(&self, ranges: &mut Ranges) {
        let Self {
            margin_mm,
            force_control_depth_mm,
        } = self;
        ranges.number("margin_mm", *margin_mm, 0.01..=5.0);
        ranges.number("force_control_depth_mm", *force_control_depth_mm, 0.1..=50.0);
    }
}

/// The distinct locations of a recording.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Places {
    /// The tables to simulate, in the order in which the recording reaches their locations.
    pub requests: Vec<DepthTableRequest>,
    /// For each press of the recording, the index of its location in `requests`; `[n_presses]`.
    pub of_press: Vec<usize>,
}

impl Places {
    /// Collects the locations. Presses at one location share a request that reaches the deepest of
    /// them.
    pub fn of(
        recording: &Recording,
        source: &dyn DepthTableSource,
        settings: &PlaceSettings,
    ) -> Result<Self, DigitacError> {
        let mut index_of_key = std::collections::BTreeMap::new();
        let mut places = Self {
            requests: Vec::new(),
            of_press: Vec::with_capacity(recording.presses.len()),
        };
        for press in &recording.presses {
            let deepest = deepest_pose(press)?;
            let next = places.requests.len();
            let index = *index_of_key.entry(key(&press.indenter, &deepest)).or_insert(next);
            if index == next {
                let touch = source
                    .touch(&press.indenter, &deepest)
                    .map_err(DigitacError::Simulation)?;
                places.requests.push(DepthTableRequest {
                    indenter: press.indenter.clone(),
                    gel_from_indenter_at_touch: touch,
                    max_depth_mm: 0.0,
                    enough_force_n: None,
                    tip_radius_mm: None,
                });
            }
            let request = &mut places.requests[index];
            let touch_z_mm = request.gel_from_indenter_at_touch.position_mm.z;
            let depth_mm = match press.control {
                Control::Pose => (touch_z_mm - deepest.position_mm.z).max(0.0) + settings.margin_mm,
                Control::Force => settings.force_control_depth_mm,
            };
            request.max_depth_mm = request.max_depth_mm.max(depth_mm);
            if press.control == Control::Force {
                let pressed_n = press.force_n.iter().flatten().copied().fold(0.0, f64::max);
                request.enough_force_n = Some(pressed_n.max(request.enough_force_n.unwrap_or(0.0)));
            }
            places.of_press.push(index);
        }
        Ok(places)
    }

    /// The same requests for a gel that is `stiffness` times as stiff as the simulated one, which
    /// has to be pressed with more or less force to reach the same depth.
    #[must_use]
    pub(crate) fn with_stiffness(mut self, stiffness: f64) -> Self {
        for request in &mut self.requests {
            request.enough_force_n = request.enough_force_n.map(|force_n| force_n / stiffness);
        }
        self
    }

    /// The same requests for an estimated test setup, with a small margin.
    #[must_use]
    pub fn at_bench(self, bench: &BenchEstimate) -> Self {
        self.with_tip_radius(bench.tip_radius_mm.map(|radius| radius.value))
            .with_stiffness(bench.stiffness() / FORCE_MARGIN)
    }

    /// The same requests with a tip of another radius.
    #[must_use]
    pub(crate) fn with_tip_radius(mut self, tip_radius_mm: Option<f64>) -> Self {
        for request in &mut self.requests {
            request.tip_radius_mm = tip_radius_mm;
        }
        self
    }
}

/// Number of distinct locations of a recording.
pub(crate) fn n_places(recording: &Recording) -> Result<usize, DigitacError> {
    let keys = recording
        .presses
        .iter()
        .map(|press| Ok(key(&press.indenter, &deepest_pose(press)?)));
    Ok(keys
        .collect::<Result<std::collections::BTreeSet<_>, DigitacError>>()?
        .len())
}

/// The lowest pose of the indenter. Its location in the gel's plane represents the press.
pub(crate) fn deepest_pose(press: &Press) -> Result<Pose, DigitacError> {
    let lowest = press
        .gel_from_indenter
        .iter()
        .min_by(|a, b| a.position_mm.z.total_cmp(&b.position_mm.z));
    lowest
        .copied()
        .ok_or_else(|| DigitacError::press(&press.name, "has no frames"))
}

type Key = (String, [i64; 2], [i64; 4]);

fn key(indenter: &str, pose: &Pose) -> Key {
    let DVec2 { x, y } = pose.position_mm.truncate();
    let turn: DQuat = if pose.rotation.w < 0.0 {
        -pose.rotation
    } else {
        pose.rotation
    };
    let cell = |value: f64, size: f64| (value / size).round() as i64;
    let place = [cell(x, SAME_PLACE_MM), cell(y, SAME_PLACE_MM)];
    (
        indenter.to_owned(),
        place,
        turn.to_array().map(|part| cell(part, SAME_TURN_RAD)),
    )
}
