//! Errors name file, line and field, in every way in which a file can be wrong.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use serde::Deserialize;
use twintac_config::{Checked, ConfigError, Ranges, parse, read};

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct File {
    #[allow(dead_code)]
    gel: Gel,
    #[allow(dead_code)]
    #[serde(default)]
    taxels: Vec<Taxel>,
    #[allow(dead_code)]
    tip: Option<Tip>,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Gel {
    #[allow(dead_code)]
    height_mm: f64,
}

#[derive(Debug, Deserialize)]
#[serde(deny_unknown_fields)]
struct Taxel {
    #[allow(dead_code)]
    x_mm: f64,
}

#[derive(Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case", deny_unknown_fields)]
enum Tip {
    Sphere {
        #[allow(dead_code)]
        radius_mm: f64,
    },
}

const GOOD: &str = "[gel]\nheight_mm = 1.0\n\n[[taxels]]\nx_mm = 1\n\n[[taxels]]\nx_mm = 2.5\n";

fn error(text: &str) -> ConfigError {
    parse::<File>("a.toml", text).unwrap_err()
}

#[track_caller]
fn expect(text: &str, line: usize, field: &str, problem: &str) {
    let found = error(text);
    assert_eq!((found.line, found.field.as_str()), (line, field), "{found}");
    assert!(found.problem.contains(problem), "{found}");
    assert!(
        found
            .to_string()
            .starts_with(&format!("a.toml:{line}: `{field}` ")),
        "{found}"
    );
}

#[test]
fn a_good_file_is_read() {
    let document = parse::<File>("a.toml", GOOD).unwrap();
    assert_eq!(document.value.taxels.len(), 2);
}

#[test]
fn text_that_is_not_toml() {
    expect("[gel]\nheight_mm = = 1\n", 2, "height_mm = = 1", "is not TOML");
    expect("[gel\nheight_mm = 1\n", 1, "[gel", "is not TOML");
    expect(
        "[gel]\nheight_mm = 1\nheight_mm = 2\n",
        3,
        "height_mm = 2",
        "duplicate key",
    );
}

#[test]
fn a_wrong_type() {
    expect(
        &GOOD.replace("2.5", "\"2.5\""),
        8,
        "taxels[1].x_mm",
        "expected f64",
    );
    expect(
        "taxels = 3\n[gel]\nheight_mm = 1.0\n",
        1,
        "taxels",
        "expected a sequence",
    );
}

#[test]
fn an_unknown_field() {
    expect(
        &GOOD.replace("height_mm", "heigth_mm"),
        2,
        "gel.heigth_mm",
        "expected `height_mm`",
    );
    expect(&format!("color = 3\n{GOOD}"), 1, "color", "unknown field");
    let tip = format!("{GOOD}\n[tip]\nkind = \"sphere\"\nradius_mm = 1\nraduis_mm = 1\n");
    expect(&tip, 13, "tip.raduis_mm", "unknown field");
}

#[test]
fn a_missing_field() {
    expect("# nothing\n", 1, "gel", "missing field");
    expect(
        &GOOD.replace("x_mm = 1\n", "\n"),
        4,
        "taxels[0].x_mm",
        "missing field",
    );
    expect(
        &format!("{GOOD}\n[tip]\nkind = \"sphere\"\n"),
        10,
        "tip.radius_mm",
        "missing field",
    );
    expect(
        &format!("{GOOD}\n[tip]\nkind = \"cone\"\n"),
        11,
        "tip.kind",
        "unknown variant",
    );
}

#[test]
fn numbers_that_are_not_finite() {
    for number in ["nan", "inf", "-inf", "1e999"] {
        expect(
            &GOOD.replace("2.5", number),
            8,
            "taxels[1].x_mm",
            &number.replace("+", ""),
        );
    }
    expect(
        "[gel]\nheight_mm = [\n  1,\n  nan,\n]\n",
        4,
        "gel.height_mm[1]",
        "nan",
    );
}

#[test]
fn findings_are_placed_at_the_field_or_its_nearest_parent() {
    let document = parse::<File>("a.toml", GOOD).unwrap();
    let line = |field: &str| document.error(field, "is odd", "change it").line;
    assert_eq!(line("gel"), 1);
    assert_eq!(line("gel.height_mm"), 2);
    assert_eq!(line("gel.width_mm"), 1);
    assert_eq!(line("taxels[1]"), 7);
    assert_eq!(line("taxels[1].x_mm"), 8);
    assert_eq!(line("taxels[7].x_mm"), 4);
    assert_eq!(line("nothing"), 1);
    assert!(document.has("taxels[1].x_mm") && !document.has("taxels[2]") && !document.has("gel.width_mm"));
}

#[test]
fn a_file_that_cannot_be_read() {
    let found = read::<File>("no/such.toml").unwrap_err();
    assert_eq!(found.line, 0);
    assert!(
        found.to_string().starts_with("no/such.toml: cannot be read: "),
        "{found}"
    );
}

#[derive(Deserialize)]
struct Fit {
    limits_mm: Vec<f64>,
    tip: Size,
}

#[derive(Deserialize)]
struct Size {
    n_places: usize,
    shift_mm: f64,
}

impl Checked for Fit {
    fn check(&self, ranges: &mut Ranges) {
        let Self { limits_mm, tip } = self;
        ranges.numbers("limits_mm", limits_mm, 3, 0.1..=1e9);
        ranges.rising("limits_mm", limits_mm);
        ranges.inside("tip", tip);
    }
}

impl Checked for Size {
    fn check(&self, ranges: &mut Ranges) {
        let Self { n_places, shift_mm } = self;
        ranges.number("n_places", *n_places, 1.0..=20.0);
        ranges.zero_or("shift_mm", *shift_mm, 0.01..=5.0);
    }
}

#[test]
fn a_number_beyond_its_range_is_named_with_its_line_and_what_it_may_be() {
    let good = "limits_mm = [1.0, 2.0]\n[tip]\nn_places = 5\nshift_mm = 0.0\n";
    let checked = |text: &str| parse::<Fit>("a.toml", text).unwrap().checked();
    assert!(checked(good).is_ok());
    for (right, wrong, expected) in [
        (
            "1.0, 2.0",
            "1.0, 1e300",
            "a.toml:1: `limits_mm[1]` is 1e300; give 0.1 to 1e9",
        ),
        (
            "1.0, 2.0",
            "2.0, 1.0",
            "a.toml:1: `limits_mm` is [2.0, 1.0]; give increasing numbers",
        ),
        (
            "1.0, 2.0",
            "1, 2, 3, 4",
            "a.toml:1: `limits_mm` has 4 numbers; give 3 at most",
        ),
        ("= 5", "= 0", "a.toml:3: `tip.n_places` is 0; give 1 to 20"),
        (
            "= 0.0",
            "= -5",
            "a.toml:4: `tip.shift_mm` is -5; give 0, or 0.01 to 5",
        ),
        (
            "= 0.0",
            "= 1e-300",
            "a.toml:4: `tip.shift_mm` is 1e-300; give 0, or 0.01 to 5",
        ),
    ] {
        let error = checked(&good.replace(right, wrong)).err().unwrap();
        assert_eq!(error.to_string(), expected);
    }
    let size = Size {
        n_places: 3,
        shift_mm: f64::NAN,
    };
    assert_eq!(
        size.checked().unwrap_err().to_string(),
        "`shift_mm` is NaN; give 0, or 0.01 to 5"
    );
}
