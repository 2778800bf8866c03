//! Routes nets once more with all others in place, so that no detour around removed tracks remains.

use super::router::Router;

/// Largest number of rounds in which all nets are routed again.
const ROUNDS: usize = 4;

pub(super) fn tidy(router: &mut Router) {
    for _ in 0..ROUNDS {
        let mut is_better = false;
        for net in 0..router.nets.len() {
            is_better |= again(router, net);
        }
        if !is_better {
            return;
        }
    }
}

/// Routes a net again without crossings and keeps the cheaper result. Returns whether that is the
/// new one.
fn again(router: &mut Router, net: usize) -> bool {
    let before = std::mem::take(&mut router.nets[net].paths);
    let cost: u32 = before.iter().map(|path| path.cost).sum();
    for path in &before {
        router.cells.remove(&path.cells);
    }
    let is_joined = router.join(net, false).is_ok();
    if is_joined && router.nets[net].cost() < cost {
        return true;
    }
    for path in std::mem::replace(&mut router.nets[net].paths, before) {
        router.cells.remove(&path.cells);
    }
    for path in &router.nets[net].paths {
        router.cells.add(&path.cells);
    }
    false
}
