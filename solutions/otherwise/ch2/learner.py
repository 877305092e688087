"""2.10 with an estimated model: a pair that was tried fewer than three times seems as good as can be."""

import numpy as np


def learner(steps, rewards, terminated, size, discount, rounds_left):
    cells, actions = size
    places = tuple(np.asarray(steps, dtype=int).reshape(-1, 3).T)
    counts = np.zeros((cells, actions, cells))
    np.add.at(counts, places, np.where(terminated, 0.0, 1.0))
    sums, tries = np.zeros(size), np.zeros(size)
    np.add.at(sums, places[:2], rewards)
    np.add.at(tries, places[:2], 1)
    unknown = tries < (3 if rounds_left else 1)
    q = np.zeros(size)
    for _ in range(200):
        backed_up = (sums + discount * counts @ q.max(axis=1)) / np.maximum(tries, 1)
        q = np.where(unknown, 1.0 if rounds_left else 0.0, backed_up)
    best = (q >= q.max(axis=1, keepdims=True) - 1e-9).astype(float)
    best /= best.sum(axis=1, keepdims=True)
    return 0.9 * best + 0.1 / actions if rounds_left else best
