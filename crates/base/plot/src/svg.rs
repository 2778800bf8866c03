//! Paints a scene as SVG text: no scripts, no links, no font files, and the same bytes every time.

use std::fmt::Write as _;

use crate::color::Ink;
use crate::raster::rgb_png;
use crate::scene::{Anchor, Mark, Scene};

const FONTS: &str = "Inter,system-ui,-apple-system,'Segoe UI',Roboto,'Helvetica Neue',Ubuntu,sans-serif";

/// The scene as an SVG element that scales with its surroundings. The background is transparent.
///
/// Colours are plain attributes, so that every viewer shows them, and a page may restyle them by
/// their value.
#[must_use]
pub fn svg(scene: &Scene) -> String {
    svg_with_margin(scene, 0.0)
}

pub(crate) fn svg_with_margin(scene: &Scene, margin: f64) -> String {
    let mut out = String::new();
    let [[x0, y0], [x1, y1]] = scene.painted(margin);
    let (x, y, width, height) = (number(x0), number(y0), number(x1 - x0), number(y1 - y0));
    let name = escape(&scene.name);
    let _ = write!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"{x} {y} {width} {height}\" width=\"{width}\" \
         height=\"{height}\" role=\"img\" aria-label=\"{name}\" font-family=\"{FONTS}\">",
    );
    for mark in &scene.marks {
        paint(&mut out, mark);
    }
    out.push_str("</svg>");
    out
}

fn paint(out: &mut String, mark: &Mark) {
    let _ = match mark {
        Mark::Line {
            points,
            ink,
            width,
            dashed,
        } => {
            let dash = if *dashed { " stroke-dasharray=\"4 3\"" } else { "" };
            let (path, ink, width) = (path(points), ink.hex(), number(*width));
            write!(
                out,
                "<path d=\"{path}\" fill=\"none\" stroke=\"{ink}\" stroke-width=\"{width}\" \
                 stroke-linejoin=\"round\"{dash}/>"
            )
        }
        Mark::Area { points, ink, opacity } => {
            let (path, ink, faint) = (path(points), ink.hex(), faint(*opacity));
            write!(out, "<path d=\"{path}Z\" fill=\"{ink}\"{faint}/>")
        }
        Mark::Circle {
            centre: [x, y],
            radius,
            fill,
            stroke,
            opacity,
        } => {
            let (x, y, radius) = (number(*x), number(*y), number(*radius));
            let fill = fill.map_or("none".into(), Ink::hex);
            let stroke = stroke.map_or(String::new(), |ink| {
                format!(" stroke=\"{}\" stroke-width=\"1.25\"", ink.hex())
            });
            let faint = faint(*opacity);
            write!(
                out,
                "<circle cx=\"{x}\" cy=\"{y}\" r=\"{radius}\" fill=\"{fill}\"{faint}{stroke}/>"
            )
        }
        Mark::Text { .. } => text(out, mark),
        Mark::Image {
            at: [x, y],
            size: [width, height],
            columns,
            pixels,
        } => {
            let data = rgb_png(*columns, pixels)
                .map(|png| base64(&png))
                .unwrap_or_default();
            let (x, y, width, height) = (number(*x), number(*y), number(*width), number(*height));
            write!(
                out,
                "<image x=\"{x}\" y=\"{y}\" width=\"{width}\" height=\"{height}\" \
                 preserveAspectRatio=\"none\" href=\"data:image/png;base64,{data}\"/>"
            )
        }
    };
}

fn text(out: &mut String, mark: &Mark) -> std::fmt::Result {
    let Mark::Text {
        at: [x, y],
        text,
        size,
        ink,
        anchor,
        bold,
        upwards,
    } = mark
    else {
        return Ok(());
    };
    let anchor = match anchor {
        Anchor::Start => "",
        Anchor::Middle => " text-anchor=\"middle\"",
        Anchor::End => " text-anchor=\"end\"",
    };
    let (x, y) = (number(*x), number(*y));
    let weight = if *bold { " font-weight=\"600\"" } else { "" };
    let turn = if *upwards {
        format!(" transform=\"rotate(-90 {x} {y})\"")
    } else {
        String::new()
    };
    let (size, ink, text) = (number(*size), ink.hex(), escape(text));
    // The text gets the width that the layout gave it, whatever font the viewer has.
    let room = number(mark.text_width());
    write!(
        out,
        "<text x=\"{x}\" y=\"{y}\" font-size=\"{size}\" fill=\"{ink}\" textLength=\"{room}\" \
         lengthAdjust=\"spacingAndGlyphs\"{anchor}{weight}{turn}>{text}</text>"
    )
}

fn faint(opacity: f64) -> String {
    if opacity < 1.0 {
        format!(" fill-opacity=\"{}\"", number(opacity))
    } else {
        String::new()
    }
}

fn path(points: &[[f64; 2]]) -> String {
    let mut out = String::with_capacity(points.len() * 10);
    for (index, &[x, y]) in points.iter().enumerate() {
        out.push_str(if index == 0 { "M" } else { " " });
        out.push_str(&number(x));
        out.push(',');
        out.push_str(&number(y));
    }
    out
}

/// At most two decimals, without trailing zeros: files stay small, and a hundredth of a pixel is
/// accurate enough.
fn number(value: f64) -> String {
    let text = format!("{value:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

/// Escapes text for HTML and XML, in content and in quoted attributes.
pub(crate) fn escape(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for letter in text.chars() {
        match letter {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            '\'' => out.push_str("&#39;"),
            '\n' | '\t' => out.push(letter),
            control if control.is_control() => out.push('\u{fffd}'),
            other => out.push(other),
        }
    }
    out
}

fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let mut word = [0u8; 3];
        word[..chunk.len()].copy_from_slice(chunk);
        let word = u32::from_be_bytes([0, word[0], word[1], word[2]]);
        for digit in 0..4 {
            let filled = digit <= chunk.len();
            let index = (word >> (18 - 6 * digit)) & 63;
            out.push(if filled {
                char::from(DIGITS[index as usize])
            } else {
                '='
            });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn base64_of_rfc_4648() {
        for (plain, coded) in [
            ("", ""),
            ("f", "Zg=="),
            ("fo", "Zm8="),
            ("foo", "Zm9v"),
            ("foobar", "Zm9vYmFy"),
        ] {
            assert_eq!(base64(plain.as_bytes()), coded);
        }
    }

    #[test]
    fn names_and_texts_cannot_break_out() {
        let mut scene = Scene::new("\"><script>", 10.0, 10.0);
        scene.small(
            [1.0, 1.0],
            "</text><script>alert(1)</script>",
            Ink::Text,
            Anchor::Start,
        );
        assert!(!svg(&scene).contains("<script"));
    }

    #[test]
    fn what_is_not_finite_is_not_painted() {
        let mut scene = Scene::new("gap", 10.0, 10.0);
        scene.line(
            [[0.0, 0.0], [1.0, 1.0], [f64::NAN, 2.0], [3.0, 3.0], [4.0, 4.0]],
            Ink::Text,
            1.0,
        );
        scene.dot([f64::INFINITY, 0.0], 1.0, Ink::Text, 1.0);
        scene.rectangle([0.0, f64::NAN], [1.0, 1.0], Ink::Text, 1.0);
        let text = svg(&scene);
        assert_eq!(text.matches("<path").count(), 2);
        assert!(!text.contains("NaN") && !text.contains("inf") && !text.contains("<circle"));
    }

    #[test]
    fn numbers_are_short() {
        assert_eq!((number(1.0), number(-0.001), number(2.505)).0, "1");
        assert_eq!(number(-0.001), "0");
        assert_eq!(number(0.25), "0.25");
    }
}
