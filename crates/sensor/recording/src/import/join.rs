//! Joins columns of another file of the same recording, which has its own clock.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

use super::bag::ReadBag;
use super::cell::Kind;
use super::clock;
use super::correlate::{Activity, Clock, Found, find};
use super::description::{Column, Description, Direction, Join, JoinClock};
use super::open::open;
use super::table::Table;
use super::unit::Unit;
use crate::RecordingError;

/// Adds the columns of other files to the rows of a table whose times are given. Rows without a
/// partner are left out. Returns notes for people.
pub(crate) fn join(
    path: &Path,
    table: &mut Table,
    times_s: &mut Vec<f64>,
    description: &Description,
    read_bag: Option<ReadBag>,
) -> Result<Vec<String>, RecordingError> {
    let mut notes = Vec::new();
    for join in &description.joins {
        let beside = beside(path, join);
        let (layout, wanted) = (join.layout(description), description.wanted_of(Some(join)));
        let other = open(&beside, &layout, &wanted, Some(&join.time), read_bag)?;
        let other_times_s = clock::times_s(&other, Some(&join.time));
        increases(&other, &other_times_s, join)?;
        let found = match join.clock {
            JoinClock::Same => None,
            JoinClock::Given { offset_s, rate } => Some(Found {
                clock: Clock { offset_s, rate },
                residual_s: 0.0,
            }),
            JoinClock::Found => {
                let main = Activity {
                    time_s: times_s.clone(),
                    touch: touch(table, description),
                };
                let there = Activity {
                    time_s: other_times_s.clone(),
                    touch: touch(&other, description),
                };
                let found = find(&main, &there).map_err(|problem| refused(&other.file, join, &problem))?;
                notes.push(said(&other.file, &found));
                Some(found)
            }
        };
        let clock = found.map_or(
            Clock {
                offset_s: 0.0,
                rate: 1.0,
            },
            |found| found.clock,
        );
        let mapped: Vec<f64> = other_times_s
            .iter()
            .map(|time_s| clock.convert(*time_s))
            .collect();
        let partners: Vec<Option<usize>> = times_s
            .iter()
            .map(|time_s| nearest(&mapped, *time_s, join.within_s))
            .collect();
        let lonely = partners.iter().filter(|partner| partner.is_none()).count();
        if lonely == partners.len() {
            let problem = format!(
                "no row of it is within {} s of one of {}",
                join.within_s, table.file
            );
            return Err(refused(&other.file, join, &problem));
        }
        if lonely > 0 {
            notes.push(format!(
                "{lonely} rows have no partner in {} within {} s, and are left out",
                other.file, join.within_s
            ));
        }
        let mut kept = partners.iter().map(Option::is_some);
        times_s.retain(|_| kept.next().unwrap_or(false));
        table.put_beside(&other, &partners);
        notes.extend(other.notes.iter().map(|note| format!("{}: {note}", other.file)));
    }
    Ok(notes)
}

/// The path of the joined file. `{stem}` stands for the main file's name without its extension.
fn beside(path: &Path, join: &Join) -> PathBuf {
    let stem = path
        .file_stem()
        .map_or_else(String::new, |stem| stem.to_string_lossy().into_owned());
    path.with_file_name(join.file.replace("{stem}", &stem))
}

fn refused(file: &str, join: &Join, problem: &str) -> RecordingError {
    RecordingError::Implausible {
        file: file.to_owned(),
        problem: match join.clock {
            JoinClock::Found => format!(
                "its clock is not found: {problem}; give it as `clock = {{ offset_s = 1.12, rate = 1.0 }}`: its times are multiplied by `rate`, then `offset_s` is added"
            ),
            _ => format!("{problem}; `clock = \"found\"` finds its clock from the presses"),
        },
    }
}

fn said(file: &str, found: &Found) -> String {
    let Found { clock, residual_s } = found;
    format!(
        "{file}: its times become those of the readings as {:.6} × time {:+.4} s, found from the presses; the median deviation of a press is {:.1} ms",
        clock.rate,
        clock.offset_s,
        1e3 * residual_s
    )
}

fn increases(table: &Table, times_s: &[f64], join: &Join) -> Result<(), RecordingError> {
    let Some(row) = times_s.windows(2).position(|step| step[1] < step[0]) else {
        return Ok(());
    };
    Err(RecordingError::Cell {
        file: table.file.clone(),
        line: table.lines[row + 1],
        column: join.time.column.clone().unwrap_or_default(),
        problem: format!(
            "is {} s after {} s, expected times to increase; {}",
            times_s[row + 1],
            times_s[row],
            clock::remedy(times_s[row], times_s[row + 1], &join.time)
        ),
    })
}

/// The row nearest in time, if it is near enough.
fn nearest(times_s: &[f64], time_s: f64, within_s: f64) -> Option<usize> {
    let after = times_s.partition_point(|other_s| *other_s < time_s);
    let near = [after.checked_sub(1), (after < times_s.len()).then_some(after)];
    let distance_s = |row: &usize| (times_s[*row] - time_s).abs();
    let nearest = near
        .into_iter()
        .flatten()
        .min_by(|one, two| distance_s(one).total_cmp(&distance_s(two)))?;
    (distance_s(&nearest) <= within_s).then_some(nearest)
}

/// Strength of contact in a file's rows: from its readings, else its force, else the indenter's
/// depth.
fn touch(table: &Table, description: &Description) -> Vec<f64> {
    let mut touch = vec![0.0; table.rows()];
    let mut add = |numbers: &[f64]| {
        let rest = at_rest(numbers);
        for (touch, number) in touch.iter_mut().zip(numbers) {
            *touch += if number.is_nan() {
                0.0
            } else {
                (number - rest).abs()
            };
        }
    };
    let readings = description
        .taxels
        .iter()
        .map(|taxel| table.column(&taxel.column, Kind::Reading));
    let readings: Vec<&[f64]> = readings.filter(|readings| !readings.is_empty()).collect();
    if !readings.is_empty() {
        readings.into_iter().for_each(&mut add);
        return touch;
    }
    let force = description.force.as_ref().and_then(|force| numbers(table, force));
    if let Some(force_n) = force {
        add(&force_n);
        return touch;
    }
    let Some(z_mm) = description.z.as_ref().and_then(|z| numbers(table, z)) else {
        return touch;
    };
    let contact = description.contact;
    let depth_mm = z_mm.iter().map(|z_mm| match contact.z_points {
        Direction::Up => contact.z_mm - z_mm,
        Direction::Down => z_mm - contact.z_mm,
    });
    depth_mm.map(|depth_mm| depth_mm.max(0.0)).collect()
}

fn numbers<U: Unit>(table: &Table, column: &Column<U>) -> Option<Vec<f64>> {
    let numbers = table.column(column.column.as_deref()?, Kind::Number);
    (!numbers.is_empty()).then(|| numbers.iter().map(|number| column.convert(*number)).collect())
}

/// The value of a sensor at rest: the middle of the shortest range with a quarter of its numbers. A
/// median would not do, because the sensor may be pressed half of the time.
fn at_rest(numbers: &[f64]) -> f64 {
    let mut sorted: Vec<f64> = numbers
        .iter()
        .copied()
        .filter(|number| !number.is_nan())
        .collect();
    sorted.sort_unstable_by(f64::total_cmp);
    let ranges = sorted
        .windows(sorted.len() / 4 + 1)
        .map(|range| [range[0], range[range.len() - 1]]);
    let shortest = ranges.min_by(|a, b| (a[1] - a[0]).total_cmp(&(b[1] - b[0])));
    shortest.map_or(0.0, |[low, high]| 0.5 * (low + high))
}

impl Description {
    /// The columns that are read from a joined file, or from the main file if `join` is `None`.
    pub(crate) fn wanted_of<'a>(&'a self, join: Option<&'a Join>) -> BTreeSet<(&'a str, Kind)> {
        let all = self.wanted();
        let gives = |join: &Join, name: &str| join.columns.iter().any(|given| given == name);
        match join {
            None => {
                let is_elsewhere = |name: &str| self.joins.iter().any(|join| gives(join, name));
                all.into_iter().filter(|(name, _)| !is_elsewhere(name)).collect()
            }
            Some(join) => {
                let mut wanted: BTreeSet<(&'a str, Kind)> =
                    all.into_iter().filter(|(name, _)| gives(join, name)).collect();
                // Its own time column, whatever the main file's is called.
                if let Some(time) = join.time.wanted() {
                    wanted.insert(time);
                }
                wanted
            }
        }
    }
}
