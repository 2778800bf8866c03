//! Rust sources without what no program is made of.

use proc_macro2::{Delimiter, Group, TokenStream, TokenTree};

/// The tokens of a source, comments and all that is compiled for tests alone left out; none where
/// it can't be read.
pub(super) fn without_comments_and_tests(text: &str) -> Option<String> {
    let tokens: TokenStream = text.parse().ok()?;
    Some(stripped(tokens).to_string())
}

fn stripped(tokens: TokenStream) -> TokenStream {
    let mut kept = Vec::new();
    let mut tokens = tokens.into_iter().peekable();
    while let Some(token) = tokens.next() {
        let is_hash = matches!(&token, TokenTree::Punct(punct) if punct.as_char() == '#');
        if is_hash {
            let mark =
                tokens.next_if(|next| matches!(next, TokenTree::Punct(punct) if punct.as_char() == '!'));
            let attribute = match tokens.peek() {
                Some(TokenTree::Group(group)) => attribute(group),
                _ => None,
            };
            match attribute {
                Some(Attribute::Comment) => drop(tokens.next()),
                Some(Attribute::Test) => {
                    // What it stands before ends with a semicolon or in braces.
                    tokens.find(|token| match token {
                        TokenTree::Punct(punct) => punct.as_char() == ';',
                        TokenTree::Group(group) => group.delimiter() == Delimiter::Brace,
                        _ => false,
                    });
                }
                None => kept.extend([Some(token), mark].into_iter().flatten()),
            }
            continue;
        }
        kept.push(match token {
            TokenTree::Group(group) => {
                TokenTree::Group(Group::new(group.delimiter(), stripped(group.stream())))
            }
            other => other,
        });
    }
    kept.into_iter().collect()
}

enum Attribute {
    Comment,
    Test,
}

/// What the brackets of an attribute say, if it does not count.
fn attribute(group: &Group) -> Option<Attribute> {
    let text = group.stream().to_string();
    if text.starts_with("doc =") {
        Some(Attribute::Comment)
    } else if text.replace(' ', "") == "cfg(test)" {
        Some(Attribute::Test)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used)]
    use super::*;

    #[test]
    fn code_is_what_is_left() {
        let code = |text: &str| without_comments_and_tests(text).unwrap();
        let bare = "pub fn two() -> u32 { 2 }";
        for same in [
            "//! Crate.\n/// Two.\npub fn two() -> u32 { /* a number */ 2 }",
            "pub fn two() -> u32 {\n    2\n}\n#[cfg(test)]\nmod tests { fn a() {} }",
            "#[cfg(test)]\nmod tests;\npub fn two() -> u32 { 2 }",
            "#[cfg(test)]\n#[derive(Debug)]\nstruct Three;\npub fn two() -> u32 { 2 }",
        ] {
            assert_eq!(code(same), code(bare), "{same}");
        }
        for other in [
            "pub fn two() -> u32 { 3 }",
            "#[inline]\npub fn two() -> u32 { 2 }",
            "#[cfg(test)]\nmod tests;\nfn two() -> u32 { 2 }",
        ] {
            assert_ne!(code(other), code(bare), "{other}");
        }
    }
}
