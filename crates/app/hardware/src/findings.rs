//! Violations that KiCad's rule checks report, of all severities.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};
use serde::Deserialize;

use crate::kicad::Kicad;

#[derive(Deserialize)]
struct Electrical {
    sheets: Vec<Sheet>,
}

#[derive(Deserialize)]
struct Sheet {
    violations: Vec<Violation>,
}

#[derive(Deserialize)]
struct Design {
    violations: Vec<Violation>,
    unconnected_items: Vec<Violation>,
    schematic_parity: Vec<Violation>,
}

#[derive(Deserialize)]
struct Violation {
    #[serde(rename = "type")]
    kind: String,
    severity: String,
    description: String,
    items: Vec<Item>,
}

#[derive(Deserialize)]
struct Item {
    description: String,
    pos: Option<Position>,
}

#[derive(Deserialize)]
struct Position {
    x: f64,
    y: f64,
}

/// Checks the electrical rules of the schematic, the design rules of the board, and the board's
/// parity with the schematic. Returns one text for each violation.
pub(crate) fn of(kicad: &Kicad, project: &Path, name: &str) -> Result<Vec<String>> {
    let reports = reports_of(project);
    fs::create_dir_all(&reports)?;
    let (schematic, board) = (format!("{name}.kicad_sch"), format!("{name}.kicad_pcb"));
    let electrical = reports.join("erc.json");
    let design = reports.join("drc.json");
    let common = ["--format", "json", "--severity-all", "-o"];
    let erc = [&["sch", "erc"], &common[..], &[text(&electrical), &schematic]].concat();
    kicad.run(project, &erc)?;
    let drc = [
        &["pcb", "drc", "--schematic-parity", "--all-track-errors"],
        &common[..],
        &[text(&design), &board],
    ]
    .concat();
    kicad.run(project, &drc)?;
    let electrical: Electrical = read(&electrical)?;
    let design: Design = read(&design)?;
    let sheets = electrical.sheets.into_iter().flat_map(|sheet| sheet.violations);
    let of_board = [
        design.violations,
        design.unconnected_items,
        design.schematic_parity,
    ];
    Ok(sheets.chain(of_board.into_iter().flatten()).map(told).collect())
}

/// The folder of the reports, beside the project.
fn reports_of(project: &Path) -> std::path::PathBuf {
    let reports = project.with_file_name("checks");
    std::path::absolute(&reports).unwrap_or(reports)
}

fn text(path: &Path) -> &str {
    path.to_str().unwrap_or_default()
}

fn read<T: serde::de::DeserializeOwned>(path: &Path) -> Result<T> {
    let bytes = fs::read(path).with_context(|| format!("reading {}", path.display()))?;
    serde_json::from_slice(&bytes).with_context(|| path.display().to_string())
}

fn told(violation: Violation) -> String {
    let items: Vec<String> = violation
        .items
        .iter()
        .map(|item| match &item.pos {
            Some(at) => format!("{} at ({}, {}) mm", item.description, at.x, at.y),
            None => item.description.clone(),
        })
        .collect();
    format!(
        "{} {}: {}: {}",
        violation.severity,
        violation.kind,
        violation.description,
        items.join("; ")
    )
}
