//! Tests against known answers: how figures scale with height, modulus and force.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

use std::path::Path;

use twintac_design::{Design, Designs, Figure, Figures, Measure, Plan, RangeEnd, Variable, Wishes, search};
use twintac_sensor::SensorFile;
use twintac_work::Caller;

/// A wide flat gel over a square of nine ports, far from its sides: a layer.
const LAYER: &str = r#"
name = "layer"
summary = "A layer"
source = "a test"

[gel.solid]
kind = "block"
size_mm = [44.0, 44.0, 8.0]

[gel.material]
shear_modulus_kpa = 15.0
poissons_ratio = 0.49
source = "a test"

[readout]
min_kpa = 0.0
max_kpa = 1500.0
resolution_kpa = 0.01
rate_hz = 50.0
"#;

fn layer() -> SensorFile {
    let mut text = LAYER.to_owned();
    for (index, [x, y]) in [-8.0, 0.0, 8.0]
        .into_iter()
        .flat_map(|x| [-8.0, 0.0, 8.0].map(|y| [x, y]))
        .enumerate()
    {
        text += &format!(
            "\n[[taxels]]\nname = \"t{index}\"\nposition_mm = [{x:.1}, {y:.1}, 0.0]\nport_radius_mm = 0.5\n"
        );
        text += &match index {
            8 => "switch = 0x71\nchannel = 0\n".to_owned(),
            channel => format!("channel = {channel}\n"),
        };
    }
    SensorFile::parse(Path::new("layer.toml"), &text).unwrap()
}

fn searched(
    sensor: &SensorFile,
    vary: &[&str],
    n_values: usize,
    measure: &Measure,
    folder: &Path,
) -> Designs {
    let variables: Vec<Variable> = vary.iter().map(|text| text.parse().unwrap()).collect();
    let plan = Plan::Grid { n_values };
    search(
        sensor,
        &variables,
        plan,
        measure,
        &Wishes::default(),
        folder,
        &Caller::default(),
    )
    .unwrap()
}

fn figures(designs: &Designs) -> Vec<Figures> {
    let evaluated = |design: &Design| {
        *design
            .figures()
            .unwrap_or_else(|| panic!("{:?}", design.refused()))
    };
    designs.designs.iter().map(evaluated).collect()
}

fn measure() -> Measure {
    Measure {
        force_n: 0.05,
        ball_radius_mm: 2.0,
        noise_kpa: Some(0.02),
        max_nodes: 4000,
    }
}

/// Under a small load on a layer, the layer's height is the only length that matters (Boussinesq's
/// 3 F / (2 π h²) has that form), so the pressure below falls with its square. The ball's contact
/// and the port have a finite size, which reduces the effect, most for thin layers.
#[test]
fn sensitivity_falls_with_the_square_of_the_height() {
    let folder = tempfile::tempdir().unwrap();
    let fine = Measure {
        max_nodes: 16_000,
        ..measure()
    };
    let found = figures(&searched(
        &layer(),
        &["gel.height_mm=5..10"],
        2,
        &fine,
        folder.path(),
    ));
    let [thin, thick] = [0, 1].map(|index| found[index].sensitivity_kpa_per_n);
    let power = (thin / thick).log2();
    assert!(
        (1.8..2.05).contains(&power),
        "{thin} {thick}: to the power of {power}"
    );
    // Boussinesq's half-space has no base. On a rigid base the middle of a nearly incompressible
    // layer bears about half as much again.
    let boussinesq = 1000.0 * 3.0 / (2.0 * std::f64::consts::PI * 100.0);
    assert!(
        (1.25..1.75).contains(&(thick / boussinesq)),
        "{thick} over {boussinesq}"
    );
}

/// A gel of another modulus, under a force scaled by the same factor, gives the same figures but
/// for the unit of pressure, exactly.
#[test]
fn stiffer_gels_under_more_force_are_the_same() {
    let folder = tempfile::tempdir().unwrap();
    let soft = Measure {
        max_nodes: 1500,
        ..measure()
    };
    let stiff = Measure {
        force_n: 4.0 * soft.force_n,
        noise_kpa: Some(0.08),
        ..soft.clone()
    };
    let at = |measure: &Measure, name: &str| {
        let vary = ["gel.material.shear_modulus_kpa=15..60"];
        figures(&searched(&layer(), &vary, 2, measure, &folder.path().join(name)))
    };
    let (soft, stiff) = (at(&soft, "soft")[0], at(&stiff, "stiff")[1]);
    let same = |figure: Figure, by: f64| {
        let [soft, stiff] = [&soft, &stiff].map(|figures| figure.of(figures).unwrap());
        assert!(
            (stiff / (by * soft) - 1.0).abs() < 1e-3,
            "{figure:?}: {soft}, {stiff}"
        );
    };
    same(Figure::SensitivityKpaPerN, 1.0);
    same(Figure::SensitivityBetweenKpaPerN, 1.0);
    same(Figure::CrossTalkPercent, 1.0);
    same(Figure::LocalizationErrorMm, 1.0);
    same(Figure::SmallestForceN, 4.0);
    assert!((stiff.depth_mm / soft.depth_mm - 1.0).abs() < 1e-3);
}

#[test]
fn places_are_found_as_well_as_readings_are_quiet() {
    let folder = tempfile::tempdir().unwrap();
    let quiet = Measure {
        max_nodes: 1500,
        ..measure()
    };
    let noisy = Measure {
        noise_kpa: Some(0.06),
        ..quiet.clone()
    };
    let of = |measure: &Measure, name: &str| {
        let designs = searched(
            &layer(),
            &["taxels.pitch_mm=6..8"],
            2,
            measure,
            &folder.path().join(name),
        );
        figures(&designs)[1]
    };
    let (quiet, noisy) = (of(&quiet, "quiet"), of(&noisy, "noisy"));
    let ratio = noisy.localization_error_mm.unwrap() / quiet.localization_error_mm.unwrap();
    assert!((ratio - 3.0).abs() < 1e-9, "{ratio}");
    assert!(noisy.smallest_force_n > 2.0 * quiet.smallest_force_n);
    assert_eq!(noisy.sensitivity_kpa_per_n, quiet.sensitivity_kpa_per_n);
}

/// The range ends where the chip saturates, or before that at the limits of the description.
#[test]
fn ranges_end_where_the_chip_or_the_limits_do() {
    let folder = tempfile::tempdir().unwrap();
    let coarse = Measure {
        max_nodes: 1500,
        ..measure()
    };
    let vary = ["readout.max_kpa=105..1000"];
    let found = figures(&searched(
        &layer(),
        &vary,
        2,
        &coarse,
        &folder.path().join("chip"),
    ));
    assert_eq!(found[0].range_end, RangeEnd::Saturation);
    assert_ne!(found[1].range_end, RangeEnd::Saturation);
    assert!(found[0].range_n < found[1].range_n);
    let about_n = (105.0 - 101.325) / found[0].sensitivity_kpa_per_n;
    assert!(
        (0.7..1.3).contains(&(found[0].range_n / about_n)),
        "{} {about_n}",
        found[0].range_n
    );

    let limited = format!("{}\n[limits]\nforce_n = 0.5\ndepth_mm = 3.0\n", layer().text);
    let limited = SensorFile::parse(Path::new("layer.toml"), &limited).unwrap();
    let found = figures(&searched(
        &limited,
        &vary,
        2,
        &coarse,
        &folder.path().join("limits"),
    ));
    assert_eq!((found[1].range_n, found[1].range_end), (0.5, RangeEnd::Force));
}

/// A material that does not relax gives no hysteresis figure; one that relaxes gives one.
#[test]
fn hysteresis_is_of_materials_that_relax() {
    let folder = tempfile::tempdir().unwrap();
    let coarse = Measure {
        max_nodes: 1500,
        ..measure()
    };
    let vary = ["gel.height_mm=7..8"];
    let elastic = figures(&searched(
        &layer(),
        &vary,
        2,
        &coarse,
        &folder.path().join("elastic"),
    ));
    assert_eq!(elastic[0].hysteresis_percent, None);
    let relaxing = layer().text.replacen(
        "shear_modulus_kpa = 15.0",
        "shear_modulus_kpa = 15.0\nprony = [{ weight = 0.2, time_s = 0.3 }]",
        1,
    );
    let relaxing = SensorFile::parse(Path::new("layer.toml"), &relaxing).unwrap();
    let found = figures(&searched(
        &relaxing,
        &vary,
        2,
        &coarse,
        &folder.path().join("relaxing"),
    ));
    let percent = found[0].hysteresis_percent.unwrap();
    assert!((0.5..60.0).contains(&percent), "{percent}");
}

/// The best design's description can be read and has the values of the table.
#[test]
fn the_best_is_written_as_a_description() {
    let folder = tempfile::tempdir().unwrap();
    let coarse = Measure {
        max_nodes: 1000,
        ..measure()
    };
    let vary = ["gel.height_mm=6..9", "taxels.pitch_mm=6..8"];
    let designs = searched(&layer(), &vary, 2, &coarse, folder.path());
    let best = designs.best(&Wishes::default()).unwrap();
    let written = SensorFile::read(&folder.path().join("best.toml")).unwrap().sensor;
    assert_eq!(written.name, format!("layer-design-{best}"));
    let height_mm = written.gel.solid.bounds_mm(&written.surfaces).1.z;
    assert_eq!(height_mm, designs.designs[best - 1].values[0]);
    let table = std::fs::read_to_string(folder.path().join("designs.csv")).unwrap();
    assert_eq!(table.lines().count(), 5);
    assert!(table.starts_with("design,gel.height_mm,taxels.pitch_mm,sensitivity_kpa_per_n,"));
    let again = searched(&layer(), &vary, 2, &coarse, folder.path());
    assert_eq!(again, designs);
}
