"""A fast gel's file: safetensors, the layout that Rust writes.

The file begins with the length of a header, 8 bytes, little-endian, and the header, JSON. For each
tensor, single precision in row-major order, the header has its `dtype`, `shape` and where its bytes
are behind the header (`data_offsets`). Tensors are the layers of the networks `pressure`, `wrench`
and, where there is one, `taxels`: `NAME.0.weight`, `[3, n_features]`, and `NAME.0.bias` of the
layer that all points share, `NAME.1.weight`, `[n_points * n_features + n_others, n_hidden]`, and so
on. Those that begin with `novelty` are not needed here.

`__metadata__` of the header has `twintac-fast`, JSON as text: the `version` of the layout, the
names of the `sensor`, its `gel` (shape and material), the `ports` that it was taught and those at
which it is read (`ports_mm`), `center_mm`, about which torques count, and `layout`: the `grids` of
points on the gel's surface (`first_mm`, `spacing_mm`, `n`, `height_mm`), the `offsets` of the
points in a port's `patch`, and the gel's `surroundings` (`low_mm`, `high_mm`, `height_mm`).
"""

import json
import os
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from .. import Error, FastGel

_VERSION = 6
_LENGTH = 8


class File(NamedTuple):
    """What a file has."""

    header: dict[str, Any]
    tensors: dict[str, npt.NDArray[np.float32]]

    def layers(self, name: str) -> list[tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]]:
        """Weights, `[n_inputs, n_outputs]`, and biases of a network's layers, if there is one."""
        found: list[tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]] = []
        while (key := f"{name}.{len(found)}") + ".weight" in self.tensors:
            found.append((self.tensors[f"{key}.weight"], self.tensors[f"{key}.bias"]))
        return found


def read_file(source: FastGel | str | os.PathLike[str] | bytes) -> File:
    """Reads a fast gel: itself, its file, or the bytes of its file.

    Raises `Error` with the file for what is none.
    """
    if isinstance(source, bytes | FastGel):
        return _parsed(source.to_bytes() if isinstance(source, FastGel) else source)
    try:
        return _parsed(Path(source).read_bytes())
    except (OSError, Error) as error:
        raise Error(f"reading {source}: {error}", file=os.fspath(source)) from error


def _parsed(data: bytes) -> File:
    try:
        start = _LENGTH + int.from_bytes(data[:_LENGTH], "little")
        entries = json.loads(data[_LENGTH:start])
        header = json.loads(entries.pop("__metadata__")["twintac-fast"])
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise Error("this is not a fast twin that can be read") from error
    if header["version"] != _VERSION:
        problem = f"its version is {header['version']} where {_VERSION} is expected"
        raise Error(f"this fast twin cannot be read: {problem}")
    try:
        tensors = {}
        for name, entry in entries.items():
            first, end = (start + offset for offset in entry["data_offsets"])
            tensors[name] = np.frombuffer(data[first:end], "<f4").reshape(entry["shape"])
    except (ValueError, KeyError, TypeError) as error:
        raise Error("this fast twin cannot be read: its tensors are not complete") from error
    return File(header, tensors)
