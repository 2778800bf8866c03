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

/// What one sensor remembers of the bodies that touch it.
#[derive(Clone, Debug, Default)]
pub(crate) struct Holds {
    bodies: Vec<Hold>,
}

/// What it remembers of one.
#[derive(Clone, Debug)]
struct Hold {
    body: u32,
    friction: Friction,
    elastic: [f32; 6],
    is_here: bool,
}

impl Holds {
    /// One more moment of a sensor.
    ///
    /// - `pressure_kpa`: is changed: without friction, then with it. `[n_taxels]`
    /// - `wrench`: is changed: of all bodies, without friction and loss, then with them.
    /// - `apart`: is written: of each body by itself. `[n_touches]`
    pub(crate) fn step(
        &mut self,
        coupling: &Coupling,
        since_previous_s: f64,
        reader: &mut FastReader,
        (bodies, touches): (&[Body], &[Touch]),
        pressure_kpa: &mut [f32],
        (wrench, apart): (&mut [f32; 6], &mut [[f32; 6]]),
    ) {
        share(reader, (bodies, touches), wrench, apart);
        for hold in &mut self.bodies {
            hold.is_here = false;
        }
        *wrench = [0.0; 6];
        for (touch, own) in touches.iter().zip(apart) {
            let body = (&bodies[touch.body as usize], touch.gel_from_body);
            let hold = self.of_body(touch.body, coupling);
            hold.friction.add(reader, body, pressure_kpa, own);
            hold.lose(coupling.retardation_s, since_previous_s, own);
            for (all, own) in wrench.iter_mut().zip(own) {
                *all += *own;
            }
        }
        self.bodies.retain(|hold| hold.is_here);
    }

    fn of_body(&mut self, body: u32, coupling: &Coupling) -> &mut Hold {
        let known = self.bodies.iter().position(|hold| hold.body == body);
        let place = known.unwrap_or_else(|| {
            self.bodies.push(Hold {
                body,
                friction: coupling.friction.clone(),
                elastic: [0.0; 6],
                is_here: true,
            });
            self.bodies.len() - 1
        });
        let hold = &mut self.bodies[place];
        hold.is_here = true;
        hold
    }
}

impl Hold {
    /// Adds the loss to a wrench.
    fn lose(&mut self, retardation_s: f64, since_previous_s: f64, wrench: &mut [f32; 6]) {
        let before = std::mem::replace(&mut self.elastic, *wrench);
        if since_previous_s > 0.0 {
            let lead = (retardation_s / since_previous_s) as f32;
            for (force, before) in wrench.iter_mut().zip(before) {
                *force += lead * (*force - before);
            }
        }
        // A gel does not pull at what leaves it.
        if wrench[2] > 0.0 {
            *wrench = [0.0; 6];
        }
    }
}

/// Shares the wrench of all bodies among them, as each would have it by itself.
fn share(
    reader: &mut FastReader,
    (bodies, touches): (&[Body], &[Touch]),
    wrench: &[f32; 6],
    apart: &mut [[f32; 6]],
) {
    if let [only] = apart {
        *only = *wrench;
        return;
    }
    let mut unused_kpa = vec![0.0; reader.n_taxels()];
    for (touch, own) in touches.iter().zip(apart.iter_mut()) {
        let body = (&bodies[touch.body as usize], touch.gel_from_body);
        reader.read(&[body], &mut unused_kpa, own);
    }
    let together_n: f32 = apart.iter().map(|own| own[2]).sum();
    if together_n < 0.0 {
        let part = wrench[2] / together_n;
        for number in apart.as_flattened_mut() {
            *number *= part;
        }
    }
}
