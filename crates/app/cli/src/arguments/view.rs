//! Arguments of `twintac view`.

use std::net::SocketAddr;
use std::path::PathBuf;

use clap::Args;

use super::Wire;

/// The program serves a page on which the gel is pressed with a mouse, a finger or keys, and solves
/// the gel itself. Anyone with the printed address can open it, in up to 32 windows at a time.
/// Requests of other pages, or without the token in the address, are refused. Ctrl-C ends the
/// program. The gel is simulated.
///
/// A sensor that is named with --bus, --serial, --udp, --replay or --lab is shown beside the gel:
/// its readings, those of the gel, and the difference. Nothing may touch the sensor when the
/// program starts: the first frames are used for its zero.
#[derive(Args, Debug)]
pub(crate) struct View {
    #[command(flatten)]
    pub(crate) wire: Wire,
    /// Sensor description (TOML) that the page opens first [default: PhysTac].
    #[arg(long, value_name = "FILE")]
    pub(crate) sensor: Option<PathBuf>,
    /// The page, made by `cargo xtask web` [default: the one that this program was built with, or
    /// target/web/twintac.html].
    #[arg(long, value_name = "FILE")]
    pub(crate) page: Option<PathBuf>,
    /// Address to listen on; port 0 means any free port. An address other than the local machine's
    /// makes the page available to other machines, without encryption.
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:0")]
    pub(crate) listen: SocketAddr,
    /// Print the address as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}
