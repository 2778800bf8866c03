//! x
use std::sync::Arc;
use glam::DQuat;
use twintac_simulate::*;
fn main() {
    let a: Vec<String> = std::env::args().collect();
    let sensor = Arc::new(twintac_sensor::Sensor::read(&a[1]).unwrap());
    let ind = sensor.indenters[0].clone();
    let mut settings = SimulateSettings::default();
    settings.edges_per_height = a[3].parse().unwrap();
    settings.edges_per_contact_radius = a[4].parse().unwrap();
    let depth: f64 = a[5].parse().unwrap();
    let gel = Gel::new(sensor, settings);
    for x in a[2].split(',') {
        let x: f64 = x.parse().unwrap();
        let t = std::time::Instant::now();
        let place = PressPlace { indenter: ind.name.clone(), shape: ind.shape.clone(), x_mm: x, y_mm: 0.0, rotation: DQuat::IDENTITY, depth_mm: depth };
        let s = gel.sweep(&place).unwrap();
        println!("x {x} nodes {} time {:.2}s frames {} failure {:?}", s.n_nodes, t.elapsed().as_secs_f64(), s.frames.len(), s.failure);
        for f in &s.frames { println!("  d {:.3} F {:.4} p {:.2?} f {:.2?} it {} res {:.1e} pen {:.4} J {:.3} {:.2}s", f.depth_mm, f.force_n, f.port_pressure_kpa, f.stress_feature_kpa_per_mm, f.honesty.iterations, f.honesty.residual, f.honesty.penetration_mm, f.honesty.smallest_volume_ratio, f.honesty.wall_time_s); }
    }
}
