//! Reads a `.msh` file.

use glam::DVec3;

use super::assemble::{Contents, NodeEntry, TetEntry, assemble};
use super::elements::{Use, nodes_of, use_of};
use super::input::{Encoding, Input, shown};
use crate::{MeshError, TetMesh};

/// Coordinates beyond this value, in the unit of the file, count as a damaged file.
const FARTHEST: f64 = 1e6;

/// Reads a mesh in which a length of 1 is `mm_per_unit` mm.
///
/// Inverted tetrahedra are turned, nodes that no tetrahedron uses are dropped, and a tetrahedron
/// that is listed twice (in two physical groups) is taken once. Points, lines and faces are
/// ignored. The bonded nodes are those of the node data named "bonded", which [`super::write`]
/// writes. Without such data they are the nodes within 0.2 % of the mesh's diagonal above the
/// lowest node.
///
/// # Errors
/// [`MeshError::File`] with the line or byte where the file is not as expected, also for hexahedra,
/// prisms and pyramids; [`MeshError::Degenerate`] for a tetrahedron without volume;
/// [`MeshError::Empty`] for a file without tetrahedra; [`MeshError::Extent`] for a size that is not
/// plausible with this `mm_per_unit`; [`MeshError::NodesTwice`] and [`MeshError::Overlap`] for
/// bodies that are not meshed as one.
pub fn read(bytes: &[u8], mm_per_unit: f64) -> Result<TetMesh, MeshError> {
    let mut input = Input::new(bytes);
    let version = read_format(&mut input)?;
    let mut contents = Contents::default();
    let encoding = std::mem::replace(&mut input.encoding, Encoding::Text);
    while let Some(word) = input.word() {
        let Some(name) = word
            .strip_prefix(b"$")
            .and_then(|name| std::str::from_utf8(name).ok())
        else {
            return input.error("the start of a section, `$...`", shown(word));
        };
        match (name, version) {
            ("Nodes", Version::Two) => read_nodes_2(&mut input, encoding, &mut contents)?,
            ("Nodes", Version::Four) => read_nodes_4(&mut input, encoding, &mut contents)?,
            ("Elements", Version::Two) => read_elements_2(&mut input, encoding, &mut contents)?,
            ("Elements", Version::Four) => read_elements_4(&mut input, encoding, &mut contents)?,
            ("NodeData", _) => {
                read_node_data(&mut input, encoding, &mut contents)?;
                input.encoding = Encoding::Text;
                input.skip_section(name)?;
                continue;
            }
            _ => {
                input.skip_section(name)?;
                continue;
            }
        }
        input.encoding = Encoding::Text;
        input.end_section(name)?;
    }
    input.encoding = encoding;
    contents
        .nodes
        .iter_mut()
        .for_each(|node| node.position_mm *= mm_per_unit);
    assemble(&input, contents)
}

#[derive(Clone, Copy)]
enum Version {
    Two,
    Four,
}

/// Reads the first section, and sets the encoding of the input.
fn read_format(input: &mut Input) -> Result<Version, MeshError> {
    match input.word() {
        Some(b"$MeshFormat") => {}
        other => return input.error("`$MeshFormat`", shown(other.unwrap_or_default())),
    }
    let version: f64 = input.text_number("a version")?;
    let version = match version {
        2.0..=2.2 => Version::Two,
        4.1 => Version::Four,
        _ => return input.error("version 2.2 or 4.1", version.to_string()),
    };
    let kind: i64 = input.text_number("0 (text) or 1 (binary)")?;
    let size: i64 = input.text_number("the size of a number")?;
    if size != 8 {
        return input.error("numbers of 8 bytes", size.to_string());
    }
    let encoding = match kind {
        0 => Encoding::Text,
        1 => {
            input.end_line()?;
            let mark = input.raw::<4>("the number 1 in binary")?;
            match (i32::from_le_bytes(mark), i32::from_be_bytes(mark)) {
                (1, _) => Encoding::LittleEndian,
                (_, 1) => Encoding::BigEndian,
                (other, _) => return input.error("the number 1 in binary", other.to_string()),
            }
        }
        other => return input.error("0 (text) or 1 (binary)", other.to_string()),
    };
    input.end_section("MeshFormat")?;
    input.encoding = encoding;
    Ok(version)
}

fn read_nodes_2(input: &mut Input, encoding: Encoding, contents: &mut Contents) -> Result<(), MeshError> {
    let count: u64 = input.text_number("the number of nodes")?;
    switch(input, encoding)?;
    for _ in 0..input.fits(count, 4, "the number of nodes")? {
        let at = input.position();
        let tag = tag(input)?;
        let position_mm = read_position(input)?;
        contents.nodes.push(NodeEntry { tag, position_mm, at });
    }
    Ok(())
}

fn read_nodes_4(input: &mut Input, encoding: Encoding, contents: &mut Contents) -> Result<(), MeshError> {
    switch(input, encoding)?;
    let n_blocks = input.size("the number of blocks")?;
    for expected in ["the number of nodes", "the smallest tag", "the largest tag"] {
        input.size(expected)?;
    }
    for _ in 0..input.fits(n_blocks, 4, "the number of blocks")? {
        let dimension = input.int("the dimension of an entity")?;
        input.int("the tag of an entity")?;
        let parametric = input.int("0 or 1 (parametric)")?;
        let n_extra = match (parametric, dimension) {
            (0, _) => 0,
            (1, 0..=3) => dimension,
            _ => {
                return input.error(
                    "0 or 1 (parametric) of an entity",
                    format!("{parametric}, dimension {dimension}"),
                );
            }
        };
        let count = input.size("the number of nodes in a block")?;
        let count = input.fits(count, 4, "the number of nodes in a block")?;
        let tags = (0..count)
            .map(|_| input.size("the tag of a node"))
            .collect::<Result<Vec<_>, _>>()?;
        for tag in tags {
            let position_mm = read_position(input)?;
            let at = input.position();
            for _ in 0..n_extra {
                input.real("a parametric coordinate")?;
            }
            contents.nodes.push(NodeEntry { tag, position_mm, at });
        }
    }
    Ok(())
}

fn read_position(input: &mut Input) -> Result<DVec3, MeshError> {
    let mut coordinates = [0.0; 3];
    for coordinate in &mut coordinates {
        *coordinate = input.real("a coordinate")?;
        if !(-FARTHEST..=FARTHEST).contains(coordinate) {
            return input.error("a coordinate within ±1e6", coordinate.to_string());
        }
    }
    Ok(DVec3::from_array(coordinates))
}

fn read_elements_2(input: &mut Input, encoding: Encoding, contents: &mut Contents) -> Result<(), MeshError> {
    let count: u64 = input.text_number("the number of elements")?;
    switch(input, encoding)?;
    let count = input.fits(count, 2, "the number of elements")?;
    let mut done = 0;
    while done < count {
        // In text files every element has a header of its own, after its number.
        if encoding == Encoding::Text {
            input.int("the number of an element")?;
        }
        let kind = input.int("the kind of an element")?;
        let in_block = if encoding == Encoding::Text {
            1
        } else {
            input.int("the number of elements in a block")?
        };
        let n_tags = input.int("the number of tags")?;
        let n_nodes = known(input, kind)?;
        let (Ok(in_block), Ok(n_tags)) = (usize::try_from(in_block), u32::try_from(n_tags)) else {
            return input.error("counts above zero", format!("{in_block} elements, {n_tags} tags"));
        };
        if in_block == 0 || in_block > count - done {
            return input.error(
                &format!("1 to {} elements in a block", count - done),
                in_block.to_string(),
            );
        }
        done += in_block;
        for _ in 0..in_block {
            let at = input.position();
            if encoding != Encoding::Text {
                input.int("the number of an element")?;
            }
            let mut entity = 0;
            for place in 0..n_tags {
                let tag = input.int("a tag")?;
                // The first tag is the physical group.
                if place == 1 {
                    entity = tag;
                }
            }
            check_use(input, kind, at, entity)?;
            read_element(input, kind, n_nodes, tag, contents)?;
        }
    }
    Ok(())
}

fn read_elements_4(input: &mut Input, encoding: Encoding, contents: &mut Contents) -> Result<(), MeshError> {
    switch(input, encoding)?;
    let n_blocks = input.size("the number of blocks")?;
    for expected in ["the number of elements", "the smallest tag", "the largest tag"] {
        input.size(expected)?;
    }
    for _ in 0..input.fits(n_blocks, 4, "the number of blocks")? {
        input.int("the dimension of an entity")?;
        let entity = input.int("the tag of an entity")?;
        let kind = input.int("the kind of elements")?;
        let n_nodes = known(input, kind)?;
        check_use(input, kind, input.position(), entity)?;
        let count = input.size("the number of elements in a block")?;
        for _ in 0..input.fits(count, 1 + n_nodes as u64, "the number of elements in a block")? {
            input.size("the tag of an element")?;
            read_element(
                input,
                kind,
                n_nodes,
                |input| input.size("the tag of a node"),
                contents,
            )?;
        }
    }
    Ok(())
}

/// Fails for an element that a mesh of tetrahedra cannot have; `at` is its position.
fn check_use(input: &Input, kind: i64, at: usize, entity: i64) -> Result<(), MeshError> {
    match use_of(kind) {
        Use::Other(name) => {
            let found = format!("{name} (kind {kind}) in entity {entity}");
            input.error_at(at, "tetrahedra as the only solid elements", found)
        }
        Use::Tetrahedron | Use::NoVolume => Ok(()),
    }
}

/// Reads the nodes of an element, and keeps them if it is a tetrahedron.
fn read_element(
    input: &mut Input,
    kind: i64,
    n_nodes: usize,
    read_tag: impl Fn(&mut Input) -> Result<u64, MeshError>,
    contents: &mut Contents,
) -> Result<(), MeshError> {
    let mut corners = [0; 4];
    for place in 0..n_nodes {
        let tag = read_tag(input)?;
        if let Some(corner) = corners.get_mut(place) {
            *corner = tag;
        }
    }
    if use_of(kind) == Use::Tetrahedron {
        contents.tets.push(TetEntry {
            tags: corners,
            at: input.position(),
        });
    }
    Ok(())
}

/// Reads node data if they state which nodes are bonded; otherwise stops somewhere before their
/// end.
fn read_node_data(input: &mut Input, encoding: Encoding, contents: &mut Contents) -> Result<(), MeshError> {
    let n_names: u32 = input.text_number("the number of names")?;
    if n_names == 0 || input.quoted()? != super::BONDED.as_bytes() {
        return Ok(());
    }
    for _ in 1..n_names {
        input.quoted()?;
    }
    let n_reals: u32 = input.text_number("the number of reals")?;
    for _ in 0..n_reals {
        input.text_number::<f64>("a real")?;
    }
    let n_whole: u32 = input.text_number("the number of whole numbers")?;
    let mut whole = [0_u64; 3];
    for place in 0..n_whole {
        let number = input.text_number("a whole number")?;
        if let Some(slot) = whole.get_mut(place as usize) {
            *slot = number;
        }
    }
    let [_time_step, n_components, count] = whole;
    if n_components != 1 {
        return input.error("one component", n_components.to_string());
    }
    switch(input, encoding)?;
    let count = input.fits(count, 2, "the number of values")?;
    let values = (0..count).map(|_| Ok((tag(input)?, input.real("a value")?)));
    contents.bonded = Some(values.collect::<Result<_, MeshError>>()?);
    Ok(())
}

/// Goes from the text of a section's head to the encoding of its body.
fn switch(input: &mut Input, encoding: Encoding) -> Result<(), MeshError> {
    if encoding != Encoding::Text {
        input.end_line()?;
    }
    input.encoding = encoding;
    Ok(())
}

/// A tag of a node, of four bytes in binary files.
fn tag(input: &mut Input) -> Result<u64, MeshError> {
    let tag = input.int("the tag of a node")?;
    match u64::try_from(tag) {
        Ok(tag) => Ok(tag),
        Err(_) => input.error("the tag of a node", tag.to_string()),
    }
}

fn known(input: &Input, kind: i64) -> Result<usize, MeshError> {
    match nodes_of(kind) {
        Some(n_nodes) => Ok(n_nodes),
        None => input.error("a kind of element from 1 to 31", kind.to_string()),
    }
}
