//! The verification tests ("rungs" of a "ladder" in code): from what must be exact to what is only
//! likely. Each has numbers with stated limits.

mod balance;
mod calibration;
mod closed_forms;
mod convergence;
mod derivatives;
mod half_space;
mod hertz;
mod locking;
mod page;
mod patch_test;
mod random_press;
mod rims;
mod robustness;
mod rubbers;
mod surface_load;
mod thin;

use std::io::Write as _;
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use clap::Args;

use crate::calculix::{self, Source};
use crate::rung::{Effort, Rung, number};

/// All tests, in order.
const RUNGS: &[Rung] = &[
    Rung {
        number: 1,
        name: "patch-test",
        title: "A linear displacement field on an irregular mesh is exact",
        run: patch_test::run,
    },
    Rung {
        number: 2,
        name: "derivatives",
        title: "Energy, forces and tangent are consistent; a rotation causes no stress",
        run: derivatives::run,
    },
    Rung {
        number: 3,
        name: "closed-forms",
        title: "Homogeneous deformations of a block follow the closed forms",
        run: closed_forms::run,
    },
    Rung {
        number: 4,
        name: "locking",
        title: "No locking: Cook's membrane at ν = 0.4999",
        run: locking::run,
    },
    Rung {
        number: 5,
        name: "hertz",
        title: "A ball on a half-space: Hertz",
        run: hertz::run,
    },
    Rung {
        number: 6,
        name: "surface-load",
        title: "Pressure below a uniform circular load on a half-space",
        run: surface_load::run,
    },
    Rung {
        number: 7,
        name: "balance",
        title: "The indenter's force equals that of board and shell",
        run: balance::run,
    },
    Rung {
        number: 8,
        name: "calculix",
        title: "Force and pressure at the taxels, compared with CalculiX",
        run: calculix::run,
    },
    Rung {
        number: 9,
        name: "convergence",
        title: "Force and pressure at the taxels converge with the mesh",
        run: convergence::run,
    },
    Rung {
        number: 10,
        name: "robustness",
        title: "Random presses converge or end in a typed error",
        run: robustness::run,
    },
    Rung {
        number: 11,
        name: "calibration",
        title: "Known materials are recovered from noisy forces",
        run: calibration::run,
    },
    Rung {
        number: 12,
        name: "rims",
        title: "Force and pressure under shapes with rims, on meshes that are pressed in real time",
        run: rims::run,
    },
];

/// Command-line options.
#[derive(Args)]
pub(crate) struct Options {
    /// Numbers or names of verification tests; all if none is given
    rungs: Vec<String>,
    /// Print one JSON line for each test instead of a table
    #[arg(long)]
    json: bool,
    /// Coarser meshes and fewer presses: about five minutes
    #[arg(long)]
    quick: bool,
    /// Run CalculiX (Debian package calculix-ccx; up to an hour a case) on the cases of test 8
    /// whose names start with this text
    #[arg(long, value_name = "CASE")]
    ccx: Option<String>,
    /// Compute the references of test 8 on finer meshes (up to half an hour a case) for the cases
    /// whose names start with this text
    #[arg(long, value_name = "CASE")]
    finer: Option<String>,
    /// Folder to which the pages are written
    #[arg(long, default_value = "docs/verification")]
    folder: PathBuf,
}

/// Runs the tests, and returns whether all limits hold.
pub(crate) fn run(options: &Options) -> Result<bool> {
    let rungs = chosen(&options.rungs)?;
    for (source, prefix) in [(Source::Calculix, &options.ccx), (Source::Finer, &options.finer)] {
        if let Some(prefix) = prefix {
            calculix::compute_references(source, prefix)?;
        }
    }
    let effort = if options.quick {
        Effort::Quick
    } else {
        Effort::Full
    };
    std::fs::create_dir_all(&options.folder)
        .with_context(|| format!("making the folder {}", options.folder.display()))?;
    let mut all_hold = true;
    let mut out = std::io::stdout().lock();
    for rung in rungs {
        let outcome = (rung.run)(effort)
            .with_context(|| format!("verification test {}, {}", rung.number, rung.name))?;
        all_hold &= outcome.holds();
        let record = page::write(&options.folder, rung, &outcome, effort)?;
        if options.json {
            writeln!(out, "{}", serde_json::to_string(&record)?)?;
        } else {
            writeln!(out, "{:2} {}", rung.number, rung.title)?;
            for figure in &outcome.figures {
                let value = format!("{} {}", number(figure.value), figure.unit);
                let limit = figure.limit.to_string();
                let verdict = if figure.holds { "" } else { "does not hold" };
                writeln!(out, "   {:70} {value:>18}  {limit:10} {verdict}", figure.name)?;
            }
        }
        out.flush()?;
    }
    page::write_index(&options.folder)?;
    Ok(all_hold)
}

fn chosen(names: &[String]) -> Result<Vec<&'static Rung>> {
    if names.is_empty() {
        return Ok(RUNGS.iter().collect());
    }
    names
        .iter()
        .map(|name| {
            let is_it = |rung: &&Rung| rung.name == name || rung.number.to_string() == *name;
            RUNGS.iter().find(is_it)
        })
        .zip(names)
        .map(|(rung, name)| match rung {
            Some(rung) => Ok(rung),
            None => {
                let known: Vec<String> = RUNGS
                    .iter()
                    .map(|rung| format!("{} {}", rung.number, rung.name))
                    .collect();
                bail!(
                    "there is no verification test `{name}`; there are {}",
                    known.join(", ")
                )
            }
        })
        .collect()
}
