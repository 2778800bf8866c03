//! Results of this project's solver beside those of CalculiX.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use anyhow::{Context, Result, bail, ensure};
use twintac_protocol::PressPath;
use twintac_simulate::{Followed, Gel, SimulateSettings};
use twintac_softbody::Element;

use super::case::{Case, line_mm, taxels_mm};
use super::difference::{percent, pressure_percent};
use super::reference::{Reference, ReferenceFrame};

/// Factors by which the meshes of the finer reference are finer than that of the comparison. On one
/// mesh, forces jump by a few percent where nodes pass a rim, which is not seen in the mean.
const FINER: [f64; 3] = [1.2, 1.3, 1.4];
/// Their largest number of nodes before rims are refined.
const FINER_NODES: usize = 40_000;

/// Frames of that reference from depth to depth: on a fine mesh, long steps have no solution.
const FINER_RATE_HZ: f64 = 5.0;

/// A press in two programs, or on two meshes.
pub(super) struct Compared {
    /// Name of the case.
    pub(super) case: String,
    /// Nodes of this project's mesh.
    pub(super) n_nodes: usize,
    /// One frame for each depth.
    pub(super) frames: Vec<ComparedFrame>,
}

/// The gel at one depth. Pairs hold this project's value and the other one.
pub(super) struct ComparedFrame {
    pub(super) depth_mm: f64,
    pub(super) force_n: [f64; 2],
    /// At the taxels.
    pub(super) pressure_kpa: BTreeMap<String, [f64; 2]>,
    /// At the points along the board.
    pub(super) line_kpa: Vec<[f64; 2]>,
}

/// Presses the gel as `twintac simulate --sensor F --path F` does, with the default settings.
pub(super) fn compare(case: &Case, reference: &Reference) -> Result<Compared> {
    let followed = follow(case, SimulateSettings::fine(), None)?;
    if let Some(failure) = followed.failure {
        bail!("{}: {failure}", case.name);
    }
    ensure!(
        reference.frames.iter().map(|frame| frame.depth_mm).eq(case
            .depths_mm
            .iter()
            .copied()
            .take(reference.frames.len())),
        "{}: the reference has other depths; compute it again",
        case.name
    );
    // The first frame is the first contact, without depth.
    let frames = followed.frames[1..]
        .iter()
        .zip(&reference.frames)
        .map(|(ours, theirs)| {
            let pair = |name: &str, theirs: f64| {
                Ok([*ours.pressure_kpa.get(name).context("a pressure lacks")?, theirs])
            };
            let line = theirs.line_kpa.iter().enumerate();
            Ok(ComparedFrame {
                depth_mm: theirs.depth_mm,
                force_n: [-ours.force_n.z, theirs.force_n],
                pressure_kpa: theirs
                    .pressure_kpa
                    .iter()
                    .map(|(name, &kpa)| Ok((name.clone(), pair(name, kpa)?)))
                    .collect::<Result<_>>()?,
                line_kpa: line
                    .map(|(index, &kpa)| pair(&format!("line{index:02}"), kpa))
                    .collect::<Result<_>>()?,
            })
        });
    Ok(Compared {
        case: case.name.clone(),
        n_nodes: followed.n_nodes,
        frames: frames.collect::<Result<_>>()?,
    })
}

/// Presses the gel on finer meshes of elements that are quadratic everywhere.
pub(super) fn finer(case: &Case) -> Result<Vec<Reference>> {
    FINER.iter().map(|&factor| on_finer_mesh(case, factor)).collect()
}

fn on_finer_mesh(case: &Case, factor: f64) -> Result<Reference> {
    let mut settings = SimulateSettings::fine();
    settings.solver.element = Element::Blended;
    settings.edges_per_height *= factor;
    settings.edges_per_contact_radius *= factor;
    settings.edges_per_rounding *= factor;
    settings.max_path_nodes = FINER_NODES;
    let followed = follow(case, settings, Some(FINER_RATE_HZ))?;
    if let Some(failure) = followed.failure {
        bail!("{} on a mesh {factor} times finer: {failure}", case.name);
    }
    let at_depth = |depth_mm: f64| {
        let mut frames = followed.frames.iter();
        frames.find(|frame| (frame.depth_mm - depth_mm).abs() < 1e-6)
    };
    let frames = case.depths_mm.iter().map(|&depth_mm| {
        let frame = at_depth(depth_mm).with_context(|| format!("no frame is {depth_mm} mm deep"))?;
        let pressure = |name: &str| frame.pressure_kpa.get(name).copied().context("a pressure lacks");
        let taxels = taxels_mm().into_iter();
        Ok(ReferenceFrame {
            depth_mm,
            force_n: -frame.force_n.z,
            penetration_mm: frame.quality.penetration_mm,
            pressure_kpa: taxels
                .map(|(name, _)| Ok((name.clone(), pressure(&name)?)))
                .collect::<Result<_>>()?,
            line_kpa: (0..line_mm().len())
                .map(|index| pressure(&format!("line{index:02}")))
                .collect::<Result<_>>()?,
        })
    });
    Ok(Reference {
        case: case.name.clone(),
        n_elements: followed.n_tets,
        n_nodes: followed.n_nodes,
        frames: frames.collect::<Result<_>>()?,
    })
}

/// Follows a press, with a frame at each depth, or at this rate with a second from depth to depth.
fn follow(case: &Case, settings: SimulateSettings, rate_hz: Option<f64>) -> Result<Followed> {
    let sensor = case.sensor()?;
    let indenter = sensor.indenters.first().context("the sensor has an indenter")?;
    let path = PressPath {
        rate_hz,
        ..case.path()?
    };
    Ok(Gel::new(sensor.clone(), settings).follow(
        &indenter.shape,
        &path,
        &mut || ControlFlow::Continue(()),
    )?)
}

impl ComparedFrame {
    /// Relative error of the force, %.
    pub(super) fn force_error_percent(&self) -> f64 {
        percent(self.force_n, self.force_n[1])
    }

    /// Error of the pressure at a taxel, %.
    pub(super) fn pressure_error_percent(&self, taxel: &str) -> f64 {
        let largest_kpa = self
            .pressure_kpa
            .values()
            .fold(0.0, |largest: f64, pair| largest.max(pair[1].abs()));
        self.pressure_kpa
            .get(taxel)
            .map_or(f64::NAN, |&pair| pressure_percent(pair, largest_kpa))
    }

    /// Root mean square difference of the pressure along the board, % of the largest pressure
    /// there.
    pub(super) fn roughness_percent(&self) -> f64 {
        let squares: f64 = self
            .line_kpa
            .iter()
            .map(|[ours, theirs]| (ours - theirs).powi(2))
            .sum();
        let largest_kpa = self
            .line_kpa
            .iter()
            .fold(0.0, |largest: f64, pair| largest.max(pair[1].abs()));
        100.0 * (squares / self.line_kpa.len() as f64).sqrt() / largest_kpa
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn small_pressures_count_as_part_of_the_largest() {
        let pressures = [("near", [10.5, 10.0]), ("far", [0.3, 0.1])];
        let frame = ComparedFrame {
            depth_mm: 1.0,
            force_n: [0.98, 1.0],
            pressure_kpa: pressures
                .into_iter()
                .map(|(name, pair)| (name.to_owned(), pair))
                .collect(),
            line_kpa: vec![[10.0, 10.0], [1.0, 0.0]],
        };
        assert!((frame.force_error_percent() + 2.0).abs() < 1e-9);
        assert!((frame.pressure_error_percent("near") - 5.0).abs() < 1e-9);
        assert!((frame.pressure_error_percent("far") - 2.0).abs() < 1e-9);
        assert!((frame.roughness_percent() - 10.0 / 2_f64.sqrt()).abs() < 1e-9);
    }
}
