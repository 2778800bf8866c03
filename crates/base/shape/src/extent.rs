//! Which sizes and positions of a body are plausible in mm.

use glam::DVec3;

/// Smallest and largest size along each axis, mm. A smaller body would lie between the nodes of any
/// mesh of a gel.
const SIZES_MM: [f64; 2] = [0.1, 1e3];
/// Largest distance of a body from its origin, mm.
const FARTHEST_MM: f64 = 1e3;

/// A body that is too small, too large or too far away to be in mm.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error("{}; {}", self.problem(), self.remedy())]
pub struct ExtentError {
    /// Corner of its box with the smallest coordinates, mm.
    pub low_mm: DVec3,
    /// Corner of its box with the largest coordinates, mm.
    pub high_mm: DVec3,
}

impl ExtentError {
    /// Checks a box: 0.1 mm to 1 m along each axis, within 1 m of the origin.
    ///
    /// # Errors
    /// Any other box, also one that is not finite.
    pub fn check(low_mm: DVec3, high_mm: DVec3) -> Result<(), Self> {
        let found = Self { low_mm, high_mm };
        if found.has_size() && !found.is_far() {
            return Ok(());
        }
        Err(found)
    }

    /// What is wrong: the end of a sentence that begins with the body's name.
    #[must_use]
    pub fn problem(&self) -> String {
        if self.has_size() {
            return format!(
                "lies from {} to {} mm, expected within 1 m of its origin",
                self.low_mm, self.high_mm
            );
        }
        let [x, y, z] = (self.high_mm - self.low_mm).to_array().map(short);
        let [least, most] = SIZES_MM;
        format!("is {x} × {y} × {z} mm large, expected {least} to {most} mm along each axis")
    }

    /// What to do about it.
    #[must_use]
    pub fn remedy(&self) -> String {
        let fits = |scale: f64| Self::check(scale * self.low_mm, scale * self.high_mm).is_ok();
        if self.has_size() {
            return "move it to its origin".to_owned();
        }
        if fits(1e3) {
            return "if its lengths are in metres, give `unit = \"m\"` or `scale = 1000`".to_owned();
        }
        if fits(1e-3) {
            return "if its lengths are in µm, give `scale = 0.001`".to_owned();
        }
        "give the unit of its lengths, such as `unit = \"m\"` or `scale = 1000`".to_owned()
    }

    fn has_size(&self) -> bool {
        let [least, most] = SIZES_MM;
        let size_mm = self.high_mm - self.low_mm;
        // A little more, for the rounding errors of the smallest size.
        size_mm
            .to_array()
            .iter()
            .all(|size| (least * (1.0 - 1e-6)..=most * (1.0 + 1e-6)).contains(size))
    }

    fn is_far(&self) -> bool {
        self.low_mm.max(-self.high_mm).max(DVec3::ZERO).length() > FARTHEST_MM
    }
}

/// A length with four digits.
fn short(length_mm: f64) -> String {
    if (1e-3..1e6).contains(&length_mm) {
        let decimals = (3.0 - length_mm.log10().floor()).clamp(0.0, 6.0) as usize;
        let text = format!("{length_mm:.decimals$}");
        return match text.contains('.') {
            true => text.trim_end_matches('0').trim_end_matches('.').to_owned(),
            false => text,
        };
    }
    format!("{length_mm:.3e}")
}
