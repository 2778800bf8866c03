//! Text without control characters for a terminal.

use std::borrow::Cow;
use std::fmt::Write;

/// The text with control characters (except for line breaks and tabs) and characters that change
/// the direction of writing replaced by escapes such as `\u001b`. Printed text then looks like what
/// it is. JSON keeps its meaning.
#[must_use]
pub fn visible(text: &str) -> Cow<'_, str> {
    if !text.contains(steers) {
        return Cow::Borrowed(text);
    }
    let mut shown = String::with_capacity(text.len() + 8);
    for letter in text.chars() {
        if steers(letter) {
            let _ = write!(shown, "\\u{:04x}", u32::from(letter)); // a string accepts everything
        } else {
            shown.push(letter);
        }
    }
    Cow::Owned(shown)
}

fn steers(letter: char) -> bool {
    letter.is_control() && !matches!(letter, '\n' | '\t')
        || matches!(letter, '\u{200e}' | '\u{200f}' | '\u{202a}'..='\u{202e}' | '\u{2066}'..='\u{2069}')
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_steers_a_terminal_is_shown_and_the_rest_stays() {
        let plain = "Größe 4 µm, \"a\\b\"\n\tin two lines, 手";
        assert!(matches!(visible(plain), Cow::Borrowed(text) if text == plain));
        assert_eq!(
            visible("\u{1b}[31mred\u{7}\r\u{9b}2J"),
            "\\u001b[31mred\\u0007\\u000d\\u009b2J"
        );
        assert_eq!(visible("a\u{202e}b"), "a\\u202eb");
    }
}
