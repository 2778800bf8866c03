//! Results of CalculiX, and the file that keeps them.

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::Path;
use std::process::{Command, Stdio};

use anyhow::{Context, Result, bail, ensure};
use glam::DVec2;
use serde::{Deserialize, Serialize};

use super::case::{Case, Level, PORT_RADIUS_MM, line_mm, taxels_mm};
use super::difference::{percent, pressure_percent};
use super::face::Faces;
use super::{deck, output};
use crate::files::write_whole;

/// Working folder of CalculiX, with one folder for each mesh.
pub(super) const FOLDER: &str = "target/calculix";

/// The variable that sets CalculiX's number of threads, and the value if it is not set.
const THREADS: (&str, &str) = ("OMP_NUM_THREADS", "2");

const KPA_PER_MPA: f64 = 1000.0;

/// One press on one reference mesh.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct Reference {
    /// Name of the case.
    pub(super) case: String,
    /// Elements of the gel.
    pub(super) n_elements: usize,
    /// Nodes of the gel.
    pub(super) n_nodes: usize,
    /// One frame for each depth.
    pub(super) frames: Vec<ReferenceFrame>,
}

/// The gel at one depth.
#[derive(Clone, Serialize, Deserialize)]
pub(super) struct ReferenceFrame {
    pub(super) depth_mm: f64,
    /// Force on the board, N.
    pub(super) force_n: f64,
    /// Largest penetration of a node of the gel's top into the indenter, mm.
    pub(super) penetration_mm: f64,
    /// Mean of -tr(σ)/3 over each taxel's port, kPa.
    pub(super) pressure_kpa: BTreeMap<String, f64>,
    /// -tr(σ)/3 at points along the board, kPa.
    pub(super) line_kpa: Vec<f64>,
}

impl Reference {
    /// The mean of forces and pressures of the same press on several meshes; `None` without meshes
    /// or if they have other depths. The numbers of elements and nodes are those of the finest
    /// mesh.
    pub(super) fn mean(meshes: &[&Self]) -> Option<Self> {
        let mut mean = (*meshes.iter().max_by_key(|mesh| mesh.n_elements)?).clone();
        if meshes.iter().any(|mesh| mesh.frames.len() != mean.frames.len()) {
            return None;
        }
        for (index, frame) in mean.frames.iter_mut().enumerate() {
            let frames: Vec<&ReferenceFrame> = meshes.iter().map(|mesh| &mesh.frames[index]).collect();
            let mean_of = |value: &dyn Fn(&ReferenceFrame) -> f64| {
                frames.iter().map(|frame| value(frame)).sum::<f64>() / frames.len() as f64
            };
            frame.force_n = mean_of(&|frame| frame.force_n);
            frame.penetration_mm = mean_of(&|frame| frame.penetration_mm);
            for (taxel, kpa) in &mut frame.pressure_kpa {
                *kpa = mean_of(&|frame| frame.pressure_kpa.get(taxel).copied().unwrap_or(f64::NAN));
            }
            for (point, kpa) in frame.line_kpa.iter_mut().enumerate() {
                *kpa = mean_of(&|frame| frame.line_kpa[point]);
            }
        }
        Some(mean)
    }

    /// Largest differences of force and of pressures at the taxels from another mesh, %.
    pub(super) fn largest_difference_percent(&self, other: &Self) -> [f64; 2] {
        let (mut force, mut pressure): (f64, f64) = (0.0, 0.0);
        for (a, b) in self.frames.iter().zip(&other.frames) {
            force = force.max(percent([a.force_n, b.force_n], b.force_n).abs());
            let largest_kpa = b.pressure_kpa.values().copied().fold(0.0, f64::max);
            for (a, b) in a.pressure_kpa.values().zip(b.pressure_kpa.values()) {
                pressure = pressure.max(pressure_percent([*a, *b], largest_kpa).abs());
            }
        }
        [force, pressure]
    }
}

/// Runs CalculiX, unless the folder has its results for the same deck. If CalculiX gives up early,
/// only the depths until then are returned.
pub(super) fn compute(case: &Case, level: Level) -> Result<Reference> {
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
        frames.push(ReferenceFrame {
            depth_mm,
            force_n: forces_n[frame].abs() * if case.is_quarter() { 4.0 } else { 1.0 },
            penetration_mm: gaps[frame].iter().map(|(_, gap)| -gap[0]).fold(0.0, f64::max),
            pressure_kpa,
            line_kpa: line_kpa
                .collect::<Option<_>>()
                .context("a point lies beside the gel")?,
        });
    }
    Ok(Reference {
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
pub(super) fn read(file: &Path) -> Result<Vec<Reference>> {
    let text = match std::fs::read_to_string(file) {
        Err(error) if error.kind() == ErrorKind::NotFound => return Ok(Vec::new()),
        other => other.with_context(|| format!("reading {}", file.display()))?,
    };
    serde_json::from_str(&text).with_context(|| format!("reading {}", file.display()))
}

/// Writes references, sorted, to a file.
pub(super) fn write(file: &Path, references: &mut [Reference]) -> Result<()> {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn on_mesh(n_elements: usize, force_n: f64, kpa: f64) -> Reference {
        Reference {
            case: "case".into(),
            n_elements,
            n_nodes: 2 * n_elements,
            frames: vec![ReferenceFrame {
                depth_mm: 1.0,
                force_n,
                penetration_mm: 0.0,
                pressure_kpa: [("t0".to_owned(), kpa)].into(),
                line_kpa: vec![2.0 * kpa],
            }],
        }
    }

    #[test]
    fn the_mean_of_meshes_is_of_each_value() -> Result<()> {
        let meshes = [on_mesh(100, 1.0, 10.0), on_mesh(300, 2.0, 20.0)];
        let mean = Reference::mean(&meshes.each_ref()).context("there are meshes")?;
        assert_eq!(mean.n_elements, 300);
        assert_eq!(mean.frames[0].force_n, 1.5);
        assert_eq!(mean.frames[0].pressure_kpa["t0"], 15.0);
        assert_eq!(mean.frames[0].line_kpa, [30.0]);
        let [force, pressure] = meshes[0].largest_difference_percent(&mean);
        assert!((force - 100.0 / 3.0).abs() < 1e-9 && (pressure - 100.0 / 3.0).abs() < 1e-9);
        assert!(Reference::mean(&[]).is_none());
        Ok(())
    }
}
