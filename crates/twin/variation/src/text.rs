//! The file of the sensor variation: every line with a comment.

use crate::width::rounded;

/// Largest length of a comment line, in characters.
const LONGEST: usize = 140;

/// A field of the file.
pub struct Line {
    /// Its name.
    pub field: &'static str,
    /// The value with its source, or why there is none.
    pub said: Result<Given, String>,
}

/// A value that was found.
pub struct Given {
    /// The value, in the unit of the field.
    pub value: f64,
    /// Its source, and the number of values that it is estimated from.
    pub comment: String,
}

impl Line {
    /// A field that was found.
    #[must_use]
    pub fn given(field: &'static str, value: f64, comment: String) -> Self {
        Self {
            field,
            said: Ok(Given { value, comment }),
        }
    }

    /// A field that was not found, and why.
    #[must_use]
    pub fn left_out(field: &'static str, why: impl Into<String>) -> Self {
        Self {
            field,
            said: Err(why.into()),
        }
    }
}

/// The file's text. Values have three significant digits.
#[must_use]
pub fn text(sensor: &str, command: &str, lines: &[Line]) -> String {
    let mut text = comment(&format!("Variation of sensors like {sensor}, found by"));
    text += &format!("#   {command}\n");
    text += &comment(
        "`±` is a standard error. Values that could not be found are left out, with the reason. Fill them in by hand if you know them.",
    );
    text += "\n[variation]\n";
    for Line { field, said } in lines {
        match said {
            Ok(given) => {
                text += &comment(&given.comment);
                text += &format!("{field} = {:?}\n", rounded(given.value, 3));
            }
            Err(why) => text += &comment(&format!("{field} is left out: {why}.")),
        }
    }
    text
}

/// Text as comment lines.
fn comment(words: &str) -> String {
    let mut lines = String::new();
    let mut line = String::from("#");
    for word in words.split_whitespace() {
        if line.chars().count() + 1 + word.chars().count() > LONGEST {
            lines += &line;
            lines.push('\n');
            "#".clone_into(&mut line);
        }
        line.push(' ');
        line += word;
    }
    lines + &line + "\n"
}

#[cfg(test)]
mod tests {
    use twintac_sensors::SensorVariation;

    use super::*;

    #[test]
    fn a_file_is_read_back_and_each_value_has_a_comment_before_it() {
        let lines = [
            Line::given("gain_deviation", 0.123_456, "gains ".repeat(60)),
            Line::left_out("jitter", "nobody looked"),
            Line::given("quantum_kpa", 3.051_757e-5, "steps".to_owned()),
        ];
        let text = text("a", "twintac fast variation --model b", &lines);
        let found = SensorVariation::parse("a.toml", &text).unwrap();
        let expected = SensorVariation {
            gain_deviation: 0.123,
            quantum_kpa: 3.05e-5,
            ..SensorVariation::default()
        };
        assert_eq!(found, expected);
        let lines: Vec<&str> = text.lines().collect();
        assert!(lines.iter().all(|line| line.chars().count() <= LONGEST), "{text}");
        let mut values = (0..lines.len()).filter(|line| lines[*line].contains(" = "));
        assert!(values.all(|line| lines[line - 1].starts_with("# ")), "{text}");
        assert!(text.contains("# jitter is left out: nobody looked."), "{text}");
    }
}
