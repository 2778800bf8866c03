//! Files that are named or matched by a pattern.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use twintac_recording::Recording;
use twintac_run::import_files;
use twintac_sensor::SensorFile;
use twintac_work::Progress;

use crate::progress::Bars;

/// The files that names and patterns match, sorted; each has to match at least one. An existing
/// path is taken literally, even if it contains special characters. The folder of a ROS 2 bag
/// stands for its files.
pub(crate) fn expand(patterns: &[String]) -> Result<Vec<PathBuf>> {
    let mut files = Vec::new();
    for pattern in patterns {
        if Path::new(pattern).exists() {
            match of_bag(Path::new(pattern)) {
                none if none.is_empty() => files.push(PathBuf::from(pattern)),
                of_bag => files.extend(of_bag),
            }
            continue;
        }
        let found = glob::glob(&of_names(pattern)).with_context(|| {
            format!(
                "`{pattern}` does not exist and is not a pattern of files; in a pattern, `[[]` stands for `[`"
            )
        })?;
        let before = files.len();
        for file in found {
            files.push(file?);
        }
        if files.len() == before {
            bail!(
                "no file matches `{pattern}`; check the path, and quote patterns so that the shell leaves them alone"
            );
        }
    }
    files.sort_unstable();
    files.dedup();
    Ok(files)
}

/// The pattern, in which the leading folders that exist by name are escaped.
fn of_names(pattern: &str) -> String {
    let (mut known, mut rest) = (PathBuf::new(), Path::new(pattern).components());
    for component in Path::new(pattern).components() {
        if !known.join(component).exists() {
            break;
        }
        known.push(component);
        rest.next();
    }
    let mut escaped = glob::Pattern::escape(&known.to_string_lossy());
    if !escaped.is_empty() && !escaped.ends_with(std::path::MAIN_SEPARATOR) {
        escaped.push(std::path::MAIN_SEPARATOR);
    }
    escaped + &rest.as_path().to_string_lossy()
}

/// The files of a ROS 2 recording, if the folder is one.
fn of_bag(folder: &Path) -> Vec<PathBuf> {
    if !folder.join("metadata.yaml").is_file() {
        return Vec::new();
    }
    let files = folder.read_dir().into_iter().flatten().flatten();
    let files = files.map(|file| file.path());
    files
        .filter(|file| file.extension().is_some_and(|extension| extension == "mcap"))
        .collect()
}

/// Reads files according to an import description, and prints what was found and left out.
pub(crate) fn import_aloud(import: &Path, files: &[PathBuf]) -> Result<Recording> {
    let (recording, summary) = import_files(import, files)?;
    let bars = Bars::default();
    for file in summary.files.iter().filter(|file| file.is_notable()) {
        file.to_string().lines().for_each(|line| bars.note(line));
    }
    Ok(recording)
}

/// Sets the sensor's name in recordings that use another name for it, if that name is
/// `recorded_as`.
pub(crate) fn rename(
    recording: &mut Recording,
    recorded_as: Option<&str>,
    sensor: &SensorFile,
) -> Result<()> {
    let Some(name) = recorded_as else {
        return Ok(());
    };
    if recording.sensor != name {
        bail!(
            "--recorded-as is `{name}`, but the recordings call their sensor `{}`",
            recording.sensor
        );
    }
    recording.sensor.clone_from(&sensor.sensor.name);
    Ok(())
}

/// Reads a sensor description; without a file, that of PhysTac.
pub(crate) fn sensor_or_phystac(file: Option<&Path>) -> Result<SensorFile> {
    Ok(file.map_or_else(SensorFile::phystac, SensorFile::read)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_folder_of_a_bag_stands_for_its_files() {
        let folder = tempfile::tempdir().unwrap();
        let file = |name: &str| folder.path().join(name);
        let given = [folder.path().display().to_string()];
        assert_eq!(expand(&given).unwrap(), [folder.path()]);
        for name in ["metadata.yaml", "b_1.mcap", "b_0.mcap", "notes.txt"] {
            std::fs::write(file(name), "").unwrap();
        }
        assert_eq!(expand(&given).unwrap(), [file("b_0.mcap"), file("b_1.mcap")]);
    }

    #[test]
    fn names_stand_for_themselves_and_patterns_for_what_matches() {
        let folder = tempfile::tempdir().unwrap();
        for name in [
            "[a]/x.parquet",
            "[a]/y[1].parquet",
            "[a]/[",
            "a/x.parquet",
            "a/*.parquet",
        ] {
            let path = folder.path().join(name);
            std::fs::create_dir_all(path.parent().unwrap()).unwrap();
            std::fs::write(path, "").unwrap();
        }
        let found = |pattern: &str| -> Result<Vec<String>, String> {
            let given = folder.path().join(pattern).display().to_string();
            let files = expand(&[given]).map_err(|error| format!("{error:#}"))?;
            let name = |file: PathBuf| file.strip_prefix(folder.path()).unwrap().display().to_string();
            Ok(files.into_iter().map(name).collect())
        };
        assert_eq!(found("[a]/x.parquet").unwrap(), ["[a]/x.parquet"]);
        assert_eq!(found("[a]/y[1].parquet").unwrap(), ["[a]/y[1].parquet"]);
        assert_eq!(found("[a]/[").unwrap(), ["[a]/["]);
        assert_eq!(
            found("[a]/*.parquet").unwrap(),
            ["[a]/x.parquet", "[a]/y[1].parquet"]
        );
        assert_eq!(
            found("a/*.parquet").unwrap(),
            ["a/*.parquet"],
            "one of this name is there"
        );
        assert_eq!(found("a/*[.]parquet").unwrap(), ["a/*.parquet", "a/x.parquet"]);
        assert_eq!(found("?/x.parquet").unwrap(), ["a/x.parquet"]);
        assert!(found("a/[").unwrap_err().contains("`[[]` stands for `[`"));
        assert!(found("a/z*").unwrap_err().contains("no file matches"));
    }
}
