//! Rows with wrong times at the start of a file.

use super::description::Description;
use super::table::Table;
use crate::RecordingError;

/// Number of usual steps in a row that end the buffered rows.
const SETTLED_STEPS: usize = 20;

/// Number of rows to leave out at the start: the number given in the description, then the rows
/// that were read from a buffer.
///
/// A recorder that connects late first reads what its serial port has buffered, and stamps those
/// rows with the time of reading. They follow each other much faster than the sensor measures. They
/// last until 20 steps in a row are at least half the median step. The row at the start of those
/// steps still came from the buffer.
pub(crate) fn leading_rows(
    table: &Table,
    times_s: &[f64],
    description: &Description,
) -> Result<usize, RecordingError> {
    let dropped = description.drop_rows.min(table.rows());
    let column = description.time.as_ref().and_then(|time| time.column.as_deref());
    let (Some(column), true) = (column, description.drop_buffered) else {
        return Ok(dropped);
    };
    let times = &times_s[dropped..];
    let steps: Vec<f64> = times.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let mut sorted = steps.clone();
    sorted.sort_unstable_by(f64::total_cmp);
    let Some(&median) = sorted.get(sorted.len() / 2) else {
        return Ok(dropped);
    };
    let is_usual = |&step: &f64| step >= 0.5 * median;
    let window = SETTLED_STEPS.min(steps.len());
    match steps
        .windows(window)
        .position(|window| window.iter().all(is_usual))
    {
        Some(0) => Ok(dropped),
        Some(buffered) => Ok(dropped + buffered + 1),
        None => Err(RecordingError::NoPresses {
            file: table.file.clone(),
            rows: table.rows(),
            why: format!("the steps of `{column}` never settle, so that all rows count as buffered"),
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::Import;
    use crate::import::clock::times_s;

    fn dropped(times: &[f64]) -> Result<usize, RecordingError> {
        let text = r#"
            sensor = "s"
            provenance = "real"
            indenter = "tip"
            drop_buffered = true
            gel_top_mm = 6.0
            time = { column = "t" }
            z = { column = "z" }
            readings = { unit = "kPa" }
            taxels = [{ name = "S0", column = "p" }]
            presses = { split = "return-to-rest" }
        "#;
        let import = Import::parse("bench.toml", text).unwrap();
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("rows.csv");
        let rows: String = times.iter().map(|time| format!("{time},0,0\n")).collect();
        std::fs::write(&path, format!("t,z,p\n{rows}")).unwrap();
        let description = import.descriptions.for_file(&path).unwrap();
        let table = Table::read(&path, &description, &description.wanted_of(None)).unwrap();
        leading_rows(&table, &times_s(&table, description.time.as_ref()), &description)
    }

    fn times(steps: impl IntoIterator<Item = f64>) -> Vec<f64> {
        let sum = |time: &mut f64, step| {
            *time += step;
            Some(*time)
        };
        steps.into_iter().scan(0.0, sum).collect()
    }

    #[test]
    fn drops_rows_up_to_the_last_of_the_buffer() {
        let steps = |buffered: &[f64]| times(buffered.iter().copied().chain([0.06; 400]));
        assert_eq!(dropped(&steps(&[])).unwrap(), 0);
        // A first time, 30 short steps and a pause among them: 32 buffered rows.
        let mut buffered = vec![0.0; 1];
        buffered.extend([0.015; 20]);
        buffered.push(0.07);
        buffered.extend([0.015; 10]);
        assert_eq!(dropped(&steps(&buffered)).unwrap(), 32);
    }

    #[test]
    fn keeps_hasty_rows_later_on() {
        assert_eq!(
            dropped(&times([[0.06; 100].as_slice(), &[0.01], &[0.06; 100]].concat())).unwrap(),
            0
        );
    }

    #[test]
    fn reports_times_that_never_settle() {
        let error = dropped(&times([0.01, 0.06].repeat(100))).unwrap_err().to_string();
        assert!(error.contains("never settle"), "{error}");
    }
}
