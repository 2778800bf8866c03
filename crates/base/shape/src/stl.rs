//! Triangles out of STL files, binary and ASCII.

use glam::DVec3;

use crate::surface_error::SurfaceError;

/// Bytes before the triangles of a binary file: a comment of 80 and their number.
const HEADER_BYTES: usize = 84;
/// Bytes of a triangle of a binary file: normal, three corners, two spare bytes.
const TRIANGLE_BYTES: usize = 50;

/// Corners of all triangles, mm (STL files carry no unit). The files' normals are not used.
pub(crate) fn read(bytes: &[u8]) -> Result<Vec<[DVec3; 3]>, SurfaceError> {
    let count = bytes
        .get(80..HEADER_BYTES)
        .and_then(|count| count.try_into().ok())
        .map(u32::from_le_bytes);
    let expected_bytes = count.map_or(HEADER_BYTES, |count| {
        HEADER_BYTES + TRIANGLE_BYTES * count as usize
    });
    // Some programs begin binary files with "solid" too: their length tells them apart.
    let is_text = bytes.trim_ascii_start().starts_with(b"solid");
    let triangles = if count.is_some() && bytes.len() == expected_bytes {
        bytes[HEADER_BYTES..]
            .chunks_exact(TRIANGLE_BYTES)
            .map(binary_triangle)
            .collect()
    } else if is_text && let Ok(text) = std::str::from_utf8(bytes) {
        ascii(text)?
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

fn ascii(text: &str) -> Result<Vec<[DVec3; 3]>, SurfaceError> {
    let mut triangles = Vec::new();
    let mut corners = Vec::new();
    let mut ended = false;
    for (index, line) in text.lines().enumerate() {
        let error = |problem: &str| SurfaceError::Text {
            line: index + 1,
            problem: problem.to_owned(),
        };
        let mut words = line.split_whitespace();
        match words.next().unwrap_or_default().to_ascii_lowercase().as_str() {
            "solid" => ended = false,
            "endsolid" => ended = true,
            "facet" => corners.clear(),
            "vertex" => {
                let numbers: Vec<f64> = words.map_while(|word| word.parse().ok()).collect();
                let [x, y, z] = numbers[..] else {
                    return Err(error("a vertex needs three numbers"));
                };
                corners.push(DVec3::new(x, y, z));
            }
            "endfacet" => {
                let three = corners[..]
                    .try_into()
                    .map_err(|_| error("a facet needs three vertices"))?;
                triangles.push(three);
            }
            "" | "outer" | "endloop" => {}
            other => return Err(error(&format!("`{other}` has no place in an STL file"))),
        }
    }
    if !ended {
        return Err(SurfaceError::Text {
            line: text.lines().count(),
            problem: "ends before `endsolid`".to_owned(),
        });
    }
    Ok(triangles)
}
