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


def _counted(steps, rewards, terminated, size):
    tries, earned = np.zeros(size), np.zeros(size)
    led = np.zeros((*size, size[0]))
    ended = np.zeros(size)
    for (state, action, following), reward, last in zip(steps, rewards, terminated):
        tries[state, action] += 1
        earned[state, action] += reward
        led[state, action, following] += not last
        ended[state, action] += last
    return tries, earned / np.maximum(tries, 1), led, ended


def one_sweep(steps, rewards, terminated, size, known_after, largest_reward, discount):
    """One sweep is not sufficient: repeat the backup until the values no longer change."""
    tries, mean, led, _ = _counted(steps, rewards, terminated, size)
    best = largest_reward / (1 - discount)
    q = np.full(size, best)
    led = led / np.maximum(tries, 1)[:, :, None]
    return np.where(tries >= known_after, mean + discount * led @ q.max(axis=1), best)


def one_sweep_from_zero(
    steps, rewards, terminated, size, known_after, largest_reward, discount
):
    """One sweep is not sufficient: repeat the backup until the values no longer change."""
    tries, mean, led, _ = _counted(steps, rewards, terminated, size)
    best = largest_reward / (1 - discount)
    q = np.where(tries >= known_after, 0.0, best)
    led = led / np.maximum(tries, 1)[:, :, None]
    return np.where(tries >= known_after, mean + discount * led @ q.max(axis=1), best)


def only_those_that_go_on(
    steps, rewards, terminated, size, known_after, largest_reward, discount
):
    """Steps that ended an episode count as tries: divide by all tries, not only by those that go on."""
    tries, mean, led, _ = _counted(steps, rewards, terminated, size)
    best = largest_reward / (1 - discount)
    led = led / np.maximum(led.sum(axis=2, keepdims=True), 1)
    q = np.zeros(size)
    for _ in range(400):
        q = np.where(tries >= known_after, mean + discount * led @ q.max(axis=1), best)
    return q


def states_of_an_end_are_worth_nothing(
    steps, rewards, terminated, size, known_after, largest_reward, discount
):
    """An end belongs to a step, not to a state: other steps may lead to the same state and go on from there."""
    tries, mean, led, _ = _counted(steps, rewards, terminated, size)
    best = largest_reward / (1 - discount)
    led = led / np.maximum(tries, 1)[:, :, None]
    going = np.ones(size[0])
    for (_, _, following), last in zip(steps, terminated):
        if last:
            going[following] = 0.0
    q = np.zeros(size)
    for _ in range(400):
        value = going * q.max(axis=1)
        q = np.where(tries >= known_after, mean + discount * led @ value, best)
    return q


def follows_a_mean(
    steps, rewards, terminated, size, known_after, largest_reward, discount
):
    """The values are those of the optimal policy: take the largest action value of the next state, not the mean."""
    tries, mean, led, _ = _counted(steps, rewards, terminated, size)
    best = largest_reward / (1 - discount)
    led = led / np.maximum(tries, 1)[:, :, None]
    q = np.zeros(size)
    for _ in range(400):
        q = np.where(tries >= known_after, mean + discount * led @ q.mean(axis=1), best)
    return q
