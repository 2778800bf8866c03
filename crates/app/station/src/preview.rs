//! A preview of presses on a bench: locations, motion and duration.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use glam::DVec3;
use serde::Serialize;
use twintac_plot::{Ink, Panel, Panels, Places, Series, svg};
use twintac_press::{DryRun, PressSettings, dry_run};
use twintac_protocol::PressPlan;
use twintac_sensor::Sensor;
use twintac_shape::Pose;
use twintac_store::write_file;
use twintac_work::WorkError;

/// What a protocol would do on a bench, and how long it would take.
#[derive(Clone, Debug, Serialize)]
pub struct Preview {
    /// Number of presses.
    pub presses: usize,
    /// Number of different indenters.
    pub indenters: usize,
    /// Duration, s, without the time to change indenters.
    pub duration_s: f64,
    /// Drawings of locations and motion (SVG).
    pub drawings: Vec<PathBuf>,
}

impl Preview {
    /// The duration in minutes and seconds, for people.
    #[must_use]
    pub fn duration(&self) -> String {
        minutes(self.duration_s)
    }
}

/// Computes and draws what presses would do on a bench, without one. The drawings go into `folder`.
///
/// # Errors
/// A press that cannot be carried out; a file that cannot be written.
pub fn preview(
    settings: &PressSettings,
    plans: &[PressPlan],
    sensor: &Sensor,
    folder: &Path,
) -> Result<Preview, WorkError> {
    let start = settings
        .placement
        .tool(&Pose::from_position(settings.travel_height_mm * DVec3::Z));
    let dry = dry_run(settings, plans, &start)?;
    let drawings = [folder.join("places.svg"), folder.join("motion.svg")];
    let scenes = [places(plans, sensor).scene(), motion(&dry, settings).scene()];
    for (path, scene) in drawings.iter().zip(scenes) {
        write_file(path, svg(&scene).as_bytes())?;
    }
    let indenters: BTreeSet<&str> = plans.iter().map(|plan| plan.indenter.as_str()).collect();
    Ok(Preview {
        presses: plans.len(),
        indenters: indenters.len(),
        duration_s: dry.duration_s,
        drawings: drawings.into(),
    })
}

fn minutes(seconds: f64) -> String {
    let seconds = seconds.round();
    format!("{:.0} min {:02.0} s", (seconds / 60.0).floor(), seconds % 60.0)
}

fn places(plans: &[PressPlan], sensor: &Sensor) -> Places {
    Places {
        title: format!("Depths of {} presses", plans.len()),
        unit: "mm".to_owned(),
        places_mm: plans.iter().map(|plan| [plan.x_mm, plan.y_mm]).collect(),
        values: plans.iter().map(|plan| plan.depth_mm).collect(),
        marks_mm: sensor
            .taxels
            .iter()
            .map(|taxel| [taxel.position_mm.x, taxel.position_mm.y])
            .collect(),
    }
}

/// Number of presses whose motion is drawn; more would be illegible.
const DRAWN: usize = 5;

/// The indenter's position over time, in the gel's frame.
fn motion(dry: &DryRun, settings: &PressSettings) -> Panels {
    let poses: Vec<(f64, DVec3)> = dry
        .presses
        .iter()
        .take(DRAWN)
        .flat_map(|press| &press.poses)
        .map(|pose| (pose.time_s, settings.placement.indenter(&pose.tool).position_mm))
        .collect();
    let panel = |y_label: &str, axis: usize| Panel {
        y_label: y_label.to_owned(),
        series: vec![Series {
            name: String::new(),
            points: poses.iter().map(|(time_s, at)| [*time_s, at[axis]]).collect(),
            ink: Ink::Series(0),
            width_px: 1.0,
            dashed: false,
        }],
        ..Panel::default()
    };
    Panels {
        title: format!(
            "Position of the indenter's tip in the first {} of {} presses, which take {} in all",
            dry.presses.len().min(DRAWN),
            dry.presses.len(),
            minutes(dry.duration_s)
        ),
        x_label: "time, s".to_owned(),
        panels: vec![panel("height, mm", 2), panel("x, mm", 0), panel("y, mm", 1)],
        panel_height_px: 110.0,
        logarithmic: false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seconds_are_rounded_before_they_are_minutes() {
        assert_eq!(minutes(119.7), "2 min 00 s");
        assert_eq!(minutes(119.4), "1 min 59 s");
        assert_eq!(minutes(5.2), "0 min 05 s");
    }
}
