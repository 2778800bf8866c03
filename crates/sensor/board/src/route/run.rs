//! The whole routing: first every net, then each net once more.

use super::router::{Failure, Router};
use super::{PadCopper, Routed, tidy};
use crate::outline::Outline;

/// Connects the pads of each of `n_nets` nets. `is_power` says which nets have wide tracks.
pub(crate) fn route(
    outline: &Outline,
    pads: &[PadCopper],
    n_nets: usize,
    is_power: &dyn Fn(usize) -> bool,
) -> Result<Routed, Failure> {
    let mut router = Router::new(outline, pads, n_nets, is_power);
    router.run()?;
    tidy::tidy(&mut router);
    let mut routed = Routed::default();
    for net in &router.nets {
        net.copper(&mut routed.tracks, &mut routed.vias);
    }
    Ok(routed)
}
