//! The report.

use twintac_plot::page::{Block, Card, Cell, Fact, Page, Section};
use twintac_recording::Recording;
use twintac_sensor::Sensor;

use super::parts::{self, badge, figures, table};
use super::plots::{self, Plot};
use super::sheet;
use super::words::{number, or_not};
use crate::recorded::Recorded;
use crate::{Characterization, Finding};

/// The source that descriptions of the TwinTac paper's sensor name.
const PAPER: &str = "arXiv 2509.10063";

/// The report page: all figures, plots and definitions, and the figures that were not found.
#[must_use]
pub fn report(found: &Characterization, recording: &Recording, sensor: &Sensor) -> Page {
    let recorded = parts::recorded(found, recording, sensor);
    let figures = |plots| vec![figures(plots, found.provenance)];
    let section = |id, title, blocks| Section { id, title, blocks };
    let time = figures(vec![plots::over_time(recording, &recorded)]);
    let speed = figures(vec![
        plots::rise(found, &recorded),
        plots::creep(found, &recorded),
    ]);
    let cross_talk = figures(vec![found.cross_talk.found().map(plots::cross_talk)]);
    let noise = figures(vec![noise_bars(found), plots::drift(found)]);
    let mut sections = vec![
        section("result", "Result", result(found, sensor)),
        section("time", "Over time", time),
        section(
            "range",
            "Range and sensitivity",
            range(found, recording, sensor, &recorded),
        ),
        section(
            "repeats",
            "Hysteresis and repeatability",
            figures(repeat_plots(found)),
        ),
        section("speed", "Rise and creep", speed),
        section("cross-talk", "Cross-talk", cross_talk),
        section("noise", "Noise and drift", noise),
        section("missing", "Not given by these recordings", missing(found)),
        section("definitions", "Definitions", definitions(found)),
    ];
    let is_empty = |block: &Block| matches!(block, Block::Figures(figures) if figures.is_empty());
    sections.retain(|section| !section.blocks.iter().all(is_empty));
    Page {
        kind: "Characterization".into(),
        title: found.sensor.clone(),
        badge: badge(found.provenance),
        lead: vec![lead(found).into()],
        warnings: parts::warnings(found),
        sections,
        is_sheet: false,
    }
}

fn range(
    found: &Characterization,
    recording: &Recording,
    sensor: &Sensor,
    recorded: &[Recorded<'_>],
) -> Vec<Block> {
    let plots = vec![
        plots::smallest_step(found, recorded),
        plots::largest_force(found, recording, recorded),
        plots::responses(found),
        plots::linearity(found),
    ];
    let mut blocks = vec![figures(plots, found.provenance)];
    blocks.extend(response_table(found));
    blocks.extend(step_table(found));
    if sensor.source.contains(PAPER) {
        let text = format!(
            "For its own sensor the TwinTac paper ({PAPER}) reports 7.24 kPa/N with a round indenter 25 mm wide, a detected step of 0.007 N, and 212 N \
             as the largest force."
        );
        blocks.push(Block::Text(text.into()));
    }
    blocks
}

fn repeat_plots(found: &Characterization) -> Vec<Option<Plot>> {
    let loops = found.hysteresis.found().into_iter().flatten();
    let repeats = found.repeatability.found().into_iter().flatten();
    vec![
        plots::hysteresis(found),
        plots::bars(
            "Hysteresis",
            "% of full scale",
            loops.map(|taxel| (taxel.taxel.clone(), taxel.percent)),
            "Largest difference between unloading and loading at the same force.",
        ),
        plots::bars(
            "Repeatability",
            "% of full scale",
            repeats.map(|taxel| (taxel.taxel.clone(), taxel.percent)),
            "Largest standard deviation at the same force.",
        ),
    ]
}

fn noise_bars(found: &Characterization) -> Option<Plot> {
    let noise = found.noise.found().into_iter().flatten();
    plots::bars(
        "Noise floor",
        "kPa",
        noise.map(|noise| (noise.taxel.clone(), noise.deviation_kpa)),
        "Standard deviation of single unloaded readings.",
    )
}

fn lead(found: &Characterization) -> String {
    if found.n_presses == 0 {
        return format!(
            "{} frames of readings alone, in which nothing should touch the sensor: figures that require presses are not given.",
            found.n_frames_alone
        );
    }
    let sensitivity = or_not(&found.overall, |overall| {
        format!(
            "{} kPa/N on average over {} taxels, linear to {} N",
            number(overall.mean_kpa_per_n, 3),
            overall.n_taxels,
            number(overall.linear_to_n, 2)
        )
    });
    let range = found.range.found().map_or(String::new(), |range| {
        format!(" The data go up to {} N.", number(range.force_n, 3))
    });
    format!("Sensitivity {sensitivity}, from {} presses.{range}", found.n_used)
}

fn result(found: &Characterization, sensor: &Sensor) -> Vec<Block> {
    let mut cards = Vec::new();
    let mut card = |value: Option<String>, name: &str| {
        cards.extend(value.map(|value| Card {
            fact: Fact::new(name, value),
            badge: badge(found.provenance),
        }));
    };
    let overall = found.overall.found();
    card(
        overall.map(|overall| format!("{} kPa/N", number(overall.mean_kpa_per_n, 3))),
        "mean sensitivity",
    );
    card(
        found
            .smallest_step()
            .map(|step| format!("{} N", number(step.force_n, 2))),
        "smallest step detected",
    );
    let range = found.range.found();
    card(
        range.map(|range| format!("{} N", number(range.force_n, 3))),
        "largest force in the data",
    );
    let widest = found
        .hysteresis
        .found()
        .into_iter()
        .flatten()
        .map(|taxel| taxel.percent.abs());
    card(
        widest
            .reduce(f64::max)
            .map(|percent| format!("{} %", number(percent, 2))),
        "largest hysteresis",
    );
    vec![Block::Cards(cards), sheet::table(found, sensor)]
}

fn response_table(found: &Characterization) -> Option<Block> {
    let rows = found.sensitivity.found()?.iter().map(|taxel| {
        vec![
            Cell::Words(taxel.taxel.clone()),
            Cell::Number(number(taxel.sensitivity_kpa_per_n, 3)),
            Cell::Number(number(taxel.linear_to_n, 3)),
            Cell::Number(number(taxel.linearity_percent, 2)),
            Cell::Words(if taxel.is_linear_to_end { "yes" } else { "no" }.into()),
            Cell::Number(number(taxel.data_to_n, 3)),
            Cell::Number(taxel.n_presses.to_string()),
        ]
    });
    let head = [
        "taxel",
        "kPa/N",
        "linear to, N",
        "linearity, %",
        "to the end of the data",
        "data to, N",
        "presses",
    ];
    let caption = "Sensitivity over the linear range, by taxel.";
    Some(table(caption, head, rows.collect()))
}

fn step_table(found: &Characterization) -> Option<Block> {
    let mut steps: Vec<_> = found.steps.found()?.iter().collect();
    steps.sort_by(|a, b| a.force_n.total_cmp(&b.force_n));
    let rows = steps.into_iter().map(|step| {
        vec![
            Cell::Words(step.press.clone()),
            Cell::Words(step.taxel.clone()),
            Cell::Number(number(step.force_n, 2)),
            Cell::Number(number(step.step_kpa, 2)),
            Cell::Number(number(step.z_single, 2)),
            Cell::Number(number(step.z_averaged, 2)),
            Cell::Words(if step.is_detected { "yes" } else { "no" }.into()),
        ]
    });
    let head = [
        "weight",
        "taxel",
        "N",
        "step, kPa",
        "z, one reading",
        "z, mean",
        "detected",
    ];
    let caption = format!(
        "Steps of known force. z is the step over the standard deviation of one reading, and of the change of the mean over {} s while nothing happens; \
         a step with z = {} or more of the mean is detected.",
        found.options.window_s, found.options.sigmas
    );
    Some(table(caption, head, rows.collect()))
}

fn missing(found: &Characterization) -> Vec<Block> {
    fn why<T>(name: &str, finding: &Finding<T>) -> Option<Fact> {
        finding.why_not().map(|why| Fact::new(name, why))
    }
    let facts: Vec<Fact> = [
        why("noise floor", &found.noise),
        why("sensitivity", &found.sensitivity),
        why("detection limit", &found.detection_limit),
        why("steps of known force", &found.steps),
        why("range", &found.range),
        why("hysteresis", &found.hysteresis),
        why("repeatability", &found.repeatability),
        why("rise time", &found.rise_time),
        why("creep", &found.creep),
        why("cross-talk", &found.cross_talk),
        why("return to zero", &found.zero_return),
        why("zero over time", &found.zero),
        why("drift with temperature", &found.temperature_drift),
    ]
    .into_iter()
    .flatten()
    .collect();
    vec![Block::Facts(facts)]
}

fn definitions(found: &Characterization) -> Vec<Block> {
    let options = &found.options;
    let words = |value: f64| value.to_string();
    let row = |name: &str, text: String| vec![Cell::Words(name.to_owned()), Cell::Words(text)];
    let rows = vec![
        row("above a taxel", format!("the indenter’s centre within {} mm of the taxel’s, in plan", words(options.above_mm))),
        row("slow press", format!("to a depth, {} s or longer from contact to hold", words(options.slow_s))),
        row(
            "sensitivity",
            "slope of the least-squares line through the response to slow loading over the linear range, the response averaged in a hundred steps of force".into(),
        ),
        row(
            "linear range",
            format!(
                "the longest range from zero force in which no point is farther from the range’s own line than {} % of the response at its end (independent \
                 linearity, IEC 61298-2)",
                words(options.linear_percent)
            ),
        ),
        row("noise floor", "standard deviation of unloaded readings about the mean of their press, all presses pooled".into()),
        row("detection limit", format!("{} times the noise floor over the sensitivity", words(options.sigmas))),
        row(
            "detected step",
            format!(
                "the mean over {} s after a known step, minus that before it, is {} or more standard deviations of such a difference while nothing happens",
                words(options.window_s),
                words(options.sigmas)
            ),
        ),
        row("hysteresis", "largest difference between unloading and loading at the same force, in % of the response at the largest force (ISA-51.1)".into()),
        row(
            "repeatability",
            "largest standard deviation of readings at the same force in three or more equal slow presses, in % of the response at their largest force".into(),
        ),
        row("rise time", format!("from 10 to 90 % of the largest reading, in presses whose force rises from 10 to 90 % in {} s or less", words(options.fast_s))),
        row("creep", "change of the ratio of reading to force in a hold (ISA-37.1, for a load that a robot cannot keep constant)".into()),
        row("cross-talk", "ratio of the reading of another taxel to that of the pressed one, at the same force".into()),
        row("return to zero", "unloaded reading after a press, minus that before".into()),
        row("zero over time", "slope of the least-squares line of unloaded readings over time, averaged over five seconds, in the longest log".into()),
        row("drift with temperature", "slope of the least-squares line of unloaded readings over the chips’ temperature, both averaged over five seconds".into()),
    ];
    vec![table("", ["figure", "definition"], rows)]
}

#[cfg(test)]
mod tests {
    use twintac_recording::Provenance;

    use super::*;
    use crate::synthetic::{Shape, press};
    use crate::{CharacterizeOptions, characterize};

    #[test]
    fn the_papers_figures_stand_beside_those_of_its_sensor_only() {
        let text = include_str!("../../../../../sensors/phystac.toml");
        let mut sensor = Sensor::parse("phystac.toml", text, &|name| std::fs::read(name)).unwrap();
        sensor.taxels.truncate(2);
        sensor.taxels[0].position_mm = glam::DVec3::ZERO; // the press is there
        let recording = Recording {
            sensor: sensor.name.clone(),
            provenance: Provenance::Emulated,
            taxels: sensor.taxels.iter().map(|taxel| taxel.name.clone()).collect(),
            presses: vec![press(&Shape::default())],
        };
        let found = characterize(&recording, &[], &sensor, &CharacterizeOptions::default()).unwrap();
        let page = report(&found, &recording, &sensor);
        for block in page.sections.iter().flat_map(|section| &section.blocks) {
            if let Block::Figures(figures) = block {
                for figure in figures {
                    assert_eq!(
                        figure.scene.overflow(),
                        Vec::<&str>::new(),
                        "{}",
                        figure.scene.name
                    );
                }
            }
        }
        let page = page.render();
        assert!(page.contains("212 N as the largest force"));
        assert!(page.contains("clocks that may differ"));
        let mut silent = recording.clone();
        for frame in 40..101 {
            let press = &mut silent.presses[0];
            (press.taxels_kpa[frame][1], press.taxels_raw[frame][1]) = (f64::NAN, f64::NAN);
            press.valid[frame][1] = false;
        }
        let silent_found = characterize(&silent, &[], &sensor, &CharacterizeOptions::default()).unwrap();
        let page = report(&silent_found, &silent, &sensor).render();
        let n = silent.presses[0].time_s.len();
        let said = format!("no readings of {} in 61 of {n} frames", silent.taxels[1]);
        assert!(page.contains("0 dead, 0 stuck, 0 late, 1 intermittent") && page.contains(&said));
        assert!(!page.contains("NaN"));
        sensor.source = "measured by its maker".to_owned();
        let page = report(&found, &recording, &sensor).render();
        assert!(!page.contains("TwinTac paper"));
    }
}
