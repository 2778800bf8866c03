//! Written boards: all nets are connected, and copper of different nets keeps its distance, for any
//! pitch.

#![allow(clippy::unwrap_used)] // a test that cannot set itself up has failed

mod written;

use std::path::Path;

use proptest::prelude::*;
use twintac_board::{Board, BoardError, rules};
use twintac_sensor::Sensor;
use written::{Written, grid_of, sensor};

fn board_file(board: &Board) -> String {
    let files = board.files();
    let (_, text) = files
        .iter()
        .find(|(name, _)| name.ends_with(".kicad_pcb"))
        .unwrap();
    text.clone()
}

/// The checks that every board has to pass.
fn check(board: &Board) {
    let written = Written::read(&board_file(board));
    assert_eq!(written.open_and_shorted(), Vec::<String>::new());
    assert_eq!(written.too_close(rules::CLEARANCE_MM), Vec::<String>::new());
    assert_eq!(written.near_edge(rules::EDGE_CLEARANCE_MM), Vec::<String>::new());
    assert!(
        written.nearest_vias() > rules::VIA_DRILL_MM + 0.25,
        "{}",
        written.nearest_vias()
    );
    assert!(!written.pour.is_empty());
    let nets = written.nets();
    for taxel in board.wiring() {
        for (chip_pin, switch_pin) in taxel.chip_pins.iter().zip(&taxel.switch_pins) {
            let of_chip = nets[format!("{}.{chip_pin}", taxel.chip).as_str()];
            assert_eq!(of_chip, nets[format!("{}.{switch_pin}", taxel.switch).as_str()]);
            assert!(of_chip.ends_with(&taxel.taxel), "{of_chip}");
        }
    }
}

fn shipped(file: &str) -> Sensor {
    Sensor::read(
        Path::new(env!("CARGO_MANIFEST_DIR"))
            .join("../../../sensors")
            .join(file),
    )
    .unwrap()
}

#[test]
fn what_ships_is_joined_and_clear() {
    for (variant, file, chip) in [
        ("phystac-ms5837", "phystac.toml", "MS5837-30BA"),
        ("fingertip", "phystac-tip.toml", "MS5837-30BA"),
        ("phystac", "phystac.toml", "CPS135B"),
    ] {
        let sensor = shipped(file);
        let board = Board::design(variant, &sensor, chip).unwrap();
        check(&board);
        let geometry = board.geometry("0");
        assert_eq!(geometry.chip.footprint_confirmed, chip != "CPS135B");
        assert_eq!(geometry.board.top_z_mm, -geometry.chip.height_mm);
        assert_eq!(geometry.taxels.len(), 8);
        let chips = board.parts();
        assert_eq!(chips[0].references.len(), 8);
    }
}

#[test]
fn sixteen_taxels_have_two_switches_of_different_addresses() {
    let board = Board::design("sixteen", &grid_of(8, 2, 9.0, 5.0), "MS5837-30BA").unwrap();
    check(&board);
    let written = board_file(&board);
    assert_eq!(
        written.matches("Jumper_3_Bridged23\"").count(),
        1,
        "one address bit is 1, at 0x71"
    );
    assert_eq!(written.matches("Jumper_3_Bridged12\"").count(), 5);
    let files = board.files();
    let nets = Written::read(&files["sixteen.kicad_pcb"]);
    let nets = nets.nets();
    assert_eq!(nets["U17.22"], nets["U18.22"], "both are on the trunk");
    assert_ne!(nets["U17.1"], nets["U18.1"], "each has an address of its own");
}

#[test]
fn the_same_description_gives_the_same_bytes() {
    let sensor = grid_of(2, 1, 8.0, 6.0);
    let files = || Board::design("two", &sensor, "MS5837-30BA").unwrap().files();
    let (one, two) = (files(), files());
    assert_eq!(one, two);
    assert!(one.len() > 10);
}

#[test]
fn a_track_that_is_missing_or_misplaced_is_found() {
    let board = Board::design("two", &grid_of(2, 1, 8.0, 6.0), "MS5837-30BA").unwrap();
    let text = board_file(&board);
    check(&board);
    let track = text.lines().find(|line| line.contains("(segment ")).unwrap();
    let without = text.replacen(&format!("{track}\n"), "", 1);
    assert_ne!(Written::read(&without).open_and_shorted(), Vec::<String>::new());
    // The same track with the number of another net.
    let stray =
        "  (segment (start 144.5 105) (end 152.5 105) (width 0.2) (layer \"F.Cu\") (net 2) (uuid \"0\"))\n";
    let crossed = text.replacen(track, &format!("{stray}{track}"), 1);
    assert_ne!(
        Written::read(&crossed).too_close(rules::CLEARANCE_MM),
        Vec::<String>::new()
    );
}

#[test]
fn what_does_not_fit_says_what_is_in_the_way() {
    let chip = "MS5837-30BA";
    let close = Board::design("close", &grid_of(2, 1, 3.0, 6.0), chip).unwrap_err();
    assert!(matches!(close, BoardError::ChipsCollide { .. }), "{close}");
    assert!(close.to_string().contains("`t1` and `t0` collide"), "{close}");
    let small = Board::design("small", &grid_of(2, 2, 4.0, 0.5), chip).unwrap_err();
    assert!(
        matches!(small, BoardError::NoRoom { .. } | BoardError::NoRoute { .. }),
        "{small}"
    );
    let unknown = Board::design("x", &grid_of(1, 1, 8.0, 9.0), "BMP390").unwrap_err();
    assert!(unknown.to_string().contains("MS5837-30BA"), "{unknown}");
    let mut bare = grid_of(1, 1, 8.0, 9.0);
    (bare.taxels[0].channel, bare.taxels[0].switch) = (None, None);
    assert_eq!(
        Board::design("x", &bare, chip).unwrap_err(),
        BoardError::NoChannel { taxel: "t0".into() }
    );
    let mut raised = grid_of(1, 1, 8.0, 9.0);
    raised.taxels[0].position_mm.z = 1.0;
    assert!(matches!(
        Board::design("x", &raised, chip).unwrap_err(),
        BoardError::PortNotInPlane { .. }
    ));
}

#[test]
fn geometry_is_what_the_mechanics_read() {
    let place = |name: &str, x: f64, y: f64, channel: u8| (name.to_owned(), x, y, 0x70, channel);
    let sensor = sensor([30.0, 20.0], &[place("a", -5.0, 0.0, 3), place("b", 5.0, 1.0, 0)]);
    let board = Board::design("two", &sensor, "MS5837-30BA").unwrap();
    let geometry = board.geometry("abc");
    let json = serde_json::to_value(&geometry).unwrap();
    assert_eq!(
        json["gel"]["bounds_mm"],
        serde_json::json!([[-15.0, -10.0, 0.0], [15.0, 10.0, 8.0]])
    );
    assert_eq!(json["gel"]["volume_mm3"], 4800.0);
    assert_eq!(json["gel"]["solid"]["kind"], "block");
    assert_eq!(json["board"]["top_z_mm"], -2.75);
    assert_eq!(json["board"]["holes"][0]["screw"], "M2");
    assert_eq!(
        json["board"]["connector"]["opens_toward"],
        serde_json::json!([0, -1])
    );
    assert_eq!(json["shell"]["wall_mm"], 2.0);
    assert_eq!(json["indenters"][0]["shape"]["kind"], "sphere");
    // The holes are beyond the shell, and the connector's opening is at the edge.
    assert!(json["board"]["holes"][1]["position_mm"][0].as_f64().unwrap() > 15.0 + 3.0 + 2.0);
    let connector = &geometry.board.connector;
    let mouth = connector.center_mm[1] - 0.5 * connector.size_mm[1];
    assert!((mouth + 13.0).abs() < 0.6, "{mouth}");
    let read: twintac_board::Geometry = serde_json::from_value(json).unwrap();
    assert_eq!(read, geometry);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 5, ..ProptestConfig::default() })]

    #[test]
    fn boards_of_any_pitch_are_joined_and_clear(tenths in 65_u32..140, columns in 2_u8..4, rows in 1_u8..3) {
        let sensor = grid_of(columns, rows, f64::from(tenths) / 10.0, 7.0);
        check(&Board::design("any", &sensor, "MS5837-02BA").unwrap());
    }
}
