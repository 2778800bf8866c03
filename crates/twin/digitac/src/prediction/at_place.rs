//! A twin whose sensor is pressed at one place, stepped with poses.

use twintac_depth_table::{DepthCurves, DepthTable};
use twintac_shape::Pose;

use crate::{BenchEstimate, Certainty, Contact, DigitacError, PortCorrection, Twin, TwinState, Variant};

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
    sureness: Option<Sureness>,
}

/// How sure the twin is of the last frame.
#[derive(Clone, Debug)]
struct Sureness {
    certainty: Certainty,
    contact: Contact,
    unlikeness: f64,
    /// The last readings, kPa; `[n_taxels]`; empty before the first frame.
    before_kpa: Vec<f64>,
    /// Their changes, kPa/s; `[n_taxels]`.
    rates_kpa_per_s: Vec<f64>,
    /// `[n_taxels]`
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
        self.unlikeness = self.certainty.unlikeness(&self.contact, depth_mm);
        let contact = (self.unlikeness, depth_mm);
        let rates = &self.rates_kpa_per_s;
        self.certainty
            .half_widths_kpa(contact, readings_kpa, rates, &mut self.half_widths_kpa);
    }
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
            sureness: None,
        })
    }

    /// The same with a twin that says how sure it is, of a contact at this place.
    #[must_use]
    pub(crate) fn with_certainty(self, certainty: &Certainty, contact: Contact) -> Self {
        let zeros = vec![0.0; self.seen.len()];
        Self {
            sureness: Some(Sureness {
                certainty: certainty.clone(),
                contact,
                unlikeness: 0.0,
                before_kpa: zeros.clone(),
                rates_kpa_per_s: zeros.clone(),
                half_widths_kpa: zeros,
                has_begun: false,
            }),
            ..self
        }
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
        if let Some(sureness) = &mut self.sureness {
            sureness.step(since_previous_s, depth_mm, readings_kpa);
        }
    }

    /// Half the widths of the 90 % intervals around the last readings, kPa, `[n_taxels]`; `None` of a twin that does not know.
    #[must_use]
    pub fn half_width_kpa(&self) -> Option<&[f64]> {
        let sureness = self.sureness.as_ref()?;
        Some(&sureness.half_widths_kpa)
    }

    /// How unlike the contact of the last frame is to what taught the twin, and whether it is too unlike for readings and intervals to be trusted; `None` of a twin that
    /// does not know.
    #[must_use]
    pub fn unlikeness(&self) -> Option<(f64, bool)> {
        let sureness = self.sureness.as_ref()?;
        Some((
            sureness.unlikeness,
            sureness.unlikeness > sureness.certainty.threshold,
        ))
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
