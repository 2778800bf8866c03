//! The pressure at the base of the gel under a contact, at more points than there are taxels.

use glam::DVec2;
use twintac_config::Problem;
use twintac_fast::FastReader;

use crate::contact::Contact;
use crate::error::InverseError;
use crate::fast_model::FastModel;
use crate::inverse::Inverse;

/// Largest number of points of a map.
const MOST_POINTS: f64 = 1e7;

/// Computes the pressure at the base of the gel on a grid, from the estimated contact and the
/// [`FastGel`](twintac_fast::FastGel).
#[derive(Clone, Debug)]
pub struct FloorMap {
    model: FastModel,
    reader: FastReader,
    first_mm: DVec2,
    spacing_mm: f64,
    n: [usize; 2],
    /// The points at which a port is within the gel.
    known: Vec<usize>,
    known_kpa: Vec<f32>,
    pressure_kpa: Vec<f32>,
}

impl Inverse<FastModel> {
    /// Prepares maps of the base of the gel on a centred grid of this spacing, mm, which covers the
    /// locations at which a port is within the gel. A spacing of 0.5 mm makes about 2,000 points
    /// for PhysTac.
    ///
    /// # Errors
    /// [`InverseError::Setting`]: a spacing that is not above zero, or that makes more than ten
    /// million points; [`InverseError::NoFloor`]: a surrogate that was trained at its taxels alone.
    pub fn floor_map(&self, spacing_mm: f64) -> Result<FloorMap, InverseError> {
        let refused =
            |hint: &str| InverseError::Setting(Problem::new("spacing_mm", format!("is {spacing_mm}"), hint));
        if !(spacing_mm > 0.0 && spacing_mm.is_finite()) {
            return Err(refused("give a number above 0"));
        }
        let gel = self.model.gel();
        let [low, high] = gel.port_bounds_mm().ok_or(InverseError::NoFloor)?;
        let size = high - low;
        let n = [size.x, size.y].map(|size| (size / spacing_mm).floor().max(1.0));
        if n[0] * n[1] > MOST_POINTS {
            return Err(refused("give one that makes at most ten million points"));
        }
        let n = n.map(|n| n as usize);
        let first_mm = 0.5 * (low + high - spacing_mm * DVec2::new(n[0] as f64 - 1.0, n[1] as f64 - 1.0));
        let place = |i: usize, j: usize| first_mm + spacing_mm * DVec2::new(i as f64, j as f64);
        let places = (0..n[1]).flat_map(|j| (0..n[0]).map(move |i| place(i, j)));
        let there = places.enumerate().filter(|(_, place)| gel.has_port_at(*place));
        let (known, places): (Vec<usize>, Vec<DVec2>) = there.unzip();
        let moved = gel
            .with_ports(&places)
            .expect("these locations were chosen by the surrogate");
        Ok(FloorMap {
            reader: moved.reader(),
            known_kpa: vec![0.0; places.len()],
            known,
            pressure_kpa: vec![f32::NAN; n[0] * n[1]],
            model: self.model.clone(),
            first_mm,
            spacing_mm,
            n,
        })
    }
}

impl FloorMap {
    /// The map under a contact, kPa, row by row along x; `[n_y * n_x]`. Each value is the mean over
    /// a disc of the size of a port; NaN where that is not within the gel, as in the corners around
    /// a round one.
    pub fn read(&mut self, contact: &Contact) -> &[f32] {
        let (body, gel_from_body) = self.model.placed(contact);
        self.reader
            .read(&[(body, gel_from_body)], &mut self.known_kpa, &mut [0.0; 6]);
        for (point, known_kpa) in self.known.iter().zip(&self.known_kpa) {
            self.pressure_kpa[*point] = *known_kpa;
        }
        &self.pressure_kpa
    }

    /// Number of points along x and along y.
    #[must_use]
    pub fn n(&self) -> [usize; 2] {
        self.n
    }

    /// Location of the point at a column and a row, mm.
    #[must_use]
    pub fn place_mm(&self, column: usize, row: usize) -> DVec2 {
        self.first_mm + self.spacing_mm * DVec2::new(column as f64, row as f64)
    }
}
