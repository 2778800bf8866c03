//! Plates, walls, cavities and unions: gel does not slip through parts that are thinner than a
//! press is deep, or an error says so.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests

use std::sync::Arc;

use glam::{DQuat, DVec2, DVec3};
use twintac_depth_table::{DepthTable, PressFrame};
use twintac_sensor::Sensor;
use twintac_shape::{Part, Pose, Shape, SurfaceFile, TriangleSurface};
use twintac_simulate::{Gel, PressPlace, SimulateSettings};

type Triangles = Vec<[DVec3; 3]>;

/// Presses the middle of PhysTac's gel straight down.
fn press(gel: &Gel, shape: Shape, depth_mm: f64) -> DepthTable {
    let place = PressPlace {
        indenter: "body".into(),
        shape,
        x_mm: 0.0,
        y_mm: 0.0,
        rotation: DQuat::IDENTITY,
        depth_mm,
        enough_force_n: None,
    };
    let table = gel.depth_table(&place).unwrap();
    let mut last_n = 0.0;
    for frame in &table.frames {
        assert!(
            frame.force_n > last_n - 1e-3,
            "{} mm: {} N after {last_n} N",
            frame.depth_mm,
            frame.force_n
        );
        last_n = frame.force_n;
    }
    table
}

/// The force of a press that reaches its depth, N.
fn force_n(gel: &Gel, shape: Shape, depth_mm: f64) -> f64 {
    let table = press(gel, shape, depth_mm);
    assert_eq!(table.failure, None);
    table.frames.last().unwrap().force_n
}

fn gel(settings: SimulateSettings) -> Gel {
    gel_with(&[], settings)
}

/// A gel with a surface named `body.stl`.
fn gel_with(triangles: &[[DVec3; 3]], settings: SimulateSettings) -> Gel {
    let mut sensor = Sensor::read("../../../sensors/phystac.toml").unwrap();
    if !triangles.is_empty() {
        let surface = TriangleSurface::from_triangles(triangles).unwrap();
        sensor.surfaces.insert("body.stl".to_owned(), Arc::new(surface));
    }
    Gel::new(Arc::new(sensor), settings)
}

fn surface() -> Shape {
    Shape::Stl(SurfaceFile::new("body.stl"))
}

/// A box between two corners.
fn cuboid(low: [f64; 3], high: [f64; 3]) -> Triangles {
    let corners =
        [[0, 0], [1, 0], [1, 1], [0, 1]].map(|[x, y]| DVec2::new([low, high][x][0], [low, high][y][1]));
    prism(&corners, [low[2], high[2]])
}

/// An upright prism on a polygon that is star-shaped about its middle; corners counterclockwise.
fn prism(corners: &[DVec2], [low_mm, high_mm]: [f64; 2]) -> Triangles {
    let middle = corners.iter().sum::<DVec2>() / corners.len() as f64;
    let ends = corners.iter().zip(corners.iter().cycle().skip(1));
    ends.flat_map(|(a, b)| {
        let [a0, a1, b0, b1] = [
            a.extend(low_mm),
            a.extend(high_mm),
            b.extend(low_mm),
            b.extend(high_mm),
        ];
        let [bottom, top] = [middle.extend(low_mm), middle.extend(high_mm)];
        [[a0, b1, a1], [a0, b0, b1], [bottom, b0, a0], [top, a1, b1]]
    })
    .collect()
}

/// A plate, and a block with the same lower side.
fn plate_and_block(thickness_mm: f64) -> [Shape; 2] {
    [thickness_mm, 6.0].map(|height_mm| Shape::Box {
        size_mm: [10.0, 8.0, height_mm],
        edge_radius_mm: (0.25 * thickness_mm).min(0.3),
    })
}

fn ring(wall_mm: f64) -> Shape {
    Shape::Ring {
        outer_radius_mm: 5.0,
        inner_radius_mm: 5.0 - wall_mm,
        height_mm: 10.0,
        edge_radius_mm: 0.25 * wall_mm,
    }
}

#[test]
fn a_plate_presses_like_a_block_also_below_the_surface() {
    let coarse = gel(SimulateSettings::fine());
    // At greater depths, rows of nodes slide around the rim one after another, at different depths
    // on the two shapes.
    let fine = gel(SimulateSettings {
        contact_edge_mm: Some(0.5),
        ..SimulateSettings::fine()
    });
    for (gel, depth_mm, thicknesses_mm) in [
        (&coarse, 1.0, [1.0, 0.5, 0.3, 0.2].as_slice()),
        (&fine, 1.5, &[1.0, 0.5]),
    ] {
        for &thickness_mm in thicknesses_mm {
            let [plate, block] = plate_and_block(thickness_mm).map(|shape| press(gel, shape, depth_mm));
            println!("{thickness_mm} mm thick, {depth_mm} mm deep: {:?}", plate.failure);
            let says_how_thick = |failure: &String| failure.contains("mm thick there");
            assert!(thickness_mm < 0.5 || plate.failure.is_none(), "{thickness_mm} mm");
            assert!(plate.failure.as_ref().is_none_or(says_how_thick));
            assert_eq!(block.failure, None);
            for frame in plate.frames.iter().skip(1) {
                let is_as_deep = |other: &&PressFrame| (other.depth_mm - frame.depth_mm).abs() < 1e-9;
                let Some(other) = block.frames.iter().find(is_as_deep) else {
                    continue;
                };
                let [plate_n, block_n] = [frame.force_n, other.force_n];
                assert!(
                    (plate_n / block_n - 1.0).abs() < 0.06,
                    "{thickness_mm} mm thick, {} mm deep: {plate_n} N, {block_n} N",
                    frame.depth_mm
                );
            }
        }
    }
}

#[test]
fn a_wall_presses_or_is_too_thin_for_the_mesh() {
    let gel = gel(SimulateSettings::default());
    let mut thicker_n = f64::INFINITY;
    for wall_mm in [2.0, 1.0, 0.6] {
        let wall_n = force_n(&gel, ring(wall_mm), 1.0);
        println!("{wall_mm} mm: {wall_n:.3} N");
        assert!(
            wall_n > 0.75 && wall_n < 1.03 * thicker_n,
            "{wall_mm} mm: {wall_n} N"
        );
        thicker_n = wall_n;
    }
    for wall_mm in [0.3, 0.1] {
        let failure = press(&gel, ring(wall_mm), 1.0).failure.unwrap();
        println!("{failure}");
        assert!(
            failure.contains(&format!(
                "it is {wall_mm:.2} mm thick there, and the edges of the mesh are "
            )),
            "{failure}"
        );
        assert!(failure.contains("contact_edge_mm"), "{failure}");
    }
    let blade = Shape::Box {
        size_mm: [0.2, 12.0, 8.0],
        edge_radius_mm: 0.05,
    };
    let table = press(&gel, blade, 2.0);
    println!("{:?} {} N", table.failure, table.frames.last().unwrap().force_n);
}

#[test]
fn nothing_gets_into_a_cavity() {
    let solid = cuboid([-5.0, -4.0, 0.0], [5.0, 4.0, 6.0]);
    let mut hollow = solid.clone();
    hollow.extend(cuboid([-4.7, -3.7, 0.3], [4.7, 3.7, 5.7]));
    let inwards = hollow[solid.len()..].iter_mut();
    inwards.for_each(|triangle| triangle.swap(1, 2));
    let forces_n = [solid, hollow].map(|triangles| {
        let table = press(&gel_with(&triangles, SimulateSettings::default()), surface(), 2.0);
        assert_eq!(table.failure, None);
        table.frames.iter().map(|frame| frame.force_n).collect::<Vec<_>>()
    });
    assert_eq!(forces_n[0], forces_n[1]);
}

#[test]
fn bodies_that_overlap_press_as_one() {
    let bar = |x_mm: f64, y_mm: f64| cuboid([-x_mm, -y_mm, 0.0], [x_mm, y_mm, 6.0]);
    let cross = [[2.0, 2.0], [7.0, 2.0]];
    let quarter = cross.into_iter().chain([[7.0, -2.0], [2.0, -2.0]]);
    let half = quarter.chain([[2.0, -7.0], [-2.0, -7.0], [-2.0, -2.0], [-7.0, -2.0]]);
    let corners: Vec<DVec2> = half
        .chain([[-7.0, 2.0], [-2.0, 2.0], [-2.0, 7.0], [2.0, 7.0]])
        .rev()
        .map(DVec2::from_array)
        .collect();
    let part = |size_mm| Part {
        shape: Shape::Box {
            size_mm,
            edge_radius_mm: 0.0,
        },
        whole_from_part: Pose::IDENTITY,
    };
    let union = Shape::Union {
        parts: vec![part([14.0, 4.0, 6.0]), part([4.0, 14.0, 6.0])],
    };
    for settings in [SimulateSettings::default(), SimulateSettings::fine()] {
        let one_n = force_n(
            &gel_with(&prism(&corners, [0.0, 6.0]), settings.clone()),
            surface(),
            2.0,
        );
        let surfaces = [bar(7.0, 2.0), bar(2.0, 7.0)].concat();
        let surfaces_n = force_n(&gel_with(&surfaces, settings.clone()), surface(), 2.0);
        let shapes_n = force_n(&gel(settings), union.clone(), 2.0);
        println!("as one {one_n:.3} N, two surfaces {surfaces_n:.3} N, two boxes {shapes_n:.3} N");
        for found_n in [surfaces_n, shapes_n] {
            assert!(
                (found_n / one_n - 1.0).abs() < 0.02,
                "{found_n} N, as one {one_n} N"
            );
        }
    }
}

#[test]
fn a_thin_flange_below_a_web_does_not_pass_a_node_in_a_step() {
    let flange = cuboid([-5.0, -4.0, 0.0], [5.0, 4.0, 0.2]);
    let web = cuboid([-1.0, -4.0, 0.1], [1.0, 4.0, 6.0]);
    let gel = gel_with(&[flange, web].concat(), SimulateSettings::fine());
    let bracket = press(&gel, surface(), 1.0);
    let [_, block] = plate_and_block(0.2);
    let whole_n = force_n(&gel, block, 1.0);
    println!("{:?} {whole_n}", bracket.frames.last().map(|frame| frame.force_n));
    match bracket.failure {
        Some(failure) => assert!(failure.contains("0.20 mm thick"), "{failure}"),
        None => assert!((bracket.frames.last().unwrap().force_n / whole_n - 1.0).abs() < 0.08),
    }
}

#[test]
fn walls_of_a_cup_are_walls() {
    let cup = |wall_mm: f64| {
        // The walls differ slightly in height, so that no two faces lie in each other.
        let wall = |low: [f64; 2], high: [f64; 2], lift_mm: f64| {
            cuboid([low[0], low[1], lift_mm], [high[0], high[1], 6.0 - lift_mm])
        };
        let (x, y) = (5.0 - wall_mm, 4.0 - wall_mm);
        [
            wall([-5.0, -4.0], [-x, 4.0], 0.0),
            wall([x, -4.0], [5.0, 4.0], 0.0),
            wall([-5.01, -4.01], [5.01, -y], 0.01),
            wall([-5.01, y], [5.01, 4.01], 0.01),
        ]
        .concat()
    };
    let thick_n = force_n(&gel_with(&cup(1.5), SimulateSettings::default()), surface(), 1.0);
    let failure = press(&gel_with(&cup(0.2), SimulateSettings::default()), surface(), 1.0).failure;
    println!("{thick_n:.3} N; {failure:?}");
    assert!(thick_n > 0.8, "{thick_n}");
    assert!(failure.unwrap().contains("it is 0.2"));
}

#[test]
fn force_rises_evenly_while_gel_slides_around_rims() {
    let edge_radius_mm = 0.3;
    let height_mm = 10.0;
    let shapes = [
        Shape::Box {
            size_mm: [10.0, 8.0, height_mm],
            edge_radius_mm,
        },
        Shape::Cylinder {
            radius_mm: 5.0,
            height_mm,
            edge_radius_mm,
        },
        Shape::X {
            length_mm: 12.0,
            width_mm: 3.0,
            height_mm,
            edge_radius_mm,
        },
    ];
    let gel = gel(SimulateSettings::fine());
    for shape in shapes {
        let table = press(&gel, shape.clone(), 2.0);
        assert_eq!(table.failure, None);
        let slopes = table
            .frames
            .windows(2)
            .map(|pair| (pair[1].force_n - pair[0].force_n) / (pair[1].depth_mm - pair[0].depth_mm));
        let slopes: Vec<f64> = slopes.collect();
        println!("{slopes:.2?} N/mm");
        assert!(
            slopes.iter().all(|slope| (0.65..1.7).contains(slope)),
            "{shape:?}: {slopes:?}"
        );
    }
}

/// A pin asks for edges so short that there are too many, and for cells so flat that they are
/// invalid. Both are settled before a mesh is accepted.
#[test]
fn pins_and_blades_are_meshed_anywhere_with_as_many_nodes_as_are_allowed() {
    let settings = SimulateSettings {
        edges_per_contact_radius: 12.0,
        max_nodes: 2000,
        ..SimulateSettings::fine()
    };
    let gel = gel(settings);
    for (radius_mm, x_mm, y_mm) in [
        (0.05, 0.0, 0.0),
        (0.1, -16.3, -4.4),
        (0.05, 7.3, 2.1),
        (0.1, 11.9, 8.5),
        (0.2, -4.4, 7.0),
    ] {
        let place = PressPlace {
            indenter: "pin".into(),
            shape: Shape::Sphere { radius_mm },
            x_mm,
            y_mm,
            rotation: DQuat::IDENTITY,
            depth_mm: 0.5,
            enough_force_n: None,
        };
        let mesh = gel.mesh(&place).unwrap();
        let n_nodes = mesh.body().mesh().nodes_mm.len();
        assert!(n_nodes <= 2000, "{radius_mm} at {x_mm}, {y_mm}: {n_nodes}");
    }
}
