//! Text in a page of Markdown.

use crate::visible;

/// The text as one line of Markdown that shows each character literally: it makes no tags, links,
/// table cells or emphasis.
#[must_use]
pub fn markdown(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for letter in visible(text).chars() {
        match letter {
            '&' => shown.push_str("&amp;"),
            '<' => shown.push_str("&lt;"),
            '>' => shown.push_str("&gt;"),
            '\n' | '\t' => shown.push(' '),
            '\\' | '`' | '*' | '[' | ']' | '|' | '~' => shown.extend(['\\', letter]),
            other => shown.push(other),
        }
    }
    shown
}

/// The text as a block of code. `language` may be empty. Nothing in the text ends the block.
#[must_use]
pub fn fenced(language: &str, text: &str) -> String {
    let runs = text.split(|letter| letter != '`').map(str::len);
    let fence = "`".repeat(runs.max().unwrap_or(0).max(2) + 1);
    format!(
        "{fence}{language}\n{}\n{fence}\n",
        visible(text).trim_end_matches('\n')
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_is_a_text() {
        assert_eq!(markdown("sphere_25-a #1"), "sphere_25-a #1");
        assert_eq!(
            markdown("<img src=x onerror=alert(1)> & |x| [a](b) `c` *d*\n# e"),
            "&lt;img src=x onerror=alert(1)&gt; &amp; \\|x\\| \\[a\\](b) \\`c\\` \\*d\\* # e"
        );
        assert_eq!(markdown("\u{1b}[2J"), "\\\\u001b\\[2J");
    }

    #[test]
    fn a_block_ends_where_it_should() {
        assert_eq!(fenced("toml", "a = 1\n"), "```toml\na = 1\n```\n");
        let tricky = fenced("", "````\n<b>\n```\n");
        assert!(
            tricky.starts_with("`````\n") && tricky.ends_with("\n`````\n"),
            "{tricky}"
        );
    }
}
