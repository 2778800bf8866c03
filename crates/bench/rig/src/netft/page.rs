//! Reads the configuration page over HTTP.

use std::time::Duration;

use super::{Configuration, PAGE};
use crate::{Device, RigError};

/// Largest page that is read, bytes. The sensor's page has a few thousand bytes.
const LARGEST_PAGE: u64 = 64 * 1024;

/// Reads the configuration from a sensor's web server, `host` or `host:port`.
pub(super) fn fetch(host: &str, within: Duration) -> Result<Configuration, RigError> {
    let address = format!("http://{host}{PAGE}");
    let agent = ureq::Agent::new_with_config(
        ureq::Agent::config_builder()
            .timeout_global(Some(within))
            .proxy(None) // the sensor is on the local network of the test setup
            .max_redirects(0)
            .build(),
    );
    let failed = |found: ureq::Error| RigError::Transport {
        device: Device::ForceSensor,
        what: format!("reading {address}"),
        source: found.into_io(),
    };
    let mut response = agent.get(&address).call().map_err(failed)?;
    let text = response
        .body_mut()
        .with_config()
        .limit(LARGEST_PAGE)
        .read_to_string()
        .map_err(failed)?;
    Configuration::parse(&address, &text)
}
