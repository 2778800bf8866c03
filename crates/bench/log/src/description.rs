//! What a log is about.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use serde::{Deserialize, Serialize};
use serde_json::Value;
use twintac_recording::Provenance;
use twintac_shape::Pose;

use crate::LogError;

/// Version of the topics and messages in a log; readers refuse others.
const VERSION: u32 = 1;
/// Most taxels of a sensor: each has two channels of the file, which are numbered with 16 bits.
const MOST_TAXELS: usize = 10_000;
const UNIT_TOLERANCE: f64 = 1e-6;
/// Key of the checksum of the other entries: they say when and where all that follows was.
const CHECKSUM: &str = "checksum";

/// What a log is about. It stands in the file before the first message, so that a log that was cut has it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Description {
    /// Name of the sensor description.
    pub sensor: String,
    /// Text of the sensor description, whole.
    pub sensor_toml: String,
    /// Where the numbers come from.
    pub provenance: Provenance,
    /// Taxel names, in the order of every frame.
    pub taxels: Vec<String>,
    /// What the taxels' counts stand for, if they count.
    pub transfer: Option<CountTransfer>,
    /// Where the gel stands in the robot's base frame.
    pub base_from_gel: Pose,
    /// Where the indenter sits in the robot's tool frame.
    pub tool_from_indenter: Pose,
    /// Direction in the force/torque sensor's frame such that `force · axis` is the force of the indenter on the gel along -z: `-z` for a
    /// sensor under the gel whose z is up. A unit vector.
    pub force_axis: DVec3,
    /// When the bench's clock started: wall-clock time, ns since 1970-01-01 UTC. Times in the file are this plus the bench's clock.
    pub start_unix_ns: u64,
    /// Versions of what recorded: programs, firmware.
    pub versions: BTreeMap<String, String>,
}

/// What counts stand for: `pressure_pa = pa_per_count · counts + offset_pa`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct CountTransfer {
    /// Pascal per count.
    pub pa_per_count: f64,
    /// Pressure at 0 counts, Pa.
    pub offset_pa: f64,
    /// Whether the counter's bits are two's complement.
    pub signed: bool,
    /// Whether somebody who knows the parts confirmed it.
    pub is_confirmed: bool,
}

impl Description {
    /// Checks that names are there and unique, numbers finite, rotations unit quaternions, and the force's axis a unit vector.
    ///
    /// # Errors
    /// [`LogError::Invalid`] for the first that does not hold.
    pub fn check(&self) -> Result<(), LogError> {
        let expect = |holds: bool, what, problem: &str| {
            let problem = problem.to_owned();
            holds.then_some(()).ok_or(LogError::Invalid { what, problem })
        };
        let names: BTreeSet<&String> = self.taxels.iter().filter(|name| !name.is_empty()).collect();
        let are_unique = names.len() == self.taxels.len();
        expect(are_unique, "taxels", "a name is empty or there twice")?;
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
            expect(is_unit, what, "the rotation is no unit quaternion")?;
        }
        let is_unit = (self.force_axis.length() - 1.0).abs() <= UNIT_TOLERANCE;
        expect(is_unit, "force_axis", "expected a unit vector")
    }

    /// Field by field, each value as JSON.
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

    /// What is wrong comes back as a text.
    pub(crate) fn from_map(map: &BTreeMap<String, String>) -> Result<Self, String> {
        let version = map.get("log_version").map_or("none", String::as_str);
        if version != VERSION.to_string() {
            return Err(format!("its log version is {version}, expected {VERSION}"));
        }
        // Older logs have none.
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

/// CRC-32 of all entries but the checksum itself.
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
