//! Python sources without what no program is made of.

/// The lines of a source without comments, docstrings and empty lines. A comment behind code counts
/// as code.
pub(super) fn without_comments(text: &str) -> String {
    let mut kept: Vec<&str> = Vec::new();
    // Whether a string of several lines is not closed yet, and whether it counts.
    let mut open: Option<bool> = None;
    for line in text.lines() {
        let code = line.trim();
        let counts = open.unwrap_or_else(|| !is_docstring(code, kept.last()));
        if counts && (open.is_some() || !code.is_empty() && !code.starts_with('#')) {
            kept.push(line);
        }
        let has_odd_quotes = line.matches(QUOTES).count() % 2 == 1;
        open = if open.is_some() == has_odd_quotes {
            None
        } else {
            Some(counts)
        };
    }
    kept.join("\n")
}

const QUOTES: &str = "\"\"\"";

/// Whether a line begins a string that is a statement of its own, not a part of one that the line
/// before begins.
fn is_docstring(code: &str, before: Option<&&str>) -> bool {
    let goes_on = before.is_some_and(|line| line.trim_end().ends_with(['(', '[', '{', ',', '=', '+', '\\']));
    code.starts_with(QUOTES) && !goes_on
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn code_is_what_is_left() {
        let bare = "def two() -> int:\n    return 2";
        for same in [
            "\"\"\"Numbers.\"\"\"\n\n# The first.\ndef two() -> int:\n    \"\"\"Two.\"\"\"\n    return 2\n",
            "def two() -> int:\n    \"\"\"Two.\n\n    Returns 2.\n    \"\"\"\n    return 2",
            "\"\"\"\nNumbers.\n\"\"\"\ndef two() -> int:\n    return 2",
        ] {
            assert_eq!(without_comments(same), bare, "{same}");
        }
        for other in [
            "def two() -> int:\n    return 3",
            "def two() -> int:\n    # return 2\n    pass",
            "def two() -> int:\n    print(\n        \"\"\"Two.\"\"\"\n    )\n    return 2",
        ] {
            assert_ne!(without_comments(other), bare, "{other}");
        }
    }

    #[test]
    fn strings_count_as_they_stand() {
        let page = "PAGE = \"\"\"\n# Numbers\n\n{}\n\"\"\"\nprint(PAGE)";
        assert_eq!(without_comments(page), page);
    }
}
