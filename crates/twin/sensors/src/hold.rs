//! How bodies and gels hold each other, from one moment to the next.

use twintac_fast::{Body, FastReader, Friction, Touch};

/// How bodies and gels hold each other where bodies move freely: with friction, and with the gel's loss, which lets what hits it come to rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Coupling {
    /// Friction of each body on each gel.
    pub friction: Friction,
    /// Time by which the gel's force leads its elastic one, s: `F + t dF/dt`, as of a Kelvin-Voigt solid. 0 for a gel without loss.
    pub retardation_s: f64,
}

/// Which of the things that touch one sensor: the same as long as it is the same thing, and not
/// that of another thing. What a gel remembers of a touch, it remembers under
/// this, wherever the touch stands in a list and whatever its shape is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TouchId(pub u64);

/// A thing that touches a sensor, or not, and that its gel holds if it does.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldTouch {
    /// Which thing it is.
    pub id: TouchId,
    /// Its shape, and where it is.
    pub touch: Touch,
}

impl From<HeldTouch> for Touch {
    fn from(held: HeldTouch) -> Self {
        held.touch
    }
}

/// Memory that holding needs in a step.
#[derive(Clone, Debug)]
pub(crate) struct Holding {
    /// `[n_taxels]`
    unused_kpa: Vec<f32>,
}

impl Holding {
    pub(crate) fn of(n_taxels: usize) -> Self {
        Self {
            unused_kpa: vec![0.0; n_taxels],
        }
    }
}

/// What one sensor remembers of the things that touch it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Holds {
    holds: Vec<Hold>,
}

/// What it remembers of one.
#[derive(Clone, Debug)]
struct Hold {
    id: TouchId,
    friction: Friction,
    /// The wrench without loss, a moment before; a touch that is new has none.
    elastic: Option<[f32; 6]>,
    /// What its loss added to that.
    loss: [f32; 6],
    is_here: bool,
}

impl Holds {
    /// One more moment of a sensor.
    ///
    /// - `pressure_kpa`: is changed: without friction, then with it. `[n_taxels]`
    /// - `wrench`: is changed: of all touches, without friction and loss, then with them.
    /// - `apart`: is written: of each touch by itself. `[n_touches]`
    pub(crate) fn step(
        &mut self,
        coupling: &Coupling,
        since_previous_s: f64,
        (reader, holding): (&mut FastReader, &mut Holding),
        (bodies, touches, ids): (&[Body], &[Touch], impl Iterator<Item = TouchId>),
        pressure_kpa: &mut [f32],
        (wrench, apart): (&mut [f32; 6], &mut [[f32; 6]]),
    ) {
        share(reader, holding, (bodies, touches), wrench, apart);
        for hold in &mut self.holds {
            hold.is_here = false;
        }
        *wrench = [0.0; 6];
        for ((touch, id), own) in touches.iter().zip(ids).zip(apart) {
            let body = (&bodies[touch.body as usize], touch.gel_from_body);
            let hold = self.of_touch(id, coupling);
            hold.friction.add(reader, body, pressure_kpa, own);
            hold.lose(coupling.retardation_s, since_previous_s, own);
            for (all, own) in wrench.iter_mut().zip(own) {
                *all += *own;
            }
        }
        self.holds.retain(|hold| hold.is_here);
    }

    fn of_touch(&mut self, id: TouchId, coupling: &Coupling) -> &mut Hold {
        let known = self.holds.iter().position(|hold| hold.id == id);
        let place = known.unwrap_or_else(|| {
            self.holds.push(Hold {
                id,
                friction: coupling.friction.clone(),
                elastic: None,
                loss: [0.0; 6],
                is_here: true,
            });
            self.holds.len() - 1
        });
        let hold = &mut self.holds[place];
        hold.is_here = true;
        hold
    }
}

impl Hold {
    /// Adds the loss to a wrench. Another look at the same moment finds the same.
    fn lose(&mut self, retardation_s: f64, since_previous_s: f64, wrench: &mut [f32; 6]) {
        let before = self.elastic.replace(*wrench).unwrap_or(*wrench);
        if since_previous_s > 0.0 {
            let lead = (retardation_s / since_previous_s) as f32;
            for ((loss, force), before) in self.loss.iter_mut().zip(*wrench).zip(before) {
                *loss = lead * (force - before);
            }
        }
        for (force, loss) in wrench.iter_mut().zip(self.loss) {
            *force += loss;
        }
        // A gel does not pull at what leaves it.
        if wrench[2] > 0.0 {
            *wrench = [0.0; 6];
        }
    }
}

/// Shares the wrench of all touches among them, as each would have it by itself.
fn share(
    reader: &mut FastReader,
    holding: &mut Holding,
    (bodies, touches): (&[Body], &[Touch]),
    wrench: &[f32; 6],
    apart: &mut [[f32; 6]],
) {
    if let [only] = apart {
        *only = *wrench;
        return;
    }
    for (touch, own) in touches.iter().zip(apart.iter_mut()) {
        let body = (&bodies[touch.body as usize], touch.gel_from_body);
        reader.read(&[body], &mut holding.unused_kpa, own);
    }
    let together_n: f32 = apart.iter().map(|own| own[2]).sum();
    if together_n < 0.0 {
        let part = wrench[2] / together_n;
        for number in apart.as_flattened_mut() {
            *number *= part;
        }
    }
}
