//! The data card: what a person who finds the data set needs to know.

use std::fmt::Write as _;

use serde_json::Value;
use twintac_text::{markdown, visible};

use super::episode::LeRobotSummary;
use super::features::Feature;
use crate::{Provenance, Recording};

/// The text of `README.md`. `how_made` is Markdown.
pub(super) fn card(
    recording: &Recording,
    features: &[Feature],
    summary: &LeRobotSummary,
    how_made: &str,
) -> String {
    let (sensor, provenance) = (markdown(&recording.sensor), recording.provenance);
    // A Python string literal; JSON's form is valid in Python.
    let repository = Value::from(format!("twintac/{}", recording.sensor)).to_string();
    let repository = visible(&repository);
    let meaning = match provenance {
        Provenance::Real => "measured on hardware",
        Provenance::Emulated => "read from an emulated bench in software, not from hardware",
        Provenance::Simulated => "computed by a simulation, not measured",
    };
    let LeRobotSummary {
        episodes,
        frames,
        tasks,
        fps,
        resampled_from_hz,
    } = summary;
    let mut card = format!(
        "---\ntags:\n- LeRobot\n- tactile\ntask_categories:\n- robotics\nconfigs:\n- config_name: default\n  data_files: data/*/*.parquet\n---\n\n\
         # Presses of the barometric touch sensor {sensor}\n\n\
         - Provenance: `{provenance}`: every number is {meaning}.\n\
         - {episodes} episodes (presses), {frames} frames, {tasks} tasks (indenters), {fps} frames a second; LeRobot format v3.0.\n\
         - Licence: to be filled in by whoever publishes this.\n\n\
         ```python\nfrom lerobot.datasets.lerobot_dataset import LeRobotDataset\n\ndataset = LeRobotDataset({repository}, root=\".\")\n```\n\n\
         ## Features\n\n| feature | type | numbers | meaning |\n|---|---|---|---|\n"
    );
    for feature in features {
        let meaning = meaning_of(&feature.name);
        let _ = writeln!(
            card,
            "| `{}` | {} | {} | {meaning} |",
            feature.name,
            feature.dtype(),
            markdown(&feature.names())
        );
    }
    card.push_str(
        "\nLengths are in mm, forces in N, pressures in kPa, times in s. The gel's frame has z up and z = 0 at the board; an indenter's origin is its point of first \
         touch on a flat gel. Quaternions are (x, y, z, w).\n",
    );
    if let Some(from_hz) = resampled_from_hz {
        let _ = writeln!(
            card,
            "\nFrames were resampled: they came at {from_hz:.2} Hz by the median of the times between them, and are interpolated linearly at {fps} Hz. A reading \
             is usable where the two readings around it are usable and no frame between them is missing; poses and forces are interpolated across missing frames, too."
        );
    }
    if !features.iter().any(|feature| feature.name == "observation.force") {
        card.push_str("\nThere is no force, because not all presses have one.\n");
    }
    for (taxel, name) in recording.taxels.iter().enumerate() {
        let rows = recording.presses.iter().flat_map(|press| &press.valid);
        let n_unusable = rows.filter(|row| !row[taxel]).count();
        if n_unusable > 0 {
            let _ = writeln!(
                card,
                "\nTaxel {} has no reading that can be used in {n_unusable} of {frames} frames: `tactile_valid` is false there, `observation.tactile` is NaN where a reading is missing, and \
                 statistics leave these readings out.",
                markdown(name)
            );
        }
    }
    let _ = writeln!(card, "\n## How it was made\n\n{}", how_made.trim());
    card
}

fn meaning_of(feature: &str) -> &'static str {
    match feature {
        "observation.state" => "pose of the indenter in the gel's frame",
        "observation.tactile" => "readings above the unloaded baseline, kPa",
        "observation.force" => "force of the indenter on the gel along -z, N",
        "action" => "pose of the next frame; the last frame's is its own",
        "tactile_valid" => {
            "whether each reading can be used: not clipped, not missing, not beyond what was simulated"
        }
        "timestamp" => "time since the press began, s",
        "frame_index" => "number of the frame in its press",
        "episode_index" => "number of the press",
        "index" => "number of the frame among all",
        "task_index" => "number of the task, see `meta/tasks.parquet`",
        _ => "",
    }
}
