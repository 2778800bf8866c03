//! The page for people.

use std::fmt::Write as _;

use super::faults::Outcome;
use super::results::Results;

pub(super) fn markdown(results: &Results) -> String {
    let whole = &results.whole;
    let mut page = format!(
        "# Recording on the emulated bench\n\n\
         `{}` made this page ({} data): `twintac record --lab` presses twice with a 25 mm ball over loopback sockets and an I²C bus that is emulated\n\
         down to its registers and its 400 kHz, in real time.\n\n\
         Without faults: {} frames of eight taxels at **{:.1} Hz**; {} lost frames are not marked in the log.\n\n\
         ## Faults\n\n\
         Each fault begins during a hold. The column *lost* counts lost readings that no gap in the log marks; the log is read again to find them.\n\
         The latency of the stop is the time from the arrival of its cause, or from the end of the longest allowed silence, in servo periods of 8 ms.\n\n\
         | fault | outcome | gaps marked | lost | stop latency, periods |\n|---|---|---|---|---|\n",
        results.command, results.provenance, whole.frames, whole.rate_hz, whole.lost_unmarked
    );
    for outcome in &results.faults {
        let summary = &outcome.summary;
        let latency = summary
            .stop_latency_periods
            .map_or(String::new(), |periods| format!("{periods:.2}"));
        let _ = writeln!(
            page,
            "| {} | {} | {} | {} | {latency} |",
            outcome.fault,
            words(outcome),
            gaps(outcome),
            summary.lost_unmarked
        );
    }
    let kills = &results.kills;
    let _ = write!(
        page,
        "\n## Kills\n\n\
         {} recordings were ended by SIGKILL at random moments, {} of them while a press was being recorded. Of the {} remaining logs, {} cannot be opened;\n\
         at most {:.2} s before the kill are missing.\n",
        kills.kills,
        kills.while_recording,
        kills.logs,
        kills.unreadable.len(),
        kills.longest_missing_s()
    );
    page
}

fn words(outcome: &Outcome) -> String {
    match &outcome.summary.stopped {
        Some(cause) => format!("stopped: {cause}"),
        None if outcome.notes.is_empty() => "recorded to the end".to_owned(),
        None => format!("recorded to the end; noted: {}", outcome.notes.join(", ")),
    }
}

fn gaps(outcome: &Outcome) -> String {
    let gaps = outcome.gaps.iter();
    gaps.map(|(stream, count)| format!("{count} {stream}"))
        .collect::<Vec<_>>()
        .join(", ")
}
