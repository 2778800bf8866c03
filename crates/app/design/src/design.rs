//! Designs with their figures, as tables.

use serde::Serialize;
use twintac_work::WorkError;

use crate::press::Outcome;
use crate::{Figure, Figures, Measure, Wishes};

/// One design.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Design {
    /// Its number, from 1.
    pub number: usize,
    /// The values of the variables.
    pub values: Vec<f64>,
    /// The figures, or why there are none.
    #[serde(flatten)]
    pub(crate) outcome: Outcome,
}

impl Design {
    /// The figures; `None` if the design could not be evaluated.
    #[must_use]
    pub fn figures(&self) -> Option<&Figures> {
        match &self.outcome {
            Outcome::Figures(figures) => Some(figures),
            Outcome::Refused(_) => None,
        }
    }

    /// Why the design could not be evaluated; `None` if it was.
    #[must_use]
    pub fn refused(&self) -> Option<&str> {
        match &self.outcome {
            Outcome::Figures(_) => None,
            Outcome::Refused(why) => Some(why),
        }
    }
}

/// All designs of a search.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Designs {
    /// The sensor that was varied.
    pub sensor: String,
    /// Provenance of the figures: `simulated`.
    pub provenance: &'static str,
    /// How they were measured.
    pub measure: Measure,
    /// Standard deviation of a reading that was assumed, kPa.
    pub noise_kpa: f64,
    /// The fields that were varied.
    pub fields: Vec<String>,
    /// The designs, in order of their numbers.
    pub designs: Vec<Design>,
}

impl Designs {
    /// The designs that could be evaluated.
    pub fn evaluated(&self) -> impl Iterator<Item = (&Design, &Figures)> {
        self.designs
            .iter()
            .filter_map(|design| Some((design, design.figures()?)))
    }

    /// Numbers of the designs on the Pareto front: no other design is at least as good in all goals
    /// and better in one.
    #[must_use]
    pub fn front(&self, wishes: &Wishes) -> Vec<usize> {
        let (designs, figures): (Vec<&Design>, Vec<&Figures>) = self.evaluated().unzip();
        wishes
            .front(&figures)
            .into_iter()
            .map(|index| designs[index].number)
            .collect()
    }

    /// The number of the best design of those that meet all needs: its worst goal is the best, with
    /// each goal scaled from 0 (best of these designs) to 1 (worst).
    #[must_use]
    pub fn best(&self, wishes: &Wishes) -> Option<usize> {
        let fit = self.evaluated().filter(|(_, figures)| wishes.are_met(figures));
        let (designs, figures): (Vec<&Design>, Vec<&Figures>) = fit.unzip();
        wishes.best(&figures).map(|index| designs[index].number)
    }

    /// The table of all designs, one row each.
    pub(crate) fn csv(&self, wishes: &Wishes) -> Result<Vec<u8>, WorkError> {
        let mut writer = csv::Writer::from_writer(Vec::new());
        let wrong = |found: csv::Error| WorkError::Input(format!("the table of designs: {found}"));
        let names = ["design"].into_iter();
        let names = names.chain(self.fields.iter().map(String::as_str));
        let names = names.chain(Figure::ALL.map(Figure::name));
        writer
            .write_record(names.chain(["depth_mm", "range_end", "is_on_front", "provenance", "refused"]))
            .map_err(wrong)?;
        let front = self.front(wishes);
        for design in &self.designs {
            let figures = design.figures();
            let number = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
            let mut row = vec![design.number.to_string()];
            row.extend(design.values.iter().map(f64::to_string));
            row.extend(Figure::ALL.map(|figure| number(figures.and_then(|figures| figure.of(figures)))));
            row.push(number(figures.map(|figures| figures.depth_mm)));
            row.push(figures.map_or(String::new(), |figures| figures.range_end.to_string()));
            row.push(front.contains(&design.number).to_string());
            row.push(self.provenance.to_owned());
            row.push(design.refused().unwrap_or_default().to_owned());
            writer.write_record(row).map_err(wrong)?;
        }
        writer
            .into_inner()
            .map_err(|found| WorkError::Input(format!("the table of designs: {}", found.error())))
    }
}
