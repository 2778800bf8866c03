//! Properties of the page: safe, self-contained, reproducible, and without sections for absent
//! data.

#[path = "../examples/invented_report/invented.rs"]
mod invented;

use digitac::Errors;
use invented::Results;
use twintac_plot::page::{Block, Figure};
use twintac_recording::Provenance;
use twintac_report::page;

fn render(results: &Results) -> String {
    page(&results.report()).render()
}

#[test]
fn every_part_appears_with_its_data_and_only_then() {
    let (moving, resting) = (render(&invented::moving()), render(&invented::resting()));
    let always = [
        "result",
        "maps",
        "taxels",
        "recordings",
        "variants",
        "training",
        "bench",
        "simulation",
    ];
    for id in always.into_iter().chain(["sensor", "making-of"]) {
        let (section, link) = (format!("<section id=\"{id}\""), format!("href=\"#{id}\""));
        for page in [&moving, &resting] {
            assert!(page.contains(&section) && page.contains(&link), "{id}");
        }
    }
    for id in ["replay", "presses", "alignment"] {
        let section = format!("<section id=\"{id}\"");
        assert!(moving.contains(&section) && !resting.contains(&section), "{id}");
    }
    assert!(resting.contains("<section id=\"places\"") && !moving.contains("<section id=\"places\""));
}

#[test]
fn the_caption_explains_the_bars_that_are_there() {
    for page in [render(&invented::moving()), render(&invented::resting())] {
        assert_eq!(page.contains("Green:"), page.contains("repeated press"));
    }
}

#[test]
fn no_text_leaves_its_picture() {
    for results in [invented::moving(), invented::resting()] {
        let mut n_figures = 0;
        let mut check = |figure: &Figure| {
            n_figures += 1;
            assert_eq!(
                figure.scene.overflow(),
                Vec::<&str>::new(),
                "{}",
                figure.scene.name
            );
        };
        for block in page(&results.report())
            .sections
            .iter()
            .flat_map(|section| &section.blocks)
        {
            match block {
                Block::Figures(figures) => figures.iter().for_each(&mut check),
                Block::Wide(figure) => check(figure),
                _ => (),
            }
        }
        assert!(n_figures > 10);
    }
}

#[test]
fn nothing_is_fetched_and_only_presses_that_move_have_a_script() {
    for (page, n_scripts) in [
        (render(&invented::moving()), 2), // data, and what shows them
        (render(&invented::resting()), 0),
    ] {
        assert_eq!(page.matches("<script").count(), n_scripts);
        // The only address is the name of the SVG namespace, which no browser opens.
        let rest = page.replace("http://www.w3.org/2000/svg", "");
        let rest = rest.replace("data:image/png;base64,", "data:");
        let outside_pictures: String = rest
            .split("data:")
            .map(|part| part.split_once('"').map_or(part, |(_, after)| after))
            .collect();
        for forbidden in ["http:", "https:", "//", "<link", "src=", "@import", "url("] {
            assert!(!outside_pictures.contains(forbidden), "{forbidden}");
        }
    }
}

#[test]
fn the_same_data_gives_the_same_bytes() {
    let results = invented::moving();
    assert_eq!(render(&results), render(&results));
}

#[test]
fn text_from_data_cannot_become_markup() {
    let evil = || "<img src=x onerror=alert(1)>\"'&".to_owned();
    let mut results = invented::moving();
    results.sensor.name = evil();
    results.sensor.taxels[0].doubtful = Some(evil());
    results.making.command = evil();
    results.making.settings = evil();
    results.bench.doubts = vec![evil()];
    results.evaluation.taxels[0] = evil();
    for press in &mut results.evaluation.presses {
        press.name = evil();
    }
    assert!(!render(&results).contains("<img"));
}

#[test]
fn numbers_that_are_missing_show_as_dashes() {
    let mut results = invented::moving();
    let press = &mut results.evaluation.presses[0];
    press.time_s[3] = f64::NAN;
    press.depth_mm.fill(f64::NAN);
    press.measured_kpa[7].fill(f64::NAN);
    press.predicted_kpa[8].fill(f64::NAN);
    results.evaluation.twin.overall = Errors::default();
    results.evaluation.twin.by_taxel[2] = Errors::default();
    let page = render(&results);
    assert!(page.contains("No error could be computed") && page.contains(">none<"));
    for word in ["NaN", "inf,"] {
        let found = page
            .find(word)
            .map(|at| page[..at].chars().rev().take(80).collect::<String>());
        let before: Option<String> = found.map(|text| text.chars().rev().collect());
        assert_eq!(before, None, "stands before {word}");
    }
}

#[test]
fn badges_follow_the_provenance() {
    let mut results = invented::moving();
    results.provenance = Provenance::Real;
    assert!(render(&results).contains("1.27\u{a0}% error (real data)"));
    results.provenance = Provenance::Emulated;
    let page = render(&results);
    assert!(page.contains("badge emulated") && page.contains("emulated data, which says nothing"));
}

#[test]
fn the_page_is_written_whole() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("report.html");
    let results = invented::resting();
    page(&results.report()).write(&path).unwrap();
    assert_eq!(std::fs::read_to_string(&path).unwrap(), render(&results));
    assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
}
