//! The chips, register by register.
//!
//! Each chip is written from its data sheet and not from the driver, and computes in the other
//! direction: from a pressure to the counts of its converter. To add a chip, add a file and a line
//! in [`CHIPS`].

mod analog;
mod bmp3;
mod bmp5;
mod cps135b;
mod dps310;
mod emulated_chip;
mod felt;
mod lps22hb;
mod mpl3115a2;
mod ms5837;

pub(super) use analog::Analog;
pub(super) use emulated_chip::{EmulatedChip, Kind, Make};
pub(super) use felt::{Felt, Now};

/// All kinds of chips, one line each.
pub(super) const CHIPS: &[Kind] = &[
    Kind {
        has_settings: true,
        ..of("CPS135B", &[0x6D], |make| Box::new(cps135b::Cps135b::new(make)))
    },
    of("MS5837-30BA", &[0x76], |make| {
        Box::new(ms5837::Ms5837::new(make, true))
    }),
    of("MS5837-02BA", &[0x76], |make| {
        Box::new(ms5837::Ms5837::new(make, false))
    }),
    of("MPL3115A2", &[0x60], |make| {
        Box::new(mpl3115a2::Mpl3115a2::new(make))
    }),
    of("BMP384", &[0x76, 0x77], |make| {
        Box::new(bmp3::Bmp3::new(make, 0x50))
    }),
    of("BMP388", &[0x76, 0x77], |make| {
        Box::new(bmp3::Bmp3::new(make, 0x50))
    }),
    of("BMP390", &[0x76, 0x77], |make| {
        Box::new(bmp3::Bmp3::new(make, 0x60))
    }),
    of("BMP581", &[0x46, 0x47], |make| {
        Box::new(bmp5::Bmp5::new(make, 0x50))
    }),
    of("BMP585", &[0x46, 0x47], |make| {
        Box::new(bmp5::Bmp5::new(make, 0x51))
    }),
    of("LPS22HB", &[0x5C, 0x5D], |make| {
        Box::new(lps22hb::Lps22hb::new(make))
    }),
    of("DPS310", &[0x77, 0x76], |make| {
        Box::new(dps310::Dps310::new(make))
    }),
];

const fn of(
    name: &'static str,
    addresses: &'static [u8],
    make: fn(Make<'_>) -> Box<dyn EmulatedChip>,
) -> Kind {
    Kind {
        name,
        addresses,
        make,
        has_settings: false,
    }
}

/// The kind of that name.
pub(super) fn kind(name: &str) -> Option<&'static Kind> {
    CHIPS.iter().find(|kind| kind.name.eq_ignore_ascii_case(name))
}
