//! A model's folder: `weights.safetensors`, `twin.json`, `CARD.md` for readers, the surfaces (STL)
//! that the sensor description names, and `checksums.json` with the SHA-256 of all files.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use safetensors::tensor::{Dtype, SafeTensors, TensorView};
use serde::{Deserialize, Serialize};
use sha2::{Digest, Sha256};
use twintac_config::Checked;
use twintac_store::{PartialFolder, write_file};

use super::card::card;
use super::{Model, ModelRecord};
use crate::network::{Parameters, Physics, Weights};
use crate::{DigitacError, Twin};

const WEIGHTS: &str = "weights.safetensors";
const RECORD: &str = "twin.json";
const CARD: &str = "CARD.md";
const CHECKSUMS: &str = "checksums.json";
/// Prefix of the file names of surfaces (STL) that the sensor description names.
const SURFACES: &str = "surfaces/";
/// Version of the folder's layout.
const VERSION: u32 = 1;

#[derive(Serialize, Deserialize)]
struct Checksums {
    format: String,
    version: u32,
    /// SHA-256 as hexadecimal digits, by file name.
    sha256: BTreeMap<String, String>,
}

impl Model {
    /// Writes the model's folder, first under a temporary name. An existing folder of that name is
    /// replaced.
    pub fn save(&self, folder: &Path) -> Result<(), DigitacError> {
        let partial = PartialFolder::create(folder)?;
        let mut checksums = Checksums {
            format: "twintac-twin".into(),
            version: VERSION,
            sha256: BTreeMap::new(),
        };
        let (weights, record) = (
            pack(&self.twin.parameters().weights(), folder)?,
            json(&self.record, folder)?,
        );
        let card = card(self).into_bytes();
        let contents = [(WEIGHTS, &weights[..]), (RECORD, &record), (CARD, &card)];
        let surfaces = self
            .surfaces
            .iter()
            .map(|(name, bytes)| (name.as_str(), &**bytes));
        for (name, bytes) in contents.into_iter().chain(surfaces) {
            checksums.sha256.insert(name.to_owned(), sha256(bytes));
            write_file(&partial.path().join(name), bytes)?;
        }
        write_file(&partial.path().join(CHECKSUMS), &json(&checksums, folder)?)?;
        Ok(partial.finish()?)
    }

    /// Reads a model's folder.
    ///
    /// # Errors
    /// A file that is missing, altered, or of another version; numbers outside their ranges, and
    /// lists whose lengths do not match the taxels. The error names the file and the field.
    pub fn load(folder: &Path) -> Result<Self, DigitacError> {
        let path = folder.join(CHECKSUMS);
        let damaged =
            |path: &Path, error: &dyn std::fmt::Display| DigitacError::model(path, error.to_string());
        let checksums: Checksums = serde_json::from_slice(&read(&path)?).map_err(|e| damaged(&path, &e))?;
        if checksums.format != "twintac-twin" || checksums.version != VERSION {
            let found = format!("`{}` version {}", checksums.format, checksums.version);
            return Err(DigitacError::model(
                &path,
                format!("expected `twintac-twin` version {VERSION}, found {found}"),
            ));
        }
        let checked = |name: &str| -> Result<Vec<u8>, DigitacError> {
            let path = folder.join(name);
            let bytes = read(&path)?;
            match checksums.sha256.get(name) {
                Some(expected) if *expected == sha256(&bytes) => Ok(bytes),
                Some(_) => Err(DigitacError::model(
                    &path,
                    "its SHA-256 is not the one in checksums.json",
                )),
                None => Err(DigitacError::model(&path, "checksums.json does not list it")),
            }
        };
        let path = folder.join(RECORD);
        let record: ModelRecord =
            serde_json::from_slice(&checked(RECORD)?).map_err(|e| damaged(&path, &e))?;
        record.checked().map_err(|problem| damaged(&path, &problem))?;
        let path = folder.join(WEIGHTS);
        let weights = unpack(&checked(WEIGHTS)?).map_err(|problem| DigitacError::model(&path, problem))?;
        let start = &record.start;
        let physics = Physics {
            variant: record.variant,
            gains: start.gains.clone(),
            normalization: start.normalization.clone(),
            correction_limit: start.correction_limit,
        };
        let parameters = Parameters::with_weights(&physics, &start.hidden, &weights)
            .map_err(|problem| damaged(&path, &problem))?;
        let twin = Twin::new(record.taxels.clone(), physics, parameters);
        let surfaces = checksums.sha256.keys().filter(|name| name.starts_with(SURFACES));
        let surfaces = surfaces.map(|name| Ok((name.clone(), checked(name)?.into())));
        Ok(Self {
            surfaces: surfaces.collect::<Result<_, DigitacError>>()?,
            record,
            twin,
        })
    }
}

fn pack(weights: &Weights, folder: &Path) -> Result<Vec<u8>, DigitacError> {
    let bytes: Vec<(&String, &Vec<usize>, Vec<u8>)> = weights
        .iter()
        .map(|(name, (shape, data))| {
            (
                name,
                shape,
                data.iter().flat_map(|number| number.to_le_bytes()).collect(),
            )
        })
        .collect();
    let views: Result<Vec<(&String, TensorView<'_>)>, _> = bytes
        .iter()
        .map(|(name, shape, data)| Ok((*name, TensorView::new(Dtype::F32, (*shape).clone(), data)?)))
        .collect();
    views
        .and_then(|views| safetensors::serialize(views, None))
        .map_err(|error| DigitacError::model(folder, format!("its weights cannot be written: {error}")))
}

fn unpack(bytes: &[u8]) -> Result<Weights, String> {
    let tensors = SafeTensors::deserialize(bytes).map_err(|error| error.to_string())?;
    let mut weights = Weights::new();
    for (name, view) in tensors.tensors() {
        if view.dtype() != Dtype::F32 {
            return Err(format!("`{name}` holds {:?}, expected F32", view.dtype()));
        }
        let numbers = view
            .data()
            .chunks_exact(4)
            .map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]]))
            .collect();
        weights.insert(name, (view.shape().to_vec(), numbers));
    }
    Ok(weights)
}

fn json(value: &impl Serialize, folder: &Path) -> Result<Vec<u8>, DigitacError> {
    let mut bytes = serde_json::to_vec_pretty(value)
        .map_err(|error| DigitacError::model(folder, format!("its record cannot be written: {error}")))?;
    bytes.push(b'\n');
    Ok(bytes)
}

fn read(path: &Path) -> Result<Vec<u8>, DigitacError> {
    fs::read(path).map_err(|source| match source.kind() {
        std::io::ErrorKind::NotFound => DigitacError::model(path, "the file is missing"),
        _ => DigitacError::file(path, source),
    })
}

fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes)
        .iter()
        .map(|byte| format!("{byte:02x}"))
        .collect()
}
