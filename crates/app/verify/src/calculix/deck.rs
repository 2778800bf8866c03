//! The input deck of CalculiX.
//!
//! Units: mm, N, MPa. Keywords: G. Dhondt, CalculiX CrunchiX user's manual, version 2.20.

use std::fmt::Write;

use anyhow::{Context, Result};

use super::bricks::Bricks;
use super::case::{Case, SIZE_MM};
use super::rigid::Skin;

/// Contact stiffness, MPa/mm: about 200 times that of the gel's topmost layer.
const CONTACT_STIFFNESS: f64 = 40.0;

/// Largest motion of the indenter in one increment, mm. In larger increments the stiffness of the
/// contact inverts elements at first.
const LARGEST_INCREMENT_MM: f64 = 0.125;

/// Largest unbalanced nodal force, relative to the mean nodal force. The mean over all nodes is far
/// smaller than that over nodes in contact.
const RESIDUAL: f64 = 0.1;

/// Writes the deck. Numbers of nodes and elements start at one; those of the gel come first.
pub(super) fn write(case: &Case, gel: &Bricks) -> Result<String> {
    let skin = Skin::of(&case.shape).context("there is no skin of this indenter")?;
    let mut deck = String::new();
    write_nodes(&mut deck, case, gel, &skin)?;
    write_elements(&mut deck, gel, &skin)?;
    write_materials(&mut deck, case)?;
    write_contact(&mut deck, gel)?;
    write_steps(&mut deck, case)?;
    Ok(deck)
}

fn write_nodes(deck: &mut String, case: &Case, gel: &Bricks, skin: &Skin) -> Result<()> {
    let lift = case.place_mm.extend(SIZE_MM.z);
    writeln!(deck, "*NODE, NSET=GEL")?;
    for (index, node) in gel.nodes_mm.iter().enumerate() {
        writeln!(deck, "{}, {:.9}, {:.9}, {:.9}", index + 1, node.x, node.y, node.z)?;
    }
    let first_node = gel.nodes_mm.len() + 1;
    writeln!(deck, "*NODE, NSET=INDENTER")?;
    for (index, node) in skin.nodes_mm.iter().enumerate() {
        let node = *node + lift;
        writeln!(
            deck,
            "{}, {:.9}, {:.9}, {:.9}",
            first_node + index,
            node.x,
            node.y,
            node.z
        )?;
    }
    for (name, axis) in [("BOTTOM", 2), ("SIDEX", 0), ("SIDEY", 1)] {
        writeln!(deck, "*NSET, NSET={name}")?;
        for (index, node) in gel.nodes_mm.iter().enumerate() {
            if node[axis].abs() < 1e-9 {
                writeln!(deck, "{},", index + 1)?;
            }
        }
    }
    Ok(())
}

fn write_elements(deck: &mut String, gel: &Bricks, skin: &Skin) -> Result<()> {
    writeln!(deck, "*ELEMENT, TYPE=C3D20R, ELSET=GEL")?;
    for (index, brick) in gel.bricks.iter().enumerate() {
        let nodes = brick.map(|node| (node + 1).to_string());
        writeln!(
            deck,
            "{}, {},\n{}",
            index + 1,
            nodes[..10].join(", "),
            nodes[10..].join(", ")
        )?;
    }
    let first_node = gel.nodes_mm.len() + 1;
    let first_facet = gel.bricks.len() + 1;
    for (corners, kind) in [(15, "C3D15"), (20, "C3D20")] {
        writeln!(deck, "*ELEMENT, TYPE={kind}, ELSET=INDENTER")?;
        for (index, nodes) in skin
            .elements
            .iter()
            .enumerate()
            .filter(|(_, nodes)| nodes.len() == corners)
        {
            let nodes: Vec<String> = nodes.iter().map(|node| (first_node + node).to_string()).collect();
            writeln!(
                deck,
                "{}, {},\n{}",
                first_facet + index,
                nodes[..10].join(", "),
                nodes[10..].join(", ")
            )?;
        }
    }
    Ok(())
}

fn write_materials(deck: &mut String, case: &Case) -> Result<()> {
    // C10 = μ/2, D1 = 2/K, in a strain energy C10 (J^(-2/3) I1 - 3) + (J - 1)²/D1.
    let c10_mpa = 0.5e-3 * case.shear_modulus_kpa();
    let d1_per_mpa = 2.0 / (1e-3 * case.bulk_modulus_kpa());
    writeln!(
        deck,
        "*MATERIAL, NAME=GEL\n*HYPERELASTIC, NEO HOOKE\n{c10_mpa:.9e}, {d1_per_mpa:.9e}"
    )?;
    // All nodes of the indenter are prescribed, so its stiffness has no effect.
    writeln!(deck, "*MATERIAL, NAME=INDENTER\n*ELASTIC\n1., 0.")?;
    writeln!(deck, "*SOLID SECTION, ELSET=GEL, MATERIAL=GEL")?;
    writeln!(deck, "*SOLID SECTION, ELSET=INDENTER, MATERIAL=INDENTER")?;
    Ok(())
}

fn write_contact(deck: &mut String, gel: &Bricks) -> Result<()> {
    writeln!(deck, "*SURFACE, NAME=TOP, TYPE=ELEMENT")?;
    for element in gel.bricks.len() - gel.n_layer..gel.bricks.len() {
        writeln!(deck, "{}, S2", element + 1)?;
    }
    writeln!(deck, "*SURFACE, NAME=SKIN, TYPE=ELEMENT\nINDENTER, S1")?;
    writeln!(deck, "*SURFACE INTERACTION, NAME=CONTACT")?;
    writeln!(
        deck,
        "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n{CONTACT_STIFFNESS:?}"
    )?;
    writeln!(
        deck,
        "*CONTACT PAIR, INTERACTION=CONTACT, TYPE=SURFACE TO SURFACE\nTOP, SKIN"
    )?;
    Ok(())
}

fn write_steps(deck: &mut String, case: &Case) -> Result<()> {
    writeln!(deck, "*BOUNDARY\nBOTTOM, 1, 3, 0.\nINDENTER, 1, 2, 0.")?;
    if case.is_quarter() {
        writeln!(deck, "SIDEX, 1, 1, 0.\nSIDEY, 2, 2, 0.")?;
    }
    let mut before_mm = 0.0;
    for depth_mm in &case.depths_mm {
        let largest = (LARGEST_INCREMENT_MM / (depth_mm - before_mm)).min(1.0);
        before_mm = *depth_mm;
        writeln!(
            deck,
            "*STEP, NLGEOM, INC=1000\n*STATIC\n{:.4}, 1., 1e-6, {largest:.4}",
            0.5 * largest
        )?;
        writeln!(
            deck,
            "*CONTROLS, PARAMETERS=FIELD\n{RESIDUAL:?}, , , , {RESIDUAL:?}"
        )?;
        writeln!(deck, "*BOUNDARY\nINDENTER, 3, 3, {:?}", -depth_mm)?;
        writeln!(deck, "*NODE PRINT, NSET=BOTTOM, TOTALS=ONLY, FREQUENCY=1000\nRF")?;
        writeln!(deck, "*EL FILE, NSET=BOTTOM, FREQUENCY=1000\nS")?;
        writeln!(deck, "*CONTACT FILE, FREQUENCY=1000\nCDIS\n*END STEP")?;
    }
    Ok(())
}
