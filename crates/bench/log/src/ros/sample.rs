//! Complete readings in messages of this project. They are read back bit for bit as they were
//! written.

use glam::{DQuat, DVec3};

use super::header::{put_header, take_header};
use crate::cdr::{Decoder, Encoder};
use crate::{PoseReading, TactileFrame, TaxelReading, TaxelState, WrenchReading};

const NO_COUNTS: i32 = i32::MIN;
const NO_SEQUENCE: i64 = -1;

pub(super) fn put_tactile(e: &mut Encoder<'_>, unix_ns: u64, frame: &TactileFrame) {
    let taxels = || frame.taxels.iter();
    put_header(e, unix_ns, "gel");
    e.u64(frame.triggered_us);
    e.sequence(taxels(), |e, taxel| e.u64(taxel.read_us));
    e.sequence(taxels(), |e, taxel| e.u8(taxel.state as u8));
    e.sequence(taxels(), |e, taxel| e.i32(taxel.counts.unwrap_or(NO_COUNTS)));
    e.sequence(taxels(), |e, taxel| e.f64(taxel.pressure_pa.unwrap_or(f64::NAN)));
    e.sequence(taxels(), |e, taxel| {
        e.f64(taxel.temperature_c.unwrap_or(f64::NAN))
    });
}

pub(super) fn take_tactile(d: &mut Decoder<'_>) -> Option<TactileFrame> {
    take_header(d)?;
    let triggered_us = d.u64()?;
    let read_us = d.sequence(Decoder::u64)?;
    let states = d.sequence(Decoder::u8)?;
    let counts = d.sequence(Decoder::i32)?;
    let pressures_pa = d.sequence(Decoder::f64)?;
    let temperatures_c = d.sequence(Decoder::f64)?;
    let lengths = [
        states.len(),
        counts.len(),
        pressures_pa.len(),
        temperatures_c.len(),
    ];
    if lengths != [read_us.len(); 4] {
        return None;
    }
    let taxel = |index: usize| {
        Some(TaxelReading {
            state: TaxelState::from_code(states[index])?,
            read_us: read_us[index],
            counts: Some(counts[index]).filter(|counts| *counts != NO_COUNTS),
            pressure_pa: number(pressures_pa[index]),
            temperature_c: number(temperatures_c[index]),
        })
    };
    let taxels = (0..read_us.len()).map(taxel).collect::<Option<_>>()?;
    Some(TactileFrame { triggered_us, taxels })
}

pub(super) fn put_wrench(e: &mut Encoder<'_>, unix_ns: u64, reading: &WrenchReading) {
    put_header(e, unix_ns, "wrench");
    e.f64(reading.source_s.unwrap_or(f64::NAN));
    e.i64(reading.sequence.map_or(NO_SEQUENCE, i64::from));
    e.u32(reading.status);
    e.u32(reading.lost_before);
    put_vector(e, reading.force_n);
    put_vector(e, reading.torque_n_mm);
}

pub(super) fn take_wrench(d: &mut Decoder<'_>) -> Option<WrenchReading> {
    take_header(d)?;
    Some(WrenchReading {
        source_s: number(d.f64()?),
        sequence: u32::try_from(d.i64()?).ok(),
        status: d.u32()?,
        lost_before: d.u32()?,
        force_n: take_vector(d)?,
        torque_n_mm: take_vector(d)?,
    })
}

pub(super) fn put_pose(e: &mut Encoder<'_>, unix_ns: u64, reading: &PoseReading) {
    put_header(e, unix_ns, "base");
    e.f64(reading.source_s.unwrap_or(f64::NAN));
    put_vector(e, reading.position_mm);
    put_quaternion(e, reading.base_from_tool);
}

pub(super) fn take_pose(d: &mut Decoder<'_>) -> Option<PoseReading> {
    take_header(d)?;
    Some(PoseReading {
        source_s: number(d.f64()?),
        position_mm: take_vector(d)?,
        base_from_tool: DQuat::from_xyzw(d.f64()?, d.f64()?, d.f64()?, d.f64()?),
    })
}

pub(super) fn put_vector(e: &mut Encoder<'_>, vector: DVec3) {
    vector.to_array().into_iter().for_each(|number| e.f64(number));
}

pub(super) fn put_quaternion(e: &mut Encoder<'_>, rotation: DQuat) {
    rotation.to_array().into_iter().for_each(|number| e.f64(number));
}

fn take_vector(d: &mut Decoder<'_>) -> Option<DVec3> {
    Some(DVec3::new(d.f64()?, d.f64()?, d.f64()?))
}

fn number(number: f64) -> Option<f64> {
    (!number.is_nan()).then_some(number)
}
