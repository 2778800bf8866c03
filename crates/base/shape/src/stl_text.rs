//! STL files in text form.
//!
//! Words may be in upper or lower case, and line ends may be those of any operating system. The
//! names of solids may be in any encoding, because they are not read.

use glam::DVec3;

use crate::surface_error::SurfaceError;

/// The byte order mark with which some editors begin a text in UTF-8.
const BYTE_ORDER_MARK: &[u8] = b"\xef\xbb\xbf";
/// First bytes of comment lines.
const COMMENTS: [&[u8]; 4] = [b"#", b"//", b";", b"!"];
/// A text file begins with a solid or a facet within this number of lines, after comments.
const HEAD_LINES: usize = 200;
/// Largest number of characters of a wrong word that an error shows.
const SHOWN: usize = 40;

/// Whether bytes that are not a complete binary file are a text file.
pub(crate) fn is_text(bytes: &[u8]) -> bool {
    let starts = |line: &[u8]| {
        let word = words(line).next().unwrap_or_default().to_ascii_lowercase();
        word == b"solid" || word == b"facet"
    };
    !bytes.contains(&0) && lines(bytes).take(HEAD_LINES).any(starts)
}

/// Corners of all triangles.
pub(crate) fn read(text: &[u8]) -> Result<Vec<[DVec3; 3]>, SurfaceError> {
    let mut triangles = Vec::new();
    let mut facet: Option<Vec<DVec3>> = None;
    let mut n_lines = 0;
    for line in lines(text) {
        n_lines += 1;
        let error = |problem: String| SurfaceError::Text {
            line: n_lines,
            problem,
        };
        let mut words = words(line);
        while let Some(word) = words.next() {
            match word.to_ascii_lowercase().as_slice() {
                // A name or a comment follows.
                b"solid" | b"endsolid" => break,
                _ if COMMENTS.iter().any(|comment| word.starts_with(comment)) => break,
                b"facet" => {
                    if facet.replace(Vec::new()).is_some() {
                        return Err(error("the previous facet has no `endfacet`".to_owned()));
                    }
                }
                b"normal" => {
                    words.nth(2);
                }
                b"outer" | b"loop" | b"endloop" => {}
                b"vertex" => {
                    let corner = vertex(&mut words).map_err(error)?;
                    let corners = facet.as_mut();
                    let corners =
                        corners.ok_or_else(|| error("a vertex is outside of a facet".to_owned()))?;
                    corners.push(corner);
                }
                b"endfacet" => {
                    let corners = facet.take().unwrap_or_default();
                    let three = corners[..]
                        .try_into()
                        .map_err(|_| error(format!("a facet needs three vertices, not {}", corners.len())))?;
                    triangles.push(three);
                }
                _ => return Err(error(format!("{} is not expected in an STL file", shown(word)))),
            }
        }
    }
    if facet.is_some() {
        return Err(SurfaceError::Text {
            line: n_lines,
            problem: "the text ends within a facet".to_owned(),
        });
    }
    Ok(triangles)
}

fn vertex<'a>(words: &mut impl Iterator<Item = &'a [u8]>) -> Result<DVec3, String> {
    let mut coordinates = [0.0; 3];
    for coordinate in &mut coordinates {
        let word = words.next().ok_or("a vertex needs three numbers")?;
        let number = std::str::from_utf8(word).ok().and_then(|word| word.parse().ok());
        *coordinate = number.ok_or_else(|| format!("a vertex needs three numbers, not {}", shown(word)))?;
    }
    Ok(DVec3::from_array(coordinates))
}

/// Lines that end with a line feed, a carriage return, or both.
fn lines(text: &[u8]) -> impl Iterator<Item = &[u8]> {
    let text = text.strip_prefix(BYTE_ORDER_MARK).unwrap_or(text);
    let without_return = |line| <[u8]>::strip_suffix(line, b"\r").unwrap_or(line);
    let lines = text.split(|&byte| byte == b'\n').map(without_return);
    lines.flat_map(|line| line.split(|&byte| byte == b'\r'))
}

fn words(line: &[u8]) -> impl Iterator<Item = &[u8]> {
    let words = line.split(|byte| byte.is_ascii_whitespace());
    words.filter(|word| !word.is_empty())
}

fn shown(word: &[u8]) -> String {
    let word = String::from_utf8_lossy(&word[..word.len().min(SHOWN)]);
    format!("`{}`", word.escape_debug())
}
