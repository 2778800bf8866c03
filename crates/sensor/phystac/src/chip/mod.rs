//! The table of chips: data from their data sheets, and the driver of each.
//!
//! To add a chip, add a file here with its driver and golden bytes, and a line in [`chips!`].

mod bmp3;
mod bmp5;
mod cps135b;
mod data;
mod dps310;
mod driver;
mod lps22hb;
mod mpl3115a2;
mod ms5837;

pub use data::{ChipData, Speed};
use driver::Driver;
pub(crate) use driver::{Command, Conversion, Progress};

use core::fmt;

use embedded_hal_async::delay::DelayNs;
use embedded_hal_async::i2c::I2c;

use crate::conversion::Sample;
use crate::error::Error;
use crate::line::Line;

/// The chips and their drivers, one line for each chip.
macro_rules! chips {
    ($($(#[$doc:meta])* $chip:ident: $driver:ident, $data:path;)*) => {
        /// A barometer that this crate can read.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
        #[non_exhaustive]
        pub enum Chip {
            $($(#[$doc])* $chip,)*
        }

        impl Chip {
            /// All chips.
            pub const ALL: &'static [Self] = &[$(Self::$chip),*];

            /// Data of the chip.
            #[must_use]
            pub const fn data(self) -> &'static ChipData {
                match self {
                    $(Self::$chip => &$data,)*
                }
            }
        }

        impl AnyDriver {
            /// Starts a chip: checks its identity, reads its calibration, sets how it measures.
            pub(crate) async fn start<I: I2c, D: DelayNs>(
                chip: Chip,
                speed: Option<Speed>,
                line: &mut Line<'_, I, D>,
            ) -> Result<Self, Error<I::Error>> {
                match chip {
                    $(Chip::$chip => $driver::start(&$data, speed, line).await.map(Self::$driver),)*
                }
            }
        }
    };
}

/// The drivers, and the functions of the trait that are passed on to each.
macro_rules! drivers {
    ($($module:ident::$driver:ident),*) => {
        $(use $module::$driver;)*

        /// The driver of a chip that was started.
        #[derive(Clone, Copy, Debug)]
        pub(crate) enum AnyDriver {
            $($driver($driver),)*
        }

        impl AnyDriver {
            pub(crate) fn command(&self, conversion: Conversion) -> Option<Command> {
                match self {
                    $(Self::$driver(driver) => driver.command(conversion),)*
                }
            }

            pub(crate) async fn is_busy<I: I2c, D: DelayNs>(
                &self,
                line: &mut Line<'_, I, D>,
            ) -> Result<bool, Error<I::Error>> {
                match self {
                    $(Self::$driver(driver) => driver.is_busy(line).await,)*
                }
            }

            pub(crate) async fn collect<I: I2c, D: DelayNs>(
                &mut self,
                conversion: Conversion,
                line: &mut Line<'_, I, D>,
            ) -> Result<Progress, Error<I::Error>> {
                match self {
                    $(Self::$driver(driver) => driver.collect(conversion, line).await,)*
                }
            }

            pub(crate) fn sample(&self) -> Sample {
                match self {
                    $(Self::$driver(driver) => driver.sample(),)*
                }
            }
        }
    };
}

drivers! {
    bmp3::Bmp3, bmp5::Bmp5, cps135b::Cps135b, dps310::Dps310, lps22hb::Lps22hb, mpl3115a2::Mpl3115a2, ms5837::Ms5837
}

chips! {
    /// Consensic, up to 1500 kPa; the chip of the PhysTac.
    Cps135b: Cps135b, cps135b::DATA;
    /// TE, gel-filled, up to 3 MPa.
    Ms5837_30Ba: Ms5837, ms5837::DATA_30BA;
    /// TE, gel-filled, up to 200 kPa; lower noise.
    Ms5837_02Ba: Ms5837, ms5837::DATA_02BA;
    /// NXP, up to 110 kPa.
    Mpl3115a2: Mpl3115a2, mpl3115a2::DATA;
    /// Bosch, gel-filled, up to 125 kPa.
    Bmp384: Bmp3, bmp3::DATA_384;
    /// Bosch, up to 125 kPa.
    Bmp388: Bmp3, bmp3::DATA_388;
    /// Bosch, up to 125 kPa.
    Bmp390: Bmp3, bmp3::DATA_390;
    /// Bosch, up to 125 kPa.
    Bmp581: Bmp5, bmp5::DATA_581;
    /// Bosch, gel-filled, up to 125 kPa.
    Bmp585: Bmp5, bmp5::DATA_585;
    /// ST, up to 126 kPa.
    Lps22hb: Lps22hb, lps22hb::DATA;
    /// Infineon, up to 120 kPa.
    Dps310: Dps310, dps310::DATA;
}

impl Chip {
    /// The chip with this name; upper and lower case are equal.
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let is_it = |chip: &&Self| chip.data().name.eq_ignore_ascii_case(name);
        Self::ALL.iter().find(is_it).copied()
    }
}

impl fmt::Display for Chip {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.data().name)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_holds_together() {
        for chip in Chip::ALL {
            let data = chip.data();
            assert_eq!(Chip::named(data.name), Some(*chip));
            assert!(!data.addresses.is_empty() && data.addresses.iter().all(|address| *address < 0x78));
            assert!(
                data.range_pa[0] < 101_325.0 && data.range_pa[1] > 101_325.0,
                "{chip}"
            );
            let usual = data.speed(None).expect("the usual samples are among its speeds");
            assert!(usual.is_some() || chip == &Chip::Cps135b);
            assert!(
                data.speeds.is_sorted_by(|one, two| one.samples < two.samples),
                "{chip}"
            );
            let times: std::vec::Vec<u32> = data
                .speeds
                .iter()
                .filter_map(|speed| speed.conversion_us)
                .collect();
            assert!(times.is_sorted(), "{chip}");
            assert!(data.speed(Some(3)).is_none());
        }
        assert_eq!(Chip::named("bmp280"), None);
    }
}
