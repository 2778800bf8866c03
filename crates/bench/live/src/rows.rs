//! Frames as rows of text.

use std::io::{self, Write};

use serde::Serialize;
use twintac_recording::Provenance;
use twintac_source::Reading;

use crate::{About, Tare};

/// The format of rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Comma-separated values under a header. A missing value is empty.
    Csv,
    /// One JSON object per line. A missing value is null.
    JsonLines,
}

/// Writes one row for each frame. Each row is flushed, so that it can be read at once.
#[derive(Debug)]
pub struct RowWriter<W> {
    out: W,
    format: Format,
    taxels: Vec<String>,
    provenance: Provenance,
}

#[derive(Serialize)]
struct Row<'a> {
    seq: u64,
    bench_s: f64,
    provenance: Provenance,
    taxels: Vec<TaxelRow<'a>>,
}

#[derive(Serialize)]
struct TaxelRow<'a> {
    name: &'a str,
    above_tare_kpa: Option<f64>,
    counts: Option<i32>,
    temperature_c: Option<f64>,
    fault: Option<&'static str>,
}

impl<W: Write> RowWriter<W> {
    /// Writes the header, if the format has one.
    ///
    /// # Errors
    /// An error of `out`.
    pub fn new(mut out: W, format: Format, about: &About) -> io::Result<Self> {
        if format == Format::Csv {
            let mut head = ["seq", "bench_s", "provenance"].map(str::to_owned).to_vec();
            for unit in ["above_tare_kpa", "counts", "temperature_c", "fault"] {
                head.extend(about.taxels.iter().map(|taxel| format!("{taxel}_{unit}")));
            }
            write_csv(&mut out, head)?;
            out.flush()?;
        }
        Ok(Self {
            out,
            format,
            taxels: about.taxels.clone(),
            provenance: about.provenance,
        })
    }

    /// Writes a frame.
    ///
    /// # Errors
    /// An error of the writer.
    pub fn write(&mut self, reading: &Reading, tare: &mut Tare) -> io::Result<()> {
        let above_kpa = tare.above_kpa(reading);
        let taxels = self.taxels.iter().zip(&reading.frame.taxels).zip(above_kpa);
        let row = Row {
            seq: reading.sequence,
            bench_s: reading.bench_s,
            provenance: self.provenance,
            taxels: taxels
                .map(|((name, taxel), above_kpa)| TaxelRow {
                    name,
                    above_tare_kpa: above_kpa.map(to_a_millipascal),
                    counts: taxel.counts,
                    temperature_c: taxel.temperature_c,
                    fault: taxel.state.fault(),
                })
                .collect(),
        };
        match self.format {
            Format::Csv => row.write_csv(&mut self.out)?,
            Format::JsonLines => {
                serde_json::to_writer(&mut self.out, &row)?;
                writeln!(self.out)?;
            }
        }
        self.out.flush()
    }
}

/// Rounds to 1 mPa. The resolution of a chip is a thousand times coarser, so further digits are
/// only rounding errors.
fn to_a_millipascal(pressure_kpa: f64) -> f64 {
    (1e6 * pressure_kpa).round() / 1e6
}

impl Row<'_> {
    fn write_csv(&self, out: &mut impl Write) -> io::Result<()> {
        let taxels = || self.taxels.iter();
        let mut cells = vec![
            self.seq.to_string(),
            format!("{:.6}", self.bench_s),
            self.provenance.to_string(),
        ];
        cells.extend(taxels().map(|taxel| text(taxel.above_tare_kpa)));
        cells.extend(taxels().map(|taxel| text(taxel.counts)));
        cells.extend(taxels().map(|taxel| text(taxel.temperature_c)));
        cells.extend(taxels().map(|taxel| text(taxel.fault)));
        write_csv(out, cells)
    }
}

/// Writes one line with a single call, so that it is complete as far as `out` allows.
fn write_csv(out: &mut impl Write, cells: Vec<String>) -> io::Result<()> {
    let mut line = csv::Writer::from_writer(Vec::new());
    line.write_record(cells)?;
    out.write_all(&line.into_inner().map_err(csv::IntoInnerError::into_error)?)
}

fn text(value: Option<impl ToString>) -> String {
    value.map(|value| value.to_string()).unwrap_or_default()
}
