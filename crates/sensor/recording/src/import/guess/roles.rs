//! Guesses the meaning of columns from their names and numbers.

use super::column::Column;

/// Names of a time column.
const TIME: [&str; 13] = [
    "t",
    "time",
    "timestamp",
    "stamp",
    "ms",
    "millis",
    "micros",
    "us",
    "seconds",
    "sec",
    "clock",
    "datetime",
    "date",
];

/// Prefixes of the name of an axis.
const AXIS: [&str; 7] = ["", "pos_", "position_", "tcp_", "ee_", "tip_", "p"];

/// Names of a height column that is not an axis.
const HEIGHT: [&str; 3] = ["depth", "indentation", "height"];

/// Names of the force into the gel.
const FORCE: [&str; 7] = ["fz", "f_z", "force", "force_z", "f", "load", "normal_force"];

/// Names of a column that distinguishes presses.
const PRESS: [&str; 7] = ["press", "label", "trial", "press_id", "trial_id", "id", "shape"];

/// Fraction of the largest change of the readings at which the tip counts as touching.
const TOUCHING: f64 = 0.03;

/// The guessed meaning of the columns.
pub(super) struct Roles<'a> {
    pub(super) time: Option<&'a Column>,
    /// The columns of x, y and z.
    pub(super) place: [Option<&'a Column>; 3],
    pub(super) turn: Option<[&'a Column; 4]>,
    pub(super) force: Option<&'a Column>,
    pub(super) press: Option<&'a Column>,
    pub(super) taxels: Vec<&'a Column>,
    /// Thermometers: one for each taxel, or one for all.
    pub(super) temperatures: Vec<&'a Column>,
}

/// Whether a column's name is that of a temperature.
fn is_temperature(column: &Column) -> bool {
    let words = ["temp", "temperature", "t"];
    let is_named = |word: &&str| column.base == **word || column.base.ends_with(&format!("_{word}"));
    column.base.starts_with("temp")
        || words.iter().any(is_named)
        || matches!(column.unit.as_deref(), Some("c" | "°c" | "degc"))
}

impl<'a> Roles<'a> {
    pub(super) fn new(columns: &'a [Column]) -> Self {
        let named = |names: &[&str]| columns.iter().find(|column| names.contains(&&*column.base));
        let axis = |axis: &str| {
            let names = AXIS.map(|start| format!("{start}{axis}"));
            columns.iter().find(|column| names.contains(&column.base))
        };
        let time = named(&TIME).or_else(|| columns.iter().find(|column| column.is_clock));
        let place = [axis("x"), axis("y"), axis("z").or_else(|| named(&HEIGHT))];
        let turn = ["qx", "qy", "qz", "qw"].map(|name| named(&[name]));
        let [force, press] = [named(&FORCE), named(&PRESS)];
        let taken: Vec<&Column> = [time, force, press]
            .into_iter()
            .chain(place)
            .chain(turn)
            .flatten()
            .collect();
        let is_left = |column: &&Column| {
            let is_number = !column.is_text && !column.is_clock;
            is_number && !taken.iter().any(|taken| std::ptr::eq(*taken, *column))
        };
        let left = columns.iter().filter(is_left);
        let (temperatures, left): (Vec<&Column>, Vec<&Column>) =
            left.partition(|column| is_temperature(column));
        // The largest group of columns that differ only in a number; if there is none, all columns
        // that change.
        let of_stem = |stem: &str| {
            left.iter()
                .copied()
                .filter(|column| column.stem() == Some(stem))
                .collect::<Vec<_>>()
        };
        let groups = left.iter().filter_map(|column| column.stem()).map(of_stem);
        let taxels = groups.reduce(|most, next| if next.len() > most.len() { next } else { most });
        let changes = |column: &&&Column| column.range()[0] < column.range()[1];
        Self {
            time,
            place,
            turn: match turn {
                [Some(x), Some(y), Some(z), Some(w)] => Some([x, y, z, w]),
                _ => None,
            },
            force,
            press,
            taxels: taxels.unwrap_or_else(|| left.iter().filter(changes).copied().collect()),
            temperatures,
        }
    }

    /// The z at which the readings begin to rise, and whether z increases downwards.
    pub(super) fn contact(&self, z: &Column) -> (f64, bool) {
        let rise = |row: usize| -> f64 {
            let change = |taxel: &&Column| Some((taxel.numbers.get(row)? - taxel.numbers.first()?).abs());
            self.taxels
                .iter()
                .filter_map(change)
                .filter(|change| change.is_finite())
                .sum()
        };
        let rises: Vec<f64> = (0..z.numbers.len()).map(rise).collect();
        let largest = rises.iter().copied().fold(0.0, f64::max);
        let at = |row: Option<usize>| row.and_then(|row| z.numbers.get(row)).copied().unwrap_or(0.0);
        let touches = at(rises.iter().position(|rise| *rise > TOUCHING * largest));
        let deepest = at(rises.iter().position(|rise| *rise >= largest));
        (touches, deepest > touches)
    }
}
