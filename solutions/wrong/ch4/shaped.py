"""Known mistakes in 4.2; a function's docstring is its hint."""

import numpy as np


def on_from_the_end(rewards, potentials, ended, discount):
    """When the episode ended, the potential counts as zero after the last step."""
    return rewards + discount * potentials[1:] - potentials[:-1]


def ends_when_cut_off(rewards, potentials, ended, discount):
    """If the episode was only cut off, keep the potential of its last state."""
    following = np.append(potentials[1:-1], 0.0)[: len(rewards)]
    return rewards + discount * following - potentials[:-1]


def no_discount(rewards, potentials, ended, discount):
    """Discount the potential of the next state. Otherwise the additions do not cancel."""
    following = np.append(potentials[1:-1], 0.0 if ended else potentials[-1])[
        : len(rewards)
    ]
    return rewards + following - potentials[:-1]


def other_way_round(rewards, potentials, ended, discount):
    """A step to a larger potential must have a larger reward, not a smaller one."""
    following = np.append(potentials[1:-1], 0.0 if ended else potentials[-1])[
        : len(rewards)
    ]
    return rewards - discount * following + potentials[:-1]


def next_potential_alone(rewards, potentials, ended, discount):
    """Also subtract the potential of the state before the step. Otherwise staying at a large one is rewarded."""
    following = np.append(potentials[1:-1], 0.0 if ended else potentials[-1])[
        : len(rewards)
    ]
    return rewards + discount * following


def discount_on_the_old_potential(rewards, potentials, ended, discount):
    """The discount belongs to the potential of the next state, not to that of the state before the step."""
    following = np.append(potentials[1:-1], 0.0 if ended else potentials[-1])[
        : len(rewards)
    ]
    return rewards + following - discount * potentials[:-1]


def all_discounted(rewards, potentials, ended, discount):
    """Discount only the potential of the next state, not the whole difference."""
    following = np.append(potentials[1:-1], 0.0 if ended else potentials[-1])[
        : len(rewards)
    ]
    return rewards + discount * (following - potentials[:-1])


def potentials_alone(rewards, potentials, ended, discount):
    """Add the potentials' difference to the reward of the step."""
    following = np.append(potentials[1:-1], 0.0 if ended else potentials[-1])[
        : len(rewards)
    ]
    return discount * following - potentials[:-1]


def from_the_step_before(rewards, potentials, ended, discount):
    """The potentials have an entry more than the rewards: step t leads from entry t to entry t + 1."""
    before = np.concatenate([potentials[:1], potentials[:-2]])[: len(rewards)]
    return rewards + discount * potentials[:-1] - before


def _following(rewards, potentials, ended):
    after = np.append(potentials[1:-1], 0.0 if ended else potentials[-1])
    return after[: len(rewards)]


def flag_turned(rewards, potentials, ended, discount):
    """The flag is the other way round: the last potential is zero where the episode ended, else it is kept."""
    following = _following(rewards, potentials, not ended)
    return rewards + discount * following - potentials[:-1]


def nothing_added_at_the_end(rewards, potentials, ended, discount):
    """In the last step only the next potential counts as zero: the one before the step is still subtracted."""
    added = discount * _following(rewards, potentials, ended) - potentials[:-1]
    added[-1:] = 0.0 if ended else added[-1:]
    return rewards + added


def rewards_discounted(rewards, potentials, ended, discount):
    """The rewards themselves stay as they are; only the potential of the next state is discounted."""
    following = _following(rewards, potentials, ended)
    return discount * (rewards + following) - potentials[:-1]
