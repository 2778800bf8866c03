//! Names and types of columns.

use std::sync::Arc;

use parquet::basic::{LogicalType, Repetition, Type as Physical};
use parquet::errors::ParquetError;
use parquet::schema::types::{Type, TypePtr};

/// Version of this layout. Readers refuse other versions.
pub(super) const VERSION: &str = "1";
/// Keys of the file's metadata.
pub(super) const VERSION_KEY: &str = "twintac.schema";
pub(super) const SENSOR_KEY: &str = "twintac.sensor";
pub(super) const PROVENANCE_KEY: &str = "twintac.provenance";

/// Index of the press, from 0.
pub(super) const PRESS_INDEX: &str = "press_index";
/// Text columns with the same value in all rows of a press.
pub(super) const PRESS: &str = "press";
pub(super) const MOUNTING: &str = "mounting";
/// The name of the column `mounting` in older files.
pub(super) const OLD_MOUNTING: &str = "file";
pub(super) const INDENTER: &str = "indenter";
pub(super) const CONTROL: &str = "control";
pub(super) const PROVENANCE: &str = "provenance";
pub(super) const TEXTS: [&str; 5] = [PRESS, MOUNTING, INDENTER, CONTROL, PROVENANCE];
/// Time and pose.
pub(super) const TIME: &str = "time_s";
pub(super) const POSE: [&str; 7] = ["x_mm", "y_mm", "z_mm", "qx", "qy", "qz", "qw"];
/// Null if the force is not known.
pub(super) const FORCE: &str = "force_n";
/// Suffixes of a taxel's name.
pub(super) const KPA: &str = "_kpa";
pub(super) const RAW: &str = "_raw";
pub(super) const VALID: &str = "_valid";
/// For tables of frames: whether frames are known to be missing before this one.
pub(super) const GAP_BEFORE: &str = "gap_before";
/// For tables of frames: suffixes of a taxel's name; null if missing.
pub(super) const ABSOLUTE_KPA: &str = "_absolute_kpa";
pub(super) const COUNTS: &str = "_counts";
pub(super) const TEMPERATURE_C: &str = "_temperature_c";
pub(super) const FAULT: &str = "_fault";

/// The columns of a table of frames, in the order of the file.
pub(super) fn frame_schema(taxels: &[String]) -> Result<TypePtr, ParquetError> {
    let mut columns = vec![
        required(TIME, Physical::DOUBLE)?,
        required(PROVENANCE, Physical::BYTE_ARRAY)?,
        required(GAP_BEFORE, Physical::BOOLEAN)?,
    ];
    for (suffix, physical) in [
        (ABSOLUTE_KPA, Physical::DOUBLE),
        (COUNTS, Physical::INT32),
        (TEMPERATURE_C, Physical::DOUBLE),
        (FAULT, Physical::BYTE_ARRAY),
    ] {
        for taxel in taxels {
            columns.push(optional(&format!("{taxel}{suffix}"), physical)?);
        }
    }
    group("frames", columns)
}

pub(super) fn group(name: &str, columns: Vec<TypePtr>) -> Result<TypePtr, ParquetError> {
    let group = Type::group_type_builder(name).with_fields(columns);
    group.build().map(Arc::new)
}

pub(super) fn required(name: &str, physical: Physical) -> Result<TypePtr, ParquetError> {
    column(name, physical, Repetition::REQUIRED)
}

pub(super) fn optional(name: &str, physical: Physical) -> Result<TypePtr, ParquetError> {
    column(name, physical, Repetition::OPTIONAL)
}

fn column(name: &str, physical: Physical, repetition: Repetition) -> Result<TypePtr, ParquetError> {
    let column = Type::primitive_type_builder(name, physical).with_repetition(repetition);
    let text = matches!(physical, Physical::BYTE_ARRAY).then_some(LogicalType::String);
    column.with_logical_type(text).build().map(Arc::new)
}
