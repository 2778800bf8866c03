//! A recording as a table.

use parquet::basic::Type as Physical;
use parquet::errors::ParquetError;
use parquet::schema::types::TypePtr;

use super::schema;
use crate::missing::known;
use crate::{Press, Recording};

/// A column of a recording's table.
#[derive(Clone, Debug, PartialEq)]
pub enum Column {
    /// An index from 0 for each frame.
    Index(Vec<i32>),
    /// A text for each press, repeated in all its frames.
    Text(Vec<String>),
    /// A number for each frame.
    Number(Vec<f64>),
    /// A number for each frame, if known.
    Known(Vec<Option<f64>>),
    /// True or false for each frame.
    Flag(Vec<bool>),
}

/// The types of columns, in order.
pub(super) fn types(columns: &[(String, Column)]) -> Result<TypePtr, ParquetError> {
    let typed = columns.iter().map(|(name, column)| match column {
        Column::Index(_) => schema::required(name, Physical::INT32),
        Column::Text(_) => schema::required(name, Physical::BYTE_ARRAY),
        Column::Number(_) => schema::required(name, Physical::DOUBLE),
        Column::Known(_) => schema::optional(name, Physical::DOUBLE),
        Column::Flag(_) => schema::required(name, Physical::BOOLEAN),
    });
    schema::group("recording", typed.collect::<Result<_, _>>()?)
}

impl Recording {
    /// The recording as a table with one row per frame: names and values of the columns that
    /// [`write_parquet`](Self::write_parquet) writes.
    #[must_use]
    pub fn columns(&self) -> Vec<(String, Column)> {
        self.columns_with(self.has_temperatures())
    }

    /// Whether any press has temperatures.
    #[must_use]
    pub fn has_temperatures(&self) -> bool {
        self.presses.iter().any(|press| press.temperature_c.is_some())
    }

    /// The table, with or without columns of temperatures.
    pub(super) fn columns_with(&self, has_temperatures: bool) -> Vec<(String, Column)> {
        let frames = |press: &Press| press.time_s.len();
        let index = (0..).zip(&self.presses);
        let index = index.flat_map(|(index, press)| std::iter::repeat_n(index, frames(press)));
        let text = |text: &dyn Fn(&Press) -> String| Column::Text(self.presses.iter().map(text).collect());
        let number = |number: &dyn Fn(&Press, usize) -> f64| {
            let mut numbers = Vec::new();
            for press in &self.presses {
                numbers.extend((0..frames(press)).map(|frame| number(press, frame)));
            }
            Column::Number(numbers)
        };
        let force = self.presses.iter().flat_map(|press| match &press.force_n {
            Some(force_n) => force_n.iter().copied().map(Some).collect(),
            None => vec![None; frames(press)],
        });
        let mut columns = vec![
            (schema::PRESS_INDEX, Column::Index(index.collect())),
            (schema::PRESS, text(&|press| press.name.clone())),
            (schema::MOUNTING, text(&|press| press.mounting.clone())),
            (schema::INDENTER, text(&|press| press.indenter.clone())),
            (schema::CONTROL, text(&|press| press.control.to_string())),
            (schema::PROVENANCE, text(&|_| self.provenance.to_string())),
            (schema::TIME, number(&|press, frame| press.time_s[frame])),
        ];
        columns.extend(schema::POSE.iter().enumerate().map(|(axis, name)| {
            let of_pose = |press: &Press, frame: usize| {
                let pose = &press.gel_from_indenter[frame];
                let (place_mm, turn) = (pose.position_mm.to_array(), pose.rotation.to_array());
                if axis < 3 { place_mm[axis] } else { turn[axis - 3] }
            };
            (*name, number(&of_pose))
        }));
        columns.push((schema::FORCE, Column::Known(force.collect())));
        let mut columns: Vec<(String, Column)> = columns
            .into_iter()
            .map(|(name, column)| (name.to_owned(), column))
            .collect();
        let mut of_taxels = |suffix: &str, column: &dyn Fn(usize) -> Column| {
            let taxels = self.taxels.iter().enumerate();
            columns.extend(taxels.map(|(taxel, name)| (format!("{name}{suffix}"), column(taxel))));
        };
        let readings = |taxel: usize, of: fn(&Press) -> &Vec<Vec<f64>>| {
            let rows = self.presses.iter().flat_map(of);
            Column::Known(rows.map(|row| known(row[taxel])).collect())
        };
        of_taxels(schema::KPA, &|taxel| readings(taxel, |press| &press.taxels_kpa));
        of_taxels(schema::RAW, &|taxel| readings(taxel, |press| &press.taxels_raw));
        of_taxels(schema::VALID, &|taxel| {
            let rows = self.presses.iter().flat_map(|press| &press.valid);
            Column::Flag(rows.map(|row| row[taxel]).collect())
        });
        if has_temperatures {
            of_taxels(schema::TEMPERATURE_C, &|taxel| {
                let of_press = |press: &Press| match &press.temperature_c {
                    Some(rows) => rows.iter().map(|row| known(row[taxel])).collect(),
                    None => vec![None; frames(press)],
                };
                Column::Known(self.presses.iter().flat_map(of_press).collect())
            });
        }
        columns
    }
}
