//! The folder of a data set: files appear in it whole or not at all, even if several programs work
//! in it.

use std::fs;
use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize};
use twintac_recording::{Provenance, Recording};
use twintac_store::{read_json, write_file, write_json};
use twintac_work::{WorkError, read_text, sha256, sha256_of_file};

use crate::shard::Shard;

/// Name of the file that identifies the data set.
pub(super) const DATASET: &str = "dataset.toml";

/// Beginning of the names of temporary folders in which shards are made.
pub(super) const AT_WORK: &str = ".shard-";

/// A press that could not be simulated.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct LeftOut {
    /// Its name.
    pub press: String,
    /// Why.
    pub why: String,
}

/// The content of a shard. Shards with the same manifest are the same byte for byte.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Manifest {
    /// Version of the program.
    pub version: String,
    /// SHA-256 of `dataset.toml`.
    pub dataset_sha256: String,
    /// Number of the shard, from 1.
    pub shard: u32,
    /// How many shards there are.
    pub of: u32,
    /// Always [`Provenance::Simulated`].
    pub provenance: Provenance,
    /// Rows of the Parquet file: the frames of all presses.
    pub rows: u64,
    /// SHA-256 of the Parquet file.
    pub parquet_sha256: String,
    /// Names of the presses, in the order of the rows.
    pub presses: Vec<String>,
    /// Presses that could not be simulated.
    pub left_out: Vec<LeftOut>,
}

/// A complete shard.
#[derive(Clone, Debug, Serialize)]
pub struct MadeShard {
    /// The Parquet file.
    pub parquet: PathBuf,
    /// The manifest's file.
    pub manifest_file: PathBuf,
    /// Whether the shard was complete before.
    pub was_kept: bool,
    /// The content of the shard.
    #[serde(flatten)]
    pub manifest: Manifest,
}

/// A folder of one data set.
pub(super) struct Folder {
    path: PathBuf,
    dataset_sha256: String,
}

impl Folder {
    /// Opens the folder of the data set with this identity. A new folder is created; a folder of
    /// another data set is an error.
    pub(super) fn open(path: &Path, identity: &str, sensor: &str, shard: Shard) -> Result<Self, WorkError> {
        fs::create_dir_all(path).map_err(WorkError::file("creating", path))?;
        let folder = Self {
            path: path.to_owned(),
            dataset_sha256: sha256(identity.as_bytes()),
        };
        let file = path.join(DATASET);
        if !file.exists() {
            let desk = folder.desk(shard)?;
            let (own, own_sensor) = (desk.path().join(DATASET), desk.path().join("sensor.toml"));
            write_file(&own, identity.as_bytes())?;
            write_file(&own_sensor, sensor.as_bytes())?;
            rename(&own_sensor, &path.join("sensor.toml"))?;
            appear(&own, &file)?;
        }
        if read_text(&file)? != identity {
            return Err(WorkError::Input(format!(
                "{} is a data set of other settings (see {DATASET} there): give another folder with --out",
                path.display()
            )));
        }
        if let Some(other) = shards(path)?.into_iter().find(|other| other.of() != shard.of()) {
            return Err(WorkError::Input(format!(
                "{} is divided into {} shards, not {}: give --shard {}/{}, or another folder with --out",
                path.display(),
                other.of(),
                shard.of(),
                shard.number().min(other.of()),
                other.of()
            )));
        }
        Ok(folder)
    }

    /// A shard that is complete and unchanged in the folder.
    pub(super) fn complete(&self, shard: Shard) -> Result<Option<MadeShard>, WorkError> {
        let (parquet, manifest_file) = files(&self.path, shard);
        let (true, Ok(manifest)) = (manifest_file.exists(), read_json::<Manifest>(&manifest_file)) else {
            return Ok(None);
        };
        let is_whole = manifest.dataset_sha256 == self.dataset_sha256
            && parquet.exists()
            && sha256_of_file(&parquet)? == manifest.parquet_sha256;
        Ok(is_whole.then_some(MadeShard {
            parquet,
            manifest_file,
            was_kept: true,
            manifest,
        }))
    }

    /// Writes a shard: the Parquet file gets its name first, and the manifest last.
    pub(super) fn put(
        &self,
        shard: Shard,
        recording: &Recording,
        left_out: Vec<LeftOut>,
    ) -> Result<MadeShard, WorkError> {
        let desk = self.desk(shard)?;
        let (own_parquet, own_manifest) = files(desk.path(), shard);
        recording.write_parquet(&own_parquet)?;
        let presses = &recording.presses;
        let manifest = Manifest {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            dataset_sha256: self.dataset_sha256.clone(),
            shard: shard.number(),
            of: shard.of(),
            provenance: recording.provenance,
            rows: presses.iter().map(|press| press.time_s.len() as u64).sum(),
            parquet_sha256: sha256_of_file(&own_parquet)?,
            presses: presses.iter().map(|press| press.name.clone()).collect(),
            left_out,
        };
        write_json(&own_manifest, &manifest)?;
        let (parquet, manifest_file) = files(&self.path, shard);
        rename(&own_parquet, &parquet)?;
        rename(&own_manifest, &manifest_file)?;
        Ok(MadeShard {
            parquet,
            manifest_file,
            was_kept: false,
            manifest,
        })
    }

    /// A temporary folder of this program. It is removed when it is dropped.
    fn desk(&self, shard: Shard) -> Result<tempfile::TempDir, WorkError> {
        let prefix = format!("{AT_WORK}{}-", shard.number());
        let desk = tempfile::Builder::new().prefix(&prefix).tempdir_in(&self.path);
        desk.map_err(WorkError::file("creating a folder in", &self.path))
    }
}

/// The paths of a shard's Parquet file and manifest.
pub(super) fn files(folder: &Path, shard: Shard) -> (PathBuf, PathBuf) {
    let stem = shard.stem();
    (
        folder.join(format!("{stem}.parquet")),
        folder.join(format!("{stem}.json")),
    )
}

/// The shards of a folder that have a manifest, in order.
pub(super) fn shards(folder: &Path) -> Result<Vec<Shard>, WorkError> {
    let entries = fs::read_dir(folder).map_err(WorkError::file("reading", folder))?;
    let mut shards = Vec::new();
    for entry in entries {
        let entry = entry.map_err(WorkError::file("reading", folder))?;
        shards.extend(Shard::of_manifest(&entry.file_name().to_string_lossy()));
    }
    shards.sort_unstable();
    Ok(shards)
}

fn rename(from: &Path, to: &Path) -> Result<(), WorkError> {
    fs::rename(from, to).map_err(WorkError::file("writing", to))
}

/// Gives a file a new name. If a file of that name exists, it stays. On file systems without hard
/// links the last file stays.
fn appear(from: &Path, to: &Path) -> Result<(), WorkError> {
    match fs::hard_link(from, to) {
        Err(error) if error.kind() != ErrorKind::AlreadyExists => rename(from, to),
        _ => Ok(()),
    }
}
