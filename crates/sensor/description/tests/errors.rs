//! Every error in a description names file, line and field.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

use std::io;

use twintac_sensor::{Sensor, SensorError};

const GOOD: &str = r#"name = "small"
summary = "A small sensor"
source = "made up"
inferred = ["gel.solid.size_mm"]

[gel.solid]
kind = "block"
size_mm = [20.0, 10.0, 6.0]

[gel.material]
youngs_modulus_kpa = 60.0
poissons_ratio = 0.49
prony = [
  { weight = 0.1, time_s = 1.0 },
]
source = "made up"

[shell]
gap_mm = 1.0
height_mm = 5.0

[readout]
min_kpa = 50.0
max_kpa = 150.0
resolution_kpa = 0.01
rate_hz = 50.0

[[inclusions]]
name = "chip"
min_mm = [-2.0, -2.0, 0.0]
max_mm = [2.0, 2.0, 1.0]

[[taxels]]
name = "a"
position_mm = [0.0, 0.0, 1.0]
port_radius_mm = 0.5
channel = 0

[[taxels]]
name = "b"
position_mm = [8.0, 0.0, 0.0]
port_radius_mm = 0.5
channel = 1

[[indenters]]
name = "ball"
shape = { kind = "sphere", radius_mm = 2.0 }
"#;

fn no_files(path: &str) -> io::Result<Vec<u8>> {
    Err(io::Error::new(io::ErrorKind::NotFound, format!("no {path}")))
}

fn error(text: &str) -> SensorError {
    Sensor::parse("small.toml", text, &no_files).unwrap_err()
}

/// Replaces one line of the valid file and expects an error about `field` there, or at the line of
/// `at` if that is given.
#[track_caller]
fn expect_at(old: &str, new: &str, at: &str, field: &str, says: &str) {
    assert_eq!(GOOD.matches(old).count(), 1, "`{old}` must be there once");
    let text = GOOD.replace(old, new);
    let line = 1 + text.lines().position(|line| line.contains(at)).unwrap();
    let found = error(&text);
    assert_eq!((found.line, found.field.as_str()), (line, field), "{found}");
    assert!(
        found
            .to_string()
            .starts_with(&format!("small.toml:{line}: `{field}` ")),
        "{found}"
    );
    assert!(found.to_string().contains(says), "{found}");
}

#[track_caller]
fn expect(old: &str, new: &str, field: &str, says: &str) {
    expect_at(old, new, new, field, says);
}

#[test]
fn the_good_file_is_good() {
    let sensor = Sensor::parse("small.toml", GOOD, &no_files).unwrap();
    assert_eq!((sensor.taxels.len(), sensor.gel.material.prony.len()), (2, 1));
}

#[test]
fn a_taxel_outside_the_gel() {
    let text = GOOD.replace("[8.0, 0.0, 0.0]", "[18.0, 0.0, 0.0]");
    assert_eq!(
        error(&text).to_string(),
        "small.toml:41: `taxels[1].position_mm` is [18, 0, 0], outside the gel, which spans [-10, -5, 0] to [10, 5, 6]; \
         put the taxel into the gel"
    );
}

#[test]
fn taxels() {
    expect(
        "position_mm = [0.0, 0.0, 1.0]",
        "position_mm = [0.0, 0.0, 0.5]",
        "taxels[0].position_mm",
        "inside the rigid `chip`",
    );
    expect_at(
        "port_radius_mm = 0.5\nchannel = 1",
        "port_radius_mm = 0.0\nchannel = 1",
        "_mm = 0.0",
        "taxels[1].port_radius_mm",
        "above 0",
    );
}

#[test]
fn a_port_has_gel_above_it_and_a_place_of_its_own() {
    let [a, b] = ["position_mm = [0.0, 0.0, 1.0]", "position_mm = [8.0, 0.0, 0.0]"];
    for (old, new, field, says) in [
        (
            b,
            "position_mm = [8.0, 0.0, 6.0]",
            "taxels[1].position_mm",
            "free surface",
        ),
        (
            b,
            "position_mm = [0.0, 0.0, 1.0]",
            "taxels[1].position_mm",
            "0.00 mm from that of taxels[0]",
        ),
        (
            b,
            "position_mm = [0.7, 0.7, 1.0]",
            "taxels[1].position_mm",
            "overlap",
        ),
        (
            a,
            "position_mm = [7.1, 0.0, 0.0]",
            "taxels[1].position_mm",
            "overlap",
        ),
    ] {
        let place = if old == a { b } else { new };
        let text = GOOD.replace(old, new);
        let lines = text.lines().enumerate();
        let line = lines.filter(|(_, line)| *line == place).last().unwrap().0 + 1;
        let found = error(&text);
        assert_eq!((found.line, found.field.as_str()), (line, field), "{found}");
        assert!(found.to_string().contains(says), "{found}");
    }
    expect_at(
        "port_radius_mm = 0.5\nchannel = 1",
        "port_radius_mm = 30.0\nchannel = 1",
        "_mm = 30.0",
        "taxels[1].port_radius_mm",
        "whole rim",
    );
    for apart in ["[1.0, 0.0, 1.0]", "[0.0, 2.5, 0.0]"] {
        let beside = GOOD.replace("[8.0, 0.0, 0.0]", apart);
        Sensor::parse("small.toml", &beside, &no_files).unwrap();
    }
}

#[test]
fn a_readout_has_the_air_in_its_range_and_limits_leave_gel() {
    expect(
        "min_kpa = 50.0",
        "min_kpa = 110.0",
        "readout.min_kpa",
        "pressure of the air",
    );
    expect(
        "max_kpa = 150.0",
        "max_kpa = 100.0",
        "readout.max_kpa",
        "pressure of the air",
    );
    let with_limits = |depth: &str| {
        let limits = format!("[limits]\nforce_n = 20.0\ndepth_mm = {depth}\n\n[[inclusions]]");
        GOOD.replace("[[inclusions]]", &limits)
    };
    Sensor::parse("small.toml", &with_limits("5.0"), &no_files).unwrap();
    let found = error(&with_limits("6.0"));
    assert_eq!(found.field, "limits.depth_mm");
    assert!(found.to_string().contains("6 mm high"), "{found}");
}

#[test]
fn a_port_may_reach_over_the_gels_side() {
    let wide = GOOD.replace(
        "port_radius_mm = 0.5\nchannel = 1",
        "port_radius_mm = 2.5\nchannel = 1",
    );
    assert_ne!(wide, GOOD);
    Sensor::parse("small.toml", &wide, &no_files).unwrap();
}

#[test]
fn names_and_channels() {
    expect(
        "name = \"small\"",
        "name = \"a/b\"",
        "name",
        "the name can be used for files",
    );
    expect("name = \"ball\"", "name = \"\"", "indenters[0].name", "is ``");
    expect_at(
        "name = \"b\"\n",
        "name = \"a\"  # again\n",
        "again",
        "taxels[1].name",
        "as that of taxels[0]",
    );
    expect_at(
        "channel = 1",
        "channel = 0  # again",
        "again",
        "taxels[1].channel",
        "as that of taxels[0]",
    );
    expect(
        "summary = \"A small sensor\"",
        "summary = \" \"",
        "summary",
        "is empty",
    );
}

#[test]
fn gel_and_inclusions() {
    expect(
        "size_mm = [20.0, 10.0, 6.0]",
        "size_mm = [20.0, 10.0, 0.0]",
        "gel.solid.size_mm[2]",
        "give 0.1 to 1000",
    );
    expect(
        "max_mm = [2.0, 2.0, 1.0]",
        "max_mm = [2.0, -2.0, 1.0]",
        "inclusions[0].max_mm",
        "not above min_mm",
    );
    expect(
        "min_mm = [-2.0, -2.0, 0.0]",
        "min_mm = [-2.0, -2.0, 0.5]",
        "inclusions[0].min_mm",
        "lowest point on the board",
    );
    let moved = "max_mm = [12.0, 2.0, 1.0]";
    expect_at(
        "max_mm = [2.0, 2.0, 1.0]",
        moved,
        "[[inclusions]]",
        "inclusions[0]",
        "outside the gel",
    );
    expect("gap_mm = 1.0", "gap_mm = 0.0", "shell.gap_mm", "above 0");
    expect(
        "height_mm = 5.0",
        "height_mm = -5.0",
        "shell.height_mm",
        "above 0",
    );
}

#[test]
fn volume_of_a_material() {
    let ratio = "poissons_ratio = 0.49";
    expect(
        ratio,
        "poissons_ratio = 0.5",
        "gel.material.poissons_ratio",
        "less than 0.5",
    );
    expect(
        ratio,
        "poissons_ratio = 0.0",
        "gel.material.poissons_ratio",
        "more than 0",
    );
    expect_at(
        ratio,
        "",
        "[gel.material]",
        "gel.material",
        "has no constant for the change of volume",
    );
    expect_at(
        ratio,
        "poissons_ratio = 0.49\nbulk_modulus_kpa = 9",
        "bulk_",
        "gel.material.bulk_modulus_kpa",
        "one of the two",
    );
    expect(
        ratio,
        "bulk_modulus_kpa = 0.0",
        "gel.material.bulk_modulus_kpa",
        "above 0",
    );
    expect(
        ratio,
        "bulk_modulus_kpa = 18.0",
        "gel.material.bulk_modulus_kpa",
        "negative Poisson's ratio",
    );
    expect_at(
        ratio,
        "bulk_modulus_kpa = 6.0",
        "youngs",
        "gel.material.youngs_modulus_kpa",
        "too large",
    );
}

const YOUNGS: &str = "youngs_modulus_kpa = 60.0";

#[test]
fn stiffness_of_a_material() {
    expect(
        YOUNGS,
        "youngs_modulus_kpa = -60.0",
        "gel.material.youngs_modulus_kpa",
        "above 0",
    );
    expect_at(YOUNGS, "", "[gel.material]", "gel.material", "has no stiffness");
    expect_at(
        YOUNGS,
        "youngs_modulus_kpa = 60.0\nshear_modulus_kpa = 20.0",
        "shear",
        "gel.material.shear_modulus_kpa",
        "one of the two",
    );
    expect_at(
        YOUNGS,
        "model = \"yeoh\"\nc10_kpa = 10.0\nc20_kpa = 0.1",
        "[gel.material]",
        "gel.material",
        "lacks `c30_kpa`",
    );
    expect_at(
        YOUNGS,
        "model = \"mooney-rivlin\"\nyoungs_modulus_kpa = 60.0",
        "youngs",
        "gel.material.youngs_modulus_kpa",
        "not a constant",
    );
    expect_at(
        YOUNGS,
        "youngs_modulus_kpa = 60.0\nc10_kpa = 10.0",
        "c10",
        "gel.material.c10_kpa",
        "not a constant",
    );
    expect_at(
        YOUNGS,
        "model = \"hooke\"",
        "hooke",
        "gel.material.model",
        "unknown variant",
    );
}

#[test]
fn terms_of_a_material() {
    let ogden = |terms: &str| format!("model = \"ogden\"\nterms = {terms}");
    expect_at(
        YOUNGS,
        &ogden("[{ mu_kpa = 1.0, alpha = 2.0 }, { mu_kpa = 3.0, alpha = -2.0 }]"),
        "terms",
        "gel.material.terms",
        "add up to -4 kPa",
    );
    expect_at(
        YOUNGS,
        &ogden("[{ mu_kpa = 1.0, alpha = 0.0 }]"),
        "terms",
        "gel.material.terms[0].alpha",
        "other than 0",
    );
    expect_at(YOUNGS, &ogden("[]"), "terms", "gel.material.terms", "above 0");
}

#[test]
fn relaxation_of_a_material() {
    expect_at(
        YOUNGS,
        "model = \"stable-neo-hookean\"\nyoungs_modulus_kpa = 60.0",
        "prony",
        "gel.material.prony",
        "which `stable-neo-hookean` is not",
    );
    let term = "{ weight = 0.1, time_s = 1.0 },";
    expect(
        term,
        "{ weight = 0.1, time_s = 0.0 },",
        "gel.material.prony[0].time_s",
        "above 0",
    );
    expect(
        term,
        "{ weight = -0.1, time_s = 1.0 },",
        "gel.material.prony[0].weight",
        "above 0",
    );
    expect_at(
        term,
        "{ weight = 0.5, time_s = 1.0 }, { weight = 0.5, time_s = 9.0 }",
        "prony",
        "gel.material.prony",
        "below 1",
    );
}

#[test]
fn materials_mean_the_same_in_all_ways_of_writing_them() {
    let material = |lines: &str| {
        let text = GOOD.replace("youngs_modulus_kpa = 60.0\npoissons_ratio = 0.49", lines);
        Sensor::parse("small.toml", &text, &no_files)
            .unwrap()
            .gel
            .material
    };
    let shear = 60.0 / (2.0 * 1.49);
    let bulk = 60.0 / (3.0 * (1.0 - 2.0 * 0.49));
    for lines in [
        "youngs_modulus_kpa = 60.0\npoissons_ratio = 0.49".to_owned(),
        format!("youngs_modulus_kpa = 60.0\nbulk_modulus_kpa = {bulk}"),
        format!("shear_modulus_kpa = {shear}\nbulk_modulus_kpa = {bulk}"),
        format!(
            "model = \"mooney-rivlin\"\nc10_kpa = {}\nc01_kpa = {}\npoissons_ratio = 0.49",
            0.4 * shear,
            0.1 * shear
        ),
        format!(
            "model = \"yeoh\"\nc10_kpa = {}\nc20_kpa = 0.1\nc30_kpa = 0.0\npoissons_ratio = 0.49",
            0.5 * shear
        ),
    ] {
        let material = material(&lines);
        let found = [
            material.youngs_modulus_kpa() / 60.0,
            material.poissons_ratio() / 0.49,
            material.shear_modulus_kpa() / shear,
            material.bulk_modulus_kpa / bulk,
        ];
        assert!(
            found.iter().all(|share| (share - 1.0).abs() < 1e-12),
            "{lines}: {found:?}"
        );
    }
}

#[test]
fn readout_indenters_and_inferred_fields() {
    expect(
        "max_kpa = 150.0",
        "max_kpa = 50.0",
        "readout.max_kpa",
        "not above",
    );
    expect(
        "resolution_kpa = 0.01",
        "resolution_kpa = 0.0",
        "readout.resolution_kpa",
        "above 0",
    );
    expect("rate_hz = 50.0", "rate_hz = -1.0", "readout.rate_hz", "above 0");
    let limited = |force_n: &str| format!("[limits]\nforce_n = {force_n}\ndepth_mm = 4.0\n\n[readout]");
    expect_at(
        "[readout]",
        &limited("0.0"),
        "force_n = 0.0",
        "limits.force_n",
        "above 0",
    );
    let ball = "shape = { kind = \"sphere\", radius_mm = 2.0 }";
    expect(
        ball,
        "shape = { kind = \"sphere\", radius_mm = 0.0 }",
        "indenters[0].shape.radius_mm",
        "give 0.05 to 1000000 (lengths are in mm)",
    );
    expect(
        ball,
        "shape = { kind = \"stl\", path = \"tip.stl\" }",
        "indenters[0].shape.path",
        "no tip.stl",
    );
    expect(
        "inferred = [\"gel.solid.size_mm\"]",
        "inferred = [\"gel.size_mm\"]",
        "inferred[0]",
        "does not have",
    );
    expect("rate_hz = 50.0", "rate_hz = nan", "readout.rate_hz", "finite");
    expect_at(
        "rate_hz = 50.0",
        "rate_hz = 50.0\ncounts_per_pa = 0",
        "counts_per_pa = 0",
        "readout.counts_per_pa",
        "leave it out",
    );
    expect_at(
        "rate_hz = 50.0",
        "rate_hz = 50.0\ntransfer = { pa_per_count = 0.0, signed = false }",
        "transfer = ",
        "readout.transfer.pa_per_count",
        "above",
    );
    expect_at(
        "rate_hz = 50.0",
        "rate_hz = 50.0\ncounts_per_pa = 8\ntransfer = { pa_per_count = 0.5, signed = false }",
        "transfer = ",
        "readout.transfer",
        "one of the two",
    );
}

#[test]
fn surfaces_are_loaded_and_checked() {
    let text = GOOD.replace(
        "kind = \"sphere\", radius_mm = 2.0",
        "kind = \"stl\", path = \"tip.stl\"",
    );
    let found = Sensor::parse(
        "small.toml",
        &text,
        &|_| Ok(b"solid tip\nendsolid tip\n".to_vec()),
    )
    .unwrap_err();
    assert_eq!(found.field, "indenters[0].shape.path");
    assert!(
        found
            .to_string()
            .contains("names `tip.stl`, which has 0 triangles"),
        "{found}"
    );
}

/// A box of triangles as a text STL.
fn box_stl(low: [f64; 3], high: [f64; 3]) -> Vec<u8> {
    let corner = |bits: usize| {
        [0, 1, 2].map(|axis| {
            if bits >> axis & 1 == 0 {
                low[axis]
            } else {
                high[axis]
            }
        })
    };
    let sides = [
        [0, 2, 3, 1],
        [4, 5, 7, 6],
        [0, 1, 5, 4],
        [2, 6, 7, 3],
        [0, 4, 6, 2],
        [1, 3, 7, 5],
    ];
    let mut text = "solid box\n".to_owned();
    for [a, b, c, d] in sides {
        for corners in [[a, b, c], [a, c, d]] {
            let vertices = corners.map(|bits| corner(bits).map(|number| number.to_string()).join(" "));
            text += &format!(
                "facet normal 0 0 0\nouter loop\nvertex {}\nendloop\nendfacet\n",
                vertices.join("\nvertex ")
            );
        }
    }
    text.into_bytes()
}

fn with_tip(tip: &str, surface: Vec<u8>) -> Result<Sensor, SensorError> {
    let text = GOOD.replace("kind = \"sphere\", radius_mm = 2.0", tip);
    Sensor::parse("small.toml", &text, &|_| Ok(surface.clone()))
}

const TIP: &str = "kind = \"stl\", path = \"tip.stl\"";

#[test]
fn a_surface_in_metres_is_said_and_read_with_its_unit() {
    let in_metres = box_stl([-0.005, -0.004, 0.0], [0.005, 0.004, 0.006]);
    let error = with_tip(TIP, in_metres.clone()).unwrap_err();
    assert_eq!(
        error.to_string(),
        "small.toml:47: `indenters[0].shape.path` names `tip.stl`, which is 0.01 × 0.008 × 0.006 mm large, expected 0.1 to 1000 mm along each \
         axis; if its lengths are in metres, give `unit = \"m\"` or `scale = 1000`"
    );
    for unit in ["unit = \"m\"", "scale = 1000", "scale = 1e3"] {
        let sensor = with_tip(&format!("{TIP}, {unit}"), in_metres.clone()).unwrap();
        let shape = &sensor.indenter("ball").unwrap().shape;
        let (low, high) = shape.signed_distance_field(&sensor.surfaces).unwrap().bounds_mm();
        assert!(
            ((high - low) - glam::DVec3::new(10.0, 8.0, 6.0)).length() < 1e-9,
            "{unit}: {low} to {high}"
        );
        assert!(sensor.describe().contains("tip.stl × 1000"));
    }
    for (wrong, field, words) in [
        (
            "unit = \"m\", scale = 1000",
            "indenters[0].shape.scale",
            "one of the two",
        ),
        ("scale = 0", "indenters[0].shape.scale", "above 0"),
        ("scale = -1", "indenters[0].shape.scale", "above 0"),
        ("unit = \"feet\"", "indenters", "unknown variant"),
    ] {
        let error = with_tip(&format!("{TIP}, {wrong}"), in_metres.clone()).unwrap_err();
        assert!(
            error.field.starts_with(field) && error.to_string().contains(words),
            "{wrong}: {error}"
        );
    }
}

#[test]
fn one_surface_can_be_named_with_two_units() {
    let text = GOOD.replace(
        "kind = \"sphere\", radius_mm = 2.0",
        "kind = \"stl\", path = \"tip.stl\"",
    );
    let text = format!(
        "{text}\n[[indenters]]\nname = \"large\"\nshape = {{ kind = \"stl\", path = \"tip.stl\", unit = \"cm\" }}\n"
    );
    let tip = box_stl([-1.0, -1.0, 0.0], [1.0, 1.0, 2.0]);
    let sensor = Sensor::parse("small.toml", &text, &|_| Ok(tip.clone())).unwrap();
    let height_mm = |name: &str| {
        let shape = &sensor.indenter(name).unwrap().shape;
        shape
            .signed_distance_field(&sensor.surfaces)
            .unwrap()
            .bounds_mm()
            .1
            .z
    };
    assert_eq!((height_mm("ball"), height_mm("large")), (2.0, 20.0));
}

#[test]
fn an_indenter_that_can_never_touch_is_an_error() {
    let beside = |x: f64| box_stl([x - 5.0, -4.0, 0.0], [x + 5.0, 4.0, 6.0]);
    for x in [0.0, 10.0, -20.0] {
        with_tip(TIP, beside(x)).unwrap();
    }
    for x in [40.0, -300.0] {
        let error = with_tip(TIP, beside(x)).unwrap_err();
        assert_eq!(error.field, "indenters[0].shape");
        assert!(
            error.problem.contains("beside its origin") && error.problem.contains("never touches"),
            "{error}"
        );
    }
    let far = with_tip(TIP, beside(1e6)).unwrap_err();
    assert!(far.problem.contains("expected within 1 m of its origin"), "{far}");
    let large = with_tip(
        "kind = \"box\", size_mm = [2000.0, 10.0, 10.0], edge_radius_mm = 0.0",
        Vec::new(),
    )
    .unwrap_err();
    assert!(large.problem.contains("is 2000 × 10 × 10 mm large"), "{large}");
}

#[test]
fn a_gel_of_triangles_is_one_body_on_the_board() {
    let gel = |surface: Vec<u8>, unit: &str| {
        let text = GOOD.replace(
            "kind = \"block\"\nsize_mm = [20.0, 10.0, 6.0]",
            &format!("kind = \"stl\"\npath = \"gel.stl\"\n{unit}"),
        );
        let text = text.replace("gel.solid.size_mm", "gel.solid.path");
        Sensor::parse("small.toml", &text, &|_| Ok(surface.clone()))
    };
    let good = || box_stl([-10.0, -5.0, 0.0], [10.0, 5.0, 6.0]);
    assert!(
        (gel(good(), "")
            .unwrap()
            .gel
            .solid
            .volume_mm3(&gel(good(), "").unwrap().surfaces)
            - 1200.0)
            .abs()
            < 1e-9
    );
    let in_metres = box_stl([-0.01, -0.005, 0.0], [0.01, 0.005, 0.006]);
    assert!(
        gel(in_metres.clone(), "")
            .unwrap_err()
            .hint
            .contains("`unit = \"m\"`")
    );
    assert!(gel(in_metres, "unit = \"m\"").is_ok());
    let error = gel([good(), box_stl([8.0, -4.0, 0.0], [14.0, 4.0, 5.0])].concat(), "").unwrap_err();
    assert!(error.problem.contains("touch or overlap"), "{error}");
    let error = gel(
        [good(), box_stl([10.0, -4.0, 0.0], [14.0, 4.0, 5.0])].concat(),
        "",
    )
    .unwrap_err();
    assert!(error.problem.contains("touch or overlap"), "{error}");
    assert!(
        gel(
            [good(), box_stl([11.0, -4.0, 0.0], [14.0, 4.0, 5.0])].concat(),
            ""
        )
        .is_ok()
    );
    let error = gel(box_stl([-10.0, -5.0, 1.0], [10.0, 5.0, 6.0]), "").unwrap_err();
    assert!(error.problem.contains("lowest point is at z = 1 mm"), "{error}");
}

#[test]
fn absurd_numbers_are_refused() {
    let expect = |from: &str, to: &str, field: &str| {
        let error = Sensor::parse("small.toml", &GOOD.replacen(from, to, 1), &no_files).unwrap_err();
        assert_eq!(error.field, field, "{error}");
    };
    expect("gap_mm = 1.0", "gap_mm = 1e300", "shell.gap_mm");
    expect("height_mm = 5.0", "height_mm = 1e9", "shell.height_mm");
    expect("rate_hz = 50.0", "rate_hz = 1e9", "readout.rate_hz");
    expect("max_kpa = 150.0", "max_kpa = 1e300", "readout.max_kpa");
    expect(
        "port_radius_mm = 0.5",
        "port_radius_mm = 1e12",
        "taxels[0].port_radius_mm",
    );
    expect(
        "size_mm = [20.0, 10.0, 6.0]",
        "size_mm = [0.020, 0.010, 0.006]",
        "gel.solid.size_mm[0]",
    );
    expect(
        "size_mm = [20.0, 10.0, 6.0]",
        "size_mm = [20.0, 10.0, 6e300]",
        "gel.solid.size_mm[2]",
    );
    expect(
        "radius_mm = 2.0 }",
        "radius_mm = 0.002 }",
        "indenters[0].shape.radius_mm",
    );
    expect(
        "radius_mm = 2.0 }",
        "radius_mm = 2.0 }\nfriction = 1e30",
        "indenters[0].friction",
    );
}

#[test]
fn a_description_is_shown_without_what_would_steer_a_terminal() {
    let text = GOOD.replace("A small sensor", "a\\u001b[2Jb");
    let shown = Sensor::parse("small.toml", &text, &no_files).unwrap().describe();
    assert!(!shown.contains('\u{1b}') && shown.contains("[2Jb"), "{shown}");
}
