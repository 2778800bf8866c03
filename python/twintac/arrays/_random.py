"""Random numbers as a function of keys: the same numbers from NumPy, PyTorch and JAX, on any
device, whatever else is drawn.

A number is a hash of a key, of which number it is, and of when it is drawn. The hash is the
finalizer `lowbias32` of Wellons (2018, "Prospecting for hash functions"), in 32-bit arithmetic that
wraps, which all libraries have. It is good enough for noise, and not for cryptography.
"""

import math
from typing import Any

import numpy as np

from ._namespace import Array, namespace, refuse

_GOLDEN = -1640531527  # 2^32 over the golden ratio, as a signed number
_FIRST, _SECOND = 0x7FEB352D, 0x846CA68B - 2**32
_MOST = 2**31


def keys(seed: int, *shape: int, like: Array | None = None) -> Array:
    """A key for each of many sensors, `[*shape]`, whole numbers of 32 bits.

    Different seeds, and different sensors of one seed, have different keys. Arrays are of NumPy, or
    of the library and the device of the array `like`.

    Raises `Error` for a seed that is no whole number from 0 to 2⁶³ - 1.
    """
    if isinstance(seed, bool) or not isinstance(seed, int | np.integer) or not 0 <= seed < 2**63:
        raise refuse("seed", f"is {seed!r}", "a whole number from 0 to 2⁶³ - 1")
    low, high = int(seed) % 2**32, int(seed) // 2**32
    number = np.arange(math.prod(shape), dtype=np.int64).astype(np.int32)
    words = np.array([low, high], np.int64).astype(np.uint32).view(np.int32)
    found = _hash(np, number * np.int32(_GOLDEN) ^ _hash(np, words[:1]) ^ _hash(np, ~words[1:]))
    found = found.reshape(shape)
    if like is None:
        return found
    xp = namespace("like", like)
    return xp.asarray(found, device=getattr(like, "device", None))


def uniform(xp: Any, key: Array, number: Array | int, moment: Array | int, like: Array) -> Array:
    """Numbers between 0 and 1, both excluded, in the precision of `like`, of the shape that key,
    number and moment are stretched to. Other numbers and other moments are independent of them."""
    mixed = _hash(xp, key ^ _hash(xp, moment * _GOLDEN + number + 0 * key))
    return (xp.astype(_shifted(mixed, 8), like.dtype) + 0.5) * 2.0**-24


def normal(xp: Any, key: Array, number: Array | int, moment: Array | int, like: Array) -> Array:
    """Normal numbers of deviation 1 (Box and Muller, 1958), as `uniform` has them. They take the
    numbers `number` and `number + 1`."""
    radius = xp.sqrt(-2.0 * xp.log(uniform(xp, key, number, moment, like)))
    return radius * xp.cos(2.0 * math.pi * uniform(xp, key, number + 1, moment, like))


def _hash(xp: Any, value: Array) -> Array:
    value = (value ^ _shifted(value, 16)) * _FIRST
    value = (value ^ _shifted(value, 15)) * _SECOND
    return value ^ _shifted(value, 16)


def _shifted(value: Array, n_bits: int) -> Array:
    """To the right, with zeros from the left."""
    return (value >> n_bits) & (2 ** (32 - n_bits) - 1)
