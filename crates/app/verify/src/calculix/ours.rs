//! The presses in this project's solver.

use std::ops::ControlFlow;

use anyhow::{Context, Result, bail};
use twintac_protocol::PressPath;
use twintac_simulate::{Followed, Gel, SimulateSettings};
use twintac_softbody::Element;

use super::case::{Case, line_mm, taxels_mm};
use super::pressed::{Pressed, PressedFrame};

/// The meshes of the finer reference: the factor by which edges are shorter than those of the
/// comparison, and the largest number of nodes before rims are refined. On one mesh, forces jump by
/// a few percent where nodes pass a rim, which is not seen in the mean.
const FINER: [(f64, usize); 3] = [(1.2, 30_000), (1.3, 35_000), (1.4, 40_000)];

/// Frames of that reference from depth to depth: on a fine mesh, long steps have no solution.
const FINER_RATE_HZ: f64 = 5.0;

/// Presses the gel as `twintac simulate --sensor F --path F` does, with the default settings.
pub(super) fn solve(case: &Case) -> Result<Pressed> {
    let followed = follow(case, SimulateSettings::fine(), None)?;
    if let Some(failure) = followed.failure {
        bail!("{}: {failure}", case.name);
    }
    pressed(case, &followed)
}

/// Presses the gel on finer meshes of elements that are quadratic everywhere.
pub(super) fn finer(case: &Case) -> Result<Vec<Pressed>> {
    let meshes = FINER.iter();
    meshes
        .map(|&(factor, max_path_nodes)| on_finer_mesh(case, factor, max_path_nodes))
        .collect()
}

fn on_finer_mesh(case: &Case, factor: f64, max_path_nodes: usize) -> Result<Pressed> {
    let mut settings = SimulateSettings::fine();
    settings.solver.element = Element::Blended;
    settings.edges_per_height *= factor;
    settings.edges_per_contact_radius *= factor;
    settings.edges_per_rounding *= factor;
    settings.max_path_nodes = max_path_nodes;
    let followed = follow(case, settings, Some(FINER_RATE_HZ))?;
    if let Some(failure) = followed.failure {
        bail!("{} on a mesh {factor} times finer: {failure}", case.name);
    }
    pressed(case, &followed)
}

/// The frames at the depths of a case.
fn pressed(case: &Case, followed: &Followed) -> Result<Pressed> {
    let at_depth = |depth_mm: f64| {
        let mut frames = followed.frames.iter();
        frames.find(|frame| (frame.depth_mm - depth_mm).abs() < 1e-6)
    };
    let frames = case.depths_mm.iter().map(|&depth_mm| {
        let frame = at_depth(depth_mm).with_context(|| format!("no frame is {depth_mm} mm deep"))?;
        let pressure = |name: &str| frame.pressure_kpa.get(name).copied().context("a pressure lacks");
        let taxels = taxels_mm().into_iter();
        Ok(PressedFrame {
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
    Ok(Pressed {
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
