//! Reads triangles from STL files, binary and text, as programs write them.

use glam::DVec3;

use crate::stl_text;
use crate::surface_error::SurfaceError;

/// Number of bytes before the triangles of a binary file: a comment of 80 bytes and the number of
/// triangles.
const HEADER_BYTES: usize = 84;
/// Number of bytes of a triangle in a binary file: normal, three corners, two unused bytes.
const TRIANGLE_BYTES: usize = 50;
/// First bytes of files of other formats.
const OTHER_FORMATS: [(&[u8], &str); 12] = [
    (b"\x1f\x8b", "a gzip file"),
    (b"PK\x03\x04", "a ZIP or 3MF file"),
    (b"\xff\xfe", "a text in UTF-16"),
    (b"\xfe\xff", "a text in UTF-16"),
    (b"ply", "a PLY file"),
    (b"OFF", "an OFF file"),
    (b"ISO-10303-21", "a STEP file"),
    (b"glTF", "a glTF file"),
    (b"$MeshFormat", "a Gmsh file"),
    (b"<", "an XML file"),
    (b"mtllib", "an OBJ file"),
    (b"v ", "an OBJ file"),
];

/// Corners of all triangles in the unit of the file, which an STL file does not state. The normals
/// of the file are not used.
///
/// A file that is long enough for the number of triangles in its header is a binary one, whatever
/// it begins with and whatever follows the last triangle.
pub(crate) fn read(bytes: &[u8]) -> Result<Vec<[DVec3; 3]>, SurfaceError> {
    let count = bytes
        .get(80..HEADER_BYTES)
        .and_then(|count| count.try_into().ok())
        .map(u32::from_le_bytes);
    let expected_bytes = count.map_or(HEADER_BYTES, |count| {
        HEADER_BYTES + TRIANGLE_BYTES * count as usize
    });
    let triangles = if count.is_some() && bytes.len() >= expected_bytes {
        bytes[HEADER_BYTES..expected_bytes]
            .chunks_exact(TRIANGLE_BYTES)
            .map(binary_triangle)
            .collect()
    } else if stl_text::is_text(bytes) {
        stl_text::read(bytes)?
    } else if let Some(found) = other_format(bytes) {
        return Err(SurfaceError::Format { found });
    } else {
        return Err(SurfaceError::Length {
            expected_bytes,
            found_bytes: bytes.len(),
        });
    };
    match triangles
        .iter()
        .position(|corners| !corners.iter().all(|corner| corner.is_finite()))
    {
        Some(triangle) => Err(SurfaceError::NotFinite { triangle }),
        None => Ok(triangles),
    }
}

fn other_format(bytes: &[u8]) -> Option<&'static str> {
    if bytes.trim_ascii().is_empty() {
        return Some("empty");
    }
    // OBJ files can begin with comments.
    let mut lines = bytes.split(|&byte| byte == b'\n').take(100);
    let first = lines.find(|line| !line.trim_ascii().is_empty() && !line.starts_with(b"#"))?;
    let known = OTHER_FORMATS.iter().find(|(start, _)| first.starts_with(start));
    known.map(|&(_, name)| name)
}

fn binary_triangle(record: &[u8]) -> [DVec3; 3] {
    let number = |index: usize| {
        let start = 12 + 4 * index;
        f64::from(f32::from_le_bytes([
            record[start],
            record[start + 1],
            record[start + 2],
            record[start + 3],
        ]))
    };
    [0, 3, 6].map(|first| DVec3::new(number(first), number(first + 1), number(first + 2)))
}
