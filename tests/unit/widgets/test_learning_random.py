"""NumPy's random numbers in the page: the same numbers from the same seed."""

import numpy as np
import pytest

SEEDS = [
    *range(40), 2**31, 2**32 - 1, 2**32, 2**53 - 1, [0], [0, 0], [3, 1, 7], [1, 2, 3, 4, 5, 6], [2**40, 9],
]  # fmt: skip


@pytest.mark.parametrize("count", [1, 4, 9])
def test_words_of_a_seed_are_numpys(node, count):
    got = node(
        "learning/random",
        "return data.seeds.map((seed) => [...page.seedWords(seed, data.count)]);",
        {"seeds": SEEDS, "count": count},
    )
    expected = [
        np.random.SeedSequence(seed).generate_state(count).tolist() for seed in SEEDS
    ]
    assert got == expected


def test_numbers_are_numpys(node):
    body = """return data.map((seed) => {
      const rng = page.defaultRng(seed);
      const drawn = [];
      for (let i = 0; i < 50; i += 1) drawn.push(rng.random());
      drawn.push(rng.integers(0, 5), rng.integers(-3, 4), rng.integers(7, 8));
      drawn.push(rng.random(), rng.integers(0, 3000000000));
      for (let i = 0; i < 50; i += 1) drawn.push(rng.integers(0, 4000000000));
      drawn.push(...rng.uniform(-0.5, 0.7, 6), ...rng.permutation(1), ...rng.permutation(2), ...rng.permutation(20));
      drawn.push(rng.random());
      return drawn;
    });"""
    for seed, got in zip(SEEDS, node("learning/random", body, SEEDS), strict=True):
        rng = np.random.default_rng(seed)
        expected = [rng.random() for _ in range(50)]
        expected += [rng.integers(0, 5), rng.integers(-3, 4), rng.integers(7, 8)]
        expected += [rng.random(), rng.integers(0, 3_000_000_000)]
        expected += [rng.integers(0, 4_000_000_000) for _ in range(50)]
        expected += [*rng.uniform(-0.5, 0.7, 6)]
        for count in (1, 2, 20):
            expected += [*rng.permutation(count)]
        expected += [rng.random()]
        assert got == [float(number) for number in expected], seed


@pytest.mark.parametrize("seed", [-1, 0.5, "seven"])
def test_what_is_no_seed_is_refused_with_a_sentence(node, seed):
    body = "try { page.defaultRng(data); } catch (error) { return error.message; }"
    said = node("learning/random", body, seed)
    assert said == f"A seed must be a whole number from 0 on, got {seed}."
