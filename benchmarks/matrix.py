"""How much faster matrix products are than a loop: the network of chapter 3 on M inputs, three ways.

    python benchmarks/matrix.py

The same network, 11-8-5, gives the same outputs in all three: by a loop over its units in Python, by the products of
one input after the other, and by the products of all inputs at once. Only ratios are printed. They are medians of
rounds in which the three take turns, in seconds of the processor, so that other programs hardly change them. Ends with
1 if the products of 1,000 inputs at once are less than 100 times as fast as the loop.
"""

from __future__ import annotations

import statistics
import sys
import time
from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from robonav.networks import forward_by_units, random_network

SIZES = (11, 8, 5)
INPUTS = (1, 10, 100, 1000)
ROUNDS = 7
LEAST = 0.02  # seconds of a round; short work is repeated
AT_LEAST = 100  # times as fast, with 1,000 inputs

Array = NDArray[np.float64]
NETWORK = random_network(SIZES, seed=0)


def loop(x: Array) -> Array:
    """A loop over inputs, units and weights in Python."""
    return np.array([forward_by_units(NETWORK, row) for row in x])


def one_by_one(x: Array) -> Array:
    """The matrix products of each input, one input after the other."""
    return np.array([NETWORK.forward(row) for row in x])


def all_at_once(x: Array) -> Array:
    """The matrix products of all inputs at once, each input a row."""
    return NETWORK.forward(x)


WAYS = (loop, one_by_one, all_at_once)


def seconds(way: Callable[[Array], Array], x: Array) -> float:
    """Return the seconds of the processor that one pass takes, the mean of as many as fill a round."""
    passes, began = 0, time.process_time()
    while (spent := time.process_time() - began) < LEAST:
        way(x)
        passes += 1
    return spent / passes


def main() -> None:
    rng = np.random.default_rng(1)
    print(f"network {'-'.join(map(str, SIZES))}, compared with a loop over its units")
    slow = False
    for m in INPUTS:
        x = rng.uniform(0, 1, (m, SIZES[0]))
        for way in WAYS[1:]:
            np.testing.assert_allclose(way(x), loop(x), atol=1e-12)
        rounds = [[seconds(way, x) for way in WAYS] for _ in range(ROUNDS)]
        each, at_once = (
            statistics.median(spent[0] / spent[k] for spent in rounds) for k in (1, 2)
        )
        print(f"{m:,} inputs, one at a time: {each:.1f} times as fast")
        print(f"{m:,} inputs, all at once: {at_once:.0f} times as fast")
        slow |= m == 1000 and at_once < AT_LEAST
    sys.exit(slow)


if __name__ == "__main__":
    main()
