//! Fabrication files and pictures, made by KiCad.

use std::fs;
use std::path::Path;

use anyhow::{Context, Result};

use crate::dates;
use crate::kicad::Kicad;

const LAYERS: &str = "F.Cu,B.Cu,F.Mask,B.Mask,F.Paste,B.Paste,F.SilkS,B.SilkS,Edge.Cuts";

/// Arguments without names or paths, separated by blanks.
const GERBER: &str = "pcb export gerbers --subtract-soldermask --no-protel-ext -o ../fabrication/";
const DRILL: &str = "pcb export drill --format excellon --excellon-separate-th -o ../fabrication/";
const PLACEMENT: &str =
    "pcb export pos --format csv --units mm --side both --smd-only -o ../fabrication/placement.csv";
const STEP: &str = "pcb export step -f --no-dnp";
const SCHEMATIC: &str = "sch export pdf -o ../schematic.pdf";
const SVG: &str = "pcb export svg --mode-single --page-size-mode 2 --exclude-drawing-sheet";
const PNG: &str = "pcb render -w 1400 -h 800 --zoom 1.5";

/// Writes all files into `fabrication` and `pictures` beside the project.
pub(crate) fn all(kicad: &Kicad, folder: &Path, name: &str) -> Result<()> {
    for sub in ["fabrication", "pictures"] {
        fs::create_dir_all(folder.join(sub))?;
    }
    let project = folder.join("board");
    let (board, schematic) = (format!("{name}.kicad_pcb"), format!("{name}.kicad_sch"));
    let run = |words: &str, more: &[&str]| {
        let words: Vec<&str> = words.split(' ').collect();
        kicad.run(&project, &[&words, more].concat())
    };
    run(GERBER, &["-l", LAYERS, &board])?;
    run(DRILL, &[&board])?;
    run(PLACEMENT, &[&board])?;
    run(STEP, &["-o", &format!("../{name}.step"), &board])?;
    run(SCHEMATIC, &[&schematic])?;
    let top = ["-l", "F.Cu,F.Mask,F.SilkS,Edge.Cuts"];
    let bottom = ["--mirror", "-l", "B.Cu,B.Mask,B.SilkS,Edge.Cuts"];
    for (face, layers) in [("top", &top[..]), ("bottom", &bottom[..])] {
        let (svg, png) = (
            format!("../pictures/{face}.svg"),
            format!("../pictures/{face}.png"),
        );
        run(SVG, &[layers, &["-o", &svg, &board]].concat())?;
        run(PNG, &["--side", face, "-o", &png, &board])?;
    }
    without_dates(folder, name)
}

fn without_dates(folder: &Path, name: &str) -> Result<()> {
    for dated in [format!("{name}.step"), "schematic.pdf".to_owned()] {
        dates::fix(&folder.join(dated))?;
    }
    for sub in ["fabrication", "pictures"] {
        for entry in fs::read_dir(folder.join(sub)).with_context(|| format!("reading {sub}"))? {
            let path = entry?.path();
            if path.extension().is_none_or(|ending| ending != "png") {
                dates::fix(&path)?;
            }
        }
    }
    Ok(())
}
