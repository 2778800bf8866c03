//! Definitions of messages, as ROS 2 writes them into its recordings (`ros2msg`).
//!
//! Source: ROS 2 documentation, "Interfaces", field types and constants; the MCAP format's
//! registry, "ros2msg": the definitions of nested messages follow, separated by a line of `=`.

use std::collections::BTreeMap;

/// Largest nesting depth and size of a message that is read.
const DEEPEST: usize = 32;
const MOST_FIELDS: usize = 10_000;

/// Text before the name of a nested message.
const NAME: &str = "MSG: ";

/// The structure of a message or of a part of one.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Kind {
    Number(Number),
    Text,
    /// Fields in order, with their names.
    Message(Vec<(String, Self)>),
    /// A fixed number of elements.
    Array(Box<Self>, usize),
    /// A number of elements that the message states.
    Sequence(Box<Self>),
}

/// The type of a number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

/// The definitions of a message and its nested messages.
struct Definitions<'a> {
    /// Lines of each message, by its name `package/Type`.
    lines: BTreeMap<String, Vec<&'a str>>,
    n_fields: usize,
}

impl Kind {
    /// The structure of a message of the type `name`, such as `std_msgs/msg/String`.
    ///
    /// # Errors
    /// A definition that cannot be read, as a text for people.
    pub(super) fn of_message(name: &str, text: &str) -> Result<Self, String> {
        let name = short(name);
        let (mut lines, mut current) = (BTreeMap::<String, Vec<&str>>::new(), name.clone());
        let mut own = Vec::new();
        for line in text.lines().map(without_comment) {
            if let Some(next) = line.strip_prefix(NAME) {
                let known = std::mem::replace(&mut current, short(next.trim()));
                let own = std::mem::take(&mut own);
                lines.entry(known).or_insert(own); // definitions that occur twice are the same
            } else if !line.is_empty() && !line.starts_with("===") {
                own.push(line);
            }
        }
        lines.entry(current).or_insert(own);
        let mut definitions = Definitions { lines, n_fields: 0 };
        definitions.message(&name, 0)
    }
}

impl Definitions<'_> {
    fn message(&mut self, name: &str, depth: usize) -> Result<Kind, String> {
        let lines = self.lines.get(name).cloned();
        let lines = lines.ok_or_else(|| format!("the definition of {name} is not in the bag"))?;
        let package = name.split('/').next().unwrap_or_default();
        let mut fields = Vec::new();
        for (kind, field) in lines.into_iter().filter_map(field) {
            self.n_fields += 1;
            if depth >= DEEPEST || self.n_fields > MOST_FIELDS {
                return Err(format!(
                    "{name} has too many fields, or they are nested too deeply"
                ));
            }
            fields.push((field.to_owned(), self.kind(kind, package, depth)?));
        }
        if fields.is_empty() {
            // ROS 2 writes one byte for a message without fields.
            fields.push((
                "structure_needs_at_least_one_member".to_owned(),
                Kind::Number(Number::U8),
            ));
        }
        Ok(Kind::Message(fields))
    }

    /// The structure of a field's type.
    fn kind(&mut self, text: &str, package: &str, depth: usize) -> Result<Kind, String> {
        if let Some((element, length)) = text.strip_suffix(']').and_then(|text| text.split_once('[')) {
            let element = Box::new(self.kind(element, package, depth)?);
            let is_bounded = length.is_empty() || length.starts_with("<=");
            return match length.parse() {
                _ if is_bounded => Ok(Kind::Sequence(element)),
                Ok(length) => Ok(Kind::Array(element, length)),
                Err(_) => Err(format!("`{text}` is not a type of a field")),
            };
        }
        let number = match text {
            "bool" | "byte" | "char" | "uint8" => Number::U8,
            "int8" => Number::I8,
            "int16" => Number::I16,
            "uint16" => Number::U16,
            "int32" => Number::I32,
            "uint32" => Number::U32,
            "int64" => Number::I64,
            "uint64" => Number::U64,
            "float32" => Number::F32,
            "float64" => Number::F64,
            _ if text == "string" || text.starts_with("string<=") => return Ok(Kind::Text),
            _ if text.starts_with("wstring") => return Err("it has strings of wide characters".to_owned()),
            "Header" => return self.message("std_msgs/Header", depth + 1),
            _ if text.contains('/') => return self.message(&short(text), depth + 1),
            _ => return self.message(&format!("{package}/{text}"), depth + 1),
        };
        Ok(Kind::Number(number))
    }
}

/// Type and name of the field that a line defines. `None` for a constant.
fn field(line: &str) -> Option<(&str, &str)> {
    let (kind, rest) = line.split_once(char::is_whitespace)?;
    let rest = rest.trim_start();
    let end = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_');
    let (name, behind) = rest.split_at(end.unwrap_or(rest.len()));
    (!behind.trim_start().starts_with('=')).then_some((kind, name))
}

fn without_comment(line: &str) -> &str {
    line.split('#').next().unwrap_or_default().trim()
}

/// The short name `package/Type` of `package/msg/Type`.
fn short(name: &str) -> String {
    name.replace("/msg/", "/")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ros::DEFINITIONS;

    fn number(name: &str, number: Number) -> (String, Kind) {
        (name.to_owned(), Kind::Number(number))
    }

    #[test]
    fn fields_of_all_kinds_are_read_and_constants_are_none() {
        let text = "# a comment\nuint8 GOOD=0\nstring NAME = \"a # b\"\nfloat32 RATE  =  2.5\n\n\
                    bool is_on # whether\nfloat64 gain 1.5\nstring<=10 label \"=\"\nint16[3] three\nuint32[] many\nbyte[<=4] few\n\
                    Part[] parts\nother/Empty nothing\n\
                    ================================================================================\n\
                    MSG: lab/Part\nint8 a\n\
                    ===\nMSG: other/msg/Empty\n# nothing\n\
                    ===\nMSG: lab/Part\nint8 a\n";
        let part = Kind::Message(vec![number("a", Number::I8)]);
        let empty = Kind::Message(vec![number("structure_needs_at_least_one_member", Number::U8)]);
        let expected = Kind::Message(vec![
            number("is_on", Number::U8),
            number("gain", Number::F64),
            ("label".to_owned(), Kind::Text),
            (
                "three".to_owned(),
                Kind::Array(Box::new(Kind::Number(Number::I16)), 3),
            ),
            (
                "many".to_owned(),
                Kind::Sequence(Box::new(Kind::Number(Number::U32))),
            ),
            (
                "few".to_owned(),
                Kind::Sequence(Box::new(Kind::Number(Number::U8))),
            ),
            ("parts".to_owned(), Kind::Sequence(Box::new(part))),
            ("nothing".to_owned(), empty),
        ]);
        assert_eq!(Kind::of_message("lab/msg/Frame", text), Ok(expected));
    }

    #[test]
    fn our_own_definitions_are_read() {
        for definition in DEFINITIONS {
            let kind = Kind::of_message(definition.name, definition.text);
            assert!(kind.is_ok(), "{}: {kind:?}", definition.name);
        }
    }

    #[test]
    fn what_cannot_be_read_says_why() {
        let endless = "A[] a\n===\nMSG: p/A\nA a\n";
        let wide: String = (0..40)
            .map(|n| format!("T{} a\nT{} b\n===\nMSG: p/T{}\n", n + 1, n + 1, n + 1))
            .collect();
        for (text, why) in [
            ("other/Part part\n", "other/Part is not in the bag"),
            ("Part part\n", "p/Part is not in the bag"),
            ("float32[x] a\n", "`float32[x]`"),
            ("wstring a\n", "wide"),
            (endless, "too many"),
            (&wide, "too many"),
        ] {
            let problem = Kind::of_message("p/msg/T0", text).unwrap_err();
            assert!(problem.contains(why), "{text}: {problem}");
        }
    }
}
