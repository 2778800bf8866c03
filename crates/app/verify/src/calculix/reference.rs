//! Results of CalculiX, and the file that keeps them.

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::Path;
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail, ensure};
use glam::DVec2;

use super::case::{Case, Level, PORT_RADIUS_MM, line_mm, taxels_mm};
use super::face::Faces;
use super::pressed::{Pressed, PressedFrame};
use super::{deck, output};
use crate::files::write_whole;

/// Working folder of CalculiX, with one folder for each mesh.
pub(super) const FOLDER: &str = "target/calculix";

/// The variable that sets CalculiX's number of threads, and the value if it is not set.
const THREADS: (&str, &str) = ("OMP_NUM_THREADS", "2");

const KPA_PER_MPA: f64 = 1000.0;

/// Runs CalculiX, unless the folder has its results for the same deck. If CalculiX gives up early,
/// only the depths until then are returned.
pub(super) fn compute(case: &Case, level: Level) -> Result<Pressed> {
    let gel = case.bricks(level)?;
    let deck = deck::write(case, &gel)?;
    let size = if level == Level::Fine { "fine" } else { "coarse" };
    let folder = Path::new(FOLDER).join(format!("{}-{size}", case.name));
    std::fs::create_dir_all(&folder)?;
    let input = folder.join("press.inp");
    // The log is written last, so it shows that the run is complete.
    let log = folder.join("press.log");
    if !log.exists() || std::fs::read_to_string(&input).ok().as_ref() != Some(&deck) {
        std::fs::write(&input, &deck)?;
        match std::fs::remove_file(&log) {
            Err(error) if error.kind() != ErrorKind::NotFound => return Err(error.into()),
            _ => (),
        }
        run_ccx(&folder).with_context(|| format!("CalculiX on {}", case.name))?;
    }
    let frd = std::fs::read_to_string(folder.join("press.frd"))?;
    let dat = std::fs::read_to_string(folder.join("press.dat"))?;
    let forces_n = output::total_force_z(&dat)?;
    let stresses = output::fields(&frd, "STRESS")?;
    let gaps = output::fields(&frd, "CONTACT")?;
    // When CalculiX gives up, its last state is no equilibrium, and has no total force.
    let n_frames = forces_n.len();
    ensure!(
        (1..=case.depths_mm.len()).contains(&n_frames)
            && stresses.len() >= n_frames
            && gaps.len() >= n_frames,
        "CalculiX solved {n_frames} depths of {}, see {}",
        case.name,
        folder.display()
    );
    let bottom = gel.bottom();
    let mut frames = Vec::new();
    for (frame, &depth_mm) in case.depths_mm.iter().take(n_frames).enumerate() {
        let mut nodal_kpa = vec![f64::NAN; gel.nodes_mm.len()];
        for (node, stress) in &stresses[frame] {
            nodal_kpa[node - 1] = -KPA_PER_MPA * (stress[0] + stress[1] + stress[2]) / 3.0;
        }
        let faces = Faces {
            faces: &bottom,
            at_mm: &|node| gel.nodes_mm[node].truncate(),
            value: &|node| nodal_kpa[node],
        };
        let folded = |at: DVec2| if case.is_quarter() { at.abs() } else { at };
        let mut pressure_kpa = BTreeMap::new();
        for (name, at_mm) in taxels_mm() {
            let mean = faces.disc_mean(folded(at_mm), PORT_RADIUS_MM);
            pressure_kpa.insert(name, mean.context("a port lies beside the gel")?);
        }
        let line_kpa = line_mm().into_iter().map(|at| faces.at(folded(at)));
        frames.push(PressedFrame {
            depth_mm,
            force_n: forces_n[frame].abs() * if case.is_quarter() { 4.0 } else { 1.0 },
            penetration_mm: gaps[frame].iter().map(|(_, gap)| -gap[0]).fold(0.0, f64::max),
            pressure_kpa,
            line_kpa: line_kpa
                .collect::<Option<_>>()
                .context("a point lies beside the gel")?,
        });
    }
    Ok(Pressed {
        case: case.name.clone(),
        n_elements: gel.bricks.len(),
        n_nodes: gel.nodes_mm.len(),
        frames,
    })
}

fn run_ccx(folder: &Path) -> Result<()> {
    let threads = std::env::var(THREADS.0).unwrap_or_else(|_| THREADS.1.to_owned());
    let output = Command::new("ccx")
        .args(["-i", "press"])
        .current_dir(folder)
        .env(THREADS.0, threads)
        .stdin(Stdio::null())
        .output();
    let output = match output {
        Err(error) if error.kind() == ErrorKind::NotFound => {
            bail!("there is no program `ccx` on the path; install the Debian package calculix-ccx")
        }
        other => other.context("starting ccx")?,
    };
    std::fs::write(folder.join("press.log"), output.stdout)?;
    Ok(())
}

/// Reads references from a file.
pub(super) fn read(file: &Path) -> Result<Vec<Pressed>> {
    let text = match std::fs::read_to_string(file) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        other => other.with_context(|| format!("reading {}", file.display()))?,
    };
    serde_json::from_str(&text).with_context(|| format!("reading {}", file.display()))
}

/// Writes references, sorted, to a file.
pub(super) fn write(file: &Path, references: &mut [Pressed]) -> Result<()> {
    references.sort_by(|a, b| (&a.case, a.n_elements).cmp(&(&b.case, b.n_elements)));
    for frame in references.iter_mut().flat_map(|reference| &mut reference.frames) {
        // CalculiX writes fewer than six digits of a stress.
        let numbers = frame.pressure_kpa.values_mut().chain(&mut frame.line_kpa);
        numbers.for_each(|kpa| *kpa = (*kpa * 1e4).round() / 1e4);
    }
    let rows: Vec<String> = references
        .iter()
        .map(serde_json::to_string)
        .collect::<Result<_, _>>()?;
    write_whole(file, format!("[\n{}\n]\n", rows.join(",\n")).as_bytes())
}
