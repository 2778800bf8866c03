//! Checks that all shards of a data set are complete, and merges them into one file.

use std::fs;
use std::path::{Path, PathBuf};

use serde::Serialize;
use twintac_recording::{Provenance, Recording, RecordingWriter};
use twintac_store::read_json;
use twintac_work::{Progress, Work, WorkError, sha256_of_file};

use crate::folder::{AT_WORK, DATASET, LeftOut, Manifest, files, shards};
use crate::shard::Shard;

/// Most missing shards that an error names.
const NAMED: usize = 10;

/// A complete data set.
#[derive(Clone, Debug, Serialize)]
pub struct WholeDataset {
    /// Always [`Provenance::Simulated`].
    pub provenance: Provenance,
    /// SHA-256 of `dataset.toml`.
    pub dataset_sha256: String,
    /// Number of shards.
    pub n_shards: u32,
    /// Number of presses.
    pub n_presses: usize,
    /// Number of frames.
    pub rows: u64,
    /// Presses that could not be simulated.
    pub left_out: Vec<LeftOut>,
    /// The merged file, if there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub merged: Option<PathBuf>,
}

/// Checks that all shards of a folder are complete and unchanged.
///
/// # Errors
/// A folder without a data set; a shard that is missing, was altered, or belongs to another data
/// set or division.
pub fn check_dataset(folder: &Path, progress: &dyn Progress) -> Result<WholeDataset, WorkError> {
    let dataset = folder.join(DATASET);
    if !dataset.exists() {
        return Err(WorkError::Input(format!(
            "{} is not a data set: it has no {DATASET}",
            folder.display()
        )));
    }
    let dataset_sha256 = sha256_of_file(&dataset)?;
    let found = shards(folder)?;
    let of = found.first().map_or(0, |first| first.of());
    if let Some(other) = found.iter().find(|other| other.of() != of) {
        return Err(WorkError::Input(format!(
            "{} has shards of two divisions, {} and {}: keep those of one",
            folder.display(),
            found[0],
            other
        )));
    }
    let has = |number: u32| found.iter().any(|shard| shard.number() == number);
    let missing: Vec<u32> = (1..=of).filter(|number| !has(*number)).collect();
    if found.is_empty() || !missing.is_empty() {
        return Err(WorkError::Input(missing_text(folder, of, &missing)));
    }
    let mut whole = WholeDataset {
        provenance: Provenance::Simulated,
        dataset_sha256,
        n_shards: of,
        n_presses: 0,
        rows: 0,
        left_out: Vec::new(),
        merged: None,
    };
    let work = Work::start(progress, "checking", found.len());
    for shard in found {
        work.go_on()?;
        let manifest = check_shard(folder, shard, &whole.dataset_sha256)?;
        whole.n_presses += manifest.presses.len();
        whole.rows += manifest.rows;
        whole.left_out.extend(manifest.left_out);
        work.step("");
    }
    Ok(whole)
}

fn missing_text(folder: &Path, of: u32, missing: &[u32]) -> String {
    let folder = folder.display();
    if of == 0 {
        return format!("{folder} has no shard yet: make them with `twintac dataset --shard 1/N` and so on");
    }
    let named: Vec<String> = missing
        .iter()
        .take(NAMED)
        .map(|number| format!("{number}/{of}"))
        .collect();
    let more = if missing.len() > NAMED { " and more" } else { "" };
    format!(
        "{folder} lacks {} of {of} shards: {}{more}; make them with `twintac dataset --shard {}`",
        missing.len(),
        named.join(", "),
        named[0]
    )
}

fn check_shard(folder: &Path, shard: Shard, dataset_sha256: &str) -> Result<Manifest, WorkError> {
    let (parquet, manifest_file) = files(folder, shard);
    let again = |problem: &str, file: &Path| {
        WorkError::Input(format!(
            "{}: {problem}; make the shard again with `twintac dataset --shard {shard}`",
            file.display()
        ))
    };
    let manifest: Manifest =
        read_json(&manifest_file).map_err(|_| again("is not a complete manifest", &manifest_file))?;
    if manifest.dataset_sha256 != dataset_sha256 {
        return Err(again("is of a data set of other settings", &manifest_file));
    }
    if (manifest.shard, manifest.of) != (shard.number(), shard.of()) {
        return Err(again("is the manifest of another shard", &manifest_file));
    }
    if !parquet.exists() {
        return Err(again("is missing", &parquet));
    }
    if sha256_of_file(&parquet)? != manifest.parquet_sha256 {
        return Err(again(
            "is not what its manifest says: it was altered or truncated",
            &parquet,
        ));
    }
    Ok(manifest)
}

/// Checks all shards and writes them as one file, in the order of the data set: `presses.parquet`
/// in its folder, or `file`. The bytes are the same for every division into shards.
///
/// # Errors
/// Those of [`check_dataset`]; a file that cannot be written.
pub fn merge_dataset(
    folder: &Path,
    file: Option<&Path>,
    progress: &dyn Progress,
) -> Result<WholeDataset, WorkError> {
    let mut whole = check_dataset(folder, progress)?;
    let path = file.map_or_else(|| folder.join("presses.parquet"), Path::to_owned);
    let work = Work::start(progress, "merging", whole.n_shards as usize);
    let mut writer: Option<RecordingWriter> = None;
    for shard in shards(folder)? {
        work.go_on()?;
        let (parquet, manifest) = files(folder, shard);
        if read_json::<Manifest>(&manifest)?.presses.is_empty() {
            work.step("");
            continue;
        }
        let part = Recording::read_parquet(&parquet)?;
        let into = match &mut writer {
            Some(writer) => writer,
            None => writer.insert(RecordingWriter::create(
                &path,
                &part.sensor,
                part.provenance,
                &part.taxels,
            )?),
        };
        for press in part.presses {
            into.push(press)?;
        }
        work.step("");
    }
    drop(work);
    let writer = writer.ok_or_else(|| {
        let folder = folder.display();
        WorkError::Input(format!("no press of the data set in {folder} could be simulated"))
    })?;
    writer.finish()?;
    clear(folder)?;
    whole.merged = Some(path);
    Ok(whole)
}

/// Removes temporary folders that killed programs left. When all shards are complete, no program
/// works in them.
fn clear(folder: &Path) -> Result<(), WorkError> {
    for entry in fs::read_dir(folder).map_err(WorkError::file("reading", folder))? {
        let entry = entry.map_err(WorkError::file("reading", folder))?;
        if entry.file_name().to_string_lossy().starts_with(AT_WORK) {
            fs::remove_dir_all(entry.path()).map_err(WorkError::file("removing", &entry.path()))?;
        }
    }
    Ok(())
}
