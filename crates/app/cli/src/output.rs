//! Output of data to standard output. Messages for people go to standard error.

use std::io::{ErrorKind, Write};

use anyhow::{Result, anyhow};
use twintac_text::visible;

/// A figure in % with two decimals, right-aligned in a column; `none` without a value.
pub(crate) fn percent(value: Option<f64>) -> String {
    match value {
        Some(value) => format!("{value:6.2} %"),
        None => "    none".to_owned(),
    }
}

/// Prints a line of data to standard output; a closed pipe is no error. Characters that control a
/// terminal are shown instead of sent.
pub(crate) fn print(text: &str) -> Result<()> {
    match writeln!(std::io::stdout(), "{}", visible(text)) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(error.into()),
        _ => Ok(()),
    }
}

/// Prints rows of comma-separated values, the header first. Texts with commas, quotes or line
/// breaks are quoted.
pub(crate) fn print_csv(rows: impl IntoIterator<Item = Vec<String>>) -> Result<()> {
    print(csv(rows)?.trim_end_matches('\n'))
}

fn csv(rows: impl IntoIterator<Item = Vec<String>>) -> Result<String> {
    let mut writer = csv::Writer::from_writer(Vec::new());
    for row in rows {
        writer.write_record(row)?;
    }
    let bytes = writer.into_inner().map_err(|error| anyhow!("{error}"))?;
    Ok(String::from_utf8(bytes)?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_figure_over_nothing_is_none() {
        assert_eq!(percent(None).trim(), "none");
        assert_eq!(percent(Some(0.0)).trim(), "0.00 %");
        assert_eq!(percent(None).len(), percent(Some(12.345)).len());
    }

    #[test]
    fn a_name_with_a_comma_is_one_cell() {
        let row = |cells: [&str; 3]| cells.map(str::to_owned).to_vec();
        let text = csv([row(["press", "x", ""]), row(["a,b \"c\"\nd", "-0.5000", ""])]).unwrap();
        assert_eq!(text, "press,x,\n\"a,b \"\"c\"\"\nd\",-0.5000,\n");
    }
}
