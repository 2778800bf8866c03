//! The figures as a page and a picture.

use std::fmt::Write as _;

use twintac_plot::{Bar, Bars, Ink, Scene};

use crate::Results;
use crate::measure::Spread;

/// Bars of the rates, with MuJoCo's.
pub(crate) fn chart(results: &Results) -> Scene {
    let bar = |name: String, ink: Ink, rate: &Spread| Bar {
        name,
        value: 1e-3 * rate.median,
        uncertainty: Some(0.5e-3 * (rate.highest_tenth - rate.lowest_tenth)),
        text: format!("{:.0}", 1e-3 * rate.median),
        ink,
    };
    let ours = results.rates.iter().map(|rate| {
        let (what, ink) = if rate.is_imperfect {
            ("", Ink::Series(0))
        } else {
            (", perfect", Ink::Series(1))
        };
        let short = rate.body.split(',').next().unwrap_or_default();
        bar(format!("{short}{what}"), ink, &rate.readings_per_s)
    });
    let theirs = results
        .touch_grid
        .iter()
        .map(|grid| bar("MuJoCo touch_grid".to_owned(), Ink::Series(2), &grid.steps_per_s));
    Bars {
        title: format!("{} sensors on {} threads", results.sensors, results.threads),
        x_label: "readings of a sensor, thousands a second".to_owned(),
        bars: ours.chain(theirs).collect(),
    }
    .scene()
}

/// The page.
pub(crate) fn markdown(results: &Results) -> Result<String, std::fmt::Error> {
    let machine = &results.machine;
    let mut text = format!(
        "# Sensors stepped together\n\nMade by `{}` of {} on {}, {} processors ({} data). Load average at the end: {:.1} (what is above {} was other \
         work, and made all rates lower).\n\n\
         {} sensors of {} taxels with the surrogate of PhysTac's gel are stepped together on {} threads. Each is pressed by a body of its own pose, which slides and tilts at \
         every step. A reading is that of all taxels of one sensor, with force and torque. *Imperfect* sensors have a trained twin's \
         viscoelastic relaxation and the whole sensor variation (`[variation]`), *perfect* ones neither. All scenes take turns in one run; of {} steps each, the median counts, and 80 % lie within the range.\n\n\
         | body | sensors | readings a second | range |\n|---|---|---:|---:|\n",
        results.command,
        results.commit,
        machine.processor,
        machine.processors,
        results.provenance,
        machine.load_average,
        results.threads,
        results.sensors,
        results.taxels,
        results.threads,
        results.steps
    );
    for rate in &results.rates {
        let what = if rate.is_imperfect { "imperfect" } else { "perfect" };
        let readings = &rate.readings_per_s;
        writeln!(
            text,
            "| {} | {what} | {:.0} | {} |",
            rate.body,
            readings.median,
            range(readings, 0)
        )?;
    }
    text += "\n![Readings a second of each scene](sensors.svg)\n\n## One sensor\n\nA call for one imperfect sensor, on the calling thread:\n\n\
             | body | call, µs | range, µs |\n|---|---:|---:|\n";
    for latency in &results.latencies {
        let call_us = &latency.call_us;
        writeln!(
            text,
            "| {} | {:.1} | {} |",
            latency.body,
            call_us.median,
            range(call_us, 1)
        )?;
    }
    write!(
        text,
        "\nMemory: {:.0} bytes a sensor, counted by the allocator for all of them, with what they share.\n\n## Beside others\n\n\
         One core copies {:.1} GB a second (`memcpy`, more than caches hold). Poses in and readings out are {:.0} bytes a reading: at the rate of the slowest scene \
         of imperfect sensors, {:.2} % of what that core could copy.\n\n",
        results.bytes_per_sensor,
        1e-9 * results.copied_bytes_per_s,
        results.moved_bytes_per_reading,
        100.0 * results.part_of_copying()
    )?;
    match (&results.touch_grid, &results.touch_grid_note) {
        (Some(grid), _) => writeln!(
            text,
            "MuJoCo {}'s sensor `touch_grid` of {} cells over a flat pad, as many scenes on as many threads, each with one ball that slides: {:.0} steps of a scene a \
             second ({}). The slowest of our scenes of imperfect sensors makes {:.2} readings in that time. MuJoCo's step also moves the bodies. Its sensor sums contact forces in \
             cells, {:.1} of which touch the ball on average; it has no gel: no pressure beside the contact, no relaxation, no sensor variation.",
            grid.version,
            grid.cells,
            grid.steps_per_s.median,
            range(&grid.steps_per_s, 0),
            results.slowest() / grid.steps_per_s.median,
            grid.cells_touched
        )?,
        (None, note) => writeln!(
            text,
            "MuJoCo's `touch_grid`: {}.",
            note.as_deref().unwrap_or("not measured")
        )?,
    }
    Ok(text)
}

fn range(spread: &Spread, decimals: usize) -> String {
    format!(
        "{:.decimals$} to {:.decimals$}",
        spread.lowest_tenth, spread.highest_tenth
    )
}
