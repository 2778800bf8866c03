//! VTK unstructured grids (`.vtu`), for ParaView and similar programs.

use std::fmt::Write;

use glam::DVec3;

use crate::{MeshError, TetMesh};

/// A named field over the nodes or the tetrahedra. Its name should include the unit.
#[derive(Clone, Copy, Debug)]
pub struct Field<'a> {
    /// Name, as shown by ParaView.
    pub name: &'a str,
    /// One value for each node or tetrahedron.
    pub values: Values<'a>,
}

/// Values of a field.
#[derive(Clone, Copy, Debug)]
pub enum Values<'a> {
    /// A number for each.
    Scalar(&'a [f64]),
    /// A vector for each.
    Vector(&'a [DVec3]),
}

/// VTK's cell type of a tetrahedron with 4 nodes.
const VTK_TETRA: &str = "10";

/// The mesh and its fields as an XML text file (VTK file formats, "UnstructuredGrid"). Coordinates
/// are in mm.
///
/// # Errors
/// A field whose number of values is not that of the nodes or tetrahedra, or with a value that is
/// not finite.
pub fn write(mesh: &TetMesh, node_fields: &[Field], tet_fields: &[Field]) -> Result<String, MeshError> {
    let (n_nodes, n_tets) = (mesh.nodes_mm.len(), mesh.tets.len());
    for (fields, expected) in [(node_fields, n_nodes), (tet_fields, n_tets)] {
        fields.iter().try_for_each(|field| field.check(expected))?;
    }
    let mut text = String::new();
    // Writing to a string cannot fail.
    let _ = write_to(&mut text, mesh, node_fields, tet_fields);
    Ok(text)
}

fn write_to(
    text: &mut String,
    mesh: &TetMesh,
    node_fields: &[Field],
    tet_fields: &[Field],
) -> std::fmt::Result {
    writeln!(text, "<?xml version=\"1.0\"?>")?;
    writeln!(
        text,
        "<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"LittleEndian\">"
    )?;
    writeln!(text, "<UnstructuredGrid>")?;
    writeln!(
        text,
        "<Piece NumberOfPoints=\"{}\" NumberOfCells=\"{}\">",
        mesh.nodes_mm.len(),
        mesh.tets.len()
    )?;
    writeln!(text, "<Points>")?;
    Field {
        name: "Points",
        values: Values::Vector(&mesh.nodes_mm),
    }
    .write_to(text)?;
    writeln!(text, "</Points>\n<Cells>")?;
    let whole = |text: &mut String, kind: &str, name: &str, lines: &mut dyn Iterator<Item = String>| {
        writeln!(
            text,
            "<DataArray type=\"{kind}\" Name=\"{name}\" format=\"ascii\">"
        )?;
        for line in lines {
            writeln!(text, "{line}")?;
        }
        writeln!(text, "</DataArray>")
    };
    let corners = |[a, b, c, d]: &[u32; 4]| format!("{a} {b} {c} {d}");
    whole(text, "Int64", "connectivity", &mut mesh.tets.iter().map(corners))?;
    whole(
        text,
        "Int64",
        "offsets",
        &mut (1..=mesh.tets.len()).map(|tet| (4 * tet).to_string()),
    )?;
    whole(
        text,
        "UInt8",
        "types",
        &mut mesh.tets.iter().map(|_| VTK_TETRA.to_owned()),
    )?;
    writeln!(text, "</Cells>")?;
    for (section, fields) in [("PointData", node_fields), ("CellData", tet_fields)] {
        writeln!(text, "<{section}>")?;
        fields.iter().try_for_each(|field| field.write_to(text))?;
        writeln!(text, "</{section}>")?;
    }
    writeln!(text, "</Piece>\n</UnstructuredGrid>\n</VTKFile>")
}

impl Field<'_> {
    fn check(&self, expected: usize) -> Result<(), MeshError> {
        let (found, finite) = match self.values {
            Values::Scalar(values) => (values.len(), values.iter().all(|value| value.is_finite())),
            Values::Vector(values) => (values.len(), values.iter().all(|value| value.is_finite())),
        };
        if found == expected && finite {
            return Ok(());
        }
        let found = if finite {
            found.to_string()
        } else {
            "some that are not".to_owned()
        };
        Err(MeshError::Field {
            name: self.name.to_owned(),
            expected,
            found,
        })
    }

    fn write_to(&self, text: &mut String) -> std::fmt::Result {
        let n_components = if matches!(self.values, Values::Vector(_)) {
            3
        } else {
            1
        };
        let name = escaped(self.name);
        writeln!(
            text,
            "<DataArray type=\"Float64\" Name=\"{name}\" NumberOfComponents=\"{n_components}\" format=\"ascii\">"
        )?;
        match self.values {
            Values::Scalar(values) => values.iter().try_for_each(|value| writeln!(text, "{value}"))?,
            Values::Vector(values) => values
                .iter()
                .try_for_each(|v| writeln!(text, "{} {} {}", v.x, v.y, v.z))?,
        }
        writeln!(text, "</DataArray>")
    }
}

fn escaped(name: &str) -> String {
    name.replace('&', "&amp;")
        .replace('<', "&lt;")
        .replace('>', "&gt;")
        .replace('"', "&quot;")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn one_tet() -> TetMesh {
        TetMesh {
            nodes_mm: vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.0, 0.25, 1.5)],
            tets: vec![[0, 1, 2, 3]],
            ..TetMesh::default()
        }
    }

    #[test]
    fn writes_this_file() {
        let pressure = Field {
            name: "pressure < \"kPa\"",
            values: Values::Scalar(&[1.0, -2.5, 0.0, 1e-3]),
        };
        let force = Field {
            name: "axis",
            values: Values::Vector(&[DVec3::Z]),
        };
        let expected = r#"<?xml version="1.0"?>
<VTKFile type="UnstructuredGrid" version="1.0" byte_order="LittleEndian">
<UnstructuredGrid>
<Piece NumberOfPoints="4" NumberOfCells="1">
<Points>
<DataArray type="Float64" Name="Points" NumberOfComponents="3" format="ascii">
0 0 0
1 0 0
0 1 0
0 0.25 1.5
</DataArray>
</Points>
<Cells>
<DataArray type="Int64" Name="connectivity" format="ascii">
0 1 2 3
</DataArray>
<DataArray type="Int64" Name="offsets" format="ascii">
4
</DataArray>
<DataArray type="UInt8" Name="types" format="ascii">
10
</DataArray>
</Cells>
<PointData>
<DataArray type="Float64" Name="pressure &lt; &quot;kPa&quot;" NumberOfComponents="1" format="ascii">
1
-2.5
0
0.001
</DataArray>
</PointData>
<CellData>
<DataArray type="Float64" Name="axis" NumberOfComponents="3" format="ascii">
0 0 1
</DataArray>
</CellData>
</Piece>
</UnstructuredGrid>
</VTKFile>
"#;
        assert_eq!(write(&one_tet(), &[pressure], &[force]).unwrap(), expected);
    }

    #[test]
    fn refuses_fields_that_do_not_fit() {
        for values in [&[1.0][..], &[1.0, f64::NAN, 1.0, 1.0]] {
            let field = Field {
                name: "p",
                values: Values::Scalar(values),
            };
            assert!(matches!(
                write(&one_tet(), &[field], &[]),
                Err(MeshError::Field { expected: 4, .. })
            ));
        }
    }
}
