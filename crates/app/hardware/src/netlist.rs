//! Compares the netlist that KiCad reads from the schematic with the description.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use anyhow::{Context, Result, ensure};
use twintac_board::TaxelWiring;

use crate::kicad::Kicad;

/// Checks that each taxel's chip is on its channel of its switch, and alone there.
pub(crate) fn compare(kicad: &Kicad, project: &Path, name: &str, wiring: &[TaxelWiring]) -> Result<()> {
    let path = project.with_file_name("checks").join("netlist.xml");
    let out = std::path::absolute(&path)?;
    let out = out.to_str().context("a path that is no text")?;
    let schematic = format!("{name}.kicad_sch");
    kicad.run(
        project,
        &[
            "sch", "export", "netlist", "--format", "kicadxml", "-o", out, &schematic,
        ],
    )?;
    let text = fs::read_to_string(&path).with_context(|| format!("reading {}", path.display()))?;
    let net_of = nets(&text)?;
    let net = |reference: &str, pin: &str| {
        let net = net_of.get(&(reference.to_owned(), pin.to_owned()));
        net.with_context(|| format!("the netlist has no pin {pin} of {reference}"))
    };
    let mut seen: BTreeMap<&String, &str> = BTreeMap::new();
    for taxel in wiring {
        for (chip_pin, switch_pin) in taxel.chip_pins.iter().zip(&taxel.switch_pins) {
            let (of_chip, of_switch) = (net(&taxel.chip, chip_pin)?, net(&taxel.switch, switch_pin)?);
            ensure!(
                of_chip == of_switch,
                "taxel {}: pin {chip_pin} of {} is on net {of_chip}, pin {switch_pin} of {} on net {of_switch}",
                taxel.taxel,
                taxel.chip,
                taxel.switch
            );
            if let Some(other) = seen.insert(of_chip, &taxel.taxel) {
                anyhow::bail!("taxels {other} and {} share net {of_chip}", taxel.taxel);
            }
        }
    }
    Ok(())
}

/// The net of each pin, by reference and pin.
fn nets(text: &str) -> Result<BTreeMap<(String, String), String>> {
    let document = roxmltree::Document::parse(text).context("reading the netlist")?;
    let mut found = BTreeMap::new();
    for net in document.descendants().filter(|node| node.has_tag_name("net")) {
        let name = net.attribute("name").unwrap_or_default();
        for node in net.children().filter(|node| node.has_tag_name("node")) {
            let of = |name| node.attribute(name).unwrap_or_default().to_owned();
            found.insert((of("ref"), of("pin")), name.to_owned());
        }
    }
    Ok(found)
}

#[cfg(test)]
mod tests {
    use super::nets;

    #[test]
    fn pins_have_their_nets() {
        let text = r#"<export><nets><net code="1" name="GND">
            <node ref="U1" pin="1"/><node ref="C1" pin="2"/></net></nets></export>"#;
        let found = nets(text).unwrap();
        assert_eq!(found[&("C1".to_owned(), "2".to_owned())], "GND");
        assert_eq!(found.len(), 2);
    }
}
