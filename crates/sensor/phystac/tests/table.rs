//! The table of chips in the hardware guide agrees with the drivers.

use phystac::{Budget, Chip, Settings, Wired, Wiring};

fn row(chip: Chip) -> String {
    let data = chip.data();
    let addresses: Vec<String> = data
        .addresses
        .iter()
        .map(|address| format!("{address:#04x}"))
        .collect();
    let [lowest_kpa, highest_kpa] = data.range_pa.map(|pa| pa / 1000.0);
    let usual = data
        .speeds
        .iter()
        .find(|speed| Some(speed.samples) == data.usual_samples);
    let noise = usual
        .and_then(|speed| speed.noise_pa)
        .map_or("not published".to_owned(), |pa| pa.to_string());
    let wired = [0, 1, 2, 3, 4, 5, 6, 7].map(|channel| Wired::on_channel(chip, channel));
    let settings = Settings::new(Wiring::<8>::new(&wired).expect("eight channels"));
    let rate_hz = Budget::new(&settings, 400_000).rate_hz();
    format!(
        "| {chip} | {} | {lowest_kpa} to {highest_kpa} | {noise} | {rate_hz:.0} |",
        addresses.join(", ")
    )
}

#[test]
fn the_guide_has_the_chips_of_the_table() {
    let Ok(guide) = std::fs::read_to_string("../../../docs/guides/hardware.md") else {
        println!("skipped: the guide is not beside the package");
        return;
    };
    let rows: Vec<String> = Chip::ALL.iter().map(|chip| row(*chip)).collect();
    let table = rows.join("\n");
    assert!(
        guide.contains(&format!("|---|---|---|---|---|\n{table}\n\n<!-- end -->")),
        "expected:\n{table}"
    );
}
