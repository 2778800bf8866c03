//! The card of a model: what users should know before they use it.

use twintac_text::markdown;

use super::Model;
use crate::{Errors, Score, Variant};

/// The card, in Markdown.
pub(super) fn card(model: &Model) -> String {
    let record = &model.record;
    let (provenance, n_taxels) = (record.provenance, record.taxels.len());
    let what = match record.variant {
        Variant::Paper => {
            "a perceptron on the mean of von Mises stress over distance, of a cluster of surface nodes for each taxel (arXiv 2509.10063)"
        }
        _ => {
            "the gel's pressure at each port times a gain, with the static nonlinearity and the viscoelastic relaxation of each taxel; if the name ends in `mlp`, a small perceptron adds a correction"
        }
    };
    let split = &record.split;
    let bench = &record.bench;
    let offset_mm = bench.contact_offset_elsewhere_mm;
    let test = record
        .test
        .as_ref()
        .map_or(String::new(), |score| row("test", split.test.len(), score));
    // An adapted twin has no validation presses between its training and its test presses.
    let validation = match split.validation.len() {
        0 => row("adapted with", split.train.len(), &record.validation),
        n_presses => row("validation", n_presses, &record.validation),
    };
    let mut text = format!(
        "# A twin of {n_taxels} barometers\n\n\
         It predicts the readings of the barometers from a finite-element simulation of the pressed gel. It was trained on `{provenance}` recordings; its \
         output is `simulated`.\n\n\
         - Model `{}`: {what}.\n\
         - Trained on {} presses of {}.\n\
         - Taxels, in the order of every row: {}.\n\n\
         | presses | number | nearest taxel in contact, % | all taxels, % | peak, % |\n|---|---|---|---|---|\n{}{test}\n\
         {}\n\n\
         ## Validity\n\n\
         The twin is valid for the sensor of its training presses, with similar shapes, depths and speeds. The indenter touches the gel {offset_mm:+.2} mm deeper \
         than its recorded height. Depths beyond those of the training presses were not checked.\n",
        record.variant,
        split.train.len(),
        markdown(&record.files.join(", ")),
        markdown(&record.taxels.join(", ")),
        validation,
        record.validation.definition,
    );
    if !bench.doubts.is_empty() {
        let doubts = bench
            .doubts
            .iter()
            .map(|doubt| format!("- {}\n", markdown(doubt)));
        text.push_str(&format!(
            "\nWarnings of the fit:\n\n{}",
            doubts.collect::<String>()
        ));
    }
    text.push_str(
        "\n## How to use it\n\n\
         `twintac predict --model DIR --path FILE` prints its readings along a path. `twin.json` has the sensor's description, the settings of simulation and \
         training, and the setup calibration; `checksums.json` has the SHA-256 of the files. The weights, in Python:\n\n\
         ```python\n\
         import json\n\
         from safetensors.numpy import load_file\n\n\
         weights = load_file(\"weights.safetensors\")\n\
         record = json.load(open(\"twin.json\"))\n\
         print(record[\"variant\"], {name: array.shape for name, array in weights.items()})\n\
         ```\n",
    );
    text
}

fn row(name: &str, n_presses: usize, score: &Score) -> String {
    let Errors {
        nearest_in_contact,
        all,
        peak,
    } = score.overall;
    let [nearest, all, peak] = [nearest_in_contact, all, peak].map(|mean| match mean.percent {
        Some(percent) => format!("{percent:.2}"),
        None => "none".to_owned(),
    });
    format!("| {name} | {n_presses} | {nearest} | {all} | {peak} |\n")
}
