//! Frames as a structured array for NumPy (NumPy Enhancement Proposal 1, format 1.0).

use digitac::PairedPress;

/// The bytes of a value, from a press, its number and the number of its frame.
pub(super) type Value = Box<dyn Fn(&PairedPress, usize, usize) -> Vec<u8>>;

/// A column: its name, its NumPy type, and its values.
pub(super) struct Column {
    pub(super) name: String,
    pub(super) kind: &'static str,
    pub(super) value: Value,
}

/// A column of single precision.
pub(super) fn float(name: impl Into<String>, value: impl Fn(&PairedPress, usize) -> f64 + 'static) -> Column {
    Column {
        name: name.into(),
        kind: "<f4",
        value: Box::new(move |press, _, frame| (value(press, frame) as f32).to_le_bytes().to_vec()),
    }
}

/// The bytes of a file with all frames, press by press.
pub(super) fn array(presses: &[PairedPress], columns: &[Column]) -> Vec<u8> {
    let fields = columns
        .iter()
        .map(|column| format!("('{}', '{}')", column.name, column.kind));
    let fields = fields.collect::<Vec<_>>().join(", ");
    let n_frames: usize = presses.iter().map(|press| press.features.n_frames()).sum();
    let header = format!("{{'descr': [{fields}], 'fortran_order': False, 'shape': ({n_frames},), }}");
    let start = b"\x93NUMPY\x01\x00";
    let unpadded = start.len() + 2 + header.len() + 1;
    let padding = unpadded.next_multiple_of(64) - unpadded;
    let length = (header.len() + padding + 1) as u16;
    let mut bytes = [
        &start[..],
        &length.to_le_bytes(),
        header.as_bytes(),
        &vec![b' '; padding],
        b"\n",
    ]
    .concat();
    for (index, press) in presses.iter().enumerate() {
        for frame in 0..press.features.n_frames() {
            for column in columns {
                bytes.extend((column.value)(press, index, frame));
            }
        }
    }
    bytes
}
