"""4.9 by double Q-learning with a network of targets that follows slowly."""

import numpy as np


def outputs(layers, x):
    hidden = np.tanh(np.column_stack([np.ones(len(x)), x]) @ layers[0].T)
    return hidden, np.column_stack([np.ones(len(x)), hidden]) @ layers[1].T


def practise(weights, states, actions, next_states, ends, rounds_left):
    rng = np.random.default_rng(1)
    layers = [np.array(layer) for layer in weights]
    slow = [layer.copy() for layer in layers]
    speed = [np.zeros_like(layer) for layer in layers]
    rewards = np.where(ends == 0, -0.04, ends)
    steps = 2400 if rounds_left == 0 else 1000
    for n in range(steps):
        rows = rng.choice(len(states), size=128)
        after = next_states[rows]
        choice = outputs(layers, after)[1].argmax(axis=1)
        future = outputs(slow, after)[1][np.arange(128), choice]
        target = rewards[rows] + 0.9 * (ends[rows] == 0) * future
        hidden, q = outputs(layers, states[rows])
        error = q[np.arange(128), actions[rows]] - target
        delta = np.eye(5)[actions[rows]] * error[:, None]
        back = delta @ layers[1][:, 1:] * (1 - hidden**2)
        gradients = [
            back.T @ np.column_stack([np.ones(128), states[rows]]),
            delta.T @ np.column_stack([np.ones(128), hidden]),
        ]
        step = 0.2 * (1 - 0.9 * n / steps) if rounds_left == 0 else 0.2
        for k, gradient in enumerate(gradients):
            speed[k] = 0.9 * speed[k] - step / 128 * gradient
            layers[k] = layers[k] + speed[k]
            slow[k] = 0.99 * slow[k] + 0.01 * layers[k]
    return layers
