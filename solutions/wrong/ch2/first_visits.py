"""Known mistakes in 2.6; a function's docstring is its hint."""

import numpy as np


def _returns(earned, discount):
    following, returns = 0.0, []
    for reward in reversed(earned):
        following = reward + discount * following
        returns.insert(0, following)
    return returns


def _mean(samples, size):
    total, count = np.zeros(size), np.zeros(size, dtype=np.int64)
    for state, value in samples:
        total[state] += value
        count[state] += 1
    return total / np.maximum(count, 1), count


def every_visit(states, rewards, discount, size):
    """This uses every visit. Use only the first visit in each episode."""
    return _mean(
        [
            pair
            for v, e in zip(states, rewards)
            for pair in zip(v, _returns(e, discount))
        ],
        size,
    )


def last_visit(states, rewards, discount, size):
    """This uses the last visit in each episode. Use the first one."""
    return _mean(
        [
            pair
            for v, e in zip(states, rewards)
            for pair in dict(zip(v, _returns(e, discount))).items()
        ],
        size,
    )


def no_discount(states, rewards, discount, size):
    """Discount the return: multiply a reward k steps later by the discount to the power of k."""
    pairs = [
        dict(reversed(list(zip(v, _returns(e, 1.0))))) for v, e in zip(states, rewards)
    ]
    return _mean([pair for first in pairs for pair in first.items()], size)


def from_the_start(states, rewards, discount, size):
    """Start discounting at the visit, not at the beginning of the episode."""
    samples = []
    for visited, earned in zip(states, rewards):
        weighted = [discount**t * reward for t, reward in enumerate(earned)]
        samples += dict(
            reversed([(s, sum(weighted[t:])) for t, s in enumerate(visited)])
        ).items()
    return _mean(samples, size)


def without_its_own(states, rewards, discount, size):
    """The return begins with the reward of the step from the visited state."""
    pairs = [
        dict(reversed(list(zip(v, [*_returns(e, discount)[1:], 0.0]))))
        for v, e in zip(states, rewards)
    ]
    return _mean([pair for first in pairs for pair in first.items()], size)


def over_all_episodes(states, rewards, discount, size):
    """Take the mean over the episodes that visited the state, not over all episodes."""
    pairs = [
        dict(reversed(list(zip(v, _returns(e, discount)))))
        for v, e in zip(states, rewards)
    ]
    values, count = _mean([pair for first in pairs for pair in first.items()], size)
    return values * count / len(states), count
