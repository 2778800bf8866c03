//! Numbers in messages, by the names of their fields.

use super::definition::{Kind, Number};
use crate::cdr::Decoder;

/// Most names of fields that are listed.
const MOST_NAMES: usize = 512;

/// Path to a number: the index of a field in its message, or of an element in its array, from the
/// outside in.
pub(super) type Path = Vec<usize>;

/// The path to the number with a name. The name is its whole path, `wrench.force.z` or `data.0`, or
/// the end of it, `force.z`, if only one number has this end. `None` if there is no such number or
/// more than one.
pub(super) fn find(kind: &Kind, name: &str) -> Option<Path> {
    let parts: Vec<&str> = name.split('.').collect();
    descend(kind, &parts).or_else(|| {
        let mut found = Vec::new();
        search(kind, &parts, &mut Vec::new(), &mut found);
        found.pop().filter(|_| found.is_empty())
    })
}

/// The path to the number with these names, from here on.
pub(super) fn descend(kind: &Kind, parts: &[&str]) -> Option<Path> {
    let (first, rest) = match (kind, parts) {
        (Kind::Number(_), []) => return Some(Path::new()),
        (Kind::Number(_) | Kind::Text, _) | (_, []) => return None,
        (_, [first, rest @ ..]) => (first, rest),
    };
    let (place, inner) = match kind {
        Kind::Message(fields) => {
            let place = fields.iter().position(|(name, _)| name == first)?;
            (place, &fields[place].1)
        }
        Kind::Array(element, length) => (first.parse().ok().filter(|place| place < length)?, &**element),
        Kind::Sequence(element) => (first.parse().ok()?, &**element),
        Kind::Number(_) | Kind::Text => return None,
    };
    let mut path = descend(inner, rest)?;
    path.insert(0, place);
    Some(path)
}

/// The paths of all numbers whose names end in this way, in messages that are not elements of
/// arrays.
fn search(kind: &Kind, parts: &[&str], before: &mut Path, found: &mut Vec<Path>) {
    let Kind::Message(fields) = kind else { return };
    found.extend(descend(kind, parts).map(|path| [before.as_slice(), &path].concat()));
    for (place, (_, inner)) in fields.iter().enumerate() {
        before.push(place);
        search(inner, parts, before, found);
        before.pop();
    }
}

/// Decodes a message and puts the numbers at some paths into `numbers`. A number that the message
/// lacks leaves its entry unchanged. `None` if the bytes are no such message.
pub(super) fn take(
    kind: &Kind,
    d: &mut Decoder<'_>,
    wanted: &[(&[usize], usize)],
    numbers: &mut [Option<f64>],
) -> Option<()> {
    match kind {
        Kind::Number(number) => {
            let value = take_number(d, *number)?;
            for (_, place) in wanted {
                numbers[*place] = Some(value);
            }
        }
        Kind::Text => d.skip_text()?,
        Kind::Message(fields) => {
            for (place, (_, inner)) in fields.iter().enumerate() {
                take(inner, d, &within(wanted, place), numbers)?;
            }
        }
        Kind::Array(element, length) => take_elements(element, *length, d, wanted, numbers)?,
        Kind::Sequence(element) => {
            let length = usize::try_from(d.u32()?).ok()?;
            take_elements(element, length, d, wanted, numbers)?;
        }
    }
    Some(())
}

fn take_elements(
    element: &Kind,
    length: usize,
    d: &mut Decoder<'_>,
    wanted: &[(&[usize], usize)],
    numbers: &mut [Option<f64>],
) -> Option<()> {
    if let Kind::Number(number) = element
        && wanted.is_empty()
    {
        return d.skip(length, bytes(*number));
    }
    for place in 0..length {
        take(element, d, &within(wanted, place), numbers)?;
    }
    Some(())
}

/// The wanted paths within one field or element.
fn within<'a>(wanted: &[(&'a [usize], usize)], place: usize) -> Vec<(&'a [usize], usize)> {
    let inner = wanted.iter().filter_map(|(path, slot)| match path {
        [first, rest @ ..] if *first == place => Some((rest, *slot)),
        _ => None,
    });
    inner.collect()
}

/// The names of a message's numbers except those of its header, at most as many as are listed.
/// `None` if the bytes are no such message.
pub(super) fn names(kind: &Kind, d: &mut Decoder<'_>) -> Option<Vec<String>> {
    let mut names = Vec::new();
    add_names(kind, d, "", &mut names)?;
    names.retain(|name| !name.starts_with("header."));
    Some(names)
}

fn add_names(kind: &Kind, d: &mut Decoder<'_>, name: &str, names: &mut Vec<String>) -> Option<()> {
    let inner = |part: &str| match name {
        "" => part.to_owned(),
        _ => format!("{name}.{part}"),
    };
    let mut elements = |element: &Kind, length: usize, d: &mut Decoder<'_>| {
        (0..length).try_for_each(|place| add_names(element, d, &inner(&place.to_string()), names))
    };
    match kind {
        Kind::Number(number) => {
            take_number(d, *number)?;
            if names.len() < MOST_NAMES {
                names.push(name.to_owned());
            }
        }
        Kind::Text => d.skip_text()?,
        Kind::Message(fields) => {
            for (part, kind) in fields {
                add_names(kind, d, &inner(part), names)?;
            }
        }
        Kind::Array(element, length) => elements(element, *length, d)?,
        Kind::Sequence(element) => {
            let length = usize::try_from(d.u32()?).ok()?;
            elements(element, length, d)?;
        }
    }
    Some(())
}

fn take_number(d: &mut Decoder<'_>, number: Number) -> Option<f64> {
    Some(match number {
        Number::I8 => f64::from(d.i8()?),
        Number::U8 => f64::from(d.u8()?),
        Number::I16 => f64::from(d.i16()?),
        Number::U16 => f64::from(d.u16()?),
        Number::I32 => f64::from(d.i32()?),
        Number::U32 => f64::from(d.u32()?),
        Number::I64 => d.i64()? as f64, // numbers beyond 2^53 are rounded
        Number::U64 => d.u64()? as f64,
        Number::F32 => f64::from(d.f32()?),
        Number::F64 => d.f64()?,
    })
}

fn bytes(number: Number) -> usize {
    match number {
        Number::I8 | Number::U8 => 1,
        Number::I16 | Number::U16 => 2,
        Number::I32 | Number::U32 | Number::F32 => 4,
        Number::I64 | Number::U64 | Number::F64 => 8,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cdr::Encoder;

    const TEXT: &str = "Part part\nPart[] parts\nfloat64[2] pair\nstring name\nuint16 last\n===\nMSG: p/Part\nint8 a\nfloat32 b\n";

    fn kind() -> Kind {
        Kind::of_message("p/msg/All", TEXT).unwrap()
    }

    /// A message with two parts.
    fn message() -> Vec<u8> {
        let mut bytes = Vec::new();
        let e = &mut Encoder::new(&mut bytes);
        let put_part = |e: &mut Encoder<'_>, a: u8, b: f32| {
            e.u8(a);
            e.u32(b.to_bits());
        };
        put_part(e, 0xFF, 0.5);
        e.sequence([(1, 1.5), (2, 2.5)].into_iter(), |e, (a, b)| put_part(e, a, b));
        e.f64(-3.0);
        e.f64(4.0);
        e.string("µ");
        // A padding byte, then the number.
        [0, 7, 0].into_iter().for_each(|byte| e.u8(byte));
        bytes
    }

    #[test]
    fn a_name_is_a_path_or_the_only_end_of_one() {
        let kind = kind();
        for (name, path) in [
            ("part.a", Some(vec![0, 0])),
            ("a", Some(vec![0, 0])),
            ("parts.7.b", Some(vec![1, 7, 1])),
            ("pair.1", Some(vec![2, 1])),
            ("pair.2", None),
            ("pair", None),
            ("name", None),
            ("7.b", None),
            ("last", Some(vec![4])),
            ("", None),
        ] {
            assert_eq!(find(&kind, name), path, "{name}");
        }
        let twice = Kind::of_message("p/msg/Two", "Part one\nPart two\n===\nMSG: p/Part\nint8 a\n").unwrap();
        assert_eq!(find(&twice, "a"), None);
        assert_eq!(find(&twice, "two.a"), Some(vec![1, 0]));
    }

    #[test]
    fn numbers_are_taken_wherever_they_stand() {
        let (kind, bytes) = (kind(), message());
        let names = [
            "part.a",
            "part.b",
            "parts.1.a",
            "parts.1.b",
            "parts.2.b",
            "pair.0",
        ];
        let paths = names.map(|name| find(&kind, name).unwrap());
        let wanted: Vec<(&[usize], usize)> = paths.iter().map(Vec::as_slice).zip(0..).collect();
        let mut numbers = [None; 6];
        take(
            &kind,
            &mut Decoder::of_others(&bytes).unwrap(),
            &wanted,
            &mut numbers,
        )
        .unwrap();
        let expected = [Some(-1.0), Some(0.5), Some(2.0), Some(2.5), None, Some(-3.0)];
        assert_eq!(numbers, expected);
        for end in 0..bytes.len() {
            let decoder = Decoder::of_others(&bytes[..end]);
            let taken = decoder.and_then(|mut d| take(&kind, &mut d, &[], &mut []));
            assert_eq!(taken, None, "{end} bytes");
        }
    }

    #[test]
    fn names_are_those_of_the_elements_that_are_there() {
        let found = names(&kind(), &mut Decoder::of_others(&message()).unwrap()).unwrap();
        let expected = [
            "part.a",
            "part.b",
            "parts.0.a",
            "parts.0.b",
            "parts.1.a",
            "parts.1.b",
            "pair.0",
            "pair.1",
            "last",
        ];
        assert_eq!(found, expected);
    }
}
