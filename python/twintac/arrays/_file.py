"""The file of a surrogate of the gel: safetensors, in the layout that Rust writes.

The file begins with the length of the header (8 bytes, little-endian) and the header (JSON). For
each tensor, in single precision and row-major order, the header has its `dtype`, its `shape` and
the position of its bytes after the header (`data_offsets`). The tensors are the layers of the
networks `pressure`, `wrench` and, if there is one, `taxels`: `NAME.0.weight`, `[3, n_features]`,
and `NAME.0.bias` belong to the layer that all points share; `NAME.1.weight`,
`[n_points * n_features + n_others, n_hidden]`, and so on to the next layers. Tensors whose names
begin with `novelty` are not needed here.

`__metadata__` of the header has `twintac-fast`, JSON as text: the `version` of the layout, the name
of the `sensor`, its `gel` (shape and material), the `ports` that the surrogate was trained on, the
ports at which it is read (`ports_mm`), `center_mm`, the reference point of torques, and `layout`:
the `grids` of points on the gel's surface (`first_mm`, `spacing_mm`, `n`, `height_mm`), the
`offsets` of the points in a port's `patch`, and the gel's `surroundings` (`low_mm`, `high_mm`,
`height_mm`).
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
    """The content of a file."""

    header: dict[str, Any]
    tensors: dict[str, npt.NDArray[np.float32]]

    def layers(self, name: str) -> list[tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]]:
        """Weights, `[n_inputs, n_outputs]`, and biases of a network's layers; empty if there is no
        such network.
        """
        found: list[tuple[npt.NDArray[np.float32], npt.NDArray[np.float32]]] = []
        while (key := f"{name}.{len(found)}") + ".weight" in self.tensors:
            found.append((self.tensors[f"{key}.weight"], self.tensors[f"{key}.bias"]))
        return found


def read_file(source: FastGel | str | os.PathLike[str] | bytes) -> File:
    """Reads a surrogate from a `FastGel`, from its file, or from the bytes of its file.

    Raises `Error`, which names the file, if the source is not a surrogate of the gel.
    """
    if isinstance(source, bytes | FastGel):
        return _parsed(source.to_bytes() if isinstance(source, FastGel) else source)
    try:
        return _parsed(Path(source).read_bytes())
    except (OSError, Error) as error:
        raise Error(f"reading {source}: {error}", file=os.fspath(source)) from error


def read_tensors(data: bytes) -> dict[str, npt.NDArray[np.float32]]:
    """The tensors of a safetensors file, by name.

    Raises `ValueError`, `KeyError`, `TypeError` or `AttributeError` for what is none.
    """
    entries, start = _entries(data)
    return _tensors(entries, data, start)


def _parsed(data: bytes) -> File:
    try:
        entries, start = _entries(data)
        header = json.loads(entries["__metadata__"]["twintac-fast"])
    except (ValueError, KeyError, TypeError, AttributeError) as error:
        raise Error("this is not a readable surrogate of the gel") from error
    if header["version"] != _VERSION:
        problem = f"its version is {header['version']} where {_VERSION} is expected"
        raise Error(f"this surrogate of the gel cannot be read: {problem}")
    try:
        return File(header, _tensors(entries, data, start))
    except (ValueError, KeyError, TypeError) as error:
        raise Error("this surrogate of the gel cannot be read: its tensors are not complete") from error


def _entries(data: bytes) -> tuple[dict[str, Any], int]:
    """The header, and where the tensors' bytes begin."""
    start = _LENGTH + int.from_bytes(data[:_LENGTH], "little")
    entries: dict[str, Any] = json.loads(data[_LENGTH:start])
    return entries, start


def _tensors(
    entries: dict[str, Any], data: bytes, start: int
) -> dict[str, npt.NDArray[np.float32]]:
    tensors = {}
    for name, entry in entries.items():
        if name != "__metadata__":
            first, end = (start + offset for offset in entry["data_offsets"])
            tensors[name] = np.frombuffer(data[first:end], "<f4").reshape(entry["shape"])
    return tensors
