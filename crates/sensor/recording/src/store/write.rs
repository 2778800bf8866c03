//! Writes recordings.

use std::collections::BTreeSet;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::basic::Compression;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int32Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::ColumnPath;
use twintac_store::PartialFile;

use super::seal::Sealing;
use super::{Column, schema, table};
use crate::{Press, Provenance, Recording, RecordingError};

/// A row group ends with the press that brings it to this number of rows: about forty minutes of a
/// sensor, some 30 MB.
const ROWS: usize = 131_072;

impl Recording {
    /// Writes a Parquet file with one row per frame, through a temporary name. The same recording
    /// gives the same bytes.
    ///
    /// Columns: `press_index` (from 0), `press`, `mounting`, `indenter`, `control` and
    /// `provenance`; `time_s`; the pose `x_mm`, `y_mm`, `z_mm`, `qx`, `qy`, `qz`, `qw`; `force_n`
    /// (null if unknown); then for all taxels `<taxel>_kpa` and `<taxel>_raw` (null if missing),
    /// and `<taxel>_valid`; and `<taxel>_temperature_c`, if any press has temperatures. The
    /// metadata has `twintac.schema`, `twintac.sensor` and `twintac.provenance`.
    ///
    /// # Errors
    ///
    /// The recording is inconsistent ([`check`](Self::check)), or the file cannot be written.
    pub fn write_parquet(&self, path: &Path) -> Result<(), RecordingError> {
        self.check()?;
        let mut writer = RecordingWriter::begin(path, self.without_presses(), self.has_temperatures())?;
        for press in &self.presses {
            writer.push(press.clone())?;
        }
        writer.finish()?;
        Ok(())
    }

    /// The bytes of a file without a seal. `mounting` is the name of the column of the
    /// installation.
    #[cfg(test)]
    pub(super) fn to_parquet(&self, mounting: &'static str) -> Result<Vec<u8>, ParquetError> {
        let mut encoder = Encoder::new(
            Vec::new(),
            self.without_presses(),
            mounting,
            self.has_temperatures(),
        )?;
        for press in &self.presses {
            encoder.push(press.clone())?;
        }
        encoder.put_group()?;
        encoder.writer.into_inner()
    }

    fn without_presses(&self) -> Self {
        Self {
            sensor: self.sensor.clone(),
            provenance: self.provenance,
            taxels: self.taxels.clone(),
            presses: Vec::new(),
        }
    }
}

/// Writes presses one by one into a file like that of [`Recording::write_parquet`], with little
/// memory for any number of presses. The file gets its name when it is complete. The same presses
/// give the same bytes.
#[derive(Debug)]
pub struct RecordingWriter {
    encoder: Encoder<Sealing<BufWriter<PartialFile>>>,
    path: PathBuf,
    names: BTreeSet<String>,
    n_rows: u64,
}

impl RecordingWriter {
    /// Begins a file of presses of one sensor, without temperatures.
    ///
    /// # Errors
    /// [`RecordingError::Write`].
    pub fn create(
        path: &Path,
        sensor: &str,
        provenance: Provenance,
        taxels: &[String],
    ) -> Result<Self, RecordingError> {
        let empty = Recording {
            sensor: sensor.to_owned(),
            provenance,
            taxels: taxels.to_vec(),
            presses: Vec::new(),
        };
        Self::begin(path, empty, false)
    }

    fn begin(path: &Path, empty: Recording, has_temperatures: bool) -> Result<Self, RecordingError> {
        let file = PartialFile::create(path).map_err(|source| RecordingError::write(path, source))?;
        let sink = Sealing::new(BufWriter::new(file));
        let encoder = Encoder::new(sink, empty, schema::MOUNTING, has_temperatures);
        Ok(Self {
            encoder: encoder.map_err(|error| problem(path, error))?,
            path: path.to_owned(),
            names: BTreeSet::new(),
            n_rows: 0,
        })
    }

    /// Adds a press.
    ///
    /// # Errors
    /// The press is inconsistent ([`Recording::check`]), has temperatures although the file has
    /// none, or its name exists already; or the file cannot be written.
    pub fn push(&mut self, press: Press) -> Result<(), RecordingError> {
        press.check(&self.encoder.waiting.taxels)?;
        let wrong = |problem: String| {
            Err(RecordingError::Inconsistent {
                place: self.path.display().to_string(),
                problem,
            })
        };
        if press.temperature_c.is_some() && !self.encoder.has_temperatures {
            return wrong(format!(
                "press `{}` has temperatures, and the file was begun without",
                press.name
            ));
        }
        if !self.names.insert(press.name.clone()) {
            return wrong(format!("press name `{}` is given twice", press.name));
        }
        self.n_rows += press.time_s.len() as u64;
        self.encoder
            .push(press)
            .map_err(|error| problem(&self.path, error))
    }

    /// Writes the waiting presses, and gives the file its name. Returns the number of rows.
    ///
    /// # Errors
    /// [`RecordingError::Write`].
    pub fn finish(self) -> Result<u64, RecordingError> {
        let whole = |encoder: Encoder<Sealing<BufWriter<PartialFile>>>| -> io::Result<()> {
            let file = encoder.finish()?.finish()?;
            file.into_inner()
                .map_err(io::IntoInnerError::into_error)?
                .finish()
        };
        whole(self.encoder).map_err(|source| RecordingError::write(&self.path, source))?;
        Ok(self.n_rows)
    }
}

fn problem(path: &Path, error: ParquetError) -> RecordingError {
    RecordingError::write(path, io::Error::other(error))
}

/// Writes presses as row groups.
struct Encoder<W: Write + Send> {
    writer: SerializedFileWriter<W>,
    /// The presses that wait for their row group.
    waiting: Recording,
    n_waiting_rows: usize,
    /// Number of presses written.
    n_written: i32,
    /// Name of the column of the installation.
    mounting: &'static str,
    has_temperatures: bool,
}

impl<W: Write + Send> Encoder<W> {
    fn new(
        sink: W,
        empty: Recording,
        mounting: &'static str,
        has_temperatures: bool,
    ) -> Result<Self, ParquetError> {
        let pair = |key: &str, value: String| KeyValue::new(key.to_owned(), value);
        let mut properties = WriterProperties::builder()
            .set_compression(Compression::UNCOMPRESSED)
            .set_dictionary_enabled(false)
            .set_statistics_enabled(EnabledStatistics::Chunk)
            .set_key_value_metadata(Some(vec![
                pair(schema::VERSION_KEY, schema::VERSION.to_owned()),
                pair(schema::SENSOR_KEY, empty.sensor.clone()),
                pair(schema::PROVENANCE_KEY, empty.provenance.to_string()),
            ]));
        for name in schema::TEXTS {
            properties = properties.set_column_dictionary_enabled(ColumnPath::from(name), true);
        }
        let types = table::types(&columns(&empty, 0, mounting, has_temperatures))?;
        Ok(Self {
            writer: SerializedFileWriter::new(sink, types, Arc::new(properties.build()))?,
            waiting: empty,
            n_waiting_rows: 0,
            n_written: 0,
            mounting,
            has_temperatures,
        })
    }

    fn push(&mut self, press: Press) -> Result<(), ParquetError> {
        self.n_waiting_rows += press.time_s.len();
        self.waiting.presses.push(press);
        if self.n_waiting_rows >= ROWS {
            self.put_group()?;
        }
        Ok(())
    }

    /// Writes the waiting presses. A file has at least one row group, which may be empty.
    fn put_group(&mut self) -> Result<(), ParquetError> {
        if self.waiting.presses.is_empty() && self.n_written > 0 {
            return Ok(());
        }
        let mut group = self.writer.next_row_group()?;
        let columns = columns(
            &self.waiting,
            self.n_written,
            self.mounting,
            self.has_temperatures,
        );
        for (_, column) in columns {
            put(&mut group, &column, &self.waiting.presses)?;
        }
        group.close()?;
        self.n_written += i32::try_from(self.waiting.presses.len()).unwrap_or(i32::MAX);
        self.waiting.presses.clear();
        self.n_waiting_rows = 0;
        Ok(())
    }
}

impl<W: Write + Send> Encoder<Sealing<W>> {
    /// Writes the waiting presses and the footer, which the sink holds back for its seal.
    fn finish(mut self) -> io::Result<Sealing<W>> {
        self.put_group().map_err(io::Error::other)?;
        self.writer.flush()?;
        self.writer.inner_mut().hold();
        self.writer.into_inner().map_err(io::Error::other)
    }
}

impl<W: Write + Send> std::fmt::Debug for Encoder<W> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Encoder")
            .field("n_written", &self.n_written)
            .finish_non_exhaustive()
    }
}

/// A recording's columns, with presses numbered from `first`.
fn columns(
    recording: &Recording,
    first: i32,
    mounting: &str,
    has_temperatures: bool,
) -> Vec<(String, Column)> {
    let mut columns = recording.columns_with(has_temperatures);
    for (name, column) in &mut columns {
        if name == schema::MOUNTING {
            mounting.clone_into(name);
        }
        if let Column::Index(numbers) = column {
            numbers.iter_mut().for_each(|number| *number += first);
        }
    }
    columns
}

fn put<W: Write + Send>(
    group: &mut SerializedRowGroupWriter<'_, W>,
    column: &Column,
    presses: &[Press],
) -> Result<(), ParquetError> {
    match column {
        Column::Index(numbers) => put_column::<Int32Type, _>(group, numbers, None),
        Column::Number(numbers) => put_column::<DoubleType, _>(group, numbers, None),
        Column::Flag(flags) => put_column::<BoolType, _>(group, flags, None),
        Column::Known(numbers) => {
            let present: Vec<i16> = numbers.iter().map(|number| i16::from(number.is_some())).collect();
            let known: Vec<f64> = numbers.iter().copied().flatten().collect();
            put_column::<DoubleType, _>(group, &known, Some(&present))
        }
        Column::Text(texts) => {
            let rows = texts.iter().zip(presses).flat_map(|(text, press)| {
                let text = ByteArray::from(text.as_bytes().to_vec());
                std::iter::repeat_n(text, press.time_s.len())
            });
            put_column::<ByteArrayType, _>(group, &rows.collect::<Vec<_>>(), None)
        }
    }
}

/// Writes the next column of a row group. `present` has 1 for each row with a value, and 0 for the
/// others.
pub(super) fn put_column<T: DataType, W: Write + Send>(
    writer: &mut SerializedRowGroupWriter<'_, W>,
    values: &[T::T],
    present: Option<&[i16]>,
) -> Result<(), ParquetError> {
    let mut column = writer
        .next_column()?
        .ok_or_else(|| ParquetError::General("too many columns".to_owned()))?;
    column.typed::<T>().write_batch(values, present, None)?;
    column.close()
}
