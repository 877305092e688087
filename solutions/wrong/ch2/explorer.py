"""Known mistakes in 2.8; a function's docstring is its hint."""

import numpy as np


def _plan(steps, rewards, terminated, size, discount, known, otherwise, stop=False, total=False):
    states, actions = size
    tries, earned, led = np.zeros(size), np.zeros(size), np.zeros((states, actions, states))
    for (state, action, following), reward, last in zip(steps, rewards, terminated):
        tries[state, action] += 1
        earned[state, action] += reward
        led[state, action, following] += not last or stop
    known = known(tries)
    mean = earned if total else earned / np.maximum(tries, 1)
    led /= np.maximum(tries, 1)[:, :, None]
    q = np.zeros(size)
    for _ in range(300):
        q = np.where(known, mean + discount * led @ q.max(axis=1), otherwise)
    return q


def on_from_the_end(steps, rewards, terminated, size, enough, most, discount):
    """After a step that ended an episode nothing follows, though the state it led to has a value."""
    best = most / (1 - discount)
    return _plan(steps, rewards, terminated, size, discount, lambda tries: tries >= enough, best, stop=True)


def pessimist(steps, rewards, terminated, size, enough, most, discount):
    """A pair that is not known yet is taken to be as good as anything could be; at zero it would never be tried."""
    return _plan(steps, rewards, terminated, size, discount, lambda tries: tries >= enough, 0.0)


def once_the_best(steps, rewards, terminated, size, enough, most, discount):
    """As good as anything could be is the largest reward in every step for ever: a geometric series."""
    return _plan(steps, rewards, terminated, size, discount, lambda tries: tries >= enough, most)


def one_try_more(steps, rewards, terminated, size, enough, most, discount):
    """A pair is known when it was tried ``enough`` times, not only when more often."""
    return _plan(steps, rewards, terminated, size, discount, lambda tries: tries > enough, most / (1 - discount))


def believes_at_once(steps, rewards, terminated, size, enough, most, discount):
    """One try is not enough to believe in: a pair counts as known after ``enough`` of them."""
    return _plan(steps, rewards, terminated, size, discount, lambda tries: tries > 0, most / (1 - discount))


def sums_rewards(steps, rewards, terminated, size, enough, most, discount):
    """The model's reward is the mean of those seen, not their sum."""
    best = most / (1 - discount)
    return _plan(steps, rewards, terminated, size, discount, lambda tries: tries >= enough, best, total=True)
