//! Presses a ball into a block of gel at several mesh sizes, and prints forces, pressures and times.

#[path = "../tests/common/mod.rs"]
mod common;

use common::{Ball, block, disc_mean, even, press};
use twintac_softbody::{Material, SoftBody, SolverSettings};

#[allow(clippy::print_stdout, clippy::unwrap_used)]
fn main() {
    let arguments: Vec<f64> = std::env::args().skip(1).map(|a| a.parse().unwrap()).collect();
    let stiffness = arguments.get(1).copied();
    let stabilisation = arguments.get(2).copied();
    for cells in [[22, 12, 6], [28, 15, 7], [38, 20, 9]] {
        if arguments
            .first()
            .is_some_and(|n| *n > 0.0 && *n as usize != cells[0])
        {
            continue;
        }
        let (x, y, z) = (
            even(-17.0, 17.0, cells[0]),
            even(-9.0, 9.0, cells[1]),
            even(0.0, 8.5, cells[2]),
        );
        let mut settings = SolverSettings::default();
        settings.contact_stiffness = stiffness.unwrap_or(settings.contact_stiffness);
        settings.stabilisation = stabilisation.unwrap_or(settings.stabilisation);
        let started = std::time::Instant::now();
        let body = SoftBody::new(block(&x, &y, &z), Material::neo_hookean(70.0, 0.49), settings).unwrap();
        println!(
            "{} nodes, built in {:.0} ms, {:.2} M factor entries",
            body.mesh().nodes_mm.len(),
            1e3 * started.elapsed().as_secs_f64(),
            body.n_factor_entries() as f64 / 1e6
        );
        let mut state = body.rest();
        for (depth, force, pressure) in [
            (0.25, None, None),
            (0.5, Some(0.2155), Some(0.642)),
            (1.0, Some(0.7100), Some(2.109)),
            (1.5, None, None),
            (2.0, Some(2.4585), Some(7.00)),
            (2.5, None, None),
            (3.0, None, None),
            (3.5, None, None),
            (4.0, Some(8.881), Some(21.96)),
        ] {
            let frame = press(&body, &mut state, &Ball { radius_mm: 12.5 }, 8.5, depth).unwrap();
            let at_taxel = disc_mean(&x, &y, &body.pressure_kpa(&state), [4.0, 4.0], 1.0);
            let found = -frame.indenter_force_n.z;
            print!("{depth:5.2} mm  {found:8.4} N  {at_taxel:8.3} kPa  ");
            if let (Some(force), Some(pressure)) = (force, pressure) {
                print!(
                    "error {:+5.1} % {:+5.1} %  ",
                    100.0 * (found / force - 1.0),
                    100.0 * (at_taxel / pressure - 1.0)
                );
            }
            println!(
                "{:2} iterations, {:4.0} ms each, residual {:.0e}, penetration {:.4} mm, J {:.2}",
                frame.iterations,
                1e3 * frame.wall_time_s / f64::from(frame.iterations.max(1)),
                frame.residual,
                frame.penetration_mm,
                frame.smallest_volume_ratio
            );
        }
    }
}
