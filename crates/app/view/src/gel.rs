//! The gel that a client presses.

use std::collections::BTreeMap;
use std::sync::Arc;

use twintac_engine::{Array, Engine, Offer};

use crate::desk::Desk;
use crate::session::Session;

/// A session in which a client presses a gel of its own.
///
/// A request is the length of its JSON text (4 bytes, little-endian), that text, and the bytes of a
/// file to store or of a line. An answer is the length of its JSON text, that text, and each array
/// that has changed: its number, its number of entries, and the entries, 4 bytes each.
#[derive(Default)]
pub struct GelSession {
    engine: Engine,
    desk: Option<Arc<Desk>>,
    n_seen: u64,
}

/// The description that a session opens first.
#[derive(Clone, Debug)]
pub struct Begin {
    /// The name of its file.
    pub file: String,
    /// Its text.
    pub text: String,
    /// The surface files, by their names in the text.
    pub surfaces: BTreeMap<String, Arc<[u8]>>,
}

impl GelSession {
    /// A session with a first description and a connected sensor, if there are any.
    #[must_use]
    pub fn beside(desk: Option<Arc<Desk>>, begin: Option<&Begin>) -> Self {
        let mut session = Self::default();
        let surfaces = begin.iter().flat_map(|begin| &begin.surfaces);
        surfaces.for_each(|(name, bytes)| session.engine.keep(name, bytes));
        let sensor = begin.map(|begin| [begin.file.clone(), begin.text.clone()]);
        let provenance = desk.as_ref().map_or("", |desk| desk.provenance());
        let source = desk.as_ref().map(|desk| desk.source().to_owned());
        session.engine.set_offer(Offer { sensor, source }, provenance);
        session.desk = desk;
        session
    }
}

impl Session for GelSession {
    fn answer(&mut self, message: &[u8]) -> Vec<u8> {
        if let Some(desk) = &self.desk {
            let (frames, remarks) = desk.since(&mut self.n_seen);
            frames.into_iter().for_each(|frame| self.engine.take_frame(frame));
            self.engine.set_remarks(remarks);
        }
        let Some((request, bytes)) = split(message) else {
            return with_length(r#"{"error": "this is not a request: it is shorter than it says"}"#);
        };
        let text = String::from_utf8_lossy(request);
        let mut answer = with_length(&self.engine.answer(&text, bytes));
        let changed: Vec<Array> = self.engine.take_new().collect();
        for array in changed {
            let (indices, numbers) = (
                self.engine.arrays().indices(array),
                self.engine.arrays().numbers(array),
            );
            answer.extend((array as u32).to_le_bytes());
            answer.extend(((indices.len() + numbers.len()) as u32).to_le_bytes());
            answer.extend(indices.iter().flat_map(|index| index.to_le_bytes()));
            answer.extend(numbers.iter().flat_map(|number| number.to_le_bytes()));
        }
        answer
    }
}

/// The text of a request, and the bytes after it.
fn split(message: &[u8]) -> Option<(&[u8], &[u8])> {
    let (length, rest) = message.split_first_chunk::<4>()?;
    rest.split_at_checked(u32::from_le_bytes(*length) as usize)
}

fn with_length(text: &str) -> Vec<u8> {
    let mut message = (text.len() as u32).to_le_bytes().to_vec();
    message.extend(text.as_bytes());
    message
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;

    /// The answer to a request, and the numbers and lengths of its arrays.
    fn ask(gel: &mut GelSession, request: &Value) -> (Value, Vec<(u32, u32)>) {
        let answer = gel.answer(&with_length(&request.to_string()));
        let (text, mut rest) = split(&answer).unwrap();
        let mut arrays = Vec::new();
        while let Some((head, after)) = rest.split_first_chunk::<8>() {
            let [number, n] = [0, 4].map(|at| u32::from_le_bytes(head[at..at + 4].try_into().unwrap()));
            arrays.push((number, n));
            rest = &after[4 * n as usize..];
        }
        (serde_json::from_slice(text).unwrap(), arrays)
    }

    #[test]
    fn arrays_come_with_the_answer_that_changes_them() {
        let mut gel = GelSession::default();
        let phystac = include_str!("../../../../sensors/phystac.toml");
        let opened = json!({"do": "open", "file": "phystac.toml", "text": phystac});
        assert_eq!(ask(&mut gel, &opened).1, []);
        let prepare = json!({"do": "prepare", "indenter": "sphere-25", "depth_mm": 2.0, "max_nodes": 800});
        let (prepared, arrays) = ask(&mut gel, &prepare);
        let n_nodes = prepared["n_nodes"].as_u64().unwrap() as u32;
        assert!(
            arrays.contains(&(Array::RestMm as u32, 3 * n_nodes)),
            "{arrays:?}"
        );
        let at = prepared["touch_mm"].as_f64().unwrap() - 1.0;
        let pose = json!({"position_mm": [0.0, 0.0, at], "rotation": [0.0, 0.0, 0.0, 1.0]});
        let step = json!({"do": "step", "since_s": 0.02, "gel_from_indenter": pose});
        let (frame, arrays) = ask(&mut gel, &step);
        assert!(frame["force_n"][2].as_f64().unwrap() < -0.1, "{frame}");
        assert!(arrays.contains(&(Array::DisplacementsMm as u32, 3 * n_nodes)));
        assert!(
            !arrays.iter().any(|(number, _)| *number == Array::RestMm as u32),
            "did not change"
        );
    }

    #[test]
    fn a_gel_begins_with_a_description_and_its_surfaces_beside_a_sensor() {
        let phystac = include_str!("../../../../sensors/phystac.toml");
        let (before, _) = phystac.split_once("[[indenters]]").unwrap();
        let indenter = |name: &str, path: &str| {
            format!("[[indenters]]\nname = \"{name}\"\nshape = {{ kind = \"stl\", path = \"{path}\" }}\n")
        };
        let text = format!(
            "{before}{}{}",
            indenter("a", "a/tip.stl"),
            indenter("b", "b/tip.stl")
        );
        let surface = |size_mm: f64| {
            let corners = [
                [0.0, 0.0, 0.0],
                [size_mm, 0.0, 0.0],
                [0.0, size_mm, 0.0],
                [0.0, 0.0, size_mm],
            ];
            let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
            let facet = |face: [usize; 3]| {
                let vertex = |corner: usize| {
                    let [x, y, z] = corners[corner];
                    format!("vertex {x} {y} {z}\n")
                };
                let vertices = face.map(vertex).concat();
                format!("facet normal 0 0 0\nouter loop\n{vertices}endloop\nendfacet\n")
            };
            let text = format!("solid tip\n{}endsolid tip\n", faces.map(facet).concat());
            Arc::from(text.into_bytes())
        };
        let begin = Begin {
            file: "mine.toml".to_owned(),
            text: text.clone(),
            surfaces: [
                ("a/tip.stl".to_owned(), surface(4.0)),
                ("b/tip.stl".to_owned(), surface(8.0)),
            ]
            .into(),
        };
        let desk = Arc::new(Desk::new("the bench", "emulated"));
        let mut gel = GelSession::beside(Some(Arc::clone(&desk)), Some(&begin));
        let (offer, _) = ask(&mut gel, &json!({"do": "offer"}));
        assert_eq!(
            offer,
            json!({"sensor": ["mine.toml", text], "source": "the bench"})
        );
        let (opened, _) = ask(
            &mut gel,
            &json!({"do": "open", "file": "mine.toml", "text": text}),
        );
        assert_eq!(opened["indenters"].as_array().unwrap().len(), 2, "{opened}");
        let mut highest = |indenter: usize| {
            let shape = &opened["indenters"][indenter]["shape"];
            ask(&mut gel, &json!({"do": "outline", "shape": shape}));
            let corners = gel.engine.arrays().numbers(Array::OutlineMm);
            corners.iter().copied().fold(0.0, f32::max)
        };
        let [small, large] = [0, 1].map(&mut highest);
        assert!(
            (small - 4.0).abs() < 0.5 && (large - 8.0).abs() < 0.5,
            "{small} mm, {large} mm"
        );
        (0..33).for_each(|frame| desk.push(vec![Some(if frame < 32 { 100.0 } else { 103.0 }); 8]));
        let (heard, _) = ask(&mut gel, &json!({"do": "hear"}));
        assert_eq!(heard["pressure_kpa"][7], 3.0, "{heard}");
    }

    #[test]
    fn what_is_no_request_is_an_error_and_the_gel_stays() {
        let mut gel = GelSession::default();
        for message in [
            b"".as_slice(),
            b"\x01",
            b"\xff\xff\xff\xff{}",
            b"\0\0\0\0",
            b"\x02\0\0\0{}more",
            b"\x01\0\0\0\xff",
        ] {
            let answer = gel.answer(message);
            let (text, _) = split(&answer).unwrap();
            let answer: Value = serde_json::from_slice(text).unwrap();
            assert!(answer["error"].is_string(), "{message:?}: {answer}");
        }
    }
}
