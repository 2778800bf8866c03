//! Gmsh files: every version and encoding, and damage of every kind.

#![allow(clippy::unwrap_used)]

use proptest::prelude::*;
use twintac_mesh::{MeshError, TetMesh, gmsh};

/// A numbers' encoding to write a test file in.
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
        let mesh = gmsh::read(&file).unwrap_or_else(|error| panic!("{name}: {error}"));
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
    let mut mesh = gmsh::read(&version_4(Encoding::Text)).unwrap();
    mesh.nodes_mm[0].x = -1.0 / 3.0 * 1e-7;
    // A node high above the board, on an inclusion.
    let freed = mesh.sets.free.remove(0);
    mesh.sets.bonded.push(freed);
    mesh.sets.bonded.sort_unstable();
    mesh.sets.top.retain(|&node| node != freed);
    assert_eq!(gmsh::read(gmsh::write(&mesh).as_bytes()).unwrap(), mesh);
}

/// Changes a text file and returns the message that it is refused with.
fn refusal(from: &str, to: &str) -> String {
    let text = String::from_utf8(version_2(Encoding::Text)).unwrap();
    assert!(text.contains(from), "{from} is not in the file");
    gmsh::read(text.replacen(from, to, 1).as_bytes())
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
        "mesh file, line 9: expected a coordinate within ±1e6 mm, found NaN"
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
    assert!(matches!(gmsh::read(b""), Err(MeshError::File { .. })));
    assert!(matches!(
        gmsh::read(b"$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"),
        Err(MeshError::Empty { .. })
    ));
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
        prop_assert!(gmsh::read(&file[..cut]).is_err(), "{} cut to {}", name, cut);
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
        if let Ok(mesh) = gmsh::read(&file) {
            assert_sound(&mesh);
        }
    }

    #[test]
    fn any_bytes_are_survived(mut tail in prop::collection::vec(any::<u8>(), 0..200), binary in any::<bool>(), four in any::<bool>()) {
        let mut file = Writer::new(if four { "4.1" } else { "2.2" }, if binary { Encoding::Little } else { Encoding::Text });
        file.text("$Nodes\n");
        file.0.append(&mut tail);
        prop_assert!(gmsh::read(&file.0).is_err());
    }
}
