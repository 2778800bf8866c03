//! Lines as boards send them: whole, torn, repeated, late and among other text.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use proptest::prelude::*;
use twintac_line::{Checksum, Decoder, Description, Heard, LineFrame, Passed};

fn described(text: &str) -> Description {
    Description::parse("line.toml", text).unwrap()
}

fn heard(description: &Description, bytes: &[u8]) -> (Vec<LineFrame>, Vec<Passed>, Decoder) {
    let mut decoder = Decoder::new(description, description.n_pressures());
    let (mut frames, mut passed) = (Vec::new(), Vec::new());
    decoder.push(bytes, &mut |heard| match heard {
        Heard::Frame(frame) => frames.push(frame),
        Heard::Passed(kind) => passed.push(kind),
    });
    (frames, passed, decoder)
}

fn pressures(frames: &[LineFrame]) -> Vec<Vec<Option<f64>>> {
    frames.iter().map(|frame| frame.pressures_kpa.clone()).collect()
}

#[test]
fn csv_with_boot_text_a_header_comments_and_missing_readings() {
    let description = described(
        r##"
        form = "text"
        fields = ["time", "pressure * 2", "temperature * 2"]
        text.missing = ["ERR", "-999"]
        pressure.unit = "hPa"
        "##,
    );
    let line = "r 3 of 9\nESP-ROM:esp32s3\nTime(ms),B1_P,B1_T\n# 100 Hz\n\n10,1013.25,1000,25,26,\n20,ERR,-999,NaN,26\n";
    let (frames, passed, decoder) = heard(&description, line.as_bytes());
    assert_eq!(pressures(&frames), [[Some(101.325), Some(100.0)], [None, None]]);
    assert_eq!(frames[1].temperatures_c, [None, Some(26.0)]);
    assert_eq!(frames[1].time_s, Some(0.02));
    assert_eq!(
        passed,
        [
            Passed::Text,
            Passed::Text,
            Passed::Text,
            Passed::Comment,
            Passed::Comment
        ]
    );
    assert_eq!(
        (
            decoder.tally().frames,
            decoder.tally().text,
            decoder.tally().comments
        ),
        (2, 3, 2)
    );
}

#[test]
fn blanks_brackets_prefixes_and_frames_of_several_lines() {
    let blanks = described(
        "form = \"text\"\nfields = [\"pressure * 3\"]\n[text]\nseparator = \"blank\"\nstrip = \"[](),\"",
    );
    let (frames, _, _) = heard(&blanks, b"[1.0, 2.5]  3 \r\n(4, 5, 6)\n\t7\t8\t9\t\n");
    let expected = [[1.0, 2.5, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]].map(|row| row.map(Some));
    assert_eq!(pressures(&frames), expected);

    let prefixed = described("form = \"text\"\nfields = [\"pressure\"]\ntext.prefix = \"P:\"");
    let (frames, passed, _) = heard(&prefixed, b"T:20\nP:101\n");
    assert_eq!(pressures(&frames), [[Some(101.0)]]);
    assert_eq!(passed, [Passed::Text]); // the first line, which may be the end of one

    let matrix =
        described("form = \"text\"\nfields = [\"pressure * 4\"]\n[text]\nseparator = \"blank\"\nlines = 2");
    let (frames, passed, _) = heard(&matrix, b"1 2 \n3 4 \n\n5 6 \n\n7 8\n9 10\n\n");
    assert_eq!(
        pressures(&frames),
        [[1.0, 2.0, 3.0, 4.0], [7.0, 8.0, 9.0, 10.0]].map(|row| row.map(Some))
    );
    assert_eq!(passed, [Passed::Torn]);
}

#[test]
fn json_by_keys() {
    let description = described(
        r#"
        form = "json"
        keys.t = "time"
        keys.p = "pressure * 3"
        keys.temp = "temperature"
        time.unit = "us"
        pressure.unit = "Pa"
        taxel_order = [2, 0, 1]
        "#,
    );
    let lines = concat!(
        "{\"t\": 1000, \"p\": [100000, null, \"nan\"], \"temp\": 20.5, \"other\": {}}\n",
        "{\"t\": 2000, \"p\": [1, 2]}\n",
        "{\"t\": 3000, \"p\":\n",
        "{\"t\": 4000, \"p\": [1000, 2000, 3000]}\n"
    );
    let (frames, passed, _) = heard(&description, lines.as_bytes());
    assert_eq!(
        pressures(&frames),
        [[None, None, Some(100.0)], [Some(2.0), Some(3.0), Some(1.0)]]
    );
    assert_eq!(frames[0].temperatures_c, [Some(20.5); 3]);
    assert_eq!(frames[1].temperatures_c, [None; 3]);
    assert_eq!(passed, [Passed::Torn, Passed::Torn]);
}

#[test]
fn packets_with_sync_bytes_inside_and_without_a_checksum() {
    let description = described(
        r#"
        form = "binary"
        fields = ["u32 time", "i16 pressure * 2", "u8 ignored"]
        binary.order = "big"
        pressure = { unit = "counts", gain = 0.5, offset = 100.0 }
        "#,
    );
    let packet = |time: u32, pressures: [i16; 2]| {
        let mut bytes = vec![0xAA, 0x55];
        bytes.extend(time.to_be_bytes());
        pressures
            .iter()
            .for_each(|pressure| bytes.extend(pressure.to_be_bytes()));
        bytes.push(0xAA);
        bytes
    };
    let mut line = vec![1, 2, 3];
    line.extend(packet(10, [2, -2]));
    line.extend(packet(20, [0x55AAu16 as i16, -0x55AB + 1]));
    line.extend(&packet(30, [1, 1])[..6]); // torn
    line.extend(packet(40, [4, 6]));
    line.extend([0xAA, 0x55]);
    let (frames, _, decoder) = heard(&description, &line);
    let times: Vec<_> = frames.iter().map(|frame| frame.time_s.unwrap()).collect();
    assert_eq!(times, [0.01, 0.02, 0.04]);
    assert_eq!(frames[2].pressures_kpa, [Some(102.0), Some(103.0)]);
    assert!(decoder.tally().endless > 0);
}

fn stuffed(packet: &[u8]) -> Vec<u8> {
    let mut out = Vec::new();
    let mut block = Vec::new();
    for byte in packet.iter().copied().chain([0]) {
        if byte == 0 {
            out.push(block.len() as u8 + 1);
            out.append(&mut block);
        } else {
            block.push(byte);
            if block.len() == 254 {
                out.push(0xFF);
                out.append(&mut block);
            }
        }
    }
    out.push(0);
    out
}

#[test]
fn stuffed_packets_with_a_checksum() {
    let description = described(
        r#"
        form = "binary"
        fields = ["u16 sequence", "f32 pressure * 2"]
        sequence_wraps_at = 65536
        [binary]
        framing = "cobs"
        checksum = "crc16-ccitt"
        "#,
    );
    let packet = |sequence: u16| {
        let mut bytes = sequence.to_le_bytes().to_vec();
        [f32::from(sequence), -1.5]
            .iter()
            .for_each(|pressure| bytes.extend(pressure.to_le_bytes()));
        bytes.extend((Checksum::Crc16Ccitt.of(&bytes) as u16).to_le_bytes());
        stuffed(&bytes)
    };
    let mut line = vec![9, 9, 0];
    for sequence in [65_534, 65_535, 0, 1, 1, 3] {
        line.extend(packet(sequence));
    }
    let mut broken = packet(4);
    broken[1] ^= 1;
    line.extend(broken);
    line.extend(packet(5));
    let (frames, passed, decoder) = heard(&description, &line);
    let numbers: Vec<_> = frames
        .iter()
        .map(|frame| (frame.sequence.unwrap(), frame.lost_before))
        .collect();
    assert_eq!(
        numbers,
        [
            (65_534, 0),
            (65_535, 0),
            (65_536, 0),
            (65_537, 0),
            (65_539, 1),
            (65_541, 1)
        ]
    );
    assert_eq!(passed, [Passed::Text, Passed::Doubled, Passed::Checksum]);
    assert_eq!(decoder.tally().lost, 2);
}

#[test]
fn a_counter_of_32_bits_goes_on_and_a_board_that_starts_anew_is_told_from_it() {
    for (unit, last_s) in [("ms", 4_294_967.295), ("us", 4_294.967_295)] {
        let description = described(&format!(
            "form = \"text\"\nfields = [\"time\", \"pressure\"]\ntime.unit = \"{unit}\""
        ));
        let (frames, _, decoder) = heard(&description, b"4294967290,1\n4294967295,2\n4,3\n9,4\n");
        let times: Vec<_> = frames.iter().map(|frame| frame.time_s.unwrap()).collect();
        let step_s = times[1] - times[0];
        assert!((times[1] - last_s).abs() < 1e-9);
        assert!((times[2] - times[1] - step_s).abs() < 1e-6 && decoder.tally().restarts == 0);
        let (frames, _, decoder) = heard(&description, b"5000,1\n5010,2\n3,3\n13,4\n");
        assert_eq!((frames.len(), decoder.tally().restarts), (4, 1));
    }
}

#[test]
fn a_time_says_what_is_missing_where_nothing_is_numbered() {
    let description = described("form = \"text\"\nfields = [\"time\", \"pressure\"]\nrate_hz = 100");
    let (frames, passed, decoder) = heard(&description, b"0,1\n10,1\n20,1\n51,1\n51,1\n51,2\n60,1\n");
    let lost: Vec<_> = frames.iter().map(|frame| frame.lost_before).collect();
    assert_eq!(lost, [0, 0, 0, 2, 0, 0]);
    assert_eq!((passed, decoder.tally().lost), (vec![Passed::Doubled], 2));
}

#[test]
fn a_line_that_never_ends_is_bounded() {
    let description = described("form = \"text\"\nfields = [\"pressure\"]");
    let mut decoder = Decoder::new(&description, 1);
    for _ in 0..1000 {
        decoder.push(&[b'7'; 10_000], &mut |heard| panic!("{heard:?}"));
    }
    let mut frames = 0;
    decoder.push(b"\n101\n", &mut |heard| {
        frames += usize::from(matches!(heard, Heard::Frame(_)))
    });
    assert_eq!((frames, decoder.tally().endless), (1, 1));
}

#[test]
fn wrong_descriptions_name_the_field() {
    for (text, expected) in [
        ("form = \"text\"", "`fields` are required for this form"),
        (
            "form = \"json\"\nfields = [\"pressure\"]",
            "`keys` are required for JSON",
        ),
        (
            "form = \"text\"\nfields = [\"u8 pressure\"]",
            "`fields` have `u8 pressure`; give no types",
        ),
        (
            "form = \"binary\"\nfields = [\"pressure\"]",
            "`fields` have `pressure`; give each a type",
        ),
        (
            "form = \"text\"\nfields = [\"time\"]",
            "`fields` have no pressure",
        ),
        (
            "form = \"text\"\nfields = [\"time\", \"time\", \"pressure\"]",
            "a time or a sequence twice",
        ),
        (
            "form = \"text\"\nfields = [\"pressure * 3\", \"temperature * 2\"]",
            "2 temperatures beside 3 pressures",
        ),
        (
            "form = \"text\"\nfields = [\"pressure * 2\"]\ntaxel_order = [0, 0]",
            "`taxel_order` is [0, 0]",
        ),
        (
            "form = \"text\"\nfields = [\"pressure\"]\npressure.unit = \"counts\"",
            "`pressure.unit` is given without a gain",
        ),
        (
            "form = \"text\"\nfields = [\"pressure\"]\npressure.gain = 0.0",
            "`pressure.gain` is 0",
        ),
        (
            "form = \"text\"\nfields = [\"pressure\"]\nserial.baud = 0",
            "`serial.baud` is 0",
        ),
        (
            "form = \"text\"\nfields = [\"pressure\"]\ntext.separator = \"ab\"",
            "`text.separator` is `ab`",
        ),
        (
            "form = \"binary\"\nfields = [\"u8 pressure\"]\nbinary.sync = []",
            "`binary.sync` has 0 bytes",
        ),
        (
            "form = \"text\"\nfields = [\"presure\"]",
            "`presure` is not a known meaning",
        ),
        (
            "form = \"text\"\nfields = [\"pressure\"]\nrate_hz = -1",
            "`rate_hz` is not above 0",
        ),
        ("form = \"text\"\nfields = [\"pressure\"]\nparity = 1", "parity"),
    ] {
        let error = Description::parse("line.toml", text).unwrap_err().to_string();
        assert!(error.contains(expected), "{text}: {error}");
    }
}

/// A frame's line with number and checksum. An 8-bit checksum would accept one of 256 broken lines.
fn line(sequence: u64) -> String {
    let body = format!("{sequence},{},{}", 1000 + sequence, 2000 + 3 * sequence);
    format!("{body}*{:08x}\n", Checksum::Crc32.of(body.as_bytes()))
}

#[derive(Clone, Debug)]
enum Mishap {
    None,
    Cut(usize),
    NoEnd,
    Twice,
    Swap,
    Garbage(Vec<u8>),
    Gone,
    Bit(usize),
}

fn mishap() -> impl Strategy<Value = Mishap> {
    prop_oneof![
        10 => Just(Mishap::None),
        1 => (0..12_usize).prop_map(Mishap::Cut),
        1 => Just(Mishap::NoEnd),
        1 => Just(Mishap::Twice),
        1 => Just(Mishap::Swap),
        1 => prop::collection::vec(any::<u8>(), 0..40).prop_map(Mishap::Garbage),
        1 => Just(Mishap::Gone),
        1 => (0..100_usize).prop_map(Mishap::Bit),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// For any damage to lines with numbers and checksums: every frame that is decoded was sent,
    /// and every missing frame is counted.
    #[test]
    fn no_loss_is_unmarked(mishaps in prop::collection::vec(mishap(), 1..200), pieces in prop::collection::vec(1..60_usize, 1..20)) {
        let description = described(
            "form = \"text\"\nfields = [\"sequence\", \"pressure * 2\"]\ntext.checksum = \"crc32\"\nsequence_wraps_at = 4294967296",
        );
        let mut bytes = line(0).into_bytes();
        let mut n_sent = 1;
        let mut held: Option<String> = None;
        for mishap in &mishaps {
            let line = line(n_sent);
            n_sent += 1;
            match mishap {
                Mishap::None => bytes.extend(line.bytes()),
                Mishap::Cut(at) => bytes.extend(line.bytes().take(*at)),
                Mishap::NoEnd => bytes.extend(line.trim_end().bytes()),
                Mishap::Twice => bytes.extend(line.bytes().chain(line.bytes())),
                Mishap::Swap => held = Some(line.clone()),
                Mishap::Garbage(garbage) => bytes.extend(garbage.iter().copied().chain(line.bytes())),
                Mishap::Gone => {}
                Mishap::Bit(at) => {
                    let mut line = line.into_bytes();
                    let at = at % (line.len() - 1);
                    line[at] ^= 1 << (at % 7);
                    bytes.extend(line);
                }
            }
            if !matches!(mishap, Mishap::Swap) && let Some(late) = held.take() {
                bytes.extend(late.bytes());
            }
        }
        // Two whole lines at the end, because the first may be torn by the bytes before it.
        bytes.extend(line(n_sent).bytes().chain(line(n_sent + 1).bytes()));
        n_sent += 2;
        let mut decoder = Decoder::new(&description, 2);
        let mut frames = Vec::new();
        let mut rest = bytes.as_slice();
        for piece in pieces.iter().cycle() {
            let (now, later) = rest.split_at((*piece).min(rest.len()));
            rest = later;
            decoder.push(now, &mut |heard| if let Heard::Frame(frame) = heard { frames.push(frame) });
            if rest.is_empty() { break; }
        }
        for frame in &frames {
            let sequence = frame.sequence.unwrap() as f64;
            prop_assert_eq!(&frame.pressures_kpa, &vec![Some(1000.0 + sequence), Some(2000.0 + 3.0 * sequence)]);
        }
        let first = frames[0].sequence.unwrap();
        let tally = decoder.tally();
        prop_assert_eq!(first, 0);
        prop_assert_eq!(tally.frames + tally.lost, n_sent);
        prop_assert_eq!(tally.restarts, 0);
    }

    /// Any bytes are handled, in every form, and no more of them is stored than a frame needs.
    #[test]
    fn any_bytes_are_survived(pieces in prop::collection::vec(prop::collection::vec(any::<u8>(), 0..200), 0..40), form in 0..4_usize) {
        let description = described([
            "form = \"text\"\nfields = [\"time\", \"pressure\"]",
            "form = \"json\"\nkeys.p = \"pressure\"\nkeys.t = \"time\"",
            "form = \"binary\"\nfields = [\"f64 time\", \"f32 pressure\"]\nbinary.sync = [0]",
            "form = \"binary\"\nfields = [\"u64 sequence\", \"f32 pressure\"]\nbinary.framing = \"cobs\"",
        ][form]);
        let mut decoder = Decoder::new(&description, 1);
        let mut frames = 0;
        for piece in &pieces {
            decoder.push(piece, &mut |heard| if let Heard::Frame(frame) = heard {
                frames += 1;
                assert_eq!(frame.pressures_kpa.len(), 1);
                assert!(frame.pressures_kpa[0].is_none_or(f64::is_finite));
            });
        }
        prop_assert_eq!(decoder.tally().frames, frames);
    }
}

#[test]
fn comments_need_no_checksum() {
    let description = described("form = \"text\"\nfields = [\"pressure * 2\"]\ntext.checksum = \"xor8\"");
    let (_, passed, _) = heard(&description, b"# 2 of 2 * kPa\n# hello\n1,2*2F\n");
    assert_eq!(passed, [Passed::Comment, Passed::Comment]);
}

#[test]
fn taxels_say_why_they_have_no_reading() {
    let description = described(
        r#"
        form = "text"
        fields = ["pressure * 3", "fault * 3"]
        taxel_order = [2, 0, 1]
        "#,
    );
    let (frames, _, _) = heard(&description, b"100,0,nan,0,4,1\n100,101,102,nan,0.5,999\n");
    assert_eq!(
        pressures(&frames),
        [[None, None, Some(100.0)], [None, None, Some(100.0)]]
    );
    assert_eq!(
        frames[0].faults,
        [Some(4), Some(1), Some(0)],
        "a taxel with a fault has no reading, whatever stands there"
    );
    assert_eq!(frames[1].faults, [Some(1), Some(255), None]);
    let wrong = "form = \"text\"\nfields = [\"pressure * 3\", \"fault\"]";
    let error = Description::parse("line.toml", wrong).unwrap_err().to_string();
    assert!(error.contains("have 1 faults beside 3 pressures"), "{error}");
}

#[test]
fn numbers_that_jump_as_far_as_they_can_are_counted_as_far_as_that_goes() {
    let description = described("form = \"text\"\nfields = [\"sequence\", \"pressure\"]");
    let mut decoder = Decoder::new(&description, 1);
    for _ in 0..4 {
        decoder.push(b"0,1\n1e19,1\n", &mut |_| ());
    }
    assert_eq!((decoder.tally().frames, decoder.tally().lost), (8, u64::MAX));
}
