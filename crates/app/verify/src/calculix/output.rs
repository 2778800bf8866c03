//! Reads the output files of CalculiX.

use anyhow::{Context, Result};

/// One field at one time: node numbers (from one) and values, `[n_values]` each.
pub(super) type Field = Vec<(usize, Vec<f64>)>;

/// All blocks of a field in a `.frd` file, in order of time.
///
/// A block starts with ` -4  NAME`, its lines with ` -1`, a node in ten columns and values in
/// twelve each; it ends with ` -3`.
pub(super) fn fields(frd: &str, name: &str) -> Result<Vec<Field>> {
    let mut found: Vec<Field> = Vec::new();
    let mut is_inside = false;
    for line in frd.lines() {
        match line.get(..3) {
            Some(" -4") => {
                is_inside = line.split_whitespace().nth(1) == Some(name);
                if is_inside {
                    found.push(Field::new());
                }
            }
            Some(" -3") => is_inside = false,
            Some(" -1") if is_inside => {
                let context = || format!("reading `{line}`");
                let node = line
                    .get(3..13)
                    .with_context(context)?
                    .trim()
                    .parse()
                    .with_context(context)?;
                let columns = line.get(13..).with_context(context)?.as_bytes().chunks(12);
                let values = columns
                    .map(|column| Ok(std::str::from_utf8(column)?.trim().parse::<f64>()?))
                    .collect::<Result<Vec<f64>>>()
                    .with_context(context)?;
                if let Some(field) = found.last_mut() {
                    field.push((node, values));
                }
            }
            _ => (),
        }
    }
    Ok(found)
}

/// Total reaction force along z in each block of a `.dat` file: the last number of the line after
/// each heading.
pub(super) fn total_force_z(dat: &str) -> Result<Vec<f64>> {
    let mut lines = dat.lines();
    let mut found = Vec::new();
    while let Some(line) = lines.next() {
        if line.contains("total force") {
            let numbers = lines
                .by_ref()
                .find(|line| !line.trim().is_empty())
                .unwrap_or_default();
            let last = numbers.split_whitespace().nth(2);
            found.push(
                last.and_then(|text| text.parse().ok())
                    .with_context(|| format!("reading `{numbers}`"))?,
            );
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fields_and_totals_are_read() {
        let frd = " -4  STRESS      6    1\n -5  SXX         1    4    1    1\n -1         7-1.00000E+00 2.50000E-03\n -3\n -4  CONTACT     6    1\n -1         8 3.00000E+00\n -3\n";
        assert_eq!(
            fields(frd, "STRESS").unwrap(),
            vec![vec![(7, vec![-1.0, 0.0025])]]
        );
        assert!(fields(" -4  STRESS\n -1         x 1.0\n", "STRESS").is_err());
        let dat = "\n total force (fx,fy,fz) for set BOTTOM and time  0.1000000E+01\n\n        1.0E-03 -2.0E-03  5.5E-01\n";
        assert_eq!(total_force_z(dat).unwrap(), vec![0.55]);
    }
}
