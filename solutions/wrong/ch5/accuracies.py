"""Known mistakes in 5.6; a function's docstring is its hint."""

import numpy as np


def _beyond(plain, expected):
    return [plain, (plain - expected) / (1 - expected) if expected < 1 else 0.0]


def _plain(expert_actions, policy_actions):
    return float((expert_actions == policy_actions).mean())


def _shares(actions, number):
    return np.bincount(actions, minlength=number) / len(actions)


def plain_twice(expert_actions, policy_actions, number):
    """This is the plain accuracy again: subtract the agreement expected by chance."""
    return [_plain(expert_actions, policy_actions)] * 2


def equal_frequencies(expert_actions, policy_actions, number):
    """The actions are not equally frequent: use the frequencies of the expert and of the policy."""
    return _beyond(_plain(expert_actions, policy_actions), 1 / number)


def shares_of_the_expert_alone(expert_actions, policy_actions, number):
    """Multiply the expert's frequency of each action by the policy's frequency, and add the products."""
    return _beyond(
        _plain(expert_actions, policy_actions),
        float((_shares(expert_actions, number) ** 2).sum()),
    )


def not_stretched(expert_actions, policy_actions, number):
    """Divide by 1 - c, so that the result is 1 for a policy that always agrees."""
    plain = _plain(expert_actions, policy_actions)
    return [
        plain,
        plain
        - float(_shares(expert_actions, number) @ _shares(policy_actions, number)),
    ]


def balanced(expert_actions, policy_actions, number):
    """This is the balanced accuracy of the chapter. Subtract the agreement expected by chance instead."""
    recalls = [
        (policy_actions[expert_actions == a] == a).mean()
        for a in range(number)
        if (expert_actions == a).any()
    ]
    return [_plain(expert_actions, policy_actions), float(np.mean(recalls))]


def beyond_first(expert_actions, policy_actions, number):
    """The plain accuracy comes first."""
    return _beyond(
        _plain(expert_actions, policy_actions),
        float(_shares(expert_actions, number) @ _shares(policy_actions, number)),
    )[::-1]


def in_percent(expert_actions, policy_actions, number):
    """Return both as fractions from 0 to 1, not in per cent."""
    found = _beyond(
        _plain(expert_actions, policy_actions),
        float(_shares(expert_actions, number) @ _shares(policy_actions, number)),
    )
    return [100 * part for part in found]


def zero_by_zero(expert_actions, policy_actions, number):
    """If both always take the same action, 1 - c is 0: the agreement beyond chance is 0 then, not 0 divided by 0."""
    plain = np.float64(_plain(expert_actions, policy_actions))
    c = _shares(expert_actions, number) @ _shares(policy_actions, number)
    with np.errstate(all="ignore"):
        return [plain, (plain - c) / (1 - c)]


def short_counts(expert_actions, policy_actions, number):
    """Count all actions, also those that do not occur: ``numpy.bincount`` has the argument ``minlength``."""
    p, q = (
        np.bincount(actions) / len(actions)
        for actions in (expert_actions, policy_actions)
    )
    return _beyond(_plain(expert_actions, policy_actions), float(p @ q))


def counts_for_frequencies(expert_actions, policy_actions, number):
    """p and q are frequencies: divide the counts by the number of steps."""
    p, q = (
        np.bincount(actions, minlength=number)
        for actions in (expert_actions, policy_actions)
    )
    return _beyond(
        _plain(expert_actions, policy_actions), float(p @ q) / len(expert_actions)
    )
