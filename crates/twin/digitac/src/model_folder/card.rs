//! The card of a model: what people should know before they use it.

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
            "the gel's pressure at each port times a gain, with the port's own law and memory, and what a small perceptron adds to it where the name ends in `mlp`"
        }
    };
    let split = &record.split;
    let bench = &record.bench;
    let offset_mm = bench.contact_offset_elsewhere_mm;
    let test = record
        .test
        .as_ref()
        .map_or(String::new(), |score| row("test", split.test.len(), score));
    // An adapted twin has no presses between those that taught it and those that judge.
    let validation = match split.validation.len() {
        0 => row("adapted with", split.train.len(), &record.validation),
        n_presses => row("validation", n_presses, &record.validation),
    };
    let mut text = format!(
        "# A twin of {n_taxels} barometers\n\n\
         It says what the barometers would read, from what a finite-element gel shows when it is pressed. Learned from `{provenance}` recordings; what it \
         says is `simulated`.\n\n\
         - Model `{}`: {what}.\n\
         - Taught by {} presses of {}.\n\
         - Taxels, in the order of every row: {}.\n\n\
         | presses | how many | nearest taxel in contact, % | all taxels, % | peak, % |\n|---|---|---|---|---|\n{}{test}\n\
         {}\n\n\
         ## Where it holds\n\n\
         For the sensor whose recordings taught it, with shapes, depths and speeds like theirs. The indenter touches {offset_mm:+.2} mm deeper than its recorded \
         height says. Beyond the depths that taught it nothing was checked.\n",
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
        text.push_str(&format!("\nDoubts of the fit:\n\n{}", doubts.collect::<String>()));
    }
    text.push_str(
        "\n## How to use it\n\n\
         `twintac predict --model DIR --path FILE` prints what it reads along a press. `twin.json` has the sensor's description, the settings of simulation and \
         training, and all that was found about the bench; `checksums.json` the SHA-256 of the files. The weights, in Python:\n\n\
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
