"""Known mistakes in 4.2; a function's docstring is its hint."""

import numpy as np


def on_from_the_end(rewards, potentials, ended, discount):
    """When the episode ended, the potential counts as zero after the last step."""
    return rewards + discount * potentials[1:] - potentials[:-1]


def ends_when_cut_off(rewards, potentials, ended, discount):
    """An episode that was only cut off goes on from its last state, which keeps its potential."""
    following = np.append(potentials[1:-1], 0.0)[: len(rewards)]
    return rewards + discount * following - potentials[:-1]


def no_discount(rewards, potentials, ended, discount):
    """The potential of the next state is discounted, or the additions do not cancel."""
    following = np.append(potentials[1:-1], 0.0 if ended else potentials[-1])[: len(rewards)]
    return rewards + following - potentials[:-1]


def other_way_round(rewards, potentials, ended, discount):
    """A step that raises the potential earns more, not less."""
    following = np.append(potentials[1:-1], 0.0 if ended else potentials[-1])[: len(rewards)]
    return rewards - discount * following + potentials[:-1]


def next_potential_alone(rewards, potentials, ended, discount):
    """Take the potential of the state that is left away, too: without that, staying where it is high pays for ever."""
    following = np.append(potentials[1:-1], 0.0 if ended else potentials[-1])[: len(rewards)]
    return rewards + discount * following
