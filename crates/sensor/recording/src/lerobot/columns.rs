//! Tables with columns of values and lists, in pyarrow's layout.

use std::fs::File;
use std::io::BufWriter;
use std::path::Path;
use std::sync::Arc;

use parquet::basic::{Compression, LogicalType, Repetition, Type as Physical};
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, FloatType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::{SerializedFileWriter, SerializedRowGroupWriter};
use parquet::schema::types::{Type, TypePtr};

use crate::RecordingError;

/// Values of one type.
pub(super) enum LeRobotValues {
    Single(Vec<f32>),
    Double(Vec<f64>),
    Whole(Vec<i64>),
    Flag(Vec<bool>),
    Text(Vec<String>),
}

/// A column of a table.
pub(super) struct LeRobotColumn {
    name: String,
    values: LeRobotValues,
    /// Number of values in each row, if rows are lists.
    lengths: Option<Vec<usize>>,
}

impl LeRobotValues {
    fn len(&self) -> usize {
        match self {
            Self::Single(values) => values.len(),
            Self::Double(values) => values.len(),
            Self::Whole(values) => values.len(),
            Self::Flag(values) => values.len(),
            Self::Text(values) => values.len(),
        }
    }

    fn physical(&self) -> Physical {
        match self {
            Self::Single(_) => Physical::FLOAT,
            Self::Double(_) => Physical::DOUBLE,
            Self::Whole(_) => Physical::INT64,
            Self::Flag(_) => Physical::BOOLEAN,
            Self::Text(_) => Physical::BYTE_ARRAY,
        }
    }

    /// Appends values of the same type.
    fn extend(&mut self, more: Self) {
        match (self, more) {
            (Self::Single(values), Self::Single(more)) => values.extend(more),
            (Self::Double(values), Self::Double(more)) => values.extend(more),
            (Self::Whole(values), Self::Whole(more)) => values.extend(more),
            (Self::Flag(values), Self::Flag(more)) => values.extend(more),
            (Self::Text(values), Self::Text(more)) => values.extend(more),
            _ => unreachable!("a column has one type"),
        }
    }
}

impl LeRobotColumn {
    /// A column with one value in each row.
    pub(super) fn single(name: &str, values: LeRobotValues) -> Self {
        Self {
            name: name.to_owned(),
            values,
            lengths: None,
        }
    }

    /// A column with a list in each row; all lists have one type.
    pub(super) fn lists(name: &str, rows: impl Iterator<Item = LeRobotValues>) -> Self {
        let mut lengths = Vec::new();
        let mut all: Option<LeRobotValues> = None;
        for row in rows {
            lengths.push(row.len());
            match &mut all {
                None => all = Some(row),
                Some(all) => all.extend(row),
            }
        }
        Self {
            name: name.to_owned(),
            values: all.unwrap_or_else(|| LeRobotValues::Whole(Vec::new())),
            lengths: Some(lengths),
        }
    }

    fn schema(&self) -> Result<TypePtr, ParquetError> {
        let leaf = |name: &str| {
            let physical = self.values.physical();
            let text = (physical == Physical::BYTE_ARRAY).then_some(LogicalType::String);
            let leaf = Type::primitive_type_builder(name, physical).with_repetition(Repetition::OPTIONAL);
            leaf.with_logical_type(text).build().map(Arc::new)
        };
        if self.lengths.is_none() {
            return leaf(&self.name);
        }
        let repeated = Type::group_type_builder("list")
            .with_repetition(Repetition::REPEATED)
            .with_fields(vec![leaf("element")?])
            .build()?;
        Type::group_type_builder(&self.name)
            .with_repetition(Repetition::OPTIONAL)
            .with_logical_type(Some(LogicalType::List))
            .with_fields(vec![Arc::new(repeated)])
            .build()
            .map(Arc::new)
    }

    /// Writes the column as the next one. All values exist, and only the first value of a list
    /// begins a row.
    fn put(&self, group: &mut SerializedRowGroupWriter<'_, BufWriter<File>>) -> Result<(), ParquetError> {
        match &self.values {
            LeRobotValues::Single(values) => self.put_values::<FloatType>(group, values),
            LeRobotValues::Double(values) => self.put_values::<DoubleType>(group, values),
            LeRobotValues::Whole(values) => self.put_values::<Int64Type>(group, values),
            LeRobotValues::Flag(values) => self.put_values::<BoolType>(group, values),
            LeRobotValues::Text(texts) => {
                let bytes: Vec<ByteArray> = texts.iter().map(|text| text.as_str().into()).collect();
                self.put_values::<ByteArrayType>(group, &bytes)
            }
        }
    }

    fn put_values<T: DataType>(
        &self,
        group: &mut SerializedRowGroupWriter<'_, BufWriter<File>>,
        values: &[T::T],
    ) -> Result<(), ParquetError> {
        let mut column = group
            .next_column()?
            .ok_or_else(|| ParquetError::General("too many columns".to_owned()))?;
        let (present, repeated) = match &self.lengths {
            None => (1, None),
            Some(lengths) => {
                let levels = |length: &usize| (0..*length).map(|place| i16::from(place > 0));
                (3, Some(lengths.iter().flat_map(levels).collect::<Vec<_>>()))
            }
        };
        let present = vec![present; values.len()];
        column
            .typed::<T>()
            .write_batch(values, Some(&present), repeated.as_deref())?;
        column.close()
    }
}

/// Writes a table, with an additional entry in its metadata if one is given.
pub(super) fn write_table(
    path: &Path,
    columns: &[LeRobotColumn],
    metadata: Option<(&str, &str)>,
) -> Result<(), RecordingError> {
    let problem = |source| RecordingError::write(path, source);
    let create = || {
        std::fs::create_dir_all(path.parent().unwrap_or(Path::new("")))?;
        File::create(path)
    };
    let file = BufWriter::new(create().map_err(problem)?);
    encode(file, columns, metadata).map_err(|error| problem(std::io::Error::other(error)))
}

fn encode(
    file: BufWriter<File>,
    columns: &[LeRobotColumn],
    metadata: Option<(&str, &str)>,
) -> Result<(), ParquetError> {
    let fields = columns
        .iter()
        .map(LeRobotColumn::schema)
        .collect::<Result<_, _>>()?;
    let schema = Type::group_type_builder("schema").with_fields(fields).build()?;
    let pair = |(key, value): (&str, &str)| vec![KeyValue::new(key.to_owned(), value.to_owned())];
    let properties = WriterProperties::builder()
        .set_compression(Compression::SNAPPY)
        .set_key_value_metadata(metadata.map(pair))
        .build();
    let mut writer = SerializedFileWriter::new(file, Arc::new(schema), Arc::new(properties))?;
    let mut group = writer.next_row_group()?;
    for column in columns {
        column.put(&mut group)?;
    }
    group.close()?;
    writer.close()?;
    Ok(())
}
