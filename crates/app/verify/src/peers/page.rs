//! The results as a page for people and as JSON.

use std::fmt::Write as _;

use serde::{Deserialize, Serialize};

use super::plan::RATIOS;
use super::process::Conditions;
use super::row::Row;

/// The text of the page around the tables.
const TEXT: &str = include_str!("../../peers/page.md");

const HEADER: &str = "\
| engine | setting | mesh | nodes / tetrahedra | RTF | CPU s per s | force error at 0.5 / 1 / 2 mm | force, N | start-up, s (first) | memory, MiB |
|---|---|---|---|---|---|---|---|---|---|
";

/// The page, with the tables at the placeholders of its text.
pub(super) fn markdown(Results { conditions, rows }: &Results) -> String {
    let mut tables = String::new();
    for ratio in RATIOS {
        let lines: String = rows
            .iter()
            .filter(|row| row.poissons_ratio == ratio)
            .map(line)
            .collect();
        if !lines.is_empty() {
            let _ = write!(tables, "### ν = {ratio}\n\n{HEADER}{lines}\n");
        }
    }
    let machine = format!(
        "{}, {} processors, {:.0} GiB of memory",
        conditions.processor, conditions.processors, conditions.memory_gib
    );
    TEXT.replace("{tables}", tables.trim_end())
        .replace("{machine}", &machine)
        .replace("{date}", &conditions.date)
        .replace("{command}", &conditions.command)
        .replace("{load}", &format!("{:.1}", conditions.load))
        .replace("{limit}", &format!("{:.0}", conditions.limit_s))
        .replace("{settings}", settings(rows).trim_end())
}

/// The page's figures, with all digits.
#[derive(Deserialize, Serialize)]
pub(super) struct Results {
    pub(super) conditions: Conditions,
    pub(super) rows: Vec<Row>,
}

fn line(row: &Row) -> String {
    let engine = format!(
        "| {} {} | {} | {} |",
        row.engine, row.version, row.setting, row.mesh
    );
    let Some(figures) = &row.figures else {
        let why = row.failure.as_deref().unwrap_or("no figures").replace('|', "/");
        return format!("{engine} no result: {why} | | | | | | |\n");
    };
    let errors = ["0.5", "1.0", "2.0"]
        .map(|depth| row.shown_error(depth))
        .join(" / ");
    let cut = if row.is_cut() {
        format!(", cut at {:.2} mm", figures.reached_mm)
    } else {
        String::new()
    };
    let forces: Vec<String> = figures
        .force_n
        .values()
        .map(|force| format!("{force:.3}"))
        .collect();
    let first = row
        .first_start_s
        .map_or(String::new(), |first| format!(" ({first:.0})"));
    format!(
        "{engine} {} / {} | {} | {} | {errors}{cut} | {} | {:.1}{first} | {:.0} |\n",
        figures.nodes,
        figures.tets,
        significant(figures.rtf),
        significant(figures.cpu_s),
        forces.join(" / "),
        figures.start_up_s,
        figures.memory_mib
    )
}

/// A number with two or three significant digits.
fn significant(value: f64) -> String {
    let decimals = (2.0 - value.abs().log10().floor()).clamp(0.0, 5.0) as usize;
    format!("{value:.decimals$}")
}

/// The parameters of each setting, once.
fn settings(rows: &[Row]) -> String {
    let mut list = String::new();
    for (at, row) in rows.iter().enumerate() {
        let same = |other: &Row| other.engine == row.engine && other.setting == row.setting;
        if row.parameters.is_empty() || rows[..at].iter().any(same) {
            continue;
        }
        let told = row.parameters.iter().filter(|(name, _)| {
            !["cells", "mesh_file", "poissons_ratio", "limit_s"].contains(&name.as_str())
        });
        let told: Vec<String> = told.map(|(name, value)| format!("`{name}` {value}")).collect();
        let _ = writeln!(list, "- {}, {}: {}", row.engine, row.setting, told.join(", "));
    }
    list
}

#[cfg(test)]
mod tests {
    use serde_json::{Map, json};

    use super::super::plan::Run;
    use super::super::row::Figures;
    use super::*;

    const PRINTED: &str = r#"{"nodes": 8050, "tets": 33660, "rtf": 0.047, "cpu_s": 21.1, "start_up_s": 12.0,
 "reached_mm": 1.168, "force_n": {"0.5": 0.2321, "1.0": 0.7113}, "memory_mib": 342.6}"#;

    fn run() -> Run {
        Run {
            engine: "Engine".into(),
            version: "1.2".into(),
            script: String::new(),
            setting: "fast".into(),
            mesh: "TwinTac's".into(),
            poissons_ratio: 0.45,
            parameters: Map::from_iter([("iterations".into(), json!(3))]),
            limit_s: 60.0,
        }
    }

    fn results(rows: Vec<Row>) -> Results {
        let conditions = conditions();
        Results { conditions, rows }
    }

    fn conditions() -> Conditions {
        Conditions {
            date: "today".into(),
            processor: "Abacus".into(),
            processors: 2,
            memory_gib: 4.0,
            load: 0.5,
            command: "cargo xtask bench peers".into(),
            limit_s: 60.0,
        }
    }

    #[test]
    fn a_cut_press_says_how_deep_it_came() {
        let figures = Figures::parse(&PRINTED.replace('\n', " ")).unwrap();
        let page = markdown(&results(vec![Row::measured(&run(), figures, Some(80.0))]));
        assert!(
            page.contains("| Engine 1.2 | fast | TwinTac's | 8050 / 33660 | 0.0470 | 21.1 | +10.0 % / +0.0 % / –, cut at 1.17 mm | 0.232 / 0.711 | 12.0 (80) | 343 |"),
            "{page}"
        );
        assert!(page.contains("- Engine, fast: `iterations` 3"), "{page}");
    }

    #[test]
    fn a_failed_run_is_a_row_with_its_reason() {
        let row = Row::failed(&run(), "no module | named engine");
        let page = markdown(&results(vec![row]));
        assert!(page.contains("no result: no module / named engine |"), "{page}");
    }

    #[test]
    fn figures_that_were_written_are_read_again() {
        let figures = Figures::parse(&PRINTED.replace('\n', " ")).unwrap();
        let rows = vec![
            Row::measured(&run(), figures, None),
            Row::failed(&run(), "no module"),
        ];
        let written = serde_json::to_string(&results(rows)).unwrap();
        let read: Results = serde_json::from_str(&written).unwrap();
        assert_eq!(read.rows[0].figures.as_ref().unwrap().nodes, 8050);
        assert!(read.rows[1].figures.is_none());
        assert_eq!(serde_json::to_string(&read).unwrap(), written);
    }

    #[test]
    fn output_that_is_no_row_is_quoted() {
        let error = Figures::parse("hello").unwrap_err();
        assert!(error.to_string().contains("hello"), "{error}");
    }

    #[test]
    fn the_text_has_a_place_for_everything() {
        let page = markdown(&results(Vec::new()));
        assert!(!page.contains('{'), "{page}");
    }
}
