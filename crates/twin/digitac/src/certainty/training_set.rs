//! The training set of a twin, and the OOD score of other contacts.

use serde::{Deserialize, Serialize};
use twintac_config::{Checked, Ranges};
use twintac_depth_table::DepthTableSource;
use twintac_shape::Underside;

use crate::{DigitacError, PairedPress, Places};

/// Locations nearer than this count as one, mm.
const SAME_PLACE_MM: f64 = 0.1;
/// Fraction of the training locations whose nearest other location is within one spacing.
const SPACING_PART: f64 = 0.9;
/// Contact geometries whose difference at a depth of one millimetre is below this count as one.
const SAME_UNDERSIDE: f64 = 0.01;
/// An excess of depth over a training press counts as one if it is this fraction of the largest
/// training depth. A reading grows with about the power 1.5 of depth, so this is a change of 2 %,
/// about the error of a good twin.
const DEPTH_PART: f64 = 0.015;
/// The difference of contact geometries that counts as one.
const SHAPE_PART: f64 = 0.1;
/// Distance at which a training press informs about depth and shape, in spacings.
const REACH: f64 = 3.0;

/// Location and contact geometry of a contact.
#[derive(Clone, Debug, PartialEq)]
pub struct Contact {
    /// Location of the indenter's origin in the gel's plane, mm.
    pub place_mm: [f64; 2],
    /// The indenter's underside (contact geometry), rotated as it presses.
    pub underside: Underside,
}

impl Contact {
    /// The contacts at a recording's locations; `[n_places]`.
    ///
    /// # Errors
    /// An indenter that the source does not know.
    pub fn of_places(places: &Places, source: &dyn DepthTableSource) -> Result<Vec<Self>, DigitacError> {
        let contact = |request| {
            let underside = source.underside(request).map_err(DigitacError::Simulation)?;
            let at = request.gel_from_indenter_at_touch.position_mm;
            Ok(Self {
                place_mm: [at.x, at.y],
                underside,
            })
        };
        places.requests.iter().map(contact).collect()
    }
}

/// The training presses of a twin.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct TrainingSet {
    /// Each contact geometry, with the location and the largest depth of its presses.
    undersides: Vec<(Underside, Vec<Deepest>)>,
    /// Distance between neighbouring training locations, mm.
    spacing_mm: f64,
    /// Excess of depth that counts as one, mm.
    depth_step_mm: f64,
}

#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Deepest {
    place_mm: [f64; 2],
    depth_mm: f64,
}

impl Checked for TrainingSet {
    fn check(&self, ranges: &mut Ranges) {
        let Self {
            undersides,
            spacing_mm,
            depth_step_mm,
        } = self;
        for (shape, (_, presses)) in undersides.iter().enumerate() {
            for (press, Deepest { place_mm, depth_mm }) in presses.iter().enumerate() {
                let field = format!("undersides[{shape}][1][{press}]");
                ranges.numbers(&format!("{field}.place_mm"), place_mm, 2, -1e4..=1e4);
                ranges.number(&format!("{field}.depth_mm"), *depth_mm, 0.0..=1e3);
            }
        }
        ranges.number("spacing_mm", *spacing_mm, 1e-6..=1e6);
        ranges.number("depth_step_mm", *depth_step_mm, 0.0..=1e3);
    }
}

impl TrainingSet {
    /// Collects training presses; `contacts` are those of the locations, `[n_places]`.
    pub(crate) fn by(
        presses: &[PairedPress],
        places: &Places,
        contacts: &[Contact],
        training_presses: &[usize],
    ) -> Self {
        let mut undersides: Vec<(Underside, Vec<Deepest>)> = Vec::new();
        for &press in training_presses {
            let contact = &contacts[places.of_press[press]];
            let depths = presses[press].features.depth_mm.iter().copied();
            let deepest = Deepest {
                place_mm: contact.place_mm,
                depth_mm: depths.fold(0.0, f64::max),
            };
            let is_same = |known: &Underside| {
                known == &contact.underside || known.difference(&contact.underside, 1.0) < SAME_UNDERSIDE
            };
            match undersides.iter_mut().find(|(known, _)| is_same(known)) {
                Some((_, own)) => own.push(deepest),
                None => undersides.push((contact.underside.clone(), vec![deepest])),
            }
        }
        let all = || undersides.iter().flat_map(|(_, own)| own);
        let deepest_mm = all().map(|press| press.depth_mm).fold(0.0, f64::max);
        let nearest_other = |press: &Deepest| {
            let distances = all().map(|other| distance_mm(press.place_mm, other.place_mm));
            let nearest = distances
                .filter(|mm| *mm > SAME_PLACE_MM)
                .fold(f64::INFINITY, f64::min);
            nearest.is_finite().then_some(nearest)
        };
        let mut spacings: Vec<f64> = all().filter_map(nearest_other).collect();
        Self {
            spacing_mm: quantile(&mut spacings, SPACING_PART).unwrap_or(1.0),
            depth_step_mm: DEPTH_PART * deepest_mm,
            undersides,
        }
    }

    /// OOD score of a contact at a depth: below about 1, it lies between training contacts; 0 above
    /// the gel.
    ///
    /// It is the larger of two numbers. The first is the distance to the nearest training location,
    /// in spacings. The second is the smallest Euclidean norm, over all training presses, of three
    /// numbers: the excess of depth over the press, the difference of the contact geometries, and a
    /// third of the distance in spacings.
    pub(crate) fn ood_score(&self, place_mm: [f64; 2], underside: &Underside, depth_mm: f64) -> f64 {
        if depth_mm <= 0.0 {
            return 0.0;
        }
        let (mut nearest, mut least) = (f64::INFINITY, f64::INFINITY);
        for (known, presses) in &self.undersides {
            let shape = known.difference(underside, depth_mm) / SHAPE_PART;
            for press in presses {
                let spacings = distance_mm(press.place_mm, place_mm) / self.spacing_mm;
                let deeper = (depth_mm - press.depth_mm).max(0.0) / self.depth_step_mm.max(f64::MIN_POSITIVE);
                nearest = nearest.min(spacings);
                least = least.min((spacings / REACH).powi(2) + deeper.powi(2) + shape.powi(2));
            }
        }
        nearest.max(least.sqrt())
    }

    /// Distance between neighbouring training locations, mm.
    pub(crate) fn spacing_mm(&self) -> f64 {
        self.spacing_mm
    }
}

fn distance_mm(a: [f64; 2], b: [f64; 2]) -> f64 {
    (a[0] - b[0]).hypot(a[1] - b[1])
}

/// The number that a fraction of the numbers does not exceed; `None` if there are none. Sorts the
/// numbers.
pub(super) fn quantile(numbers: &mut [f64], part: f64) -> Option<f64> {
    numbers.sort_unstable_by(f64::total_cmp);
    let last = numbers.len().checked_sub(1)?;
    let at = (part * numbers.len() as f64).ceil() as usize;
    Some(numbers[at.saturating_sub(1).min(last)])
}
