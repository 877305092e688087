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


def without_its_own_discounted(states, rewards, discount, size):
    """The return begins with the reward of the step from the visited state, which is not discounted."""
    pairs = [
        dict(
            reversed(
                list(
                    zip(
                        v,
                        [discount * after for after in _returns(e, discount)[1:]]
                        + [0.0],
                    )
                )
            )
        )
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


def seen_in_any_episode(states, rewards, discount, size):
    """A first visit is the first in its own episode: forget the visited states when the next episode begins."""
    samples, seen = [], set()
    for visited, earned in zip(states, rewards):
        for state, value in zip(visited, _returns(earned, discount)):
            if state not in seen:
                seen.add(state)
                samples.append((state, value))
    return _mean(samples, size)


def nothing_by_nothing(states, rewards, discount, size):
    """The value of a state that no episode visited is 0, not 0 divided by 0."""
    values, count = _first(states, rewards, discount, size)
    return np.where(count > 0, values, np.nan), count


def _first(states, rewards, discount, size):
    pairs = [
        dict(reversed(list(zip(v, _returns(e, discount)))))
        for v, e in zip(states, rewards)
    ]
    return _mean([pair for first in pairs for pair in first.items()], size)


def counts_visits(states, rewards, discount, size):
    """Count the episodes that visited the state, not its visits: an episode counts once."""
    count = np.zeros(size, dtype=np.int64)
    for visited in states:
        for state in visited:
            count[state] += 1
    return _first(states, rewards, discount, size)[0], count


def sums(states, rewards, discount, size):
    """Divide the sum of the returns by the number of episodes that visited the state."""
    values, count = _first(states, rewards, discount, size)
    return values * count, count


def only_the_reward(states, rewards, discount, size):
    """The return holds the rewards of all later steps too, not only that of the step from the state."""
    pairs = [dict(reversed(list(zip(v, e)))) for v, e in zip(states, rewards)]
    return _mean([pair for first in pairs for pair in first.items()], size)
