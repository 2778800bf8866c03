//! A twin whose sensor is pressed at one location, stepped with poses.

use twintac_depth_table::{DepthCurves, DepthTable};
use twintac_shape::Pose;

use crate::{BenchEstimate, Certainty, Contact, DigitacError, PortCorrection, Twin, TwinState, Variant};

/// A twin in use whose sensor is pressed at one location. The pressures in its gel at a depth are
/// read from the location's table. Steps allocate no memory.
#[derive(Clone, Debug)]
pub struct TwinAtPlace {
    state: TwinState,
    curves: DepthCurves,
    correction: PortCorrection,
    touch_z_mm: f64,
    contact_offset_mm: f64,
    /// The twin's input: pressures at the ports, kPa, or stress features, kPa/mm; `[n_taxels]`.
    seen: Vec<f64>,
    force_n: f64,
    sureness: Option<Sureness>,
}

/// Uncertainty of the last frame.
#[derive(Clone, Debug)]
struct Sureness {
    certainty: Certainty,
    contact: Contact,
    ood_score: f64,
    /// The last readings, kPa; `[n_taxels]`.
    before_kpa: Vec<f64>,
    /// Their rates of change, kPa/s; `[n_taxels]`.
    rates_kpa_per_s: Vec<f64>,
    /// Half widths of their intervals, kPa; `[n_taxels]`.
    half_widths_kpa: Vec<f64>,
    has_begun: bool,
}

impl Sureness {
    fn step(&mut self, since_previous_s: f64, depth_mm: f64, readings_kpa: &[f64]) {
        let changes = readings_kpa.iter().zip(&self.before_kpa);
        for (rate, (now, before)) in self.rates_kpa_per_s.iter_mut().zip(changes) {
            *rate = if self.has_begun {
                (now - before) / since_previous_s.max(1e-6)
            } else {
                0.0
            };
        }
        self.has_begun = true;
        for (before, now) in self.before_kpa.iter_mut().zip(readings_kpa) {
            if !now.is_nan() {
                *before = *now;
            }
        }
        self.ood_score = self.certainty.ood_score(&self.contact, depth_mm);
        let contact = (self.ood_score, depth_mm);
        let rates = &self.rates_kpa_per_s;
        self.certainty
            .half_widths_kpa(contact, readings_kpa, rates, &mut self.half_widths_kpa);
    }
}

impl TwinAtPlace {
    /// A twin without contact, at the location of a table over depth. The contact height is that of
    /// an installation in the recordings of the test setup, or the median for any other. The
    /// readings of a sensor without contact are zero.
    ///
    /// # Errors
    /// A table that cannot be used.
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
            sureness: None,
        })
    }

    /// The same with the uncertainty of a contact at this location.
    #[must_use]
    pub(crate) fn with_certainty(self, certainty: &Certainty, contact: Contact) -> Self {
        let zeros = vec![0.0; self.seen.len()];
        Self {
            sureness: Some(Sureness {
                certainty: certainty.clone(),
                contact,
                ood_score: 0.0,
                before_kpa: zeros.clone(),
                rates_kpa_per_s: zeros.clone(),
                half_widths_kpa: zeros,
                has_begun: false,
            }),
            ..self
        }
    }

    /// One more frame: from a depth below first touch, mm, negative above the gel, to the readings
    /// of the barometers, kPa; `[n_taxels]`. `since_previous_s` is the time since the last frame,
    /// s; the first frame ignores it.
    ///
    /// # Panics
    /// If `readings_kpa` has a wrong length.
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
        if let Some(sureness) = &mut self.sureness {
            sureness.step(since_previous_s, depth_mm, readings_kpa);
        }
    }

    /// Half widths of the 90 % intervals around the last readings, kPa; `[n_taxels]`. `None` for a
    /// twin without intervals.
    #[must_use]
    pub fn half_width_kpa(&self) -> Option<&[f64]> {
        let sureness = self.sureness.as_ref()?;
        Some(&sureness.half_widths_kpa)
    }

    /// OOD score of the contact of the last frame, and whether the contact is out of distribution,
    /// so that readings and intervals cannot be trusted. `None` for a twin without intervals.
    #[must_use]
    pub fn ood_score(&self) -> Option<(f64, bool)> {
        let sureness = self.sureness.as_ref()?;
        Some((
            sureness.ood_score,
            sureness.ood_score > sureness.certainty.threshold,
        ))
    }

    /// One more frame, from the indenter's pose in the gel's frame. Only its height counts:
    /// location and rotation are those of the table.
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

    /// Depth below first touch at which the table ends, mm. Its last pressures are used at larger
    /// depths.
    #[must_use]
    pub fn max_depth_mm(&self) -> f64 {
        self.curves.max_depth_mm() - self.contact_offset_mm
    }

    /// Sets the present readings to zero, as a tare of a real sensor does.
    pub fn tare(&mut self) {
        self.state.tare();
    }

    /// Lets the gel rest until the next frame. The zero stays.
    pub fn rest(&mut self) {
        self.state.rest(0);
    }
}
