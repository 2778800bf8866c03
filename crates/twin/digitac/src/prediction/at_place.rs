//! A twin whose sensor is pressed at one place, stepped with poses.

use twintac_depth_table::{DepthCurves, DepthTable};
use twintac_shape::Pose;

use crate::{BenchEstimate, DigitacError, PortCorrection, Twin, TwinState, Variant};

/// A twin in use whose sensor is pressed at one place: what its gel shows at a depth is read from the place's table. Steps allocate nothing.
#[derive(Clone, Debug)]
pub struct TwinAtPlace {
    state: TwinState,
    curves: DepthCurves,
    correction: PortCorrection,
    touch_z_mm: f64,
    contact_offset_mm: f64,
    /// What the gel shows; `[n_taxels]`.
    seen: Vec<f64>,
    force_n: f64,
}

impl TwinAtPlace {
    /// A twin that nothing touches, at the place of a table over depth. The contact height is that of a mounting of the bench's recordings, or
    /// for any other the median. What an untouched sensor reads is zero.
    ///
    /// # Errors
    /// A table that can't be used.
    pub fn new(
        twin: &Twin,
        table: &DepthTable,
        bench: &BenchEstimate,
        mounting: &str,
    ) -> Result<Self, DigitacError> {
        let n_taxels = twin.taxels().len();
        let curves = DepthCurves::new(table, n_taxels)
            .map_err(|source| DigitacError::DepthTable { index: 0, source })?;
        let touch_mm = table.gel_from_indenter_at_touch.position_mm;
        let mut state = twin.state();
        state.tare_untouched();
        Ok(Self {
            state,
            curves,
            correction: bench.correction_at(touch_mm.truncate().to_array()),
            touch_z_mm: touch_mm.z,
            contact_offset_mm: bench.contact_offset_mm(mounting),
            seen: vec![0.0; n_taxels],
            force_n: 0.0,
        })
    }

    /// One more frame: from a depth below first touch, mm, negative above the gel, to what the barometers would read, kPa; `[n_taxels]`.
    /// `since_previous_s` is the time since the last frame, s, of which the first takes no notice.
    ///
    /// # Panics
    /// Readings of another length.
    pub fn step(&mut self, since_previous_s: f64, depth_mm: f64, readings_kpa: &mut [f64]) {
        let depth_mm = depth_mm + self.contact_offset_mm;
        self.force_n = self.curves.force_n(depth_mm);
        if self.state.twin().variant() == Variant::Paper {
            let stresses = self.curves.stresses_kpa_per_mm(depth_mm);
            self.seen
                .iter_mut()
                .zip(stresses)
                .for_each(|(seen, stress)| *seen = stress);
        } else {
            let pressures = self.curves.pressures_kpa(depth_mm);
            self.seen
                .iter_mut()
                .zip(pressures)
                .for_each(|(seen, pressure)| *seen = pressure);
            let slopes = self.curves.slopes_kpa_per_mm(depth_mm);
            self.correction.apply(depth_mm, slopes, &mut self.seen);
        }
        self.state.step(since_previous_s, &self.seen, readings_kpa);
    }

    /// One more frame, from the indenter's pose in the gel's frame. Its height counts alone: place and turn are the table's.
    ///
    /// # Panics
    /// As [`step`](Self::step).
    pub fn step_to(&mut self, since_previous_s: f64, gel_from_indenter: &Pose, readings_kpa: &mut [f64]) {
        let depth_mm = self.touch_z_mm - gel_from_indenter.position_mm.z;
        self.step(since_previous_s, depth_mm, readings_kpa);
    }

    /// Force of the indenter on the gel at the last frame, N.
    #[must_use]
    pub fn force_n(&self) -> f64 {
        self.force_n
    }

    /// Depth below first touch at which the table ends, mm; deeper, its last pressures stand.
    #[must_use]
    pub fn max_depth_mm(&self) -> f64 {
        self.curves.max_depth_mm() - self.contact_offset_mm
    }

    /// Takes what is read now as zero, as a tare of a real sensor does.
    pub fn tare(&mut self) {
        self.state.tare();
    }

    /// Lets the gel rest until the next frame. The zero stays.
    pub fn rest(&mut self) {
        self.state.rest(0);
    }
}
