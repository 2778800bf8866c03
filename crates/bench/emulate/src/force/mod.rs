//! The force/torque sensor: an ATI Net F/T, as its clients see it by UDP and HTTP.
//!
//! Source: ATI Industrial Automation, Network Force/Torque Sensor System, manual 9620-05-NET FT.
//! The codecs of `twintac-rig` make and read the records, requests and the page, in the other
//! direction.

mod sensor;
mod server;
mod settings;

pub use sensor::{ForceSensor, Outgoing};
pub use server::ForceServer;
pub use settings::ForceSettings;
