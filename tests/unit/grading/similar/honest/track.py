"""Twelve ways to write exercise 2.4, as students who do not know each other would."""

import numpy as np


def track_1(belief, transitions, observations, actions, readings):
    for a, z in zip(actions, readings):
        belief = belief @ transitions[a]
        if z == -1:
            continue
        new = belief * observations[a][:, z]
        total = new.sum()
        if total > 0:
            belief = new / total
    return belief


def track_2(belief, transitions, observations, actions, readings):
    b = np.array(belief)
    S = len(b)
    for t in range(len(actions)):
        a = actions[t]
        predicted = np.zeros(S)
        for s in range(S):
            for s2 in range(S):
                predicted[s2] += b[s] * transitions[a, s, s2]
        if readings[t] >= 0:
            corrected = np.zeros(S)
            for s2 in range(S):
                corrected[s2] = predicted[s2] * observations[a, s2, readings[t]]
            norm = sum(corrected)
            if norm > 0:
                predicted = corrected / norm
        b = predicted
    return b


def track_3(belief, transitions, observations, actions, readings):
    def predict(b, a):
        return transitions[a].T @ b

    def correct(b, a, z):
        weighted = observations[a, :, z] * b
        if np.all(weighted == 0):
            return b
        return weighted / np.sum(weighted)

    for a, z in zip(actions, readings):
        belief = predict(belief, a)
        if z != -1:
            belief = correct(belief, a, z)
    return belief


def track_4(belief, transitions, observations, actions, readings):
    current = belief.copy()
    for action, reading in zip(actions, readings):
        prior = np.dot(current, transitions[action])
        likelihood = (
            np.ones_like(prior) if reading < 0 else observations[action, :, reading]
        )
        evidence = np.dot(prior, likelihood)
        current = prior * likelihood / evidence if evidence else prior
    return current


def track_5(belief, transitions, observations, actions, readings):
    # unnormalised until the end
    weights = belief.astype(float)
    for k, a in enumerate(actions):
        weights = np.einsum("s,st->t", weights, transitions[a])
        z = readings[k]
        if z > -1:
            joint = weights * observations[a, :, z]
            if joint.max() > 0:
                weights = joint
        weights = weights / weights.sum()
    return weights


def track_6(belief, transitions, observations, actions, readings):
    if len(actions) == 0:
        return belief
    a, z = actions[0], readings[0]
    after = belief @ transitions[a]
    if z != -1:
        joint = after * observations[a, :, z]
        if joint.sum() != 0:
            after = joint / joint.sum()
    return track_6(after, transitions, observations, actions[1:], readings[1:])


def track_7(belief, transitions, observations, actions, readings):
    belief = list(belief)
    n = range(len(belief))
    for action, reading in zip(actions, readings):
        belief = [sum(belief[i] * transitions[action][i][j] for i in n) for j in n]
        if reading == -1:
            continue
        posterior = [belief[j] * observations[action][j][reading] for j in n]
        if not any(posterior):
            continue
        belief = [p / sum(posterior) for p in posterior]
    return belief


def track_8(belief, transitions, observations, actions, readings):
    none = np.ones((*observations.shape[:2], 1))
    # the last column, which -1 means, is that of no reading
    extended = np.concatenate([observations, none], axis=2)
    for a, z in zip(actions, readings):
        moved = (belief[:, None] * transitions[a]).sum(axis=0)
        seen = moved * extended[a, :, z]
        belief = seen / seen.sum() if seen.sum() > 0 else moved
    return belief


def track_9(belief, transitions, observations, actions, readings):
    history = [belief]
    for step in range(actions.size):
        T, O = transitions[actions[step]], observations[actions[step]]
        forecast = history[-1] @ T
        history.append(forecast)
        if readings[step] != -1:
            p = O[:, readings[step]] @ forecast
            if p > 0:
                history[-1] = np.diag(O[:, readings[step]]) @ forecast / p
    return history[-1]


def track_10(belief, transitions, observations, actions, readings):
    t = 0
    while t < len(readings):
        act, obs = actions[t], readings[t]
        belief = np.matmul(belief, transitions[act])
        valid = obs >= 0
        if valid:
            probability = np.multiply(belief, observations[act, :, obs])
            s = np.sum(probability)
            belief = np.divide(probability, s) if s > 0.0 else belief
        t += 1
    return belief


def track_11(belief, transitions, observations, actions, readings):
    for a, z in zip(actions.tolist(), readings.tolist()):
        belief = sum(belief[s] * transitions[a, s] for s in range(len(belief)))
        factor = 1.0
        if z >= 0 and (belief * observations[a, :, z]).any():
            factor = observations[a, :, z]
        belief = belief * factor
        belief /= belief.sum()
    return belief


def track_12(belief, transitions, observations, actions, readings):
    from functools import reduce

    def step(b, az):
        a, z = az
        b = b.dot(transitions[a])
        if z < 0:
            return b
        c = b * observations[a, :, z]
        mass = c.sum()
        return b if mass == 0 else c / mass

    return reduce(step, zip(actions, readings), belief)
