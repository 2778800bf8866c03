//! Gmsh files of every version and encoding, and with every kind of damage.

#![allow(clippy::unwrap_used)]

use proptest::prelude::*;
use twintac_mesh::{MeshError, TetMesh, gmsh};

/// The encoding of numbers in a test file.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Encoding {
    Text,
    Little,
    Big,
}

struct Writer(Vec<u8>, Encoding);

impl Writer {
    fn new(version: &str, encoding: Encoding) -> Self {
        let mut writer = Self(Vec::new(), encoding);
        writer.text(&format!(
            "$MeshFormat\n{version} {} 8\n",
            i32::from(encoding != Encoding::Text)
        ));
        if encoding != Encoding::Text {
            writer.int(1);
            writer.text("\n");
        }
        writer.text("$EndMeshFormat\n$Comments\n12 $Nodes are not here\n$EndComments\n");
        writer
    }

    fn text(&mut self, text: &str) {
        self.0.extend(text.as_bytes());
    }

    fn int(&mut self, number: i32) {
        self.put(number.to_string(), number.to_le_bytes());
    }

    fn size(&mut self, number: u64) {
        self.put(number.to_string(), number.to_le_bytes());
    }

    fn real(&mut self, number: f64) {
        self.put(number.to_string(), number.to_le_bytes());
    }

    fn put<const N: usize>(&mut self, text: String, mut bytes: [u8; N]) {
        match self.1 {
            Encoding::Text => return self.text(&format!("{text} ")),
            Encoding::Little => {}
            Encoding::Big => bytes.reverse(),
        }
        self.0.extend(bytes);
    }

    fn ints(&mut self, numbers: &[i32]) {
        numbers.iter().for_each(|&number| self.int(number));
    }

    fn sizes(&mut self, numbers: &[u64]) {
        numbers.iter().for_each(|&number| self.size(number));
    }

    fn reals(&mut self, numbers: &[f64]) {
        numbers.iter().for_each(|&number| self.real(number));
    }
}

/// Tags with gaps and out of order; node 40 belongs to a line only.
const TAGS: [i32; 6] = [30, 7, 12, 5, 40, 9];
const NODES: [[f64; 3]; 6] = [
    [0.0, 0.0, 0.0],
    [2.0, 0.0, 0.0],
    [0.0, 2.0, 0.0],
    [0.0, 0.0, 3.0],
    [9.0, 9.0, 9.0],
    [2.0, 2.0, 3.0],
];

fn version_2(encoding: Encoding) -> Vec<u8> {
    let mut file = Writer::new("2.2", encoding);
    file.text("$Nodes\n6\n");
    for (tag, node) in TAGS.iter().zip(NODES) {
        file.int(*tag);
        file.reals(&node);
    }
    file.text("\n$EndNodes\n$Elements\n3\n");
    if encoding == Encoding::Text {
        file.ints(&[1, 1, 2, 0, 1, 30, 40]);
        file.ints(&[2, 4, 2, 0, 1, 30, 7, 12, 5]);
        file.ints(&[3, 4, 0, 7, 12, 5, 9]);
    } else {
        file.ints(&[1, 1, 2, 1, 0, 1, 30, 40]);
        file.ints(&[4, 2, 1, 2, 1, 30, 7, 12, 5, 3, 1, 7, 12, 5, 9]);
    }
    file.text("\n$EndElements\n");
    file.0
}

fn version_4(encoding: Encoding) -> Vec<u8> {
    let mut file = Writer::new("4.1", encoding);
    file.text("$Nodes\n");
    file.sizes(&[2, 6, 5, 40]);
    for (dimension, parametric, range) in [(2, 1, 0..2), (3, 0, 2..6)] {
        file.ints(&[dimension, 1, parametric]);
        file.size(range.len() as u64);
        range.clone().for_each(|i| file.size(TAGS[i] as u64));
        for i in range {
            file.reals(&NODES[i]);
            (0..dimension * parametric).for_each(|_| file.real(0.5));
        }
    }
    file.text("\n$EndNodes\n$Elements\n");
    file.sizes(&[2, 3, 1, 3]);
    file.ints(&[1, 1, 1]);
    file.sizes(&[1, 1, 30, 40]);
    file.ints(&[3, 1, 4]);
    file.sizes(&[2, 2, 30, 7, 12, 5, 3, 7, 12, 5, 9]);
    file.text("\n$EndElements\n");
    file.0
}

fn all_files() -> Vec<(String, Vec<u8>)> {
    [Encoding::Text, Encoding::Little, Encoding::Big]
        .into_iter()
        .flat_map(|e| {
            [
                (format!("2.2 {e:?}"), version_2(e)),
                (format!("4.1 {e:?}"), version_4(e)),
            ]
        })
        .collect()
}

#[test]
fn every_version_and_encoding_gives_the_same_mesh() {
    for (name, file) in all_files() {
        let mesh = gmsh::read(&file, 1.0).unwrap_or_else(|error| panic!("{name}: {error}"));
        assert_eq!(mesh.nodes_mm.len(), 5, "{name}");
        assert_eq!(mesh.tets.len(), 2, "{name}");
        assert!((0..2).all(|tet| mesh.tet_volume_mm3(tet) > 0.0), "{name}");
        // A sixth and a third of their box of 2 × 2 × 3 mm.
        assert!(
            (mesh.volume_mm3() - 6.0).abs() < 1e-12,
            "{name}: {}",
            mesh.volume_mm3()
        );
        let heights = |set: &[u32]| {
            set.iter()
                .map(|&node| mesh.nodes_mm[node as usize].z)
                .collect::<Vec<_>>()
        };
        assert_eq!(heights(&mesh.sets.bonded), [0.0; 3], "{name}");
        assert_eq!(heights(&mesh.sets.free), [3.0; 2], "{name}");
    }
}

#[test]
fn a_written_mesh_comes_back_bit_for_bit() {
    let mut mesh = gmsh::read(&version_4(Encoding::Text), 1.0).unwrap();
    mesh.nodes_mm[0].x = -1.0 / 3.0 * 1e-7;
    // A node high above the board, on an inclusion.
    let freed = mesh.sets.free.remove(0);
    mesh.sets.bonded.push(freed);
    mesh.sets.bonded.sort_unstable();
    mesh.sets.top.retain(|&node| node != freed);
    assert_eq!(gmsh::read(gmsh::write(&mesh).as_bytes(), 1.0).unwrap(), mesh);
}

/// Changes a text file, and returns the message of the error.
fn refusal(from: &str, to: &str) -> String {
    let text = String::from_utf8(version_2(Encoding::Text)).unwrap();
    assert!(text.contains(from), "{from} is not in the file");
    gmsh::read(text.replacen(from, to, 1).as_bytes(), 1.0)
        .unwrap_err()
        .to_string()
}

#[test]
fn damage_is_named_with_its_place() {
    assert_eq!(
        refusal("2.2 0", "3.0 0"),
        "mesh file, line 2: expected version 2.2 or 4.1, found 3"
    );
    assert_eq!(
        refusal("$Nodes\n6", "$Nodes\n4000000000000000000"),
        "mesh file, line 8: expected the number of nodes, found 4000000000000000000, more than the rest of the file can hold"
    );
    assert_eq!(
        refusal("0 0 3 ", "0 NaN 3 "),
        "mesh file, line 9: expected a coordinate within ±1e6, found NaN"
    );
    assert_eq!(
        refusal("7 12 5 9", "7 12 5 8"),
        "mesh file, line 13: expected nodes of the file, found the tag 8, which no node has"
    );
    assert_eq!(
        refusal("30 0 0 0", "7 0 0 0"),
        "mesh file, line 9: expected every node once, found node 7 again"
    );
    assert_eq!(
        refusal("$EndElements", "$EndElement"),
        "mesh file, line 14: expected `$EndElements`, found `$EndElement`"
    );
    assert!(refusal("30 7 12 5", "30 7 12 7").starts_with("tetrahedron 0 at "));
    assert!(matches!(gmsh::read(b"", 1.0), Err(MeshError::File { .. })));
    assert!(matches!(
        gmsh::read(b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n", 1.0),
        Err(MeshError::Empty { .. })
    ));
}

/// A text file of these nodes, numbered from 1, and elements: type, entity, nodes.
fn file_of(nodes: &[[f64; 3]], elements: &[(i64, i64, &[usize])]) -> String {
    let mut text = format!("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n{}\n", nodes.len());
    for (index, [x, y, z]) in nodes.iter().enumerate() {
        text += &format!("{} {x} {y} {z}\n", index + 1);
    }
    text += &format!("$EndNodes\n$Elements\n{}\n", elements.len());
    for (index, (kind, entity, nodes)) in elements.iter().enumerate() {
        let nodes: Vec<String> = nodes.iter().map(usize::to_string).collect();
        text += &format!("{} {kind} 2 1 {entity} {}\n", index + 1, nodes.join(" "));
    }
    text + "$EndElements\n"
}

/// A box of five tetrahedra with its lowest corner at `low`: nodes, and tetrahedra given by node
/// numbers that start at `first`.
fn box_of(low: [f64; 3], size: [f64; 3], first: usize) -> (Vec<[f64; 3]>, Vec<Vec<usize>>) {
    let corner = |bits: usize| [0, 1, 2].map(|axis| low[axis] + size[axis] * (bits >> axis & 1) as f64);
    let tets = [
        [0, 1, 2, 4],
        [3, 1, 2, 7],
        [5, 1, 4, 7],
        [6, 2, 4, 7],
        [1, 2, 4, 7],
    ];
    let numbered = tets.map(|tet| tet.map(|corner| first + corner).to_vec());
    ((0..8).map(corner).collect(), numbered.to_vec())
}

fn read_text(nodes: &[[f64; 3]], tets: &[Vec<usize>], mm_per_unit: f64) -> Result<TetMesh, MeshError> {
    let elements: Vec<(i64, i64, &[usize])> = tets.iter().map(|tet| (4, 1, &tet[..])).collect();
    gmsh::read(file_of(nodes, &elements).as_bytes(), mm_per_unit)
}

#[test]
fn an_element_of_two_physical_groups_counts_once() {
    let (nodes, tets) = box_of([0.0; 3], [4.0, 3.0, 3.0], 1);
    let once = read_text(&nodes, &tets, 1.0).unwrap();
    let mut turned = tets.clone();
    turned.iter_mut().for_each(|tet| tet.swap(0, 3));
    let twice = read_text(&nodes, &[tets.clone(), turned, tets].concat(), 1.0).unwrap();
    assert_eq!(twice, once);
    assert!((twice.volume_mm3() - 36.0).abs() < 1e-12);
    assert_eq!(twice.boundary_triangles().len(), 12);
}

#[test]
fn other_solids_are_named_with_their_entity() {
    let (nodes, tets) = box_of([0.0; 3], [4.0, 3.0, 3.0], 1);
    let hexahedron = [1, 2, 4, 3, 5, 6, 8, 7];
    for (kind, n_nodes, name) in [(5, 8, "a hexahedron"), (6, 6, "a prism"), (7, 5, "a pyramid")] {
        let elements: Vec<(i64, i64, &[usize])> = vec![(4, 1, &tets[0]), (kind, 17, &hexahedron[..n_nodes])];
        let error = gmsh::read(file_of(&nodes, &elements).as_bytes(), 1.0).unwrap_err();
        let expected = format!(
            "line 18: expected tetrahedra as the only solid elements, found {name} (kind {kind}) in entity 17"
        );
        assert!(error.to_string().contains(&expected), "{error}");
    }
    // The same in version 4.1, in which elements are listed in blocks.
    let mut file = Writer::new("4.1", Encoding::Text);
    file.text("$Nodes\n1 8 1 8\n3 9 0 8\n1 2 3 4 5 6 7 8\n");
    nodes.iter().for_each(|node| file.reals(node));
    file.text("\n$EndNodes\n$Elements\n1 1 1 1\n3 9 5 1\n1 1 2 4 3 5 6 8 7\n$EndElements\n");
    let error = gmsh::read(&file.0, 1.0).unwrap_err().to_string();
    assert!(
        error.contains("found a hexahedron (kind 5) in entity 9"),
        "{error}"
    );
    // Faces, lines and points are not part of the mesh.
    let mut elements: Vec<(i64, i64, &[usize])> = vec![
        (2, 1, &[1, 2, 3]),
        (1, 1, &[1, 2]),
        (15, 1, &[1]),
        (3, 1, &[1, 2, 4, 3]),
    ];
    elements.extend(tets.iter().map(|tet| (4, 1, &tet[..])));
    let mesh = gmsh::read(file_of(&nodes, &elements).as_bytes(), 1.0).unwrap();
    assert_eq!(mesh, read_text(&nodes, &tets, 1.0).unwrap());
}

#[test]
fn bodies_have_to_be_one_mesh() {
    let (nodes, tets) = box_of([0.0; 3], [4.0, 3.0, 3.0], 1);
    let with = |low: [f64; 3], size: [f64; 3]| {
        let (more, tets_more) = box_of(low, size, 9);
        read_text(
            &[&nodes[..], &more].concat(),
            &[&tets[..], &tets_more].concat(),
            1.0,
        )
    };
    assert!(
        (with([5.0, 0.0, 0.0], [1.0; 3]).unwrap().volume_mm3() - 37.0).abs() < 1e-12,
        "apart"
    );
    let unmerged = with([4.0, 0.0, 0.0], [4.0, 3.0, 3.0]).unwrap_err();
    assert!(
        matches!(unmerged, MeshError::NodesTwice { tags: [2, 9], .. }),
        "{unmerged}"
    );
    assert!(unmerged.to_string().contains("Coherence Mesh;"), "{unmerged}");
    for (name, low, size) in [
        ("overlap", [2.0, 1.0, 1.0], [4.0; 3]),
        ("in the same planes", [2.0, 0.0, 0.0], [4.0, 3.0, 3.0]),
        ("within", [1.0, 1.0, 1.0], [1.0; 3]),
        ("touch", [4.0, 1.0, 1.0], [1.0; 3]),
    ] {
        let error = with(low, size).unwrap_err();
        assert!(
            matches!(error, MeshError::Overlap { .. } | MeshError::NodesTwice { .. }),
            "{name}: {error}"
        );
    }
    // Two tetrahedra on the same side of their common face.
    let nodes = [
        [0.0, 0.0, 0.0],
        [3.0, 0.0, 0.0],
        [0.0, 3.0, 0.0],
        [1.0, 1.0, 2.0],
        [1.0, 1.0, 3.0],
    ];
    let folded = read_text(&nodes, &[vec![1, 2, 3, 4], vec![1, 2, 3, 5]], 1.0).unwrap_err();
    assert!(matches!(folded, MeshError::Overlap { .. }), "{folded}");
}

#[test]
fn a_mesh_in_metres_is_noticed_and_read_as_such() {
    let (nodes, tets) = box_of([0.0; 3], [0.004, 0.003, 0.003], 1);
    let error = read_text(&nodes, &tets, 1.0).unwrap_err().to_string();
    assert!(
        error.contains("the mesh is 0.004 × 0.003 × 0.003 mm large"),
        "{error}"
    );
    assert!(error.contains("`unit = \"m\"`"), "{error}");
    assert!((read_text(&nodes, &tets, 1e3).unwrap().volume_mm3() - 36.0).abs() < 1e-9);
    let (nodes, tets) = box_of([0.0; 3], [4e4, 3e4, 3e4], 1);
    assert!(matches!(read_text(&nodes, &tets, 1.0), Err(MeshError::Extent(_))));
    let (nodes, tets) = box_of([5e5, 0.0, 0.0], [4.0, 3.0, 3.0], 1);
    assert!(matches!(read_text(&nodes, &tets, 1.0), Err(MeshError::Extent(_))));
}

fn assert_sound(mesh: &TetMesh) {
    let n_nodes = mesh.nodes_mm.len() as u32;
    assert!(mesh.tets.iter().flatten().all(|&node| node < n_nodes));
    assert!(mesh.nodes_mm.iter().all(|node| node.is_finite()));
    assert!((0..mesh.tets.len()).all(|tet| mesh.tet_volume_mm3(tet) > 0.0));
}

proptest! {
    #![proptest_config(ProptestConfig { failure_persistence: None, ..ProptestConfig::with_cases(512) })]

    #[test]
    fn cut_files_are_refused(which in 0..6_usize, share in 0.0..1.0) {
        let (name, file) = all_files().swap_remove(which);
        let end = file.windows(12).position(|w| w == b"$EndElements").unwrap();
        let cut = (share * (end + 11) as f64) as usize;
        prop_assert!(gmsh::read(&file[..cut], 1.0).is_err(), "{} cut to {}", name, cut);
    }

    #[test]
    fn flipped_bytes_never_panic_and_never_give_an_unsound_mesh(
        which in 0..6_usize,
        flips in prop::collection::vec((0.0..1.0, any::<u8>()), 1..6),
    ) {
        let (_, mut file) = all_files().swap_remove(which);
        for (share, byte) in flips {
            let at = (share * file.len() as f64) as usize;
            file[at] = byte;
        }
        if let Ok(mesh) = gmsh::read(&file, 1.0) {
            assert_sound(&mesh);
        }
    }

    #[test]
    fn any_bytes_are_survived(mut tail in prop::collection::vec(any::<u8>(), 0..200), binary in any::<bool>(), four in any::<bool>()) {
        let mut file = Writer::new(if four { "4.1" } else { "2.2" }, if binary { Encoding::Little } else { Encoding::Text });
        file.text("$Nodes\n");
        file.0.append(&mut tail);
        prop_assert!(gmsh::read(&file.0, 1.0).is_err());
    }
}
