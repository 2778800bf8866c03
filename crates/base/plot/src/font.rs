//! The embedded font: widths of texts and outlines of letters, so that no picture needs a font of the system.

use ttf_parser::{Face, GlyphId};

/// Parses the font; `None` only if the embedded file were damaged, which a test excludes.
pub(crate) fn face() -> Option<Face<'static>> {
    Face::parse(epaint_default_fonts::UBUNTU_LIGHT, 0).ok()
}

/// Letters of `text` with the distance of each from the start, and the width of all, in em.
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

/// Width of `text` in px at `size` px, with the slack that a browser's own font may take.
pub fn text_width(text: &str, size: f64) -> f64 {
    face().map_or(0.0, |face| layout(&face, text).1 * size * 1.06)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sign_that_plots_use_is_in_the_font() {
        let face = face().unwrap();
        for sign in "0123456789.−±×·µ°%\u{a0}–—…²³abcXYZ()/".chars() {
            assert!(face.glyph_index(sign).is_some(), "no glyph for {sign}");
        }
    }

    #[test]
    fn width_grows_with_the_text_and_its_size() {
        assert!(text_width("pressure, kPa", 12.0) > text_width("pressure", 12.0));
        assert!((text_width("kPa", 24.0) / text_width("kPa", 12.0) - 2.0).abs() < 1e-12);
        assert_eq!(text_width("", 12.0), 0.0);
    }
}
