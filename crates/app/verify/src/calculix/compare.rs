//! Results of this project's solver beside those of CalculiX.

use std::collections::BTreeMap;
use std::ops::ControlFlow;

use anyhow::{Context, Result, bail, ensure};
use twintac_protocol::PressPath;
use twintac_simulate::{Followed, Gel, SimulateSettings};
use twintac_softbody::Element;

use super::case::{Case, Level, line_mm, taxels_mm};
use super::difference::{percent, pressure_percent};
use super::reference::{Reference, ReferenceFrame};

/// Factor by which the mesh of the quadratic reference is finer than that of the comparison, and
/// its largest number of nodes before rims are refined.
pub(super) const FINER: f64 = 1.4;
const FINER_NODES: usize = 40_000;

/// Frames of that reference from depth to depth: on a fine mesh, long steps have no solution.
const QUADRATIC_RATE_HZ: f64 = 5.0;

/// A press in two programs, or with two kinds of elements.
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

/// Presses the gel with quadratic elements, on a mesh as fine as that of the comparison or on a
/// finer one. A press that ends early gives the depths until then.
pub(super) fn quadratic(case: &Case, level: Level) -> Result<Reference> {
    let mut settings = SimulateSettings::fine();
    settings.solver.element = Element::Quadratic;
    if level == Level::Fine {
        settings.edges_per_height *= FINER;
        settings.edges_per_contact_radius *= FINER;
        settings.edges_per_rounding *= FINER;
        settings.max_path_nodes = FINER_NODES;
    }
    let followed = follow(case, settings, Some(QUADRATIC_RATE_HZ))?;
    let at_depth = |depth_mm: f64| {
        let mut frames = followed.frames.iter();
        frames.find(|frame| (frame.depth_mm - depth_mm).abs() < 1e-6)
    };
    let reached = case
        .depths_mm
        .iter()
        .filter_map(|&depth_mm| Some((at_depth(depth_mm)?, depth_mm)));
    let frames = reached.map(|(frame, depth_mm)| {
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
        is_fine: level == Level::Fine,
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
