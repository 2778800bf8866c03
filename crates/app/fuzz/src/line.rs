//! A serial line that carries any bytes.

use twintac_line::{Decoder, Description, Heard};

/// Descriptions of lines, of every form.
const FORMS: [&str; 7] = [
    "form = \"text\"\nfields = [\"sequence\", \"time\", \"pressure * 2\", \"temperature\"]\ntext.checksum = \"xor8\"",
    "form = \"json\"\nkeys.n = \"sequence\"\nkeys.t = \"time\"\nkeys.p = \"pressure * 2\"",
    "form = \"binary\"\nfields = [\"u32 time\", \"i16 pressure * 2\"]",
    "form = \"binary\"\nfields = [\"u16 sequence\", \"f32 pressure * 2\"]\nsequence_wraps_at = 65536\nbinary = { framing = \"cobs\", checksum = \"crc8\" }",
    "form = \"text\"\nfields = [\"pressure * 2\"]\ntext = { separator = \"blank\", lines = 2, strip = \"[]\", prefix = \"p\" }",
    "form = \"text\"\nfields = [\"time\", \"pressure * 2\"]\nrate_hz = 100\ntime.unit = \"us\"\ntext.longest = 64",
    "form = \"binary\"\nfields = [\"u8 fault * 2\", \"f32 pressure * 2\"]\nbinary = { framing = \"cobs\", checksum = \"sum8\" }",
];

/// Decodes the bytes. The first byte chooses the form, the second the size of the pieces in which
/// they arrive.
pub(crate) fn bytes(bytes: &[u8]) {
    let [form, size, bytes @ ..] = bytes else {
        return;
    };
    let text = FORMS[usize::from(*form) % FORMS.len()];
    let description = Description::parse("line.toml", text).unwrap();
    let whole = frames(&description, bytes, usize::MAX);
    let in_pieces = frames(&description, bytes, usize::from(*size).max(1));
    assert_eq!(whole, in_pieces, "pieces say the same as the whole");
}

/// The decoded frames and other events as text.
fn frames(description: &Description, bytes: &[u8], size: usize) -> String {
    let mut decoder = Decoder::new(description, 2);
    let (mut said, mut n_frames, mut n_lost) = (String::new(), 0, 0_u64);
    let mut last = None;
    for piece in bytes.chunks(size.min(bytes.len().max(1))) {
        decoder.push(piece, &mut |heard| {
            said += &format!("{heard:?}");
            if let Heard::Frame(frame) = heard {
                n_frames += 1;
                n_lost = n_lost.saturating_add(frame.lost_before);
                let numbers = frame.pressures_kpa.iter().chain(&frame.temperatures_c);
                assert!(numbers.flatten().all(|number| number.is_finite()));
                assert_eq!((frame.pressures_kpa.len(), frame.temperatures_c.len()), (2, 2));
                let taxels = frame.pressures_kpa.iter().zip(&frame.faults);
                assert!({ taxels }.all(|(pressure, fault)| pressure.is_none() || fault.unwrap_or(0) == 0));
                last = frame.sequence.or(last);
            }
        });
    }
    let tally = decoder.tally();
    assert_eq!((tally.frames, tally.lost), (n_frames, n_lost));
    said
}
