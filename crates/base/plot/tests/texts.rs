//! No text extends beyond its picture, for any plot and any length of its labels.

#[path = "../examples/plots/plots.rs"]
mod plots;

use twintac_plot::svg;

#[test]
fn no_text_leaves_its_picture() {
    for label in [str::to_owned, plots::long] {
        for (name, scene) in plots::plots(label) {
            assert!(svg(&scene).matches("<text").count() > 3, "{name} has labels");
            assert_eq!(scene.overflow(), Vec::<&str>::new(), "{name}");
        }
    }
}

#[test]
fn names_that_a_picture_has_room_for_are_written_in_full() {
    let plots = plots::plots(str::to_owned);
    let of = |name: &str| svg(&plots.iter().find(|(known, _)| *known == name).unwrap().1);
    for name in ["paper (its own sensor)", "pressure+memory+mlp"] {
        assert!(of("bars").contains(&format!(">{name}<")), "{name}");
    }
    for name in ["sphere", "cylinder", "bar 0.49"] {
        assert!(of("panels").contains(&format!(">{name}<")), "{name}");
    }
}
