//! Writes recordings.

use std::io::Write;
use std::path::Path;
use std::sync::Arc;

use parquet::basic::Compression;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int32Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::ColumnPath;

use super::{schema, seal};
use crate::{Press, Recording, RecordingError};

impl Recording {
    /// Writes a Parquet file with one row per frame, through a temporary name. The same recording gives the same bytes.
    ///
    /// Columns: `press_index` (from 0), `press`, `mounting`, `indenter`, `control` and `provenance`; `time_s`; the pose
    /// `x_mm`, `y_mm`, `z_mm`, `qx`, `qy`, `qz`, `qw`; `force_n` (null where unknown); then `<taxel>_kpa` of all taxels,
    /// `<taxel>_raw` and `<taxel>_valid`. The metadata has `twintac.schema`, `twintac.sensor` and `twintac.provenance`.
    ///
    /// # Errors
    ///
    /// The recording is inconsistent ([`check`](Self::check)), or the file cannot be written.
    pub fn write_parquet(&self, path: &Path) -> Result<(), RecordingError> {
        self.check()?;
        let problem = |e: ParquetError| RecordingError::write(path, std::io::Error::other(e));
        let bytes = self.to_parquet(schema::MOUNTING).map_err(problem)?;
        let bytes = seal::seal(bytes).map_err(|e| RecordingError::write(path, std::io::Error::other(e)))?;
        twintac_files::write_whole(path, &bytes).map_err(|source| RecordingError::write(path, source))
    }

    /// The bytes of a file, without a seal; `mounting` is what the column of the mounting is called.
    pub(super) fn to_parquet(&self, mounting: &str) -> Result<Vec<u8>, ParquetError> {
        let pair = |key: &str, value: String| KeyValue::new(key.to_owned(), value);
        let mut properties = WriterProperties::builder()
            .set_compression(Compression::UNCOMPRESSED)
            .set_dictionary_enabled(false)
            .set_statistics_enabled(EnabledStatistics::Chunk)
            .set_key_value_metadata(Some(vec![
                pair(schema::VERSION_KEY, schema::VERSION.to_owned()),
                pair(schema::SENSOR_KEY, self.sensor.clone()),
                pair(schema::PROVENANCE_KEY, self.provenance.to_string()),
            ]));
        for name in schema::TEXTS {
            properties = properties.set_column_dictionary_enabled(ColumnPath::from(name), true);
        }
        let properties = Arc::new(properties.build());
        let mut writer =
            SerializedFileWriter::new(Vec::new(), schema::schema(&self.taxels, mounting)?, properties)?;
        self.put_columns(writer.next_row_group()?)?;
        writer.into_inner()
    }

    fn put_columns(&self, writer: SerializedRowGroupWriter<'_, Vec<u8>>) -> Result<(), ParquetError> {
        let mut rows = Rows {
            presses: &self.presses,
            writer,
        };
        let frames = |press: &Press| 0..press.time_s.len();
        rows.put::<Int32Type>(
            (0..)
                .zip(&self.presses)
                .flat_map(|(index, press)| frames(press).map(move |_| index)),
        )?;
        let provenance = self.provenance.to_string();
        rows.text(|press| press.name.clone())?;
        rows.text(|press| press.mounting.clone())?;
        rows.text(|press| press.indenter.clone())?;
        rows.text(|press| press.control.to_string())?;
        rows.text(|_| provenance.clone())?;
        rows.double(|press, frame| press.time_s[frame])?;
        for axis in 0..3 {
            rows.double(|press, frame| press.gel_from_indenter[frame].position_mm[axis])?;
        }
        for axis in 0..4 {
            rows.double(|press, frame| press.gel_from_indenter[frame].rotation.to_array()[axis])?;
        }
        rows.force()?;
        for taxel in 0..self.taxels.len() {
            rows.double(|press, frame| press.taxels_kpa[frame][taxel])?;
        }
        for taxel in 0..self.taxels.len() {
            rows.double(|press, frame| press.taxels_raw[frame][taxel])?;
        }
        for taxel in 0..self.taxels.len() {
            rows.put::<BoolType>(
                self.presses
                    .iter()
                    .flat_map(|press| press.valid.iter().map(move |row| row[taxel])),
            )?;
        }
        rows.writer.close()?;
        Ok(())
    }
}

/// Writes one column after the other, in the order of the schema.
struct Rows<'a, 'w> {
    presses: &'a [Press],
    writer: SerializedRowGroupWriter<'w, Vec<u8>>,
}

impl Rows<'_, '_> {
    fn put<T: DataType>(&mut self, values: impl Iterator<Item = T::T>) -> Result<(), ParquetError> {
        self.put_some::<T>(values, None)
    }

    /// `present` tells for each row whether it has a value: 1 or 0.
    fn put_some<T: DataType>(
        &mut self,
        values: impl Iterator<Item = T::T>,
        present: Option<&[i16]>,
    ) -> Result<(), ParquetError> {
        put_column::<T, _>(&mut self.writer, &values.collect::<Vec<_>>(), present)
    }

    fn text(&mut self, text: impl Fn(&Press) -> String) -> Result<(), ParquetError> {
        let presses = self.presses;
        let rows = presses.iter().flat_map(|press| {
            let text = ByteArray::from(text(press).into_bytes());
            press.time_s.iter().map(move |_| text.clone())
        });
        self.put::<ByteArrayType>(rows)
    }

    fn double(&mut self, number: impl Fn(&Press, usize) -> f64) -> Result<(), ParquetError> {
        let presses = self.presses;
        let number = &number;
        self.put::<DoubleType>(
            presses
                .iter()
                .flat_map(|press| (0..press.time_s.len()).map(move |frame| number(press, frame))),
        )
    }

    fn force(&mut self) -> Result<(), ParquetError> {
        let presses = self.presses;
        let present = |press: &Press| vec![i16::from(press.force_n.is_some()); press.time_s.len()];
        let present: Vec<i16> = presses.iter().flat_map(present).collect();
        self.put_some::<DoubleType>(
            presses
                .iter()
                .filter_map(|press| press.force_n.as_ref())
                .flatten()
                .copied(),
            Some(&present),
        )
    }
}

/// Writes the next column of a row group. `present` tells for each row whether it has a value: 1 or 0.
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
