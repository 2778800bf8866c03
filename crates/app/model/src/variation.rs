//! Estimates the sensor variation of a kind of sensors from what was measured on one of them: a
//! file for [`SensorVariation`].
//!
//! A trained model shows how its taxels and mountings differ; recordings show the errors of the
//! read-out. What neither shows is left out, with the reason: nothing is guessed. For every width
//! the file says its source and the number of values.

use std::path::Path;

use digitac::Model;
use twintac_recorded::Recorded;
use twintac_sensor::SensorFile;
use twintac_sensors::SensorVariation;
use twintac_store::write_file;
use twintac_variation::of_model::Casting;
use twintac_variation::{Line, of_model, of_readings, text};
use twintac_work::WorkError;

use crate::taxels::left_out;
use crate::unseen::refuse_other_sensor;

/// The sources of the estimate. Without a model or without recordings, the fields that they would
/// give are left out.
#[derive(Clone, Copy, Debug)]
pub struct VariationSources<'a> {
    /// The sensor's description.
    pub sensor: &'a SensorFile,
    /// The folder of a trained model of the sensor.
    pub model: Option<&'a Path>,
    /// Recordings of the sensor.
    pub recorded: Option<&'a Recorded>,
    /// The command that makes the file, for its first line.
    pub command: &'a str,
}

/// The estimated sensor variation, and the text of its file.
#[derive(Clone, Debug)]
pub struct FoundVariation {
    /// The widths; zero for those that were left out.
    pub variation: SensorVariation,
    /// The file's text: every width has a comment.
    pub text: String,
    /// Names of the fields that were estimated.
    pub found: Vec<&'static str>,
    /// Names of the fields that were left out.
    pub left_out: Vec<&'static str>,
}

/// The sensor's description that a model was trained with.
///
/// # Errors
/// A model that cannot be read.
pub fn sensor_of_model(folder: &Path) -> Result<SensorFile, WorkError> {
    let model = Model::load(folder)?;
    Ok(SensorFile::parse(
        &folder.join("twin.json"),
        &model.record.sensor,
    )?)
}

/// Estimates the variation of sensors of a kind.
///
/// # Errors
/// Neither a model nor recordings; a model that cannot be read; recordings that are of another
/// sensor than description and model.
pub fn find_variation(sources: &VariationSources<'_>) -> Result<FoundVariation, WorkError> {
    if sources.model.is_none() && sources.recorded.is_none() {
        return Err(WorkError::Input(
            "there is no source for the sensor variation; give a model, recordings, or both".to_owned(),
        ));
    }
    let sensor = &sources.sensor.sensor;
    let model = sources.model.map(Model::load).transpose()?;
    if let Some(recorded) = sources.recorded {
        refuse_other_sensor(&recorded.recording, sensor)?;
    }
    if let Some(folder) = sources.model {
        refuse_other_gel(&sensor_of_model(folder)?, sources.sensor, folder)?;
    }
    let casting = model.as_ref().map(|model| Casting {
        provenance: model.record.provenance,
        has_gains: model.record.variant != digitac::Variant::Paper,
        gains: &model.record.gains,
        bench: &model.record.bench,
        sensor,
        doubtful: left_out(sensor),
    });
    let has_memory = casting.as_ref().is_some_and(Casting::has_memory);
    let mut lines = of_model::lines(casting.as_ref());
    let characterization = sources
        .recorded
        .map(|recorded| recorded.characterize(sensor))
        .transpose()?;
    lines.extend(of_readings::lines(
        characterization.as_ref(),
        &left_out(sensor),
        has_memory,
    ));
    let text = text(&sensor.name, sources.command, &lines);
    // The text is parsed by the same rules as a file that a person wrote.
    let variation = SensorVariation::parse("the estimated sensor variation", &text)?;
    let names = |is_found: bool| {
        let lines = lines.iter().filter(|line| line.said.is_ok() == is_found);
        lines.map(|line: &Line| line.field).collect::<Vec<_>>()
    };
    Ok(FoundVariation {
        variation,
        found: names(true),
        left_out: names(false),
        text,
    })
}

/// Refuses a description whose taxels differ from those of the model, by name or position.
fn refuse_other_gel(of_model: &SensorFile, described: &SensorFile, folder: &Path) -> Result<(), WorkError> {
    let taxels = |of: &SensorFile| {
        let taxels = of.sensor.taxels.iter();
        let places = taxels.map(|taxel| (taxel.name.clone(), taxel.position_mm));
        places.collect::<Vec<_>>()
    };
    if taxels(of_model) == taxels(described) {
        return Ok(());
    }
    Err(WorkError::Input(format!(
        "the model in {} is of the sensor `{}`, whose taxels are not those of `{}`: leave --sensor out",
        folder.display(),
        of_model.sensor.name,
        described.sensor.name
    )))
}

impl FoundVariation {
    /// Writes the file.
    ///
    /// # Errors
    /// A file that cannot be written.
    pub fn write(&self, path: &Path) -> Result<(), WorkError> {
        Ok(write_file(path, self.text.as_bytes())?)
    }
}
