//! Imports the real recordings beside the workspace, if they exist.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // also in the helpers of tests

use std::path::{Path, PathBuf};

use twintac_recording::{Control, FileSummary, Import, Press, Provenance, Recording};

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../..")
}

/// The CSV files of one folder of recordings, in order; empty if the recordings are absent.
fn files(folder: &str) -> Vec<PathBuf> {
    let folder = root().join("../shared/data").join(folder);
    let Ok(entries) = std::fs::read_dir(&folder) else {
        println!("skipped: no recordings at {}", folder.display());
        return Vec::new();
    };
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    files.retain(|file| file.extension().is_some_and(|extension| extension == "csv"));
    files.sort();
    files
}

fn import(name: &str) -> Import {
    let file = root().join("imports").join(name);
    Import::parse(name, &std::fs::read_to_string(file).unwrap()).unwrap()
}

fn read(import: &Import, file: &Path) -> (Recording, FileSummary) {
    let (recording, mut summary) = import.read_csv(file).unwrap();
    assert_eq!(summary.files.len(), 1);
    let summary = summary.files.remove(0);
    println!("{summary}");
    (recording, summary)
}

fn x_mm(press: &Press) -> f64 {
    let x_mm = press.gel_from_indenter[0].position_mm.x;
    assert!(
        press
            .gel_from_indenter
            .iter()
            .all(|pose| (pose.position_mm.x - x_mm).abs() < 1e-9)
    );
    x_mm
}

/// Largest depth below the top of the unloaded gel, mm.
fn depth_mm(press: &Press, gel_top_mm: f64) -> f64 {
    press
        .gel_from_indenter
        .iter()
        .map(|pose| gel_top_mm - pose.position_mm.z)
        .fold(f64::MIN, f64::max)
}

/// Largest usable reading of each taxel, kPa.
fn peaks_kpa(presses: &[Press]) -> Vec<f64> {
    let mut peaks_kpa = vec![f64::MIN; presses[0].taxels_kpa[0].len()];
    for press in presses {
        for (row, valid) in press.taxels_kpa.iter().zip(&press.valid) {
            for (taxel, (&kpa, &valid)) in row.iter().zip(valid).enumerate() {
                if valid {
                    peaks_kpa[taxel] = f64::max(peaks_kpa[taxel], kpa);
                }
            }
        }
    }
    peaks_kpa
}

/// Known values of each strip4 file: sensor, first and last location and step, mm, travel and
/// contact, mm.
struct Known {
    sensor: &'static str,
    first_x_mm: f64,
    step_mm: f64,
    presses: usize,
    travel_mm: f64,
    contact_mm: f64,
    gel_top_mm: f64,
}

fn known(name: &str) -> Known {
    let travel_mm = match name
        .find("_zd")
        .and_then(|at| name[at + 3..].chars().next())
        .and_then(|c| c.to_digit(10))
    {
        Some(digit) => f64::from(digit),
        None if name.contains("162352") => 3.0,
        None => 4.0,
    };
    let (sensor, contact_mm, gel_top_mm) = match &name[..4] {
        "gelA" => ("strip4-gel-a", 3.5, 5.0),
        "gelB" => ("strip4-gel-b", 4.5, 5.0),
        "gelC" => ("strip4-gel-b", 2.05, 5.0),
        _ => ("strip4-gel-d", 2.08, 6.0),
    };
    let (first_x_mm, step_mm, presses) = match name {
        "gelD_test_20230707_153948.csv" => (-6.0, 0.5, 12),
        _ if name.starts_with("gelC") => (0.0, 1.0, 7),
        _ => (0.0, 1.0, 20),
    };
    Known {
        sensor,
        first_x_mm,
        step_mm,
        presses,
        travel_mm,
        contact_mm,
        gel_top_mm,
    }
}

#[test]
fn strip4_presses_stand_where_and_as_deep_as_the_bench_went() {
    let import = import("strip4.toml");
    for file in files("strip4") {
        let (recording, summary) = read(&import, &file);
        let known = known(&summary.file);
        assert_eq!(recording.sensor, known.sensor);
        assert_eq!(recording.provenance, Provenance::Real);
        assert_eq!(recording.taxels, ["S0", "S1", "S2", "S3"]);
        assert_eq!(
            (recording.presses.len(), summary.presses_dropped),
            (known.presses, 0),
            "{summary}"
        );
        assert!((100..420).contains(&summary.rows_dropped), "{summary}");
        for (index, press) in recording.presses.iter().enumerate() {
            assert_eq!(press.control, Control::Pose);
            assert_eq!(press.force_n, None);
            let expected_mm = known.first_x_mm + known.step_mm * index as f64;
            assert!(
                (x_mm(press) - expected_mm).abs() < 1e-9,
                "{} at {} mm",
                press.name,
                x_mm(press)
            );
            // A press without a hold may turn between two rows: 60 ms at 2 mm/s.
            let travel_mm = depth_mm(press, known.gel_top_mm) + known.contact_mm;
            let short_mm = known.travel_mm - travel_mm;
            assert!(
                (-1e-9..0.12).contains(&short_mm),
                "{} travels {travel_mm} mm",
                press.name
            );
        }
    }
}

#[test]
fn strip4_readings_are_zero_before_contact_and_plausible_in_it() {
    let import = import("strip4.toml");
    for file in files("strip4") {
        let (recording, summary) = read(&import, &file);
        let gel_top_mm = known(&summary.file).gel_top_mm;
        for press in &recording.presses {
            let height_mm = |frame: usize| press.gel_from_indenter[frame].position_mm.z - gel_top_mm;
            let in_gel = (0..press.time_s.len())
                .find(|&frame| height_mm(frame) < 0.0)
                .unwrap();
            let last_s = press.time_s[(0..in_gel).rfind(|&frame| height_mm(frame) > 0.5).unwrap()];
            let is_before = |&frame: &usize| height_mm(frame) > 0.5 && press.time_s[frame] > last_s - 1.0;
            let before = (0..in_gel).filter(is_before);
            assert!(
                before.clone().count() >= 10,
                "{}: few frames before contact",
                press.name
            );
            let stray_kpa = before
                .flat_map(|frame| press.taxels_kpa[frame].iter())
                .fold(0.0, |a, kpa| f64::max(a, kpa.abs()));
            assert!(stray_kpa < 0.2, "{}: {stray_kpa} kPa before contact", press.name);
            assert!(
                height_mm(press.time_s.len() - 1) > 0.0,
                "{} ends in the gel",
                press.name
            );
        }
        let peaks_kpa = peaks_kpa(&recording.presses);
        println!("  peaks {peaks_kpa:.1?} kPa");
        let largest_kpa = peaks_kpa.iter().copied().fold(0.0, f64::max);
        assert!((3.0..70.0).contains(&largest_kpa), "{peaks_kpa:?}");
    }
}

#[test]
fn strip4_taxels_read_most_when_the_tip_is_nearest() {
    let import = import("strip4.toml");
    let Some(file) = files("strip4")
        .into_iter()
        .find(|file| file.ends_with("gelD_test_20230706_164635.csv"))
    else {
        return;
    };
    let (recording, _) = read(&import, &file);
    for (taxel, centre_mm) in [(1, -0.53), (2, 5.64), (3, 11.71)] {
        let peak_kpa = |press: &&Press| peaks_kpa(std::slice::from_ref(press))[taxel];
        let best = recording
            .presses
            .iter()
            .max_by(|a, b| peak_kpa(a).total_cmp(&peak_kpa(b)))
            .unwrap();
        assert!(
            (x_mm(best) - centre_mm).abs() <= 0.6,
            "S{taxel} reads most at {} mm",
            x_mm(best)
        );
        assert!((10.0..20.0).contains(&peak_kpa(&best)), "{}", peak_kpa(&best));
    }
}

#[test]
fn files_of_one_gel_become_one_recording_in_any_order_and_gels_do_not_mix() {
    let import = import("strip4.toml");
    let gel = |letter: &str| -> Vec<PathBuf> {
        let is_gel = |file: &PathBuf| file.file_name().unwrap().to_string_lossy().starts_with(letter);
        files("strip4").into_iter().filter(is_gel).collect()
    };
    let mut files = gel("gelD");
    if files.is_empty() {
        return;
    }
    let (recording, summary) = import.read_all(&files).unwrap();
    assert_eq!(recording.presses.len(), 52);
    files.reverse();
    assert_eq!(import.read_all(&files).unwrap(), (recording, summary));
    files.extend(gel("gelA"));
    let error = import.read_all(&files).unwrap_err().to_string();
    assert!(
        error.contains("strip4-gel-a") && error.contains("strip4-gel-d"),
        "{error}"
    );
}

#[test]
fn array8_rows_are_presses_under_one_weight() {
    let import = import("array8.toml");
    for file in files("array8") {
        let (recording, summary) = read(&import, &file);
        let (sensor, presses, largest_kpa, outliers) = match summary.file.as_str() {
            "DS10_atm_pitch6.75.csv" => ("array8-ds10", 2800, 7.3, 1..=3),
            "DS20_25psi_pitch9.90.csv" => ("array8-ds20", 3388, 24.6, 5..=9),
            other => panic!("unknown file {other}"),
        };
        assert_eq!(recording.sensor, sensor);
        assert_eq!(recording.presses.len(), presses);
        assert!(outliers.contains(&summary.outliers), "{summary}");
        assert_eq!(recording.taxels, ["s0", "s1", "s2", "s3", "s4", "s5", "s6", "s7"]);
        for press in &recording.presses {
            assert_eq!(press.control, Control::Force);
            assert_eq!(press.force_n, Some(vec![0.980_665]));
            assert!((press.gel_from_indenter[0].position_mm.z - 8.0).abs() < 1e-12);
        }
        let peaks_kpa = peaks_kpa(&recording.presses);
        println!("  peaks {peaks_kpa:.2?} kPa");
        let found_kpa = peaks_kpa.into_iter().fold(0.0, f64::max);
        assert!(
            (0.95 * largest_kpa..1.15 * largest_kpa).contains(&found_kpa),
            "{found_kpa} kPa"
        );
        // The taxels in opposite corners of the array read most at their own positions.
        let centres_mm = match sensor {
            "array8-ds10" => [(0, 3.29, -9.415), (4, -3.98, 10.965)],
            _ => [(0, 5.29, -14.015), (4, -5.05, 15.645)],
        };
        for (taxel, x_mm, y_mm) in centres_mm {
            let mut presses: Vec<&Press> = recording
                .presses
                .iter()
                .filter(|press| press.valid[0][taxel])
                .collect();
            presses.sort_by(|a, b| b.taxels_kpa[0][taxel].total_cmp(&a.taxels_kpa[0][taxel]));
            let places_mm = presses[..20]
                .iter()
                .map(|press| press.gel_from_indenter[0].position_mm.truncate());
            let place_mm = places_mm.sum::<glam::DVec2>() / 20.0;
            assert!(
                place_mm.distance(glam::DVec2::new(x_mm, y_mm)) < 1.0,
                "s{taxel} reads most at {place_mm}"
            );
        }
        // The gel's outline is centred, so no location is outside of it.
        let (half_x_mm, half_y_mm) = if sensor == "array8-ds10" {
            (14.25, 15.625)
        } else {
            (14.25, 20.875)
        };
        for press in &recording.presses {
            let place_mm = press.gel_from_indenter[0].position_mm;
            assert!(
                place_mm.x.abs() < half_x_mm && place_mm.y.abs() < half_y_mm,
                "{}",
                press.name
            );
        }
    }
}
