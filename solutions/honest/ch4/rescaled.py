"""Eight ways to write exercise 4.3, as students who do not know each other would."""

import numpy as np


def rescaled_1(
    outputs, actions, rewards, next_outputs, ended, bounds, discount, learning_rate
):
    low = bounds[0] / (1 - discount)
    high = bounds[1] / (1 - discount)
    targets = outputs.copy()
    for n in range(len(actions)):
        q = low + outputs[n, actions[n]] * (high - low)
        if ended[n]:
            best = 0.0
        else:
            best = low + max(next_outputs[n]) * (high - low)
        q = q + learning_rate * (rewards[n] + discount * best - q)
        y = (q - low) / (high - low)
        targets[n, actions[n]] = min(max(y, 0), 1)
    return targets


def rescaled_2(
    outputs, actions, rewards, next_outputs, ended, bounds, discount, learning_rate
):
    def to_q(y):
        return (bounds[0] + y * (bounds[1] - bounds[0])) / (1 - discount)

    def to_output(q):
        return (q * (1 - discount) - bounds[0]) / (bounds[1] - bounds[0])

    rows = np.arange(outputs.shape[0])
    old = to_q(outputs[rows, actions])
    bootstrap = to_q(np.max(next_outputs, axis=1)) * ~ended
    new = (1 - learning_rate) * old + learning_rate * (rewards + discount * bootstrap)
    result = np.array(outputs)
    result[rows, actions] = np.clip(to_output(new), 0, 1)
    return result


def rescaled_3(
    outputs, actions, rewards, next_outputs, ended, bounds, discount, learning_rate
):
    q_min, q_max = np.array(bounds) / (1 - discount)
    span = q_max - q_min
    Q, Q_next = span * outputs + q_min, span * next_outputs + q_min
    Q_next[ended] = 0
    mask = np.eye(outputs.shape[1])[actions]
    error = (rewards + discount * Q_next.max(axis=1))[:, None] - Q
    Q = Q + learning_rate * mask * error
    return np.minimum(np.maximum((Q - q_min) / span, 0.0), 1.0)


def rescaled_4(
    outputs, actions, rewards, next_outputs, ended, bounds, discount, learning_rate
):
    answer = []
    factor = 1 / (1 - discount)
    lo, width = bounds[0] * factor, (bounds[1] - bounds[0]) * factor
    for y, a, r, y2, done in zip(outputs, actions, rewards, next_outputs, ended):
        row = y.tolist()
        value = lo + width * row[a]
        goal = r if done else r + discount * (lo + width * y2.max())
        value += learning_rate * (goal - value)
        row[a] = float(np.clip((value - lo) / width, 0, 1))
        answer.append(row)
    return np.array(answer)


def rescaled_5(
    outputs, actions, rewards, next_outputs, ended, bounds, discount, learning_rate
):
    r_min, r_max = bounds
    scale = (r_max - r_min) / (1 - discount)
    shift = r_min / (1 - discount)
    # everything in units of the network
    next_best = np.where(ended, -shift / scale, next_outputs.max(axis=1))
    target = (rewards + discount * (shift + scale * next_best) - shift) / scale
    idx = (range(len(actions)), actions)
    y = outputs.copy()
    y[idx] += learning_rate * (target - y[idx])
    y[y > 1] = 1
    y[y < 0] = 0
    return y


def rescaled_6(
    outputs, actions, rewards, next_outputs, ended, bounds, discount, learning_rate
):
    class Scale:
        def __init__(self):
            self.a = bounds[0] / (1 - discount)
            self.b = bounds[1] / (1 - discount)

        def up(self, y):
            return self.a * (1 - y) + self.b * y

        def down(self, q):
            return np.clip((q - self.a) / (self.b - self.a), 0, 1)

    s = Scale()
    q = s.up(outputs)
    v = s.up(np.amax(next_outputs, axis=1))
    v[ended] = 0.0
    for i, a in enumerate(actions):
        delta = rewards[i] + discount * v[i] - q[i, a]
        q[i, a] = q[i, a] + learning_rate * delta
    return s.down(q)


def rescaled_7(
    outputs, actions, rewards, next_outputs, ended, bounds, discount, learning_rate
):
    horizon = 1.0 / (1.0 - discount)
    least, most = bounds[0] * horizon, bounds[1] * horizon
    taken = np.take_along_axis(outputs, actions[:, None], axis=1).ravel()
    q_taken = np.interp(taken, [0, 1], [least, most])
    q_best = np.interp(next_outputs.max(axis=1), [0, 1], [least, most])
    q_best = q_best * np.logical_not(ended)
    q_new = q_taken + learning_rate * (rewards + discount * q_best - q_taken)
    moved = outputs.copy()
    np.put_along_axis(
        moved,
        actions[:, None],
        np.interp(q_new, [least, most], [0, 1])[:, None],
        axis=1,
    )
    return moved


def rescaled_8(
    outputs, actions, rewards, next_outputs, ended, bounds, discount, learning_rate
):
    N, A = outputs.shape
    q_low = bounds[0] / (1 - discount)
    q_range = bounds[1] / (1 - discount) - q_low
    targets = np.zeros((N, A))
    for n in range(N):
        for a in range(A):
            targets[n, a] = outputs[n, a]
            if a != actions[n]:
                continue
            q_old = q_low + q_range * outputs[n, a]
            q_next = [q_low + q_range * x for x in next_outputs[n]]
            future = 0 if ended[n] else discount * max(q_next)
            q_new = q_old + learning_rate * (rewards[n] + future - q_old)
            targets[n, a] = (q_new - q_low) / q_range
            if targets[n, a] < 0:
                targets[n, a] = 0
            elif targets[n, a] > 1:
                targets[n, a] = 1
    return targets
