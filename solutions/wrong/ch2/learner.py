"""Known mistakes in 2.10. The hints of an open task say what the robots did."""

import numpy as np


def _replayed(steps, rewards, terminated, size, discount):
    """Q-learning over the recorded steps, from zeros."""
    q = np.zeros(size).tolist()
    seen = list(zip(steps.tolist(), rewards.tolist(), terminated.tolist()))
    for _ in range(5):
        for (cell, action, after), reward, end in reversed(seen):
            target = reward + (0.0 if end else discount * max(q[after]))
            q[cell][action] += 0.1 * (target - q[cell][action])
    return np.array(q)


def wanders(steps, rewards, terminated, size, discount, rounds_left):
    """The robot never uses what it has learned."""
    return np.full(size, 1 / size[1])


def never_explores(steps, rewards, terminated, size, discount, rounds_left):
    """A robot that is greedy from the start repeats its first action."""
    q = _replayed(steps, rewards, terminated, size, discount)
    return np.eye(size[1])[q.argmax(axis=1)]


def short_sighted(steps, rewards, terminated, size, discount, rounds_left):
    """Only the next reward is learned, and not what comes after it."""
    if rounds_left:
        return np.full(size, 1 / size[1])
    q = _replayed(steps, rewards, terminated, size, 0.0)
    return np.eye(size[1])[q.argmax(axis=1)]


def explores_to_the_end(steps, rewards, terminated, size, discount, rounds_left):
    """The last answer still explores in every second step."""
    q = _replayed(steps, rewards, terminated, size, discount)
    return 0.5 * np.eye(size[1])[q.argmax(axis=1)] + 0.5 / size[1]
