"""The networks of the surrogate, as `arrays._read` evaluates them."""

from typing import Any

import numpy as np
import warp as wp

from ... import arrays

wp.set_module_options({"enable_backward": False})


class Network:
    """A network on a device, for proximities of `shape`, `[n_worlds, n_sensors, n, n_points]`.

    Args:
        network: a network of NumPy.
        shape: the shape of the proximities.
        device: the device.
    """

    def __init__(self, network: arrays.Network, shape: tuple[int, ...], device: Any) -> None:
        def on_device(values: Any) -> Any:
            return wp.array(np.ascontiguousarray(values), dtype=float, device=device)

        def zeros(*last: int) -> Any:
            return wp.zeros((self._n, *last), dtype=float, device=device)

        self._n = int(np.prod(shape[:-1]))
        self._shape = shape
        self._n_points, n_rows = network.near.shape
        self._point = [on_device(part) for part in network.point]
        self._rows, self._bias = on_device(network.rows), on_device(network.bias)
        self._layers = [[on_device(part) for part in layer] for layer in network.layers]
        self._near, self._unit = on_device(network.near), on_device(network.unit)
        self._features = zeros(self._n_points, len(network.point.bias))
        widths = [len(layer.bias) for layer in network.layers]
        self._hidden = [zeros(n_rows, width) for width in (network.bias.shape[1], *widths)]
        self.output = wp.zeros((*shape[:-1], n_rows * widths[-1]), dtype=float, device=device)
        """The last output, `[n_worlds, n_sensors, n, n_rows * n_outputs]`."""

    def launch(self, share: Any, touched: Any) -> None:
        """Evaluates the network.

        Args:
            share: the proximities of the points.
            touched: the degree of contact, `[n_worlds, n_sensors, n]`.
        """
        share, touched = share.reshape((self._n, self._shape[-1])), touched.reshape((self._n,))
        hidden = self._hidden
        _launch(_features, self._features, touched, share, *self._point)
        _launch(_first, hidden[0], touched, share, self._features, self._rows, self._bias)
        for before, after, layer in zip(hidden, hidden[1:], self._layers):
            _launch(_layer, after, touched, before, *layer)
        output = self.output.reshape((self._n, self.output.shape[-1]))
        _launch(_output, output, touched, share, self._near, hidden[-1], self._unit)


# Where nothing touches, outputs are 0, and what is before them is not evaluated.


def _launch(kernel: Any, output: Any, *inputs: Any) -> None:
    wp.launch(kernel, output.shape, inputs=inputs, outputs=[output], device=output.device)


@wp.kernel
def _features(
    touched: wp.array[float],
    share: wp.array2d[wp.vec3],
    weight: wp.array2d[float],
    bias: wp.array[float],
    features: wp.array3d[float],
) -> None:
    """The features of each point, 0 for a point without a near body."""
    r, p, f = wp.tid()
    if touched[r] == 0.0:
        return
    near = share[r, p]
    value = near[0] * weight[0, f] + near[1] * weight[1, f] + near[2] * weight[2, f]
    features[r, p, f] = _silu(value + bias[f]) - _silu(bias[f])


@wp.kernel
def _first(
    touched: wp.array[float],
    share: wp.array2d[wp.vec3],
    features: wp.array3d[float],
    weight: wp.array2d[float],
    bias: wp.array2d[float],
    hidden: wp.array3d[float],
) -> None:
    """The first hidden units of each row, from the points that are near a body."""
    r, row, unit = wp.tid()
    if touched[r] == 0.0:
        return
    column = row * bias.shape[1] + unit
    n_features = features.shape[2]
    value = bias[row, unit]
    for p in range(features.shape[1]):
        if share[r, p][0] > 0.0:
            for f in range(n_features):
                value += features[r, p, f] * weight[p * n_features + f, column]
    hidden[r, row, unit] = value


@wp.kernel
def _layer(
    touched: wp.array[float],
    before: wp.array3d[float],
    weight: wp.array2d[float],
    bias: wp.array[float],
    after: wp.array3d[float],
) -> None:
    r, row, unit = wp.tid()
    if touched[r] == 0.0:
        return
    value = bias[unit]
    for k in range(before.shape[2]):
        value += _silu(before[r, row, k]) * weight[k, unit]
    after[r, row, unit] = value


@wp.kernel
def _output(
    touched: wp.array[float],
    share: wp.array2d[wp.vec3],
    near: wp.array2d[float],
    hidden: wp.array3d[float],
    unit: wp.array[float],
    output: wp.array2d[float],
) -> None:
    """The outputs; a row without a near body gives 0."""
    r, column = wp.tid()
    row = column // hidden.shape[2]
    output[r, column] = 0.0
    if touched[r] == 0.0:
        return
    for p in range(near.shape[0]):
        if near[p, row] > 0.0 and share[r, p][0] > 0.0:
            value = hidden[r, row, column - row * hidden.shape[2]]
            output[r, column] = touched[r] * unit[column] * value
            return


@wp.func
def _silu(value: float) -> float:
    half = 0.5 * value
    return half + half * wp.tanh(half)
