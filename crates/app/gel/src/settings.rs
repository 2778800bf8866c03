//! Settings of commands that only simulate.

use std::path::Path;

use serde::{Deserialize, Serialize};
use twintac_config::{Checked, ConfigError, Ranges};
use twintac_simulate::SimulateSettings;
use twintac_work::WorkError;

/// A file of settings of the simulation alone, for commands that only simulate.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
struct SimulateFile {
    simulate: SimulateSettings,
}

impl Checked for SimulateFile {
    fn check(&self, ranges: &mut Ranges) {
        let Self { simulate } = self;
        ranges.inside("simulate", simulate);
    }
}

/// The settings of the simulation: `base`, with the values of the file's table `[simulate]` in
/// place of its own, if there is a file.
///
/// # Errors
/// A file that cannot be read or has another table, an unknown field, or a value that is not
/// allowed.
pub fn simulate_settings(base: SimulateSettings, path: Option<&Path>) -> Result<SimulateSettings, WorkError> {
    let Some(path) = path else {
        return Ok(base);
    };
    let read = twintac_config::read_over(path, &SimulateFile { simulate: base });
    let file = read.map_err(|error| {
        let tables = ["fast_gel", "places", "bench", "split", "pair", "train"];
        if tables.contains(&&error.field[..]) {
            return ConfigError {
                problem: "is not used by this command, which simulates and does nothing else".to_owned(),
                hint: "keep the table [simulate] alone".to_owned(),
                ..error
            };
        }
        error
    })?;
    Ok(file.checked()?.simulate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_that_only_simulates_takes_no_other_table() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("settings.toml");
        std::fs::write(&path, "[simulate]\nmax_nodes = 900\n").unwrap();
        let read = || simulate_settings(SimulateSettings::fine(), Some(&path));
        assert_eq!(read().unwrap().max_nodes, 900);
        assert_eq!(
            read().unwrap().edges_per_height,
            SimulateSettings::fine().edges_per_height
        );
        for text in [
            "[train]\nepochs = 3\n",
            "fast_gel = \"a\"\n",
            "[simulate]\n[bench]\n",
        ] {
            std::fs::write(&path, text).unwrap();
            let error = read().unwrap_err().to_string();
            assert!(error.contains("is not used by this command"), "{error}");
        }
        std::fs::write(&path, "[simulate]\nmax_nodes = 0\n").unwrap();
        assert!(
            read()
                .unwrap_err()
                .to_string()
                .contains("`simulate.max_nodes` is 0")
        );
    }
}
