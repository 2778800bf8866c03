//! Files that are compiled into this crate. They are used if no file is named.

use std::path::Path;

use twintac_lab::EmulatorConfiguration;
use twintac_work::{WorkError, read_text};

/// A file that people can copy and edit, as it was when this crate was compiled.
#[derive(Clone, Copy, Debug)]
pub struct BuiltIn {
    /// Its name, for error messages.
    pub name: &'static str,
    /// Its text.
    pub text: &'static str,
}

/// The protocol of the demo.
pub const DEMO_PROTOCOL: BuiltIn = BuiltIn {
    name: "protocols/demo.toml",
    text: include_str!("../built_in/demo.toml"),
};

/// The protocol of the paper's data.
pub const PAPER_PROTOCOL: BuiltIn = BuiltIn {
    name: "protocols/paper.toml",
    text: include_str!("../built_in/paper.toml"),
};

/// The protocol of the presses that the gel's material is fitted to.
pub const MATERIAL_PROTOCOL: BuiltIn = BuiltIn {
    name: "protocols/material.toml",
    text: include_str!("../built_in/material.toml"),
};

/// The protocol of the trials from which shapes are classified.
pub const SHAPES_PROTOCOL: BuiltIn = BuiltIn {
    name: "protocols/shapes.toml",
    text: include_str!("../built_in/shapes.toml"),
};

/// The protocol of the paper's pressure maps.
pub const MAPS_PROTOCOL: BuiltIn = BuiltIn {
    name: "protocols/maps.toml",
    text: include_str!("../built_in/maps.toml"),
};

/// The protocol for the characterization of a sensor.
pub const CHARACTERIZE_PROTOCOL: BuiltIn = BuiltIn {
    name: "protocols/characterize.toml",
    text: include_str!("../built_in/characterize.toml"),
};

/// The default emulator configuration.
pub(crate) const EMULATOR: BuiltIn = BuiltIn {
    name: "emulators/default.toml",
    text: include_str!("../built_in/default.toml"),
};

/// The built-in emulator configurations, found by the names of their files.
const EMULATORS: [BuiltIn; 3] = [
    EMULATOR,
    BuiltIn {
        name: "emulators/harder.toml",
        text: include_str!("../built_in/harder.toml"),
    },
    BuiltIn {
        name: "emulators/thicker.toml",
        text: include_str!("../built_in/thicker.toml"),
    },
];

/// The hardware configuration of the emulated bench.
pub const LAB_RIG: BuiltIn = BuiltIn {
    name: "rigs/lab.toml",
    text: include_str!("../built_in/lab.toml"),
};

impl BuiltIn {
    /// Name and text of a file, or of this built-in file if none is named.
    ///
    /// # Errors
    /// A file that cannot be read.
    pub fn unless(self, file: Option<&Path>) -> Result<(String, String), WorkError> {
        match file {
            None => Ok((self.name.to_owned(), self.text.to_owned())),
            Some(file) => Ok((file.display().to_string(), read_text(file)?)),
        }
    }
}

/// The emulator configuration by the name of a built-in one, such as `harder`, or from a file. The
/// default is [`EMULATOR`].
///
/// # Errors
/// A file that cannot be read or is wrong; a name that is not built in.
pub fn emulator(named: Option<&Path>) -> Result<EmulatorConfiguration, WorkError> {
    let stem = |built_in: &BuiltIn| Path::new(built_in.name).file_stem().map(Path::new);
    let known = EMULATORS
        .into_iter()
        .find(|built_in| named.is_none_or(|name| stem(built_in) == Some(name)));
    let (name, text) = match (known, named) {
        (Some(built_in), _) => (built_in.name.to_owned(), built_in.text.to_owned()),
        (None, Some(file)) if file.extension().is_none() && !file.exists() => {
            let names: Vec<String> = EMULATORS
                .iter()
                .filter_map(|built_in| Some(stem(built_in)?.display().to_string()))
                .collect();
            return Err(WorkError::Input(format!(
                "there is no emulator configuration `{}`, neither as a file nor built in; built in are {}",
                file.display(),
                names.join(", ")
            )));
        }
        (None, _) => EMULATOR.unless(named)?,
    };
    Ok(EmulatorConfiguration::parse(&name, &text)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The copies in this package are symbolic links to the files that people edit. Where links are
    /// not kept, the copies must be equal.
    #[test]
    fn what_is_built_in_is_what_people_edit() {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..");
        let others = [
            DEMO_PROTOCOL,
            PAPER_PROTOCOL,
            SHAPES_PROTOCOL,
            MATERIAL_PROTOCOL,
            MAPS_PROTOCOL,
            CHARACTERIZE_PROTOCOL,
            LAB_RIG,
        ];
        for built_in in EMULATORS.into_iter().chain(others) {
            let edited = std::fs::read_to_string(root.join(built_in.name)).unwrap();
            assert_eq!(built_in.text, edited, "{}", built_in.name);
        }
    }
    #[test]
    fn an_emulator_has_a_name_or_a_file() {
        let plain = emulator(None).unwrap();
        assert_eq!(emulator(Some(Path::new("default"))).unwrap(), plain);
        let harder = emulator(Some(Path::new("harder"))).unwrap();
        assert!(harder.gel.friction > 0.0 && harder.mounting.tilt_rad != [0.0; 2]);
        let thicker = emulator(Some(Path::new("thicker"))).unwrap();
        assert!((thicker.gel.height_ratio - 1.2).abs() < 1e-12);
        assert!((thicker.gel.yeoh_kpa[0] / plain.gel.yeoh_kpa[0] - 1.2).abs() < 1e-12);
        let error = emulator(Some(Path::new("easier"))).unwrap_err().to_string();
        assert!(
            error.contains("easier") && error.contains("default, harder, thicker"),
            "{error}"
        );
        assert!(emulator(Some(Path::new("nowhere/easier.toml"))).is_err());
    }
}
