//! Presses that a reader moves through, as HTML: data, a plan for each source, and a script.

use std::fmt::Write;

use super::block::{Badge, Replay, ReplayPress};
use crate::color::VIRIDIS;
use crate::svg::escape;

/// The script that moves all replays of a page.
pub(super) const SCRIPT: &str = include_str!("replay.js");

/// A replay, with its badges as HTML; nothing if it has no presses.
pub(super) fn replay(replay: &Replay, badge: impl Fn(&Badge) -> String) -> String {
    if replay.presses.is_empty() {
        return String::new();
    }
    let presses = replay.presses.iter();
    let options: String = presses
        .enumerate()
        .map(|(index, press)| format!("<option value=\"{index}\">{}</option>", escape(&press.name)))
        .collect();
    let badges = replay.sources.iter().map(|(name, source)| {
        let badge = badge(source);
        format!(
            "<figure><svg role=\"img\" aria-label=\"{0}\"></svg><figcaption>{0} {badge}</figcaption></figure>\n",
            escape(name)
        )
    });
    format!(
        "<div class=\"replay\">\n<script type=\"application/json\">{}</script>\n\
         <p class=\"controls\"><label>Press <select>{options}</select></label>\n\
         <label>Frame <input type=\"range\" min=\"0\" step=\"1\"></label>\n<output></output></p>\n\
         <div class=\"plans\">\n{}</div>\n\
         <noscript>The frames are shown by a script of this page, which is switched off here.</noscript>\n</div>\n",
        data(replay),
        badges.collect::<String>(),
    )
}

/// The data as JSON.
fn data(replay: &Replay) -> String {
    let presses: Vec<String> = replay.presses.iter().map(press).collect();
    let marks = replay
        .marks
        .iter()
        .map(|(name, at)| format!("[{},{}]", text(name), numbers(at)));
    let [low, high] = &replay.bounds_mm;
    format!(
        "{{\"bounds\":[{},{}],\"unit\":{},\"marks\":[{}],\"colours\":{:?},\"presses\":[{}]}}",
        numbers(low),
        numbers(high),
        text(&replay.unit),
        marks.collect::<Vec<_>>().join(","),
        VIRIDIS,
        presses.join(","),
    )
}

fn press(press: &ReplayPress) -> String {
    let sources = press.values.iter().map(|frames| {
        let frames = frames.iter().map(|values| numbers(values));
        format!("[{}]", frames.collect::<Vec<_>>().join(","))
    });
    format!(
        "{{\"place\":{},\"depth\":{},\"values\":[{}]}}",
        numbers(&press.place_mm),
        numbers(&press.depth_mm),
        sources.collect::<Vec<_>>().join(","),
    )
}

/// Numbers with three decimals at most; `null` for what is none.
fn numbers(values: &[f64]) -> String {
    let mut list = String::from("[");
    for (index, value) in values.iter().enumerate() {
        let comma = if index == 0 { "" } else { "," };
        let _ = if value.is_finite() {
            write!(list, "{comma}{}", (1000.0 * value).round() / 1000.0 + 0.0)
        } else {
            write!(list, "{comma}null")
        };
    }
    list + "]"
}

/// A JSON text that cannot end its element.
fn text(text: &str) -> String {
    let mut quoted = String::from("\"");
    for letter in text.chars() {
        match letter {
            '"' | '\\' | '<' | '>' | '&' | '\0'..='\x1f' | '\u{2028}' | '\u{2029}' => {
                let _ = write!(quoted, "\\u{:04x}", u32::from(letter));
            }
            _ => quoted.push(letter),
        }
    }
    quoted + "\""
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(replayed: &Replay) -> String {
        replay(replayed, |Badge(word)| word.clone())
    }

    #[test]
    fn names_cannot_leave_the_data_and_missing_readings_are_null() {
        let replayed = Replay {
            unit: "kPa".into(),
            bounds_mm: [[0.0, 0.0], [10.0, 5.0]],
            marks: vec![("</script><b>\"".into(), [1.0, -0.0])],
            sources: vec![("sensor".into(), Badge("real".into()))],
            presses: vec![ReplayPress {
                name: "<i>".into(),
                place_mm: [1.00049, 2.0],
                depth_mm: vec![0.5],
                values: vec![vec![vec![f64::NAN]]],
            }],
        };
        let html = shown(&replayed);
        assert!(html.contains("[1,2]") && html.contains("[[[null]]]"), "{html}");
        assert!(html.contains("&lt;i&gt;") && !html.contains("<b>"));
        assert_eq!(html.matches("</script>").count(), 1);
        assert!(
            shown(&Replay {
                presses: Vec::new(),
                ..replayed
            })
            .is_empty()
        );
    }
}
