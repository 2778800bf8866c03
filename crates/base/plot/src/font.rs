//! The embedded font: widths of texts and outlines of letters, so that no picture needs a font of
//! the system.

use ttf_parser::{Face, GlyphId};

/// Factor by which texts may be wider in a browser's own font than in the embedded one; `svg` makes
/// the browser keep to it.
const SLACK: f64 = 1.06;
/// The same factor for bold texts, which are wider.
const BOLD_SLACK: f64 = 1.12;

/// Parses the font; `None` only if the embedded file is damaged, which a test excludes.
pub(crate) fn face() -> Option<Face<'static>> {
    Face::parse(epaint_default_fonts::UBUNTU_LIGHT, 0).ok()
}

/// Glyphs of `text` with the distance of each from the start, and the width of the text, in em.
pub(crate) fn layout(face: &Face<'_>, text: &str) -> (Vec<(GlyphId, f64)>, f64) {
    let em = f64::from(face.units_per_em());
    let mut pen = 0.0;
    let letters = text
        .chars()
        .map(|letter| {
            let glyph = face.glyph_index(letter).unwrap_or_default();
            let start = pen;
            pen += f64::from(face.glyph_hor_advance(glyph).unwrap_or_default()) / em;
            (glyph, start)
        })
        .collect();
    (letters, pen)
}

/// Width that the layout reserves for a text of font size `size` px, px.
#[must_use]
pub fn text_width(text: &str, size: f64) -> f64 {
    face().map_or(0.0, |face| layout(&face, text).1 * size * SLACK)
}

/// Like [`text_width`], for bold text.
pub(crate) fn bold_width(text: &str, size: f64) -> f64 {
    text_width(text, size) * BOLD_SLACK / SLACK
}

/// The largest width of the texts, px; 0 without texts.
pub(crate) fn widest<'a>(texts: impl IntoIterator<Item = &'a str>, size: f64) -> f64 {
    texts
        .into_iter()
        .map(|text| text_width(text, size))
        .fold(0.0, f64::max)
}

/// The text, shortened with dots if it is wider than `room` px.
pub(crate) fn fitted(text: &str, size: f64, room: f64) -> String {
    cut(text, room, |text| text_width(text, size))
}

fn cut(text: &str, room: f64, width: impl Fn(&str) -> f64) -> String {
    if width(text) <= room {
        return text.to_owned();
    }
    let mut rest = text.to_owned();
    while rest.pop().is_some() {
        let shown = format!("{}…", rest.trim_end());
        if width(&shown) <= room {
            return shown;
        }
    }
    String::new()
}

/// Bold text in lines of at most `room` px, broken between words.
pub(crate) fn bold_lines(text: &str, size: f64, room: f64) -> Vec<String> {
    let width = |text: &str| bold_width(text, size);
    let mut lines: Vec<String> = Vec::new();
    for word in text.split(' ') {
        match lines.last_mut() {
            Some(line) if width(&format!("{line} {word}")) <= room => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines.iter().map(|line| cut(line, room, width)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sign_that_plots_use_is_in_the_font() {
        let face = face().unwrap();
        for sign in "0123456789.−±×·µνσ°%\u{a0}–—…²³abcXYZ()/".chars() {
            assert!(face.glyph_index(sign).is_some(), "no glyph for {sign}");
        }
    }

    #[test]
    fn width_grows_with_the_text_and_its_size() {
        assert!(text_width("pressure, kPa", 12.0) > text_width("pressure", 12.0));
        assert!((text_width("kPa", 24.0) / text_width("kPa", 12.0) - 2.0).abs() < 1e-12);
        assert_eq!(text_width("", 12.0), 0.0);
    }

    #[test]
    fn long_texts_are_cut_or_broken_to_the_room_they_have() {
        let text = "a pressure of many words";
        assert_eq!(fitted(text, 11.0, 500.0), text);
        let cut = fitted(text, 11.0, 60.0);
        assert!(cut.ends_with('…') && text_width(&cut, 11.0) <= 60.0);
        assert_eq!(fitted(text, 11.0, 1.0), "");
        let lines = bold_lines(text, 13.0, 80.0);
        assert!(lines.len() > 1 && lines.iter().all(|line| bold_width(line, 13.0) <= 80.0));
        assert_eq!(lines.join(" "), text);
    }
}
