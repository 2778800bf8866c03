//! Bodies of parts, for pictures and for the solid of the whole board: boxes as STEP files (ISO
//! 10303-21, protocol 214).

use std::collections::BTreeMap;
use std::fmt::Write as _;

use glam::DVec3;

use crate::design::Design;
use crate::land::Land;

/// A body for each land pattern that has a part, by file name.
pub(super) fn models(board: &Design) -> BTreeMap<String, String> {
    let lands = board.circuit.parts.iter().map(|part| &part.device.land);
    let with_body = lands.filter(|land| land.height_mm > 0.0);
    with_body
        .map(|land| (format!("{}.step", land.name), box_of(land)))
        .collect()
}

/// Colour of a body: red, green, blue.
fn color(land: &Land) -> [f64; 3] {
    match land.name {
        name if name.starts_with("C_") => [0.62, 0.50, 0.35],
        name if name.starts_with("JST") => [0.88, 0.86, 0.78],
        name if name.starts_with("TE_") => [0.70, 0.71, 0.73],
        _ => [0.12, 0.12, 0.13],
    }
}

fn box_of(land: &Land) -> String {
    // Footprints have y down, solids have y up.
    let low = DVec3::new(land.body.min.x, -land.body.max.y, 0.0);
    let high = DVec3::new(land.body.max.x, -land.body.min.y, land.height_mm);
    let mut step = Step::default();
    let context = step.context();
    let solid = step.solid(low, high);
    step.product(land.name, solid, context);
    step.paint(color(land), solid, context);
    format!(
        "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\n\
         FILE_NAME('{}','1980-01-01T00:00:00',(''),(''),'','twintac','');\n\
         FILE_SCHEMA(('AUTOMOTIVE_DESIGN {{ 1 0 10303 214 1 1 1 1 }}'));\n\
         ENDSEC;\nDATA;\n{}ENDSEC;\nEND-ISO-10303-21;\n",
        land.name, step.text
    )
}

/// The corners of each face of a box, counter-clockwise from outside. The bits of a corner's number
/// say whether x, y and z are at the high end.
const FACES: [[usize; 4]; 6] = [
    [0, 2, 3, 1],
    [4, 5, 7, 6],
    [0, 1, 5, 4],
    [2, 6, 7, 3],
    [0, 4, 6, 2],
    [1, 3, 7, 5],
];

/// STEP entities, numbered in their order.
#[derive(Default)]
struct Step {
    text: String,
    count: usize,
}

impl Step {
    fn add(&mut self, entity: &str) -> usize {
        self.count += 1;
        let _ = writeln!(self.text, "#{}={entity};", self.count);
        self.count
    }

    fn triple(&mut self, kind: &str, value: DVec3) -> usize {
        let number = |value: f64| format!("{:?}", (value * 1e6).round() / 1e6 + 0.0);
        let values = [value.x, value.y, value.z].map(number).join(",");
        self.add(&format!("{kind}('',({values}))"))
    }

    fn placement(&mut self, at: DVec3, axis: DVec3, along: DVec3) -> usize {
        let at = self.triple("CARTESIAN_POINT", at);
        let axis = self.triple("DIRECTION", axis);
        let along = self.triple("DIRECTION", along);
        self.add(&format!("AXIS2_PLACEMENT_3D('',#{at},#{axis},#{along})"))
    }

    /// The units: millimetres and radians.
    fn context(&mut self) -> usize {
        let length = self.add("(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.))");
        let angle = self.add("(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.))");
        let solid_angle = self.add("(NAMED_UNIT(*)SI_UNIT($,.STERADIAN.)SOLID_ANGLE_UNIT())");
        let accuracy = self.add(&format!(
            "UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-7),#{length},'distance_accuracy_value','')"
        ));
        self.add(&format!(
            "(GEOMETRIC_REPRESENTATION_CONTEXT(3)\
             GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#{accuracy}))\
             GLOBAL_UNIT_ASSIGNED_CONTEXT((#{length},#{angle},#{solid_angle}))\
             REPRESENTATION_CONTEXT('',''))"
        ))
    }

    fn solid(&mut self, low: DVec3, high: DVec3) -> usize {
        let corner = |bits: usize| {
            let pick = |axis: usize| {
                if bits >> axis & 1 == 1 {
                    high[axis]
                } else {
                    low[axis]
                }
            };
            DVec3::new(pick(0), pick(1), pick(2))
        };
        let vertices: Vec<usize> = (0..8)
            .map(|bits| {
                let at = self.triple("CARTESIAN_POINT", corner(bits));
                self.add(&format!("VERTEX_POINT('',#{at})"))
            })
            .collect();
        let mut edges: BTreeMap<(usize, usize), usize> = BTreeMap::new();
        let mut faces = Vec::new();
        for face in FACES {
            let mut sides = Vec::new();
            for (index, from) in face.into_iter().enumerate() {
                let to = face[(index + 1) % 4];
                let ends = (from.min(to), from.max(to));
                let edge = match edges.get(&ends) {
                    Some(edge) => *edge,
                    None => {
                        let edge =
                            self.edge(corner(ends.0), corner(ends.1), vertices[ends.0], vertices[ends.1]);
                        edges.insert(ends, edge);
                        edge
                    }
                };
                let sense = if from < to { ".T." } else { ".F." };
                sides.push(self.add(&format!("ORIENTED_EDGE('',*,*,#{edge},{sense})")));
            }
            let sides = listed(&sides);
            let side = self.add(&format!("EDGE_LOOP('',({sides}))"));
            let bound = self.add(&format!("FACE_OUTER_BOUND('',#{side},.T.)"));
            let along = (corner(face[1]) - corner(face[0])).normalize();
            let up = (corner(face[2]) - corner(face[1])).normalize();
            let plane = self.placement(corner(face[0]), along.cross(up), along);
            let plane = self.add(&format!("PLANE('',#{plane})"));
            faces.push(self.add(&format!("ADVANCED_FACE('',(#{bound}),#{plane},.T.)")));
        }
        let faces = listed(&faces);
        let shell = self.add(&format!("CLOSED_SHELL('',({faces}))"));
        self.add(&format!("MANIFOLD_SOLID_BREP('',#{shell})"))
    }

    fn edge(&mut self, from: DVec3, to: DVec3, first: usize, last: usize) -> usize {
        let at = self.triple("CARTESIAN_POINT", from);
        let along = self.triple("DIRECTION", (to - from).normalize());
        let along = self.add(&format!("VECTOR('',#{along},1.)"));
        let line = self.add(&format!("LINE('',#{at},#{along})"));
        self.add(&format!("EDGE_CURVE('',#{first},#{last},#{line},.T.)"))
    }

    fn product(&mut self, name: &str, solid: usize, context: usize) {
        let origin = self.placement(DVec3::ZERO, DVec3::Z, DVec3::X);
        let shape = self.add(&format!(
            "ADVANCED_BREP_SHAPE_REPRESENTATION('',(#{origin},#{solid}),#{context})"
        ));
        let application =
            self.add("APPLICATION_CONTEXT('core data for automotive mechanical design processes')");
        self.add(&format!(
            "APPLICATION_PROTOCOL_DEFINITION('international standard','automotive_design',2000,#{application})"
        ));
        let of_product = self.add(&format!("PRODUCT_CONTEXT('',#{application},'mechanical')"));
        let product = self.add(&format!("PRODUCT('{name}','{name}','',(#{of_product}))"));
        let formation = self.add(&format!("PRODUCT_DEFINITION_FORMATION('','',#{product})"));
        let stage = self.add(&format!(
            "PRODUCT_DEFINITION_CONTEXT('part definition',#{application},'design')"
        ));
        let definition = self.add(&format!("PRODUCT_DEFINITION('design','',#{formation},#{stage})"));
        let of_shape = self.add(&format!("PRODUCT_DEFINITION_SHAPE('','',#{definition})"));
        self.add(&format!("SHAPE_DEFINITION_REPRESENTATION(#{of_shape},#{shape})"));
    }

    fn paint(&mut self, color: [f64; 3], solid: usize, context: usize) {
        let [red, green, blue] = color;
        let color = self.add(&format!("COLOUR_RGB('',{red:?},{green:?},{blue:?})"));
        let area = self.add(&format!("FILL_AREA_STYLE_COLOUR('',#{color})"));
        let area = self.add(&format!("FILL_AREA_STYLE('',(#{area}))"));
        let area = self.add(&format!("SURFACE_STYLE_FILL_AREA(#{area})"));
        let side = self.add(&format!("SURFACE_SIDE_STYLE('',(#{area}))"));
        let usage = self.add(&format!("SURFACE_STYLE_USAGE(.BOTH.,#{side})"));
        let style = self.add(&format!("PRESENTATION_STYLE_ASSIGNMENT((#{usage}))"));
        let item = self.add(&format!("STYLED_ITEM('color',(#{style}),#{solid})"));
        self.add(&format!(
            "MECHANICAL_DESIGN_GEOMETRIC_PRESENTATION_REPRESENTATION('',(#{item}),#{context})"
        ));
    }
}

fn listed(entities: &[usize]) -> String {
    let all: Vec<String> = entities.iter().map(|entity| format!("#{entity}")).collect();
    all.join(",")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_edge_of_a_body_has_two_faces_that_run_along_it_in_opposite_ways() {
        let text = box_of(&crate::passive::capacitor_100n().land);
        let mut uses: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
        for line in text.lines().filter(|line| line.contains("ORIENTED_EDGE")) {
            let given: Vec<&str> = line.trim_end_matches(");").split(',').collect();
            uses.entry(given[3]).or_default().push(given[4]);
        }
        assert_eq!(uses.len(), 12);
        for senses in uses.values_mut() {
            senses.sort_unstable();
            assert_eq!(*senses, [".F.", ".T."]);
        }
        let named = |number: &str| text.contains(&format!("\n#{number}="));
        let all = text.split('#').skip(1);
        for reference in all.map(|rest| {
            rest.split(|c: char| !c.is_ascii_digit())
                .next()
                .unwrap_or_default()
        }) {
            assert!(named(reference), "#{reference} is nowhere");
        }
    }
}
