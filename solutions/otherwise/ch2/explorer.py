"""2.8 by policy iteration, each policy evaluated by solving linear equations."""

import numpy as np


def explorer(steps, rewards, terminated, size, known_after, largest_reward, discount):
    states, actions = size
    best = largest_reward / (1 - discount)
    model = {}
    for (s, a, t), reward, last in zip(steps.tolist(), rewards, terminated):
        model.setdefault((s, a), []).append((reward, None if last else t))
    model = {pair: seen for pair, seen in model.items() if len(seen) >= known_after}

    def backup(values):
        q = [[best] * actions for _ in range(states)]
        for (s, a), seen in model.items():
            q[s][a] = sum(
                r + (0 if t is None else discount * values[t]) for r, t in seen
            ) / len(seen)
        return np.array(q)

    policy = np.zeros(states, dtype=int)
    while True:
        matrix, right = np.eye(states), np.full(states, best)
        for s in range(states):
            if (s, policy[s]) in model:
                seen = model[s, policy[s]]
                right[s] = sum(r for r, _ in seen) / len(seen)
                for _, t in seen:
                    if t is not None:
                        matrix[s, t] -= discount / len(seen)
        q = backup(np.linalg.solve(matrix, right))
        improved = np.where(
            q.max(axis=1) > q[range(states), policy] + 1e-9, q.argmax(axis=1), policy
        )
        if (improved == policy).all():
            return q
        policy = improved
