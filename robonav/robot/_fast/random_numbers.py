"""Random numbers as a hash of (key, purpose, step, item, draw): the same numbers here and in JavaScript.

Every purpose has a stream of its own, so that one random event never changes another.
"""

from __future__ import annotations

import math

import numpy as np

from robonav.compilation import compiler

# Purposes of a random number
DRAWING, DRIFTING, SENSING, SLIPPING = 1, 2, 3, 4
ITEMS = 1024  # obstacles, and a few others that draw numbers in one step
ENDPOINTS = ITEMS - 1  # slot that draws start and target
MAX_OBSTACLES = ITEMS - 2

_MASK = np.uint64(0xFFFFFFFF)

compiled = compiler()


@compiled
def _mix(x):
    """Wellons' 32-bit finaliser ("lowbias32", 2018): every input bit flips every output bit about half the time."""
    x = x & _MASK
    x ^= x >> np.uint64(16)
    x = (x * np.uint64(0x7FEB352D)) & _MASK
    x ^= x >> np.uint64(15)
    x = (x * np.uint64(0x846CA68B)) & _MASK
    return x ^ (x >> np.uint64(16))


# one signature each: otherwise every literal argument compiles another, for 2 s
@compiler(signature="f8(u4, u4, i8, i8, i8, i8)")
def draw_from(low, high, purpose, step, item, draw):
    """Return a number in [0, 1) from the halves of a world's key and a counter: 8 draws an item, 1024 items a step."""
    counter = np.uint64((step * ITEMS + item) * 8 + draw)
    first = _mix(counter * np.uint64(0x9E3779B9) + np.uint64(low))
    second = _mix(first ^ np.uint64(high))
    return (
        float(_mix(second + np.uint64(purpose) * np.uint64(0x632BE5AB))) / 4294967296.0
    )


@compiler(signature="f8(u4[::1], i8, i8, i8, i8)")
def uniform(key, purpose, step, item, draw):
    """Return a number in [0, 1) from a world's key (2,) and a counter, as ``draw_from``."""
    return draw_from(key[0], key[1], purpose, step, item, draw)


@compiled
def normal(key, purpose, step, item):
    """A standard normal number (Box and Muller 1958)."""
    radius = math.sqrt(-2.0 * math.log(1.0 - uniform(key, purpose, step, item, 0)))
    return radius * math.cos(2.0 * math.pi * uniform(key, purpose, step, item, 1))
