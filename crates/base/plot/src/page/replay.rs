//! Presses that a reader moves through, as HTML: data, a plan for each source, and a script.

use serde_json::json;

use super::block::{Badge, Replay};
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

/// The data as a JSON text that cannot end its element. What is no number is `null`.
fn data(replay: &Replay) -> String {
    let presses = replay.presses.iter().map(|press| {
        let values = press.values.iter();
        json!({
            "place": short(&press.place_mm),
            "depth": short(&press.depth_mm),
            "values": values
                .map(|frames| frames.iter().map(|frame| short(frame)).collect())
                .collect::<Vec<Vec<_>>>(),
        })
    });
    let data = json!({
        "bounds": replay.bounds_mm,
        "unit": replay.unit,
        "marks": replay.marks,
        "colours": VIRIDIS,
        "presses": presses.collect::<Vec<_>>(),
    });
    data.to_string().replace('<', "\\u003c")
}

/// Numbers with three decimals at most.
fn short(values: &[f64]) -> Vec<f64> {
    values
        .iter()
        .map(|value| (1000.0 * value).round() / 1000.0)
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::page::ReplayPress;

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
        assert!(
            html.contains("[1.0,2.0]") && html.contains("[[[null]]]"),
            "{html}"
        );
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
