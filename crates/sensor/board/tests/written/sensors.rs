//! Sensor descriptions for tests.

use std::fmt::Write as _;

use twintac_sensor::Sensor;

/// A block of gel with taxels: name, x, y, switch, channel.
pub(crate) fn sensor(size_mm: [f64; 2], taxels: &[(String, f64, f64, u8, u8)]) -> Sensor {
    let [x, y] = size_mm;
    let mut text = format!(
        "name = \"test\"\nsummary = \"a test\"\nsource = \"none\"\ninferred = []\n\
         [gel.solid]\nkind = \"block\"\nsize_mm = [{x:?}, {y:?}, 8.0]\n\
         [gel.material]\nshear_modulus_kpa = 15.0\npoissons_ratio = 0.495\nsource = \"none\"\n\
         [shell]\ngap_mm = 1.0\nheight_mm = 3.0\n\
         [readout]\nchip = \"MS5837-30BA\"\nmin_kpa = 0.0\nmax_kpa = 3000.0\nresolution_kpa = 0.02\nrate_hz = 50.0\n\
         [[indenters]]\nname = \"ball\"\nshape = {{ kind = \"sphere\", radius_mm = 5.0 }}\n"
    );
    for (name, x, y, switch, channel) in taxels {
        let _ = write!(
            text,
            "[[taxels]]\nname = \"{name}\"\nposition_mm = [{x:?}, {y:?}, 0.0]\nport_radius_mm = 1.0\nswitch = \
            {switch}\nchannel = {channel}\n"
        );
    }
    Sensor::parse("test.toml", &text, &|_| Err(std::io::ErrorKind::NotFound.into())).unwrap()
}

/// Taxels in rows along x, eight for each switch from 0x70 on, under a gel that extends `rim_mm`
/// beyond them.
pub(crate) fn grid_of(columns: u8, rows: u8, pitch_mm: f64, rim_mm: f64) -> Sensor {
    let at = |index: u8, count: u8| (f64::from(index) - 0.5 * f64::from(count - 1)) * pitch_mm;
    let taxels: Vec<_> = (0..columns * rows)
        .map(|index| {
            // The eight taxels of a switch are neighbours.
            let (column, row) = (index / rows, index % rows);
            let at = (at(column, columns), at(row, rows));
            (format!("t{index}"), at.0, at.1, 0x70 + index / 8, index % 8)
        })
        .collect();
    let size = [columns, rows].map(|count| f64::from(count - 1) * pitch_mm + 2.0 * rim_mm);
    sensor(size, &taxels)
}
