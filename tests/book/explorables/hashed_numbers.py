"""The random numbers of the page's small simulations."""

from __future__ import annotations

from itertools import count


class HashedNumbers:
    """The numbers of random_numbers.js: a hash of a seed and a count."""

    def __init__(self, seed: int) -> None:
        self.seed, self.count = seed, count(1)

    def random(self) -> float:
        """The next number in [0, 1)."""
        low = 0xFFFFFFFF
        x = (self.seed + 1) * 0x9E3779B9 ^ next(self.count) * 0x85EBCA6B
        x = ((x ^ (x & low) >> 16) & low) * 0x7FEB352D & low
        x = (x ^ x >> 15) * 0x846CA68B & low
        return (x ^ x >> 16) / 2**32
