//! Work on the contacts with all shapes.

use super::rigid_body::RigidBody;
use super::state::Contact;
use crate::parallel::join_halves;

/// Calls `work` with each shape's index, the shape and its contact. The second half of the shapes
/// may be worked on at the same time as the first. Returns the results in the order of the shapes.
pub(crate) fn for_each_contact<T: Send>(
    shapes: &[RigidBody],
    contacts: &mut [Contact],
    work: impl Fn(usize, &RigidBody, &mut Contact) -> T + Sync,
) -> Vec<T> {
    let half = shapes.len() / 2;
    let part = |first: usize, shapes: &[RigidBody], contacts: &mut [Contact]| -> Vec<T> {
        let pairs = shapes.iter().zip(contacts);
        let pairs = pairs.enumerate();
        pairs
            .map(|(index, (shape, contact))| work(first + index, shape, contact))
            .collect()
    };
    let shapes = shapes.split_at(half);
    let contacts = contacts.split_at_mut(half);
    let (mut results, mut others) = join_halves(
        || part(0, shapes.0, contacts.0),
        || part(half, shapes.1, contacts.1),
    );
    results.append(&mut others);
    results
}
