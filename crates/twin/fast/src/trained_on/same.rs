//! Comparison of two descriptions.

use serde::Serialize;
use serde_json::Value;

/// Relative difference up to which two numbers count as equal: a shear modulus of 15.2 kPa may be
/// given directly, or be computed from Young's modulus.
const TOLERANCE: f64 = 1e-9;

/// Whether two values are equal, number by number, within the tolerance.
pub(super) fn same<T: Serialize>(a: &T, b: &T) -> bool {
    let value = |of: &T| serde_json::to_value(of).expect("descriptions are numbers and words");
    is_same(&value(a), &value(b))
}

fn is_same(a: &Value, b: &Value) -> bool {
    match (a, b) {
        (Value::Array(a), Value::Array(b)) => {
            a.len() == b.len() && a.iter().zip(b).all(|(a, b)| is_same(a, b))
        }
        (Value::Object(a), Value::Object(b)) => {
            let is_in_b = |(name, a): (&String, &Value)| b.get(name).is_some_and(|b| is_same(a, b));
            a.len() == b.len() && a.iter().all(is_in_b)
        }
        (Value::Number(a), Value::Number(b)) => match (a.as_f64(), b.as_f64()) {
            (Some(a), Some(b)) => (a - b).abs() <= TOLERANCE * a.abs().max(b.abs()).max(1.0),
            _ => a == b,
        },
        _ => a == b,
    }
}
