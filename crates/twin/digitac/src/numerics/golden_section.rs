//! Golden-section search (Kiefer, Proc. AMS 4, 1953).

/// Largest number of steps. After these, an interval of any size is below the resolution of `f64`.
const MOST_STEPS: u32 = 200;

/// The argument between two bounds, to a tolerance, at which a function is smallest, and the value
/// there. If there are several local minima, it finds one of them.
pub(crate) fn minimize(
    mut low: f64,
    mut high: f64,
    tolerance: f64,
    mut value: impl FnMut(f64) -> f64,
) -> (f64, f64) {
    let share = (5.0_f64.sqrt() - 1.0) / 2.0;
    let (mut left, mut right) = (high - share * (high - low), low + share * (high - low));
    let (mut at_left, mut at_right) = (value(left), value(right));
    for _ in 0..MOST_STEPS {
        if high - low <= tolerance {
            break;
        }
        if at_left <= at_right {
            (high, right, at_right) = (right, left, at_left);
            left = high - share * (high - low);
            at_left = value(left);
        } else {
            (low, left, at_left) = (left, right, at_right);
            right = low + share * (high - low);
            at_right = value(right);
        }
    }
    if at_left <= at_right {
        (left, at_left)
    } else {
        (right, at_right)
    }
}

#[cfg(test)]
mod tests {
    #[test]
    fn a_valley_is_found() {
        let (at, value) = super::minimize(-3.0, 5.0, 1e-6, |x| (x - 1.3).abs() + 2.0);
        assert!((at - 1.3).abs() < 1e-6 && (value - 2.0).abs() < 1e-6);
        assert!((super::minimize(-3.0, 5.0, 1e-6, |x| x).0 + 3.0).abs() < 1e-5);
    }

    #[test]
    fn a_valley_that_is_wider_than_numbers_can_be_narrowed_ends() {
        let (at, _) = super::minimize(-1e300, 1e300, 1e-6, |x| (x - 1e299).abs());
        assert!((at / 1e299 - 1.0).abs() < 1e-6, "{at}");
        super::minimize(-1.0, 1.0, 0.0, |_| f64::NAN);
    }
}
