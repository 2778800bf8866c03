//! Frames of a sensor without planned presses, as a table with one row per frame.

use std::io::BufWriter;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::basic::Compression;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int32Type};
use parquet::errors::ParquetError;
use parquet::file::metadata::KeyValue;
use parquet::file::properties::WriterProperties;
use parquet::file::writer::SerializedFileWriter;
use twintac_store::PartialFile;

use super::schema;
use super::write::put_column;
use crate::{Provenance, RecordingError};

/// Number of frames in a row group: ten minutes of a sensor.
const ROWS: usize = 65_536;

/// The data of one taxel in a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct TaxelCell {
    /// Absolute pressure, kPa. `None` if it cannot be used.
    pub absolute_kpa: Option<f64>,
    /// Raw counts, if the taxel gave any.
    pub counts: Option<i32>,
    /// Temperature, °C, if the taxel gave one.
    pub temperature_c: Option<f64>,
    /// Why the pressure cannot be used, if so.
    pub fault: Option<&'static str>,
}

/// Writes frames as a Parquet file, through a temporary name, with little memory for any number of
/// frames. The same frames give the same bytes.
///
/// Columns: `time_s`, `provenance` and `gap_before`; then for all taxels `<taxel>_absolute_kpa`,
/// `<taxel>_counts`, `<taxel>_temperature_c` and `<taxel>_fault`, null if missing. The metadata has
/// `twintac.sensor` and `twintac.provenance`.
#[derive(Debug)]
pub struct FrameTable {
    writer: SerializedFileWriter<BufWriter<PartialFile>>,
    path: PathBuf,
    provenance: Provenance,
    time_s: Vec<f64>,
    gap_before: Vec<bool>,
    /// Cells of the waiting frames, for each taxel.
    cells: Vec<Vec<TaxelCell>>,
    rows: u64,
}

impl FrameTable {
    /// Begins a table. The file gets its name when the table is finished.
    ///
    /// # Errors
    /// [`RecordingError::Write`].
    pub fn create(
        path: &Path,
        sensor: &str,
        provenance: Provenance,
        taxels: &[String],
    ) -> Result<Self, RecordingError> {
        let problem = |error: ParquetError| RecordingError::write(path, std::io::Error::other(error));
        let file = PartialFile::create(path).map_err(|source| RecordingError::write(path, source))?;
        let pair = |key: &str, value: String| KeyValue::new(key.to_owned(), value);
        let properties = WriterProperties::builder()
            .set_compression(Compression::UNCOMPRESSED)
            .set_key_value_metadata(Some(vec![
                pair(schema::SENSOR_KEY, sensor.to_owned()),
                pair(schema::PROVENANCE_KEY, provenance.to_string()),
            ]));
        let schema = schema::frame_schema(taxels).map_err(problem)?;
        let writer = SerializedFileWriter::new(BufWriter::new(file), schema, Arc::new(properties.build()));
        Ok(Self {
            writer: writer.map_err(problem)?,
            path: path.to_owned(),
            provenance,
            time_s: Vec::new(),
            gap_before: Vec::new(),
            cells: vec![Vec::new(); taxels.len()],
            rows: 0,
        })
    }

    /// Adds a frame: a cell for each taxel, and whether frames before it are known to be missing.
    ///
    /// # Errors
    /// [`RecordingError::Write`]. [`RecordingError::Inconsistent`]: the number of cells is wrong,
    /// or a number is not finite; a missing number is `None`. Nothing is added then.
    pub fn push(
        &mut self,
        time_s: f64,
        gap_before: bool,
        cells: impl IntoIterator<Item = TaxelCell>,
    ) -> Result<(), RecordingError> {
        let cells: Vec<TaxelCell> = cells.into_iter().collect();
        let wrong = |problem: String| {
            Err(RecordingError::Inconsistent {
                place: format!("frame {}", self.rows),
                problem,
            })
        };
        if cells.len() != self.cells.len() {
            return wrong(format!(
                "expected {} taxels, found {}",
                self.cells.len(),
                cells.len()
            ));
        }
        let numbers = cells
            .iter()
            .flat_map(|cell| [cell.absolute_kpa, cell.temperature_c]);
        if !numbers.flatten().chain([time_s]).all(f64::is_finite) {
            return wrong("a number is not finite".to_owned());
        }
        self.time_s.push(time_s);
        self.gap_before.push(gap_before);
        for (column, cell) in self.cells.iter_mut().zip(cells) {
            column.push(cell);
        }
        self.rows += 1;
        if self.time_s.len() == ROWS {
            self.put_group()?;
        }
        Ok(())
    }

    /// Writes the waiting frames, and gives the file its name. Returns the number of rows.
    ///
    /// # Errors
    /// [`RecordingError::Write`].
    pub fn finish(mut self) -> Result<u64, RecordingError> {
        self.put_group()?;
        let written = self.writer.into_inner().map_err(std::io::Error::other);
        written
            .and_then(|buffer| buffer.into_inner().map_err(std::io::IntoInnerError::into_error))
            .and_then(PartialFile::finish)
            .map_err(|source| RecordingError::write(&self.path, source))?;
        Ok(self.rows)
    }

    fn put_group(&mut self) -> Result<(), RecordingError> {
        let result = self.put_columns();
        self.time_s.clear();
        self.gap_before.clear();
        self.cells.iter_mut().for_each(Vec::clear);
        result.map_err(|error| RecordingError::write(&self.path, std::io::Error::other(error)))
    }

    fn put_columns(&mut self) -> Result<(), ParquetError> {
        let mut group = self.writer.next_row_group()?;
        put_column::<DoubleType, _>(&mut group, &self.time_s, None)?;
        let provenance = ByteArray::from(self.provenance.to_string().into_bytes());
        put_column::<ByteArrayType, _>(&mut group, &vec![provenance; self.time_s.len()], None)?;
        put_column::<BoolType, _>(&mut group, &self.gap_before, None)?;
        for cells in &self.cells {
            let (values, present) = split::<DoubleType>(cells, |cell| cell.absolute_kpa);
            put_column::<DoubleType, _>(&mut group, &values, Some(&present))?;
        }
        for cells in &self.cells {
            let (values, present) = split::<Int32Type>(cells, |cell| cell.counts);
            put_column::<Int32Type, _>(&mut group, &values, Some(&present))?;
        }
        for cells in &self.cells {
            let (values, present) = split::<DoubleType>(cells, |cell| cell.temperature_c);
            put_column::<DoubleType, _>(&mut group, &values, Some(&present))?;
        }
        for cells in &self.cells {
            let (values, present) = split::<ByteArrayType>(cells, |cell| cell.fault.map(ByteArray::from));
            put_column::<ByteArrayType, _>(&mut group, &values, Some(&present))?;
        }
        group.close()?;
        Ok(())
    }
}

/// The values that exist, and for each row whether it has one.
fn split<T: DataType>(
    cells: &[TaxelCell],
    value: impl Fn(&TaxelCell) -> Option<T::T>,
) -> (Vec<T::T>, Vec<i16>) {
    let values: Vec<Option<T::T>> = cells.iter().map(value).collect();
    let present = values.iter().map(|value| i16::from(value.is_some())).collect();
    (values.into_iter().flatten().collect(), present)
}

#[cfg(test)]
mod tests {
    use super::super::column::Columns;
    use super::*;

    #[test]
    fn a_table_that_is_given_up_leaves_nothing() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frames.parquet");
        let mut table = FrameTable::create(&path, "pad", Provenance::Real, &[]).unwrap();
        table.push(0.0, false, []).unwrap();
        drop(table);
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 0);
    }

    #[test]
    fn a_frame_with_another_number_of_taxels_or_without_a_number_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frames.parquet");
        let mut table = FrameTable::create(&path, "pad", Provenance::Real, &["a".to_owned()]).unwrap();
        let cell = |kpa| TaxelCell {
            absolute_kpa: Some(kpa),
            ..TaxelCell::default()
        };
        let error = table
            .push(0.0, false, [cell(1.0), cell(2.0)])
            .unwrap_err()
            .to_string();
        assert_eq!(error, "frame 0: expected 1 taxels, found 2");
        assert!(table.push(0.0, false, []).is_err());
        assert!(table.push(0.0, false, [cell(f64::INFINITY)]).is_err());
        assert!(table.push(f64::NAN, false, [cell(1.0)]).is_err());
        table.push(0.0, false, [cell(1.0)]).unwrap();
        assert_eq!(table.finish().unwrap(), 1);
    }

    #[test]
    fn a_table_reads_back_over_several_row_groups() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("frames.parquet");
        let taxels = ["a".to_owned(), "b".to_owned()];
        let mut table = FrameTable::create(&path, "pad", Provenance::Real, &taxels).unwrap();
        let good = |frame: usize| TaxelCell {
            absolute_kpa: Some(100.0 + frame as f64),
            counts: Some(frame as i32),
            temperature_c: Some(21.5),
            fault: None,
        };
        let missing = TaxelCell {
            fault: Some("missing"),
            ..TaxelCell::default()
        };
        let n = 2 * ROWS + 3;
        for frame in 0..n {
            let second = if frame % 3 == 0 { missing } else { good(frame) };
            table
                .push(frame as f64 / 64.0, frame == 5, [good(frame), second])
                .unwrap();
        }
        assert!(!path.exists(), "it has its name when it is whole");
        assert_eq!(table.finish().unwrap(), n as u64);

        let columns = Columns::open(std::fs::read(&path).unwrap()).unwrap();
        assert_eq!(columns.metadata("twintac.provenance").unwrap(), "real");
        assert_eq!(columns.metadata("twintac.sensor").unwrap(), "pad");
        let time_s = columns.doubles("time_s").unwrap();
        assert_eq!((time_s.len(), time_s[n - 1]), (n, (n - 1) as f64 / 64.0));
        let gaps = columns.bools("gap_before").unwrap();
        assert_eq!(gaps.iter().position(|gap| *gap), Some(5));
        assert_eq!(gaps.iter().filter(|gap| **gap).count(), 1);
        let second_kpa = columns.optional_doubles("b_absolute_kpa").unwrap();
        assert_eq!(second_kpa[..4], [None, Some(101.0), Some(102.0), None]);
        assert_eq!(
            columns.optional_doubles("a_temperature_c").unwrap()[n - 1],
            Some(21.5)
        );
        assert!(columns.texts("a_fault").is_err(), "null where there is none");
        assert!(columns.names.contains(&"b_counts".to_owned()));
    }
}
