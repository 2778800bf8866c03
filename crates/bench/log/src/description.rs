//! The description of a log.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use twintac_recording::Provenance;
use twintac_shape::Pose;

use crate::LogError;

/// Version of the topics and messages in a log. Readers refuse other versions.
const VERSION: u32 = 1;
/// Most taxels of a sensor. Each has two channels of the file, and channel numbers have 16 bits.
const MOST_TAXELS: usize = 10_000;
const UNIT_TOLERANCE: f64 = 1e-6;
/// Key of the checksum of the other entries, because these state the time and the frame of all
/// messages.
const CHECKSUM: &str = "checksum";

/// The description of a log. It is in the file before the first message, so a cut log has it too.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Description {
    /// Name of the sensor description.
    pub sensor: String,
    /// Full text of the sensor description.
    pub sensor_toml: String,
    /// Provenance of the numbers.
    pub provenance: Provenance,
    /// Taxel names, in the order of every frame.
    pub taxels: Vec<String>,
    /// The conversion from the taxels' counts to pressure, if they have counts.
    pub transfer: Option<CountTransfer>,
    /// Pose of the gel in the robot's base frame.
    pub base_from_gel: Pose,
    /// Pose of the indenter in the robot's tool frame.
    pub tool_from_indenter: Pose,
    /// Direction in the force/torque sensor's frame, a unit vector. `force · axis` is the force of
    /// the indenter on the gel along -z. For a sensor under the gel whose z axis points up, it is
    /// `-z`.
    pub force_axis: DVec3,
    /// Wall-clock time of the start of the bench clock, ns since 1970-01-01 UTC. Times in the file
    /// are the sum of this and the bench clock.
    pub start_unix_ns: u64,
    /// Versions of the programs and firmware that recorded.
    pub versions: BTreeMap<String, String>,
}

/// Conversion from counts to pressure: `pressure_pa = pa_per_count · counts + offset_pa`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CountTransfer {
    /// Pascal per count.
    pub pa_per_count: f64,
    /// Pressure at 0 counts, Pa.
    pub offset_pa: f64,
    /// Whether counts are in two's complement.
    pub signed: bool,
    /// Whether a person who knows the parts has confirmed it.
    pub is_confirmed: bool,
}

impl Description {
    /// Checks that names exist and are unique, numbers are finite, rotations are unit quaternions,
    /// and the force axis is a unit vector.
    ///
    /// # Errors
    /// [`LogError::Invalid`] for the first condition that is not met.
    pub fn check(&self) -> Result<(), LogError> {
        let expect = |holds: bool, what, problem: &str| {
            let problem = problem.to_owned();
            holds.then_some(()).ok_or(LogError::Invalid { what, problem })
        };
        let names: BTreeSet<&String> = self.taxels.iter().filter(|name| !name.is_empty()).collect();
        let are_unique = names.len() == self.taxels.len();
        expect(are_unique, "taxels", "a name is empty or given twice")?;
        expect(self.taxels.len() <= MOST_TAXELS, "taxels", "more than 10 000")?;
        if let Some(transfer) = self.transfer {
            let is_finite = transfer.pa_per_count.is_finite() && transfer.offset_pa.is_finite();
            expect(is_finite, "transfer", "a number is not finite")?;
        }
        for (what, pose) in [
            ("base_from_gel", self.base_from_gel),
            ("tool_from_indenter", self.tool_from_indenter),
        ] {
            let is_unit = (pose.rotation.length() - 1.0).abs() <= UNIT_TOLERANCE;
            expect(pose.position_mm.is_finite(), what, "a number is not finite")?;
            expect(is_unit, what, "the rotation is not a unit quaternion")?;
        }
        let is_unit = (self.force_axis.length() - 1.0).abs() <= UNIT_TOLERANCE;
        expect(is_unit, "force_axis", "expected a unit vector")
    }

    /// Each field with its value as JSON.
    pub(crate) fn to_map(&self) -> Result<BTreeMap<String, String>, LogError> {
        self.check()?;
        let invalid = |problem: String| LogError::Invalid {
            what: "description",
            problem,
        };
        let Value::Object(fields) = serde_json::to_value(self).map_err(|e| invalid(e.to_string()))? else {
            return Err(invalid("is no table".to_owned()));
        };
        let mut map: BTreeMap<String, String> = fields
            .into_iter()
            .map(|(field, value)| (field, value.to_string()))
            .collect();
        map.insert("log_version".to_owned(), VERSION.to_string());
        map.insert(CHECKSUM.to_owned(), checksum(&map).to_string());
        Ok(map)
    }

    /// The error is a text that says what is wrong.
    pub(crate) fn from_map(map: &BTreeMap<String, String>) -> Result<Self, String> {
        let version = map.get("log_version").map_or("none", String::as_str);
        if version != VERSION.to_string() {
            return Err(format!("its log version is {version}, expected {VERSION}"));
        }
        // Older logs have no checksum.
        if map
            .get(CHECKSUM)
            .is_some_and(|written| *written != checksum(map).to_string())
        {
            return Err("its description is damaged: its checksum does not match".to_owned());
        }
        let mut fields = serde_json::Map::new();
        for (field, text) in map {
            let value = serde_json::from_str(text).map_err(|e| format!("metadata `{field}`: {e}"))?;
            fields.insert(field.clone(), value);
        }
        let description: Self =
            serde_json::from_value(Value::Object(fields)).map_err(|e| format!("metadata: {e}"))?;
        description.check().map_err(|e| e.to_string())?;
        Ok(description)
    }
}

/// CRC-32 of all entries except the checksum.
fn checksum(map: &BTreeMap<String, String>) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    for (key, value) in map.iter().filter(|(key, _)| *key != CHECKSUM) {
        for text in [key, value] {
            hasher.update(text.as_bytes());
            hasher.update(&[0]);
        }
    }
    hasher.finalize()
}
