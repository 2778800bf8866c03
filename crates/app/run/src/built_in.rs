//! Files that the program carries with it, which stand for those that are not named.

use std::path::Path;

use anyhow::{Context, Result};

/// A file of the repository.
#[derive(Clone, Copy, Debug)]
pub struct BuiltIn {
    pub name: &'static str,
    pub text: &'static str,
}

pub const PHYSTAC: BuiltIn = BuiltIn {
    name: "sensors/phystac.toml",
    text: include_str!("../../../../sensors/phystac.toml"),
};

pub const DEMO_PROTOCOL: BuiltIn = BuiltIn {
    name: "protocols/demo.toml",
    text: include_str!("../../../../protocols/demo.toml"),
};

pub const REALITY: BuiltIn = BuiltIn {
    name: "realities/default.toml",
    text: include_str!("../../../../realities/default.toml"),
};

/// How the emulated bench presses.
pub const LAB_BENCH: BuiltIn = BuiltIn {
    name: "rigs/lab.toml",
    text: include_str!("../../../../rigs/lab.toml"),
};

impl BuiltIn {
    /// Name and text of a file, or without one of this.
    pub fn unless(self, file: Option<&Path>) -> Result<(String, String)> {
        let Some(file) = file else {
            return Ok((self.name.to_owned(), self.text.to_owned()));
        };
        let text = std::fs::read_to_string(file).with_context(|| format!("reading {}", file.display()))?;
        Ok((file.display().to_string(), text))
    }
}
