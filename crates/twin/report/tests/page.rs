//! The page as a reader gets it: safe, self-contained, the same every time, and silent about what is absent.

#[path = "../examples/gallery/invented.rs"]
mod invented;

use twintac_report::data::{Agreement, Headline, PressPeak, PressSeries, TaxelError};
use twintac_report::{Provenance, ReportData, page};

fn render(data: &ReportData) -> String {
    page(data).render()
}

#[test]
fn no_data_gives_a_page_without_sections() {
    let page = render(&ReportData::default());
    assert!(page.starts_with("<!doctype html>") && page.ends_with("</html>\n"));
    assert!(!page.contains("<section") && !page.contains("<li>"));
}

#[test]
fn every_part_appears_with_its_data_and_only_then() {
    let (moving, resting) = (render(&invented::moving()), render(&invented::resting()));
    for id in ["result", "maps", "taxels", "sensor", "making-of"] {
        let (section, link) = (format!("<section id=\"{id}\""), format!("href=\"#{id}\""));
        assert!(
            [&moving, &resting]
                .iter()
                .all(|page| page.contains(&section) && page.contains(&link)),
            "{id}"
        );
    }
    for id in [
        "presses",
        "recordings",
        "variants",
        "training",
        "bench",
        "alignment",
        "simulation",
    ] {
        let section = format!("<section id=\"{id}\"");
        assert!(moving.contains(&section) && !resting.contains(&section), "{id}");
    }
    assert!(resting.contains("<section id=\"places\"") && !moving.contains("<section id=\"places\""));
}

#[test]
fn nothing_is_fetched_and_nothing_runs() {
    for page in [render(&invented::moving()), render(&invented::resting())] {
        // The only address is the name of the SVG namespace, which no browser opens.
        let rest = page.replace("http://www.w3.org/2000/svg", "");
        for forbidden in ["http:", "https:", "//", "<script", "<link", "@import", "url("] {
            let rest = rest.replace("data:image/png;base64,", "data:");
            let outside_pictures: String = rest
                .split("data:")
                .map(|part| part.split_once('"').map_or(part, |(_, after)| after))
                .collect();
            assert!(!outside_pictures.contains(forbidden), "{forbidden}");
        }
    }
}

#[test]
fn the_same_data_gives_the_same_bytes() {
    let data = invented::moving();
    assert_eq!(render(&data), render(&data));
}

#[test]
fn text_from_data_cannot_become_markup() {
    let evil = || "<img src=x onerror=alert(1)>\"'&".to_owned();
    let mut data = invented::moving();
    data.title = evil();
    data.command = evil();
    data.settings = evil();
    data.warnings = vec![evil()];
    data.taxels = vec![TaxelError {
        name: evil(),
        note: evil(),
        ..TaxelError::default()
    }];
    data.presses[0].name = evil();
    data.presses[0].label = evil();
    data.presses[0].taxels[0] = evil();
    data.peaks[0].name = evil();
    data.files[0].name = evil();
    data.variants[0].name = evil();
    assert!(!render(&data).contains("<img"));
}

#[test]
fn numbers_that_are_missing_show_as_dashes() {
    let nan = f64::NAN;
    let press = PressSeries {
        label: "ä".into(),
        taxels: vec!["S0".into()],
        time_s: vec![0.0, nan, 2.0],
        sensor_kpa: vec![vec![nan], vec![], vec![1.0]],
        twin_kpa: vec![vec![nan]],
        depth_mm: vec![nan; 9],
        ..PressSeries::default()
    };
    let peak = PressPeak {
        taxels_mm: vec![[nan, 0.0]],
        sensor_kpa: vec![nan],
        twin_kpa: vec![nan],
        ..PressPeak::default()
    };
    let data = ReportData {
        headline: Some(Headline {
            nearest_in_contact_percent: nan,
            all_percent: nan,
            ..Headline::default()
        }),
        presses: vec![press],
        peaks: vec![peak, PressPeak::default()],
        agreement: Some(Agreement {
            measured_kpa: vec![nan, 1.0],
            predicted_kpa: vec![nan],
        }),
        taxels: vec![TaxelError {
            nearest_in_contact_percent: nan,
            ..TaxelError::default()
        }],
        ..ReportData::default()
    };
    let page = render(&data);
    assert!(page.contains("No error could be computed") && page.contains('–'));
    assert!(!page.contains("NaN") && !page.contains("inf,"));
}

#[test]
fn badges_follow_the_provenance() {
    let mut data = invented::moving();
    data.provenance = Provenance::Real;
    assert!(render(&data).contains("1.27\u{a0}% error (real data)"));
    data.provenance = Provenance::Emulated;
    let page = render(&data);
    assert!(page.contains("badge emulated") && page.contains("emulated data, which says nothing"));
}

#[test]
fn the_page_is_written_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("report.html");
    page(&invented::resting()).write(&path).unwrap();
    assert_eq!(
        std::fs::read_to_string(&path).unwrap(),
        render(&invented::resting())
    );
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}
