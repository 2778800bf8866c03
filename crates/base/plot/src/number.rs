//! Numbers as text.

/// A number with this number of decimals, a true minus sign and no negative zero; a dash for NaN.
pub fn fixed(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return "–".into();
    }
    let text = format!("{value:.decimals$}");
    match text.strip_prefix('-') {
        Some(rest)
            if rest
                .chars()
                .any(|letter| letter.is_ascii_digit() && letter != '0') =>
        {
            format!("−{rest}")
        }
        Some(rest) => rest.into(),
        None => text,
    }
}

/// A number with about three digits, with a power of ten if it is very large or small.
pub fn short(value: f64) -> String {
    if !value.is_finite() {
        return "–".into();
    }
    if value == 0.0 {
        return "0".into();
    }
    let power = value.abs().log10().floor();
    if !(-3.0..6.0).contains(&power) {
        let head = value / 10f64.powf(power);
        return format!("{}e{}", trimmed(&fixed(head, 1)), fixed(power, 0));
    }
    trimmed(&fixed(value, (2.0 - power).max(0.0) as usize)).to_owned()
}

fn trimmed(text: &str) -> &str {
    if text.contains('.') {
        text.trim_end_matches('0').trim_end_matches('.')
    } else {
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_read_well() {
        assert_eq!(fixed(-0.001, 2), "0.00");
        assert_eq!(fixed(-2.5, 1), "−2.5");
        assert_eq!(fixed(f64::NAN, 1), "–");
        assert_eq!(short(36000.0), "36000");
        assert_eq!(short(0.0075), "0.0075");
        assert_eq!(short(1.3e-9), "1.3e−9");
        assert_eq!(short(0.0), "0");
    }
}
