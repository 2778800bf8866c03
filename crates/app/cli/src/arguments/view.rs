//! What can be typed behind `twintac view`.

use std::net::SocketAddr;
use std::path::PathBuf;

use clap::Args;

use super::Wire;

/// A page is served on which the gel is pressed with a mouse, a finger or keys, while this program solves it. Whoever has the
/// printed address may open it, in up to 32 windows at a time; requests of other pages, or without its token, are refused. Ctrl-C ends it. The gel is simulated.
///
/// A sensor that is named with --bus, --serial, --udp, --replay or --lab is shown beside it: what it reads, what the gel says, and the difference. Nothing
/// may touch the sensor when the program starts: its zero is taken from the first frames.
#[derive(Args, Debug)]
pub(crate) struct View {
    #[command(flatten)]
    pub(crate) wire: Wire,
    /// Sensor description (TOML) that the page begins with [default: PhysTac].
    #[arg(long, value_name = "FILE")]
    pub(crate) sensor: Option<PathBuf>,
    /// The page, as `cargo xtask web` makes it [default: the one that this program was built with, or target/web/twintac.html].
    #[arg(long, value_name = "FILE")]
    pub(crate) page: Option<PathBuf>,
    /// Where to listen; port 0 is any that is free. An address other than this machine's own lets other machines in: what is sent is not encrypted.
    #[arg(long, value_name = "ADDRESS", default_value = "127.0.0.1:0")]
    pub(crate) listen: SocketAddr,
    /// Print the address as JSON.
    #[arg(long)]
    pub(crate) json: bool,
}
