//! The inputs that a value is made from.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize};
use serde_json::Value;

use crate::{Digest, StoreError, read_json, write_json};

/// The file in which a folder says what its contents are made from.
const CLAIM: &str = "made_from.json";

/// The inputs of a kept value: the digest of each, by its name. Values with the same inputs are the
/// same.
#[derive(Clone, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub struct MadeFrom(BTreeMap<String, Digest>);

impl MadeFrom {
    /// Each field of `inputs` is an input. The program is one more, because another build may
    /// compute something else.
    ///
    /// # Errors
    /// An input cannot be written as JSON.
    pub fn of(program: &str, inputs: &impl Serialize) -> Result<Self, StoreError> {
        let mut made_from = Self::without_program(inputs)?;
        let program = Digest::of(program.as_bytes());
        made_from.0.insert("program".to_owned(), program);
        Ok(made_from)
    }

    /// Each field of `inputs` is an input; the program is not.
    ///
    /// # Errors
    /// An input cannot be written as JSON.
    pub fn without_program(inputs: &impl Serialize) -> Result<Self, StoreError> {
        let failed = |what: &str| {
            let what = what.to_owned();
            move |source| StoreError::Json { what, source }
        };
        let value = serde_json::to_value(inputs).map_err(failed("inputs"))?;
        let fields = match value {
            Value::Object(fields) => fields.into_iter().collect(),
            other => BTreeMap::from([("input".to_owned(), other)]),
        };
        let mut parts = BTreeMap::new();
        for (name, field) in fields {
            let digest = Digest::of_value(&field).map_err(failed(&name))?;
            parts.insert(name, digest);
        }
        Ok(Self(parts))
    }

    /// Reserves a folder for contents that are made from these inputs, or checks that its contents
    /// are. The inputs are written to `made_from.json` in the folder.
    ///
    /// # Errors
    /// [`StoreError::OtherContents`] names the inputs that differ; or the folder cannot be read or
    /// written.
    pub fn claim(&self, folder: &Path) -> Result<(), StoreError> {
        self.check(folder)?;
        let path = folder.join(CLAIM);
        if path.exists() {
            return Ok(());
        }
        write_json(&path, self)
    }

    /// Checks that the contents of a folder are made from these inputs, if the folder has a
    /// `made_from.json`.
    ///
    /// # Errors
    /// Those of [`claim`](Self::claim).
    pub fn check(&self, folder: &Path) -> Result<(), StoreError> {
        let path = folder.join(CLAIM);
        if !path.exists() {
            return Ok(());
        }
        let there: Self = read_json(&path)?;
        let differences = self.differences(&there);
        if differences.is_empty() {
            return Ok(());
        }
        Err(StoreError::OtherContents {
            folder: folder.to_owned(),
            differences: differences.join(", "),
        })
    }

    /// One digest of all inputs.
    #[must_use]
    pub fn digest(&self) -> Digest {
        let lines = self.0.iter().map(|(name, digest)| format!("{name} {digest}\n"));
        Digest::of(lines.collect::<String>().as_bytes())
    }

    /// The digest of one input.
    #[must_use]
    pub fn part(&self, name: &str) -> Option<Digest> {
        self.0.get(name).copied()
    }

    /// Names of the inputs that differ, in alphabetical order.
    #[must_use]
    pub fn differences(&self, other: &Self) -> Vec<String> {
        let names = self.0.keys().chain(other.0.keys());
        let mut names: Vec<String> = names
            .filter(|name| self.part(name) != other.part(name))
            .cloned()
            .collect();
        names.sort_unstable();
        names.dedup();
        names
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed
    use super::*;

    #[derive(Clone, Serialize)]
    struct Inputs {
        depth_mm: f64,
        shape: &'static str,
    }

    #[test]
    fn every_field_and_the_program_count() {
        let inputs = Inputs {
            depth_mm: 1.0,
            shape: "ball",
        };
        let one = MadeFrom::of("a", &inputs).unwrap();
        assert!(one.differences(&MadeFrom::of("a", &inputs).unwrap()).is_empty());
        assert_eq!(one.differences(&MadeFrom::of("b", &inputs).unwrap()), ["program"]);
        let deeper = Inputs {
            depth_mm: 1.0 + f64::EPSILON,
            ..inputs.clone()
        };
        let deeper = MadeFrom::of("a", &deeper).unwrap();
        assert_eq!(one.differences(&deeper), ["depth_mm"]);
        assert_ne!(one.digest(), deeper.digest());
        let folder = tempfile::tempdir().unwrap();
        one.claim(folder.path()).unwrap();
        one.claim(folder.path()).unwrap();
        let refused = deeper.claim(folder.path()).unwrap_err().to_string();
        assert!(refused.contains("another depth_mm"), "{refused}");
        let other = MadeFrom::of("a", &7).unwrap();
        assert_eq!(one.differences(&other), ["depth_mm", "input", "shape"]);
    }
}
