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

use super::{Column, schema, seal, table};
use crate::{Recording, RecordingError};

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
        let mut columns = self.columns();
        for (name, _) in &mut columns {
            if name == schema::MOUNTING {
                mounting.clone_into(name);
            }
        }
        let mut writer = SerializedFileWriter::new(Vec::new(), table::types(&columns)?, properties)?;
        let mut group = writer.next_row_group()?;
        for (_, column) in &columns {
            self.put(&mut group, column)?;
        }
        group.close()?;
        writer.into_inner()
    }

    fn put(
        &self,
        group: &mut SerializedRowGroupWriter<'_, Vec<u8>>,
        column: &Column,
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
                let rows = texts.iter().zip(&self.presses).flat_map(|(text, press)| {
                    let text = ByteArray::from(text.as_bytes().to_vec());
                    std::iter::repeat_n(text, press.time_s.len())
                });
                put_column::<ByteArrayType, _>(group, &rows.collect::<Vec<_>>(), None)
            }
        }
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
