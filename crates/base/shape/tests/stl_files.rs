//! STL files as programs write them, and files that only look like STL files.

#![allow(clippy::unwrap_used)] // also in the helpers of tests

mod common;

use common::{ascii, binary, box_triangles, moved};
use glam::DVec3;
use twintac_shape::{LengthUnit, ShapeError, SurfaceError, SurfaceFile, TriangleSurface};

const HALF_MM: DVec3 = DVec3::new(5.0, 4.0, 3.0);

fn good() -> String {
    ascii(&box_triangles(HALF_MM))
}

fn read(bytes: &[u8]) -> Result<TriangleSurface, SurfaceError> {
    TriangleSurface::from_stl(bytes, 1.0)
}

fn assert_is_the_box(name: &str, bytes: &[u8]) {
    let surface = read(bytes).unwrap_or_else(|error| panic!("{name}: {error}"));
    assert!(
        (surface.volume_mm3() - 480.0).abs() < 0.01,
        "{name}: {}",
        surface.volume_mm3()
    );
    assert_eq!(
        (surface.vertices_mm().len(), surface.triangles().len()),
        (8, 12),
        "{name}"
    );
}

/// A text file whose solid has this name, in an arbitrary encoding.
fn named(name: &[u8]) -> Vec<u8> {
    let text = good();
    let facets = text
        .split_once('\n')
        .unwrap()
        .1
        .replace("endsolid a shape", "endsolid ");
    [
        b"solid ",
        name,
        b"\n",
        facets.trim_end().as_bytes(),
        b" ",
        name,
        b"\n",
    ]
    .concat()
}

#[test]
fn texts_are_read_as_programs_write_them() {
    let text = good();
    let files: Vec<(&str, Vec<u8>)> = vec![
        ("upper case", text.to_uppercase().into_bytes()),
        ("Latin-1", named(b"Pr\xfcfk\xf6rper")),
        ("GBK", named(b"\xc4\xa3\xd0\xcd")),
        ("keywords in a name", named(b"facet vertex 1 endfacet")),
        ("no name", text.replace(" a shape", "").into_bytes()),
        ("byte-order mark", [b"\xef\xbb\xbf", text.as_bytes()].concat()),
        (
            "comments",
            format!(
                "# by a program\n; and a line\n{}",
                text.replacen("facet", "// a note\nfacet", 1)
            )
            .into_bytes(),
        ),
        ("no endsolid", text.replace("endsolid a shape\n", "").into_bytes()),
        ("Windows", text.replace('\n', "\r\n").into_bytes()),
        ("old Macintosh", text.replace('\n', "\r").into_bytes()),
        (
            "mixed line ends",
            text.replacen('\n', "\r\n", 40)
                .replacen("\r\n", "\r", 9)
                .into_bytes(),
        ),
        (
            "one line",
            text.replacen('\n', " \n", 1)
                .replacen("facet", "\nfacet", 1)
                .into_bytes(),
        ),
        (
            "facets in one line each",
            text.replace("endfacet\n", "endfacet@")
                .replace("shape\n", "shape@")
                .replace('\n', " ")
                .replace('@', "\n")
                .into_bytes(),
        ),
        (
            "normals that are no numbers",
            text.replace("normal 0 0 0", "normal -nan(ind) nan 1.#QNAN")
                .into_bytes(),
        ),
        (
            "tabs and exponents",
            text.replace("vertex 5 ", "vertex\t+0.5E+01\t").into_bytes(),
        ),
        ("two solids in one file", {
            let cut = text.find("endfacet").unwrap() + "endfacet\n".len();
            [&text[..cut], "endsolid a shape\nsolid more\n", &text[cut..]]
                .concat()
                .into_bytes()
        }),
    ];
    for (name, bytes) in files {
        assert_is_the_box(name, &bytes);
    }
}

#[test]
fn binary_files_are_read_as_programs_write_them() {
    let bytes = binary(&box_triangles(HALF_MM));
    assert_is_the_box("a comment that begins with solid", &bytes);
    for n_more in [1, 2, 50, 1000] {
        assert_is_the_box(
            "bytes after the last triangle",
            &[&bytes[..], &vec![7; n_more]].concat(),
        );
    }
    let mut other = bytes.clone();
    other[..6].copy_from_slice(b"\x1f\x8bply ");
    assert_is_the_box("a header like that of another format", &other);
}

#[test]
fn what_is_no_stl_file_is_called_by_its_name() {
    let text = good();
    for (start, words) in [
        (&b""[..], "is empty, expected an STL file"),
        (b" \r\n\t\n", "is empty, expected an STL file"),
        (b"\x1f\x8b\x08\x00\x00\x00", "is a gzip file"),
        (b"PK\x03\x04\x14\x00", "is a ZIP or 3MF file"),
        (b"ply\nformat ascii 1.0\nelement vertex 8\n", "is a PLY file"),
        (
            b"# Blender\n\n# www\no Cube\nv 1 1 -1\n",
            "is not a complete STL file",
        ),
        (
            b"# Blender\nmtllib cube.mtl\no Cube\nv 1 1 -1\n",
            "is an OBJ file",
        ),
        (b"# OBJ\nv 1 1 -1\nv 1 2 3\nf 1 2 3\n", "is an OBJ file"),
        (b"OFF\n8 12 0\n", "is an OFF file"),
        (b"ISO-10303-21;\nHEADER;\n", "is a STEP file"),
        (b"<?xml version=\"1.0\"?>\n<amf>", "is an XML file"),
        (b"$MeshFormat\n4.1 0 8\n", "is a Gmsh file"),
        (b"\xff\xfes\x00o\x00l\x00i\x00d\x00", "is a text in UTF-16"),
        (b"solid", "has 0 triangles"),
        (b"SOLID nothing\nENDSOLID nothing\n", "has 0 triangles"),
        (&[0; 84], "has 0 triangles"),
        (&[0; 83], "is not a complete STL file: it has 83 bytes"),
        (&[0xff; 400], "a binary one would have 214748364834"),
        (
            b"solid a\nfacet normal 0 0 1\nouter loop\n",
            "line 4: the text ends within a facet",
        ),
        (
            b"solid a\nvertex 1 2 3\n",
            "line 2: a vertex is outside of a facet",
        ),
        (
            b"solid a\nfacet\nfacet\n",
            "line 3: the previous facet has no `endfacet`",
        ),
        (
            b"solid a\nfacet\nvertex 1 2 3\nvertex 1 2 4\nendfacet",
            "line 5: a facet needs three vertices, not 2",
        ),
        (&text.as_bytes()[..text.len() * 2 / 3], "line "),
    ] {
        let error = read(start).unwrap_err().to_string();
        assert!(
            error.contains(words),
            "{:?}: {error}",
            String::from_utf8_lossy(&start[..start.len().min(40)])
        );
    }
    for number in ["nan", "inf", "-1e999"] {
        let error = read(
            text.replacen("vertex 5", &format!("vertex {number}"), 1)
                .as_bytes(),
        );
        assert!(matches!(error, Err(SurfaceError::NotFinite { .. })), "{number}");
    }
    let mut bytes = binary(&box_triangles(HALF_MM));
    bytes[84 + 50 + 12..][..4].copy_from_slice(&f32::NAN.to_le_bytes());
    assert_eq!(read(&bytes).unwrap_err(), SurfaceError::NotFinite { triangle: 1 });
}

#[test]
fn a_size_or_place_that_is_not_in_mm_is_said_with_the_remedy() {
    let scaled = |scale: f64, by_mm: DVec3| {
        let triangles = moved(&box_triangles(HALF_MM * scale), by_mm);
        TriangleSurface::from_stl(ascii(&triangles).as_bytes(), 1.0)
    };
    for (scale, problem, remedy) in [
        (
            1e-3,
            "is 0.01 × 0.008 × 0.006 mm large, expected 0.1 to 1000 mm along each axis",
            "`unit = \"m\"` or `scale = 1000`",
        ),
        (1e-30, "mm large", "give the unit of its lengths"),
        (
            1e3,
            "is 10000 × 8000 × 6000 mm large",
            "if its lengths are in µm, give `scale = 0.001`",
        ),
        (
            1e20,
            "is 1.000e21 × 8.000e20 × 6.000e20 mm large",
            "give the unit",
        ),
    ] {
        let error = scaled(scale, DVec3::ZERO).unwrap_err();
        let (found, hint) = error.problem_and_remedy();
        assert!(
            found.contains(problem) && hint.contains(remedy),
            "{found}; {hint}"
        );
        assert_eq!(error.to_string(), format!("{found}; {hint}"));
    }
    let far = scaled(1.0, DVec3::X * 1e6).unwrap_err().problem_and_remedy();
    assert!(far.0.contains("expected within 1 m of its origin"), "{far:?}");
    // One axis is enough for an error: a plate of 200 mm, given in metres.
    let plate = ascii(&box_triangles(DVec3::new(0.1, 0.1, 0.002)));
    assert!(matches!(read(plate.as_bytes()), Err(SurfaceError::Extent(_))));
    let in_metres = ascii(&box_triangles(HALF_MM * 1e-3));
    let surface = TriangleSurface::from_stl(in_metres.as_bytes(), 1e3).unwrap();
    assert!((surface.volume_mm3() - 480.0).abs() < 1e-9);
}

#[test]
fn a_surface_has_a_unit_or_a_scale_and_a_name_by_it() {
    let file = |unit, scale| SurfaceFile {
        unit,
        scale,
        ..SurfaceFile::new("tip.stl")
    };
    for (name, unit) in LengthUnit::NAMED {
        assert_eq!(file(Some(unit), None).mm_per_unit(), unit.in_mm(), "{name}");
    }
    assert_eq!(
        LengthUnit::NAMED.map(|(_, unit)| unit.in_mm()),
        [1.0, 10.0, 1000.0, 25.4]
    );
    assert_eq!(file(None, Some(0.5)).mm_per_unit(), 0.5);
    assert_eq!(file(None, None).name(), "tip.stl");
    assert_eq!(
        file(Some(LengthUnit::Metre), None).name(),
        file(None, Some(1e3)).name()
    );
    assert_ne!(
        file(Some(LengthUnit::Metre), None).name(),
        file(None, None).name()
    );
    let field = |file: SurfaceFile| file.validate().map_err(|ShapeError { field, .. }| field);
    assert_eq!(
        field(file(Some(LengthUnit::Metre), Some(1e3))),
        Err("scale".to_owned())
    );
    for scale in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert_eq!(field(file(None, Some(scale))), Err("scale".to_owned()));
    }
    assert_eq!(field(file(Some(LengthUnit::Inch), None)), Ok(()));
}
