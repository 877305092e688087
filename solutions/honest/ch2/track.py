"""Thirty ways to write exercise 2.4, as students who do not know each other would."""

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


def track_13(belief, transitions, observations, actions, readings):
    state_count = belief.shape[0]
    for step in range(len(actions)):
        predicted_belief = np.zeros(state_count)
        for next_state in range(state_count):
            column = transitions[actions[step], :, next_state]
            predicted_belief[next_state] = np.sum(column * belief)
        belief = predicted_belief
        if readings[step] == -1:
            pass
        else:
            updated_belief = np.zeros(state_count)
            normaliser = 0.0
            for state in range(state_count):
                chance = observations[actions[step], state, readings[step]]
                updated_belief[state] = chance * predicted_belief[state]
                normaliser += updated_belief[state]
            if normaliser != 0.0:
                belief = updated_belief / normaliser
    return belief


def track_14(belief, transitions, observations, actions, readings):
    # a row vector all the way
    row = np.reshape(belief, (1, -1))
    for a, z in zip(actions, readings):
        row = row @ transitions[a]
        if z >= 0:
            scaled = row @ np.diag(observations[a, :, z])
            if scaled.sum() > 0:
                row = scaled / scaled.sum()
    return row[0]


def track_15(belief, transitions, observations, actions, readings):
    def likelihoods():
        for a, z in zip(actions, readings):
            yield transitions[a], None if z == -1 else observations[a][..., z]

    for matrix, column in likelihoods():
        belief = belief @ matrix
        if column is None or not np.any(belief * column):
            continue
        belief = belief * column / (belief @ column)
    return belief


def track_16(belief, transitions, observations, actions, readings):
    log_b = None
    b = belief
    for a, z in zip(actions, readings):
        b = np.tensordot(b, transitions[a], 1)
        if z < 0:
            continue
        with np.errstate(divide="ignore"):
            log_b = np.log(b) + np.log(observations[a, :, z])
        highest = log_b.max()
        if highest == -np.inf:
            continue
        b = np.exp(log_b - highest)
        b /= b.sum()
    return b


def track_17(belief, transitions, observations, actions, readings):
    class Filter:
        def __init__(self, start):
            self.p = start

        def act(self, a):
            self.p = self.p @ transitions[a]

        def see(self, a, z):
            hit = self.p * observations[a, :, z]
            if sum(hit) > 0:
                self.p = hit / sum(hit)

    robot = Filter(belief)
    for i, a in enumerate(actions):
        robot.act(a)
        if readings[i] != -1:
            robot.see(a, readings[i])
    return robot.p


def track_18(belief, transitions, observations, actions, readings):
    probs = {s: float(p) for s, p in enumerate(belief) if p > 0}
    for a, z in zip(actions, readings):
        moved = {}
        for s, p in probs.items():
            for t, chance in enumerate(transitions[a][s]):
                if chance > 0:
                    moved[t] = moved.get(t, 0.0) + p * chance
        probs = moved
        if z >= 0:
            seen = {t: p * observations[a][t][z] for t, p in moved.items()}
            whole = sum(seen.values())
            if whole > 0:
                probs = {t: p / whole for t, p in seen.items()}
    return np.array([probs.get(s, 0.0) for s in range(len(belief))])


def track_19(belief, transitions, observations, actions, readings):
    n_steps = len(actions)
    beliefs = np.zeros((n_steps + 1, len(belief)))
    beliefs[0] = belief
    for k in range(1, n_steps + 1):
        a, z = actions[k - 1], readings[k - 1]
        beliefs[k] = beliefs[k - 1] @ transitions[a]
        if z != -1:
            w = observations[a][:, z]
            denominator = (w * beliefs[k]).sum()
            if denominator > 0:
                beliefs[k] *= w
                beliefs[k] /= denominator
    return beliefs[-1]


def track_20(belief, transitions, observations, actions, readings):
    for a, z in zip(actions, readings):
        prior = transitions[a].transpose().dot(belief)
        try:
            if z == -1:
                raise ZeroDivisionError
            parts = [float(o) * float(p) for o, p in zip(observations[a, :, z], prior)]
            belief = np.array([x / sum(parts) for x in parts])
        except ZeroDivisionError:
            belief = prior
    return belief


def track_21(belief, transitions, observations, actions, readings):
    # everything about a step in one matrix, if the reading is possible
    b = np.asarray(belief, dtype=float)
    pending = list(zip(actions, readings))
    while pending:
        a, z = pending.pop(0)
        step = transitions[a]
        if z != -1:
            joint = step * observations[a, :, z]
            step = joint if (b @ joint).sum() > 0 else step
        b = b @ step
        b = b / b.sum()
    return b


def track_22(belief, transitions, observations, actions, readings):
    def normalise(x, otherwise):
        total = np.sum(x)
        return x / total if total > 0 else otherwise

    likelihood = lambda a, z: observations[a, :, z] if z >= 0 else 1.0
    b = belief
    for t in range(len(readings)):
        prediction = np.einsum("i,ij", b, transitions[actions[t]])
        b = normalise(prediction * likelihood(actions[t], readings[t]), prediction)
    return b


def track_23(belief, transitions, observations, actions, readings):
    S = transitions.shape[-1]
    current = [belief[s] for s in range(S)]
    for a, z in zip(actions, readings):
        nxt = [0] * S
        for s, p in enumerate(current):
            for t in range(S):
                nxt[t] = nxt[t] + p * transitions[a, s, t]
        if z > -1:
            evidence = sum(nxt[t] * observations[a, t, z] for t in range(S))
            if evidence > 0:
                for t in range(S):
                    nxt[t] = nxt[t] * observations[a, t, z] / evidence
        current = nxt
    return np.array(current)


def track_24(belief, transitions, observations, actions, readings):
    possible = readings >= 0
    columns = np.where(possible, readings, 0)
    for a, z, known in zip(actions, columns, possible):
        belief = (transitions[a] * belief[:, np.newaxis]).sum(0)
        weight = observations[a, :, z] if known else np.ones(len(belief))
        if np.dot(weight, belief) <= 0:
            weight = np.ones(len(belief))
        belief = weight * belief / np.dot(weight, belief)
    return belief


def track_25(belief, transitions, observations, actions, readings):
    def update(b, a, z):
        after = b @ transitions[a]
        if z == -1:
            return after
        support = np.flatnonzero(observations[a, :, z] * after)
        if support.size == 0:
            return after
        result = np.zeros(b.size)
        result[support] = after[support] * observations[a, support, z]
        return result / result.sum()

    for k in range(actions.shape[0]):
        belief = update(belief, actions[k], readings[k])
    return belief


def track_26(belief, transitions, observations, actions, readings):
    pred = belief.astype("float64").copy()
    for idx, act in np.ndenumerate(actions):
        pred[:] = np.inner(transitions[act].T, pred)
        r = readings[idx]
        if r == -1:
            continue
        p_reading = np.inner(pred, observations[act, :, r])
        if p_reading == 0:
            continue
        pred *= observations[act, :, r]
        pred *= 1.0 / p_reading
    return pred


def track_27(belief, transitions, observations, actions, readings):
    from itertools import accumulate

    def move_and_look(b, pair):
        b = np.sum([b[s] * transitions[pair[0]][s] for s in range(b.size)], axis=0)
        if pair[1] == -1:
            return b
        looked = observations[pair[0], :, pair[1]] * b
        return looked / looked.sum() if looked.sum() else b

    *_, last = accumulate(zip(actions, readings), move_and_look, initial=belief)
    return last


def track_28(belief, transitions, observations, actions, readings):
    count = 0
    for reading in readings:
        action = actions[count]
        count = count + 1
        belief = np.dot(transitions[action].T, belief)
        if reading != -1:
            old = belief
            belief = observations[action].T[reading] * belief
            belief = belief / np.linalg.norm(belief, 1) if belief.any() else old
    return belief


def track_29(belief, transitions, observations, actions, readings):
    b = belief.reshape(-1, 1)
    for a, z in zip(actions, readings):
        T = transitions[a].T
        b = T @ b
        if z == -1:
            continue
        O = observations[a][:, [z]]
        eta = (O * b).sum()
        b = (O * b) / eta if eta > 0 else b
    return b.flatten()


def track_30(belief, transitions, observations, actions, readings):
    remaining = len(actions)
    while remaining:
        a = actions[-remaining]
        z = readings[-remaining]
        remaining -= 1
        belief = np.average(transitions[a], axis=0, weights=belief)
        if z < 0 or np.isclose(belief @ observations[a, :, z], 0, atol=1e-300):
            continue
        belief = np.prod([belief, observations[a, :, z]], axis=0)
        belief = np.true_divide(belief, np.sum(belief))
    return belief
