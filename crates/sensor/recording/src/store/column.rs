//! Reads the columns of a Parquet file.

use parquet::basic::Type as Physical;
use parquet::column::reader::{ColumnReader, ColumnReaderImpl};
use parquet::data_type::{ByteArray, DataType};
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader, SerializedFileReader};

use bytes::Bytes;

/// Number of rows that are read at once. It does not depend on the number of rows that the file
/// states, because that may be wrong.
const BATCH: usize = 4096;

/// A Parquet file with access to columns by name. Errors are texts.
pub(super) struct Columns {
    reader: SerializedFileReader<Bytes>,
    /// Names of the columns, in the order of the file.
    pub(super) names: Vec<String>,
}

impl Columns {
    pub(super) fn open(bytes: Vec<u8>) -> Result<Self, String> {
        let reader = SerializedFileReader::new(Bytes::from(bytes)).map_err(describe)?;
        let schema = reader.metadata().file_metadata().schema_descr();
        let names = schema
            .columns()
            .iter()
            .map(|column| column.path().string())
            .collect();
        Ok(Self { reader, names })
    }

    #[cfg(test)]
    pub(super) fn n_row_groups(&self) -> usize {
        self.reader.num_row_groups()
    }

    /// The value of a key in the file's metadata.
    pub(super) fn metadata(&self, key: &str) -> Result<String, String> {
        let pairs = self.reader.metadata().file_metadata().key_value_metadata();
        let value = pairs
            .into_iter()
            .flatten()
            .find(|pair| pair.key == key)
            .and_then(|pair| pair.value.clone());
        value.ok_or_else(|| format!("its metadata has no `{key}`"))
    }

    pub(super) fn doubles(&self, name: &str) -> Result<Vec<f64>, String> {
        self.required(name, Physical::DOUBLE, |column| match column {
            ColumnReader::DoubleColumnReader(column) => Some(column),
            _ => None,
        })
    }

    pub(super) fn optional_doubles(&self, name: &str) -> Result<Vec<Option<f64>>, String> {
        self.values(name, Physical::DOUBLE, |column| match column {
            ColumnReader::DoubleColumnReader(column) => Some(column),
            _ => None,
        })
    }

    pub(super) fn bools(&self, name: &str) -> Result<Vec<bool>, String> {
        self.required(name, Physical::BOOLEAN, |column| match column {
            ColumnReader::BoolColumnReader(column) => Some(column),
            _ => None,
        })
    }

    pub(super) fn texts(&self, name: &str) -> Result<Vec<String>, String> {
        let texts = self.required(name, Physical::BYTE_ARRAY, |column| match column {
            ColumnReader::ByteArrayColumnReader(column) => Some(column),
            _ => None,
        })?;
        let text = |(row, text): (usize, ByteArray)| match text.as_utf8() {
            Ok(text) => Ok(text.to_owned()),
            Err(_) => Err(format!("row {row} of column `{name}` is not UTF-8 text")),
        };
        texts.into_iter().enumerate().map(text).collect()
    }

    fn required<T: DataType>(
        &self,
        name: &str,
        physical: Physical,
        typed: fn(ColumnReader) -> Option<ColumnReaderImpl<T>>,
    ) -> Result<Vec<T::T>, String> {
        let values = self.values(name, physical, typed)?.into_iter().enumerate();
        values
            .map(|(row, value)| value.ok_or_else(|| format!("row {row} of column `{name}` is null")))
            .collect()
    }

    fn values<T: DataType>(
        &self,
        name: &str,
        physical: Physical,
        typed: fn(ColumnReader) -> Option<ColumnReaderImpl<T>>,
    ) -> Result<Vec<Option<T::T>>, String> {
        let place = self
            .names
            .iter()
            .position(|n| n == name)
            .ok_or_else(|| format!("it has no column `{name}`"))?;
        let column = self
            .reader
            .metadata()
            .file_metadata()
            .schema_descr()
            .column(place);
        if column.physical_type() != physical || column.max_rep_level() > 0 || column.max_def_level() > 1 {
            return Err(format!(
                "column `{name}` has type {}, expected {physical}",
                column.physical_type()
            ));
        }
        let mut all = Vec::new();
        for group in 0..self.reader.num_row_groups() {
            let group = self.reader.get_row_group(group).map_err(describe)?;
            let reader = group.get_column_reader(place).map_err(describe)?;
            let mut reader = typed(reader).ok_or_else(|| format!("column `{name}` changes its type"))?;
            loop {
                let (mut values, mut present) = (Vec::new(), Vec::new());
                let levels = (column.max_def_level() > 0).then_some(&mut present);
                let (rows, _, _) = reader
                    .read_records(BATCH, levels, None, &mut values)
                    .map_err(describe)?;
                if rows == 0 {
                    break;
                }
                if column.max_def_level() == 0 {
                    all.extend(values.into_iter().map(Some));
                } else {
                    let mut values = values.into_iter();
                    all.extend(
                        present
                            .into_iter()
                            .map(|level| if level > 0 { values.next() } else { None }),
                    );
                }
            }
        }
        Ok(all)
    }
}

#[allow(clippy::needless_pass_by_value)] // for map_err
fn describe(error: ParquetError) -> String {
    error.to_string()
}
