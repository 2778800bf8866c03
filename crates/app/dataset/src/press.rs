//! One press of a data set.

use digitac::{Model, simulated_recording, unread_press};
use rand::RngCore;
use twintac_depth_table::{DepthCurves, DepthTableRequest, DepthTableSource};
use twintac_fast::{Body, Touch};
use twintac_protocol::PressPlan;
use twintac_random::digest_stream;
use twintac_recording::Press;
use twintac_sensors::{SensorBatch, SensorVariation};
use twintac_tables::{DepthTableStore, FastTables};
use twintac_work::{Silent, WorkError};

use crate::identity::Inputs;

/// Tolerance at the end of a table, mm: a depth is beyond the table if it exceeds it by more.
const BEYOND_MM: f64 = 1e-9;

/// Simulates a planned press. The result does not depend on other presses.
pub(super) fn press(inputs: &Inputs, plan: &PressPlan, seed: u64) -> Result<Press, WorkError> {
    let store;
    let source: &dyn DepthTableSource = match &inputs.fast {
        // The gel itself, without a lattice that several presses share.
        None => &inputs.gel,
        Some(fast) => {
            store = DepthTableStore::of(inputs.gel.clone(), &Silent)?.with_fast(Some(fast));
            &store
        }
    };
    match (&inputs.fast, &inputs.variation, &inputs.twin) {
        (Some(fast), Some(variation), twin) => {
            let sensor = (variation, digest_stream(seed, &plan.name).next_u64());
            by_imperfect_sensor(inputs, (fast, twin.as_ref()), sensor, source, plan)
        }
        (_, _, Some(twin)) => by_twin(inputs, twin, source, plan),
        (_, _, None) => at_ports(inputs, source, plan),
    }
}

/// A press with the readings of a twin.
fn by_twin(
    inputs: &Inputs,
    model: &Model,
    source: &dyn DepthTableSource,
    plan: &PressPlan,
) -> Result<Press, WorkError> {
    let rate_hz = inputs.gel.sensor().readout.rate_hz;
    let plans = std::slice::from_ref(plan);
    let mut recording = simulated_recording(&model.twin, &model.record.bench, source, plans, rate_hz)?;
    Ok(recording.presses.swap_remove(0))
}

/// A press with the pressures at the ports as readings. Frames deeper than the gel could be solved
/// are marked as invalid.
fn at_ports(inputs: &Inputs, source: &dyn DepthTableSource, plan: &PressPlan) -> Result<Press, WorkError> {
    let sensor = inputs.gel.sensor();
    let n_taxels = sensor.taxels.len();
    let trajectory = plan.trajectory(sensor.readout.rate_hz);
    let (mut press, touch) = unread_press(plan, &trajectory, source, n_taxels)?;
    let tables = source.depth_tables(&[DepthTableRequest {
        indenter: plan.indenter.clone(),
        gel_from_indenter_at_touch: touch,
        max_depth_mm: plan.depth_mm,
        enough_force_n: None,
        tip_radius_mm: None,
    }])?;
    let curves =
        DepthCurves::new(&tables[0], n_taxels).map_err(|error| WorkError::Tables(Box::new(error)))?;
    let depths_mm = || {
        trajectory
            .iter()
            .map(|(_, depth_mm)| depth_mm.min(curves.max_depth_mm()))
    };
    press.taxels_kpa = depths_mm()
        .map(|depth_mm| curves.pressure_kpa(depth_mm))
        .collect();
    press.taxels_raw.clone_from(&press.taxels_kpa);
    press.force_n = Some(depths_mm().map(|depth_mm| curves.force_n(depth_mm)).collect());
    let is_solved = |depth_mm: f64| depth_mm <= curves.max_depth_mm() + BEYOND_MM;
    press.valid = trajectory
        .iter()
        .map(|(_, depth_mm)| vec![is_solved(*depth_mm); n_taxels])
        .collect();
    Ok(press)
}

/// A press with the readings of an imperfect sensor that is drawn for this press, with the number
/// `sensor.1`.
fn by_imperfect_sensor(
    inputs: &Inputs,
    (fast, twin): (&FastTables, Option<&Model>),
    (variation, number): (&SensorVariation, u64),
    source: &dyn DepthTableSource,
    plan: &PressPlan,
) -> Result<Press, WorkError> {
    let described = inputs.gel.sensor();
    let n_taxels = described.taxels.len();
    let trajectory = plan.trajectory(described.readout.rate_hz);
    let (mut press, _) = unread_press(plan, &trajectory, source, n_taxels)?;
    let shape = inputs.gel.shape(&plan.indenter)?;
    let bodies = [Body::clone(&*fast.body(shape, described)?)];
    let twin = twin.map(|model| &model.twin);
    let mut sensor = SensorBatch::new(fast.gel(), twin, variation.clone(), [1, 1], number);
    let (mut readings_kpa, mut wrench) = (vec![0.0; n_taxels], [[0.0; 6]]);
    let (mut before_s, mut force_n) = (0.0, Vec::with_capacity(trajectory.len()));
    for (frame, (time_s, _)) in trajectory.iter().enumerate() {
        let touch = Touch {
            body: 0,
            gel_from_body: press.gel_from_indenter[frame],
        };
        sensor.step(
            time_s - before_s,
            &bodies,
            &[touch],
            &[1],
            &mut readings_kpa,
            &mut wrench,
        );
        before_s = *time_s;
        force_n.push(-f64::from(wrench[0][2]));
        for (to_kpa, from_kpa) in press.taxels_kpa[frame].iter_mut().zip(&readings_kpa) {
            *to_kpa = f64::from(*from_kpa);
        }
    }
    press.taxels_raw.clone_from(&press.taxels_kpa);
    press.force_n = Some(force_n);
    press.valid = vec![vec![true; n_taxels]; trajectory.len()];
    Ok(press)
}
