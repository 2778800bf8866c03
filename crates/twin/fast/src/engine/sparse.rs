//! Evaluation of a network most of whose points have nothing near them: only the other points are
//! multiplied.

use pulp::Simd;

use super::dense::{Dense, padded, padded_rows};
use super::places::Places;
use super::product::Weights;
use crate::contact::N_CHANNELS;
use crate::network::{LocalNetwork, silu};
use crate::simd::lanes;

/// Points whose features are computed together.
const POINTS: usize = 8;

/// The network, laid out for speed.
#[derive(Clone, Debug)]
pub(super) struct Sparse {
    /// From the channels of a point to its features.
    point: Dense,
    /// Features of a point that nothing is near, repeated for [`POINTS`] points; they are
    /// subtracted. `[POINTS][n_features]`, padded
    nothing: Vec<f32>,
    n_features: usize,
    /// Weights of the layer after the features, for each place in the patch. `[n_places]`
    rows: Vec<Weights>,
    /// The constant part of that layer. `[n_ports][n_hidden]`
    bias: Vec<f32>,
    places: Places,
    /// Number of that layer's outputs, padded.
    n_hidden: usize,
    n_ports: usize,
    /// The layers after that.
    rest: Vec<Dense>,
}

/// The points of some sensors that something is near.
#[derive(Clone, Debug, Default)]
pub(super) struct Near {
    /// `[n_near][N_CHANNELS]`, with spare room
    pub(super) channels: Vec<[f32; N_CHANNELS]>,
    /// `[n_near]`, with spare room
    pub(super) points: Vec<u32>,
    /// Where the points of each sensor end. `[n_sensors]`
    pub(super) ends: Vec<usize>,
}

/// Buffers of an evaluation.
#[derive(Clone, Debug, Default)]
pub(super) struct Scratch {
    /// `[n_near][n_features]`, padded
    features: Vec<f32>,
    /// The uses of each place. Each place has room for the largest possible number.
    pairs: Vec<Pair>,
    n_pairs: Vec<u32>,
    /// Inputs and outputs of a layer: one row for each port that has something in its patch.
    /// `[n_sensors * n_ports][n_units]`
    hidden: [Vec<f32>; 2],
    /// The row of each port, or [`NO_ROW`]. `[n_sensors * n_ports]`
    rows: Vec<u32>,
}

/// A point that something is near, in the patch of a port.
#[derive(Clone, Copy, Debug, Default)]
struct Pair {
    near: u32,
    /// The port's row.
    row: u32,
}

/// Marks a port with nothing in its patch.
const NO_ROW: u32 = u32::MAX;

impl Sparse {
    /// Lays out a network for `n_places` places. `around` returns where the ports are and the
    /// constant part of the first layer. It may append rows of places; its second argument says how
    /// many numbers a place has, and how many hidden units there are.
    pub(super) fn of(
        network: &LocalNetwork,
        n_places: usize,
        around: impl FnOnce(&mut Vec<f32>, [usize; 2]) -> (Places, Vec<f32>),
    ) -> Self {
        let first = &network.rest.layers[0];
        let nothing = network.nothing();
        let n_features = nothing.len();
        let n_hidden = first.bias.len().next_multiple_of(lanes());
        let point = Dense::of(&network.point);
        let mut rows = padded_rows(first, n_hidden);
        // After the rows of the places come the rows of the inputs that describe a location.
        rows.truncate(n_places * n_features * n_hidden);
        let (places, bias) = around(&mut rows, [n_features * n_hidden, n_hidden]);
        let nothing: Vec<f32> = padded(&nothing, point.n_outputs()).collect();
        Self {
            point,
            nothing: nothing.repeat(POINTS),
            n_features,
            rows: rows
                .chunks_exact(n_features * n_hidden)
                .map(|rows| Weights::of(rows, n_hidden))
                .collect(),
            n_ports: bias.len() / n_hidden,
            bias,
            places,
            n_hidden,
            rest: network.rest.layers[1..].iter().map(Dense::of).collect(),
        }
    }

    /// Buffers for this number of sensors and points.
    pub(super) fn scratch(&self, n_sensors: usize, n_points: usize) -> Scratch {
        let n_rows = n_sensors * self.n_ports;
        let widest = self.rest.iter().map(Dense::n_outputs).max().unwrap_or(0);
        let n_units = n_rows * widest.max(self.n_hidden);
        Scratch {
            features: vec![0.0; n_sensors * n_points * self.point.n_outputs()],
            pairs: vec![Pair::default(); n_sensors * self.places.n_uses()],
            n_pairs: vec![0; self.places.n()],
            hidden: [(); 2].map(|()| vec![0.0; n_units]),
            rows: vec![NO_ROW; n_rows],
        }
    }

    /// Passes the outputs of each port of each sensor to `found`; `None` for a port with nothing in
    /// its patch.
    #[inline(always)]
    pub(super) fn read<S: Simd>(
        &self,
        simd: S,
        near: &Near,
        scratch: &mut Scratch,
        mut found: impl FnMut(usize, Option<&[f32]>),
    ) {
        self.features(simd, near, &mut scratch.features);
        let n_rows = self.pair(near, scratch);
        self.first(simd, near.ends.len(), scratch);
        let (outputs, n_outputs) = self.finish(simd, n_rows, &mut scratch.hidden);
        let n_ports = near.ends.len() * self.n_ports;
        for (port, row) in scratch.rows[..n_ports].iter().enumerate() {
            let outputs = (*row != NO_ROW).then(|| &outputs[*row as usize * n_outputs..][..n_outputs]);
            found(port, outputs);
        }
    }

    /// Computes the features of the points that something is near.
    #[inline(always)]
    fn features<S: Simd>(&self, simd: S, near: &Near, features: &mut [f32]) {
        let n_near = near.ends.last().copied().unwrap_or(0);
        let features = &mut features[..n_near * self.point.n_outputs()];
        self.point
            .apply(simd, n_near, N_CHANNELS, near.channels.as_flattened(), features);
        for features in features.chunks_mut(self.nothing.len()) {
            for (value, nothing) in features.iter_mut().zip(&self.nothing) {
                *value = silu(*value) - nothing;
            }
        }
    }

    /// Sorts the products by place, so that the rows of a place are fetched once for all sensors.
    /// Each port that has something in its patch gets a row, which is initialized with the constant
    /// part. Returns the number of these rows.
    #[inline(always)]
    fn pair(&self, near: &Near, scratch: &mut Scratch) -> usize {
        let Scratch {
            pairs,
            n_pairs,
            rows,
            hidden: [sums, _],
            ..
        } = scratch;
        let n_sensors = near.ends.len();
        n_pairs.fill(0);
        rows.fill(NO_ROW);
        let (mut first, mut n_rows) = (0, 0);
        for (sensor, end) in near.ends.iter().enumerate() {
            for number in first..*end {
                for used in self.places.of_point(near.points[number]) {
                    let port = used.port as usize;
                    let row = &mut rows[sensor * self.n_ports + port];
                    if *row == NO_ROW {
                        *row = n_rows as u32;
                        sums[n_rows * self.n_hidden..][..self.n_hidden]
                            .copy_from_slice(&self.bias[port * self.n_hidden..][..self.n_hidden]);
                        n_rows += 1;
                    }
                    let n_pairs = &mut n_pairs[used.place as usize];
                    pairs[n_sensors * used.before as usize + *n_pairs as usize] = Pair {
                        near: number as u32,
                        row: *row,
                    };
                    *n_pairs += 1;
                }
            }
            first = *end;
        }
        n_rows
    }

    /// The layer after the features, place by place.
    #[inline(always)]
    fn first<S: Simd>(&self, simd: S, n_sensors: usize, scratch: &mut Scratch) {
        let (features, sums) = (&scratch.features, &mut scratch.hidden[0]);
        let n_padded = self.point.n_outputs();
        for (place, (rows, n_pairs)) in self.rows.iter().zip(&scratch.n_pairs).enumerate() {
            let pairs = &scratch.pairs[n_sensors * self.places.before(place)..][..*n_pairs as usize];
            let (twos, ones) = pairs.as_chunks::<2>();
            for [a, b] in twos {
                let factors = [
                    &features[a.near as usize * n_padded..][..self.n_features],
                    &features[b.near as usize * n_padded..][..self.n_features],
                ];
                let starts = [a.row as usize * self.n_hidden, b.row as usize * self.n_hidden];
                rows.add(simd, factors, starts, sums);
            }
            for one in ones {
                let factors = &features[one.near as usize * n_padded..][..self.n_features];
                rows.add(simd, [factors], [one.row as usize * self.n_hidden], sums);
            }
        }
    }

    /// The layers after the first. Returns the outputs of all rows, and the length of a row.
    #[inline(always)]
    fn finish<'a, S: Simd>(
        &self,
        simd: S,
        n_rows: usize,
        hidden: &'a mut [Vec<f32>; 2],
    ) -> (&'a [f32], usize) {
        let [mut hidden, mut next] = {
            let [hidden, next] = hidden;
            [hidden, next]
        };
        let mut n_units = self.n_hidden;
        for layer in &self.rest {
            for value in &mut hidden[..n_rows * n_units] {
                *value = silu(*value);
            }
            layer.apply(simd, n_rows, n_units, hidden, next);
            n_units = layer.n_outputs();
            (hidden, next) = (next, hidden);
        }
        (&hidden[..n_rows * n_units], n_units)
    }
}
