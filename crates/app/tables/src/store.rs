//! Simulated presses. Each is computed once and kept as a file.

use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;

use glam::DVec2;
use rayon::prelude::*;
use serde::Serialize;
use twintac_depth_table::{DepthTable, DepthTableRequest, DepthTableSource, Lattice, SourceError};
use twintac_shape::{Pose, Underside};
use twintac_simulate::{Gel, PressPlace};
use twintac_store::{Digest, Keyed, Recipe, Store};
use twintac_work::{Progress, WorkError, go_on};

use crate::fast::FastTables;

/// Spacing of a lattice in gel heights, for locations along a line and over a plane. A plane needs
/// many more locations.
const LATTICE_SPACINGS: [f64; 2] = [1.0 / 4.0, 1.0 / 3.0];

/// Tables over depth of one gel.
pub struct DepthTableStore<'a> {
    gel: Keyed<Gel>,
    progress: &'a dyn Progress,
    /// The cache on disk.
    store: Option<Store>,
    /// The surrogate that makes the tables instead of the gel, if there is one.
    fast: Option<&'a FastTables>,
}

/// What a table is made from: the gel, with its description and settings, and the location, with
/// the indenter's shape.
#[derive(Serialize)]
struct TableAt<'a> {
    gel: &'a Keyed<Gel>,
    place: &'a PressPlace,
}

impl Recipe for TableAt<'_> {
    type Value = DepthTable;
    type Error = WorkError;

    fn label(&self) -> String {
        let PressPlace {
            indenter, x_mm, y_mm, ..
        } = self.place;
        format!("{indenter}_x{x_mm:+.2}_y{y_mm:+.2}")
    }

    fn make(&self) -> Result<DepthTable, WorkError> {
        Ok(self.gel.depth_table(self.place)?)
    }
}

impl<'a> DepthTableStore<'a> {
    /// Tables of a gel, without a cache on disk.
    pub fn of(gel: Gel, progress: &'a dyn Progress) -> Result<Self, WorkError> {
        Ok(Self {
            gel: Keyed::new(gel)?,
            progress,
            store: None,
            fast: None,
        })
    }

    /// The same with a cache in a folder, which may hold tables of other gels as well. `program`
    /// identifies the build of the program.
    pub fn kept_in(self, folder: &Path, program: &str) -> Self {
        Self {
            store: Some(Store::new(folder, program)),
            ..self
        }
    }

    /// The same with tables of a surrogate, if there is one. These are not cached.
    pub fn with_fast(self, fast: Option<&'a FastTables>) -> Self {
        Self { fast, ..self }
    }

    /// The tables at locations, from the cache or computed now, in order.
    fn compute(&self, places: &[PressPlace]) -> Result<Vec<DepthTable>, SourceError> {
        self.progress.more_steps(places.len());
        places
            .par_iter()
            .with_max_len(1)
            .map(|place| {
                go_on(self.progress)?;
                let recipe = TableAt {
                    gel: &self.gel,
                    place,
                };
                let table = match &self.store {
                    Some(store) => {
                        let kept = store.get(&recipe)?;
                        kept.made_again.iter().for_each(|why| self.progress.note(why));
                        kept.value
                    }
                    None => recipe.make()?,
                };
                self.progress.step("");
                Ok(table)
            })
            .collect()
    }
}

impl DepthTableSource for DepthTableStore<'_> {
    fn touch(&self, indenter: &str, above: &Pose) -> Result<Pose, SourceError> {
        Ok(self.gel.touch(self.gel.shape(indenter)?, above)?)
    }

    fn underside(&self, request: &DepthTableRequest) -> Result<Underside, SourceError> {
        DepthTableSource::underside(&*self.gel, request)
    }

    fn depth_tables(&self, requests: &[DepthTableRequest]) -> Result<Vec<DepthTable>, SourceError> {
        let places = requests
            .iter()
            .map(|request| self.gel.requested(request))
            .collect::<Result<Vec<_>, _>>()?;
        if let Some(fast) = self.fast {
            return places.iter().map(|place| fast.table(&self.gel, place)).collect();
        }
        let mut groups: BTreeMap<Vec<u8>, Vec<usize>> = BTreeMap::new();
        for (index, place) in places.iter().enumerate() {
            groups.entry(kind(place)?).or_default().push(index);
        }
        let lattices: Vec<Laid> = groups
            .into_values()
            .filter_map(|members| self.lay(&places, members))
            .collect();
        let is_laid = |index: &usize| lattices.iter().any(|laid| laid.members.contains(index));
        let alone: Vec<usize> = (0..places.len()).filter(|index| !is_laid(index)).collect();

        // All solutions run in one parallel loop, so that no thread waits for the last location of
        // each group.
        let depths_mm = lattices
            .iter()
            .map(|laid| self.depth_mm(laid))
            .collect::<Result<Vec<_>, _>>()?;
        let mut nodes: Vec<PressPlace> = Vec::new();
        for (laid, depth_mm) in lattices.iter().zip(depths_mm) {
            nodes.extend(laid.at(laid.lattice.places_mm(), depth_mm, None));
        }
        let mut index_of = BTreeMap::new();
        let mut to_simulate = nodes.clone();
        let mut of_place = Vec::with_capacity(alone.len());
        for &index in &alone {
            let next = to_simulate.len();
            let found = *index_of.entry(Digest::of_value(&places[index])?).or_insert(next);
            if found == next {
                to_simulate.push(places[index].clone());
            }
            of_place.push((index, found));
        }
        let tables = self.compute(&to_simulate)?;

        let mut answers: Vec<Option<DepthTable>> = vec![None; places.len()];
        for (index, found) in of_place {
            answers[index] = Some(tables[found].clone());
        }
        let mut start = 0;
        for laid in &lattices {
            let own = &tables[start..start + laid.lattice.places_mm().len()];
            start += own.len();
            for &index in &laid.members {
                let place = &places[index];
                answers[index] = Some(laid.lattice.at(own, DVec2::new(place.x_mm, place.y_mm)));
            }
        }
        Ok(answers.into_iter().flatten().collect())
    }
}

/// Requests that differ in location and depth alone, and the lattice that replaces them.
struct Laid {
    members: Vec<usize>,
    lattice: Lattice,
    /// One of the requests, with the largest depth and the largest force of all.
    place: PressPlace,
}

impl Laid {
    fn at(&self, places_mm: Vec<DVec2>, depth_mm: f64, enough_force_n: Option<f64>) -> Vec<PressPlace> {
        let moved = |at: DVec2| PressPlace {
            x_mm: at.x,
            y_mm: at.y,
            depth_mm,
            enough_force_n,
            ..self.place.clone()
        };
        places_mm.into_iter().map(moved).collect()
    }
}

impl DepthTableStore<'_> {
    /// A lattice over requests of one kind, if it has fewer locations than the requests have.
    fn lay(&self, places: &[PressPlace], members: Vec<usize>) -> Option<Laid> {
        let own = || members.iter().map(|&index| &places[index]);
        let at = |place: &PressPlace| DVec2::new(place.x_mm, place.y_mm);
        let low = own().map(at).reduce(DVec2::min)?;
        let high = own().map(at).reduce(DVec2::max)?;
        let is_plane = (high - low).min_element() > 0.0;
        let spacing = LATTICE_SPACINGS[usize::from(is_plane)];
        let lattice = Lattice::covering(low, high, spacing * self.gel.height_mm());
        let place = PressPlace {
            depth_mm: own().map(|place| place.depth_mm).fold(0.0, f64::max),
            enough_force_n: own().filter_map(|place| place.enough_force_n).reduce(f64::max),
            ..places[*members.first()?].clone()
        };
        let distinct: BTreeSet<[u64; 2]> = own()
            .map(|place| [place.x_mm.to_bits(), place.y_mm.to_bits()])
            .collect();
        (lattice.places_mm().len() < distinct.len()).then_some(Laid {
            members,
            lattice,
            place,
        })
    }

    /// The depth to which a lattice's locations are pressed, mm.
    fn depth_mm(&self, laid: &Laid) -> Result<f64, SourceError> {
        if laid.place.enough_force_n.is_none() {
            return Ok(laid.place.depth_mm);
        }
        // A gel is softest at its corners: the depths that are needed there suffice at all
        // locations.
        let corners = laid.at(
            laid.lattice.corners_mm(),
            laid.place.depth_mm,
            laid.place.enough_force_n,
        );
        let corners = self.compute(&corners)?;
        Ok(corners.iter().map(DepthTable::depth_mm).fold(0.0, f64::max))
    }
}

/// What all requests of one lattice have in common.
fn kind(place: &PressPlace) -> Result<Vec<u8>, SourceError> {
    Ok(serde_json::to_vec(&PressPlace {
        x_mm: 0.0,
        y_mm: 0.0,
        depth_mm: 0.0,
        enough_force_n: place.enough_force_n.map(|_| 0.0),
        ..place.clone()
    })?)
}
