"""Known mistakes in 2.8; a function's docstring is its hint."""

import numpy as np


def _plan(
    steps,
    rewards,
    terminated,
    size,
    discount,
    known,
    otherwise,
    stop=False,
    total=False,
):
    states, actions = size
    tries, earned, led = (
        np.zeros(size),
        np.zeros(size),
        np.zeros((states, actions, states)),
    )
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


def on_from_the_end(
    steps, rewards, terminated, size, known_after, largest_reward, discount
):
    """If a step ended its episode, do not add the value of the state that it led to."""
    best = largest_reward / (1 - discount)
    return _plan(
        steps,
        rewards,
        terminated,
        size,
        discount,
        lambda tries: tries >= known_after,
        best,
        stop=True,
    )


def pessimist(steps, rewards, terminated, size, known_after, largest_reward, discount):
    """An unknown pair has the largest possible value. With the value 0 it would never be tried."""
    return _plan(
        steps,
        rewards,
        terminated,
        size,
        discount,
        lambda tries: tries >= known_after,
        0.0,
    )


def once_the_best(
    steps, rewards, terminated, size, known_after, largest_reward, discount
):
    """The largest possible value is that of the largest reward in every step: a geometric series."""
    return _plan(
        steps,
        rewards,
        terminated,
        size,
        discount,
        lambda tries: tries >= known_after,
        largest_reward,
    )


def one_try_more(
    steps, rewards, terminated, size, known_after, largest_reward, discount
):
    """A pair is known when it was tried ``known_after`` times; it need not be tried more often."""
    return _plan(
        steps,
        rewards,
        terminated,
        size,
        discount,
        lambda tries: tries > known_after,
        largest_reward / (1 - discount),
    )


def believes_at_once(
    steps, rewards, terminated, size, known_after, largest_reward, discount
):
    """One try is not sufficient: a pair is known after ``known_after`` tries."""
    return _plan(
        steps,
        rewards,
        terminated,
        size,
        discount,
        lambda tries: tries > 0,
        largest_reward / (1 - discount),
    )


def sums_rewards(
    steps, rewards, terminated, size, known_after, largest_reward, discount
):
    """The model's reward is the mean of the recorded rewards, not their sum."""
    best = largest_reward / (1 - discount)
    return _plan(
        steps,
        rewards,
        terminated,
        size,
        discount,
        lambda tries: tries >= known_after,
        best,
        total=True,
    )
