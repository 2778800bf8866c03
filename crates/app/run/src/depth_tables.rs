//! Simulated presses, each computed once and kept as a file.

use std::collections::BTreeMap;
use std::path::PathBuf;

use glam::DVec2;
use rayon::prelude::*;
use twintac_depth_table::{DepthTable, DepthTableRequest, DepthTableSource, Lattice, SourceError};
use twintac_shape::Pose;
use twintac_simulate::{Gel, PressPlace};

use crate::Progress;
use crate::files::{read_json, sha256, write_json};

/// From this many different places on, a lattice of places is simulated and interpolated.
const LATTICE_FROM: usize = 150;

/// Spacing of that lattice over the gel's height.
const LATTICE_SPACING: f64 = 1.0 / 3.0;

/// Sweeps of one gel, kept in a folder: what is there is not computed again.
pub(crate) struct DepthTableStore<'a> {
    gel: &'a Gel,
    folder: PathBuf,
    progress: &'a dyn Progress,
}

impl<'a> DepthTableStore<'a> {
    /// Keeps the gel's tables in `folder`, which holds tables of no other gel.
    pub(crate) fn new(gel: &'a Gel, folder: PathBuf, progress: &'a dyn Progress) -> Self {
        Self {
            gel,
            folder,
            progress,
        }
    }

    /// The tables at places, from their files or computed now, in order.
    fn compute(&self, places: &[PressPlace]) -> Result<Vec<DepthTable>, SourceError> {
        self.progress.more_steps(places.len());
        places
            .par_iter()
            .with_max_len(1)
            .map(|place| {
                let path = self.path(place)?;
                let table = match read_json(&path) {
                    Ok(table) => table,
                    Err(_) => {
                        let table = self.gel.depth_table(place)?;
                        write_json(&path, &table)?;
                        table
                    }
                };
                self.progress.step("");
                Ok(table)
            })
            .collect()
    }

    fn path(&self, place: &PressPlace) -> Result<PathBuf, SourceError> {
        let hash = sha256(&serde_json::to_vec(place)?);
        let name = format!(
            "{}_x{:+.2}_y{:+.2}_{}.json",
            place.indenter,
            place.x_mm,
            place.y_mm,
            &hash[..12]
        );
        Ok(self.folder.join(name))
    }
}

impl DepthTableSource for DepthTableStore<'_> {
    fn touch(&self, indenter: &str, above: &Pose) -> Result<Pose, SourceError> {
        Ok(self.gel.touch(self.gel.shape(indenter)?, above)?)
    }

    fn depth_tables(&self, requests: &[DepthTableRequest]) -> Result<Vec<DepthTable>, SourceError> {
        let places = requests
            .iter()
            .map(|request| self.gel.requested(request))
            .collect::<Result<Vec<_>, _>>()?;
        if let Some(lattice) = lattice(self.gel, &places) {
            let mut place = places[0].clone();
            let moved = |place: &PressPlace, to: Vec<DVec2>| -> Vec<PressPlace> {
                to.into_iter()
                    .map(|at| PressPlace {
                        x_mm: at.x,
                        y_mm: at.y,
                        ..place.clone()
                    })
                    .collect()
            };
            if place.enough_force_n.is_some() {
                // A gel gives most at its corners: they tell how deep all places have to go.
                let corners = self.compute(&moved(&place, lattice.corners_mm()))?;
                place.enough_force_n = None;
                place.depth_mm = corners.iter().map(DepthTable::depth_mm).fold(0.0, f64::max);
            }
            let tables = self.compute(&moved(&place, lattice.places_mm()))?;
            return Ok(places
                .iter()
                .map(|p| lattice.at(&tables, DVec2::new(p.x_mm, p.y_mm)))
                .collect());
        }
        let mut distinct: Vec<PressPlace> = Vec::new();
        let mut index_of = BTreeMap::new();
        let mut indices = Vec::with_capacity(places.len());
        for place in places {
            let key = self.path(&place)?;
            indices.push(*index_of.entry(key).or_insert_with(|| {
                distinct.push(place);
                distinct.len() - 1
            }));
        }
        let tables = self.compute(&distinct)?;
        Ok(indices.into_iter().map(|index| tables[index].clone()).collect())
    }
}

/// A lattice over the places, if they are many and differ in nothing but where they are.
fn lattice(gel: &Gel, places: &[PressPlace]) -> Option<Lattice> {
    let first = places.first()?;
    let alike = |place: &PressPlace| {
        PressPlace {
            x_mm: first.x_mm,
            y_mm: first.y_mm,
            ..place.clone()
        } == *first
    };
    let low = places
        .iter()
        .map(|p| DVec2::new(p.x_mm, p.y_mm))
        .reduce(DVec2::min)?;
    let high = places
        .iter()
        .map(|p| DVec2::new(p.x_mm, p.y_mm))
        .reduce(DVec2::max)?;
    let lattice = Lattice::covering(low, high, LATTICE_SPACING * gel.height_mm());
    let pays = places.len() >= LATTICE_FROM && lattice.places_mm().len() < places.len();
    (pays && places.iter().all(alike)).then_some(lattice)
}
