"""Known mistakes in 5.6; a function's docstring is its hint."""

import numpy as np


def _beyond(plain, chance):
    return [plain, (plain - chance) / (1 - chance) if chance < 1 else 0.0]


def _plain(shown, chosen):
    return float((shown == chosen).mean())


def _shares(actions, number):
    return np.bincount(actions, minlength=number) / len(actions)


def plain_twice(shown, chosen, number):
    """This is the plain accuracy again: take off what chance agrees in."""
    return [_plain(shown, chosen)] * 2


def chances_alike(shown, chosen, number):
    """Chance does not take all actions alike: it keeps the expert's shares and the policy's."""
    return _beyond(_plain(shown, chosen), 1 / number)


def shares_of_the_expert_alone(shown, chosen, number):
    """The policy has shares of its own: chance agrees in an action as often as the two shares together say."""
    return _beyond(_plain(shown, chosen), float((_shares(shown, number) ** 2).sum()))


def not_stretched(shown, chosen, number):
    """Divide by what chance leaves to agree in, so that a policy that does as the expert gets one."""
    plain = _plain(shown, chosen)
    return [plain, plain - float(_shares(shown, number) @ _shares(chosen, number))]


def balanced(shown, chosen, number):
    """This is the chapter's balanced accuracy; here chance is to be taken off."""
    recalls = [(chosen[shown == a] == a).mean() for a in range(number) if (shown == a).any()]
    return [_plain(shown, chosen), float(np.mean(recalls))]


def beyond_first(shown, chosen, number):
    """The plain accuracy comes first."""
    return _beyond(_plain(shown, chosen), float(_shares(shown, number) @ _shares(chosen, number)))[::-1]


def in_percent(shown, chosen, number):
    """Give both as fractions, one for all."""
    found = _beyond(_plain(shown, chosen), float(_shares(shown, number) @ _shares(chosen, number)))
    return [100 * part for part in found]
