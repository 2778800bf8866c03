//! Recordings for libraries that read Arrow.

use std::sync::Arc;

use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{
    ArrayRef, BooleanArray, Float64Array, Int32Array, RecordBatch, RecordBatchIterator, StringArray,
};
use arrow_schema::{ArrowError, Field, Schema};
use twintac::{Column, Recording};

/// The name of a stream's capsule in the Arrow PyCapsule interface.
pub(crate) const STREAM: &std::ffi::CStr = c"arrow_array_stream";

/// The columns of a recording as a stream of one batch. The batch has a copy of the numbers.
pub(crate) fn stream(recording: &Recording) -> Result<FFI_ArrowArrayStream, ArrowError> {
    let (mut fields, mut arrays) = (Vec::new(), Vec::new());
    for (name, column) in recording.columns() {
        let is_optional = matches!(column, Column::Known(_));
        let array = array(recording, column);
        fields.push(Field::new(name, array.data_type().clone(), is_optional));
        arrays.push(array);
    }
    let metadata = [
        ("twintac.sensor".to_owned(), recording.sensor.clone()),
        ("twintac.provenance".to_owned(), recording.provenance.to_string()),
    ];
    let schema = Arc::new(Schema::new(fields).with_metadata(metadata));
    let batch = RecordBatch::try_new(Arc::clone(&schema), arrays);
    let batches = RecordBatchIterator::new([batch], schema);
    Ok(FFI_ArrowArrayStream::new(Box::new(batches)))
}

fn array(recording: &Recording, column: Column) -> ArrayRef {
    match column {
        Column::Index(numbers) => Arc::new(Int32Array::from(numbers)),
        Column::Number(numbers) => Arc::new(Float64Array::from(numbers)),
        Column::Known(numbers) => Arc::new(Float64Array::from(numbers)),
        Column::Flag(flags) => Arc::new(BooleanArray::from(flags)),
        Column::Text(texts) => {
            let frames = texts.iter().zip(&recording.presses);
            let each = frames.flat_map(|(text, press)| std::iter::repeat_n(text, press.time_s.len()));
            Arc::new(StringArray::from_iter_values(each))
        }
    }
}
