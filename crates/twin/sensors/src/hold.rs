//! Friction and loss between bodies and gels, which depend on earlier steps.

use twintac_fast::{Body, FastReader, Friction, Touch};

/// Coupling of freely moving bodies and gels: friction, and the loss of the gel, by which a body
/// that hits the gel comes to rest.
#[derive(Clone, Debug, PartialEq)]
pub struct Coupling {
    /// Friction of each body on each gel.
    pub friction: Friction,
    /// Retardation time `t` of the gel, s: its force is `F + t dF/dt` with the elastic force `F`,
    /// as in a Kelvin-Voigt solid. 0 for a gel without loss.
    pub retardation_s: f64,
}

/// Identifies one of the things that touch a sensor. It stays the same as long as the thing is the
/// same, and no other thing has it. What a gel remembers of a touch is stored under this number,
/// whatever the position of the touch in a list and whatever its shape.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct TouchId(pub u64);

/// A thing at a pose relative to a sensor, with its identity; it may touch the sensor or not.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HeldTouch {
    /// Which thing it is.
    pub id: TouchId,
    /// Its shape and pose.
    pub touch: Touch,
}

impl From<HeldTouch> for Touch {
    fn from(held: HeldTouch) -> Self {
        held.touch
    }
}

/// Buffers of a step.
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

/// What the gel of one sensor remembers of the things that touch it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Holds {
    holds: Vec<Hold>,
}

/// What the gel remembers of one thing.
#[derive(Clone, Debug)]
struct Hold {
    id: TouchId,
    friction: Friction,
    /// The wrench without loss in the step before; `None` for a new touch.
    elastic: Option<[f32; 6]>,
    /// What the loss added to that wrench.
    loss: [f32; 6],
    /// How fast it slips over the gel, mm/s, along x and y of the gel.
    slip_mm_per_s: [f32; 2],
    is_here: bool,
}

impl Holds {
    /// One step of a sensor.
    ///
    /// - `pressure_kpa`: is changed: pressures without friction, then with it. `[n_taxels]`
    /// - `wrench`: is changed: wrench of all touches, without friction and loss, then with both.
    /// - `apart`: output; the wrench of each touch by itself. `[n_touches]`
    /// - `slip`: output; its slip velocity, mm/s. `[n_touches]`
    pub(crate) fn step(
        &mut self,
        coupling: &Coupling,
        since_previous_s: f64,
        (reader, holding): (&mut FastReader, &mut Holding),
        (bodies, touches, ids): (&[Body], &[Touch], impl Iterator<Item = TouchId>),
        pressure_kpa: &mut [f32],
        (wrench, apart, slip): (&mut [f32; 6], &mut [[f32; 6]], &mut [[f32; 2]]),
    ) {
        share(reader, holding, (bodies, touches), wrench, apart);
        for hold in &mut self.holds {
            hold.is_here = false;
        }
        *wrench = [0.0; 6];
        for (((touch, id), own), slip) in touches.iter().zip(ids).zip(apart).zip(slip) {
            let body = (&bodies[touch.body as usize], touch.gel_from_body);
            let hold = self.of_touch(id, coupling);
            hold.friction.add(reader, body, pressure_kpa, own);
            hold.lose(coupling.retardation_s, since_previous_s, own);
            hold.slip(since_previous_s, slip);
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
                slip_mm_per_s: [0.0; 2],
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
    /// The slip velocity, mm/s. A step of zero duration keeps the one before.
    fn slip(&mut self, since_previous_s: f64, slip_mm_per_s: &mut [f32; 2]) {
        if since_previous_s > 0.0 {
            self.slip_mm_per_s = self
                .friction
                .slipped_mm()
                .map(|mm| (mm / since_previous_s) as f32);
        }
        *slip_mm_per_s = self.slip_mm_per_s;
    }

    /// Adds the loss to a wrench. A step of zero duration gives the same loss again.
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
        // A gel does not pull at a body that leaves it.
        if wrench[2] > 0.0 {
            *wrench = [0.0; 6];
        }
    }
}

/// Divides the wrench of all touches among them, in proportion to what each would have by itself.
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
