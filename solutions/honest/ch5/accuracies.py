"""Eight ways to write exercise 5.6, as students who do not know each other would."""

from collections import Counter

import numpy as np


def accuracies_1(expert_actions, policy_actions, number):
    N = len(expert_actions)
    o = np.sum(expert_actions == policy_actions) / N
    c = 0.0
    for a in range(number):
        c += np.mean(expert_actions == a) * np.mean(policy_actions == a)
    if c == 1:
        return np.array([o, 0.0])
    return np.array([o, (o - c) / (1 - c)])


def accuracies_2(expert_actions, policy_actions, number):
    table = np.zeros((number, number))
    for e, p in zip(expert_actions, policy_actions):
        table[e, p] += 1
    table /= table.sum()
    agreement = np.trace(table)
    chance = table.sum(axis=0) @ table.sum(axis=1)
    beyond = (
        0
        if np.isclose(chance, 1, rtol=0, atol=1e-15)
        else (agreement - chance) / (1 - chance)
    )
    return np.array([agreement, beyond])


def accuracies_3(expert_actions, policy_actions, number):
    n = len(expert_actions)
    expert, policy = Counter(expert_actions.tolist()), Counter(policy_actions.tolist())
    same = sum(1 for e, p in zip(expert_actions, policy_actions) if e == p)
    product = sum(expert[a] * policy[a] for a in expert)
    if product == n * n:
        return [same / n, 0.0]
    return [same / n, (same * n - product) / (n * n - product)]


def accuracies_4(expert_actions, policy_actions, number):
    one_hot = np.eye(number)
    E, P = one_hot[expert_actions], one_hot[policy_actions]
    plain = (E * P).sum(axis=1).mean()
    by_chance = np.dot(E.mean(axis=0), P.mean(axis=0))
    kappa = np.divide(plain - by_chance, 1 - by_chance) if by_chance != 1 else 0.0
    return np.array([plain, kappa])


def accuracies_5(expert_actions, policy_actions, number):
    # all pairs of a step of the one and a step of the other
    plain = np.average(np.equal(expert_actions, policy_actions))
    expected = (expert_actions[:, None] == policy_actions[None, :]).mean()
    result = np.zeros(2)
    result[0] = plain
    if expected < 1:
        result[1] = 1 - (1 - plain) / (1 - expected)
    return result


def accuracies_6(expert_actions, policy_actions, number):
    agree, p, q = 0, [0] * number, [0] * number
    for i in range(len(expert_actions)):
        p[expert_actions[i]] += 1
        q[policy_actions[i]] += 1
        if expert_actions[i] == policy_actions[i]:
            agree += 1
    total = len(expert_actions)
    observed = agree / total
    by_chance = sum(x * y for x, y in zip(p, q)) / total**2
    try:
        return np.array([observed, (observed - by_chance) / (1 - by_chance)])
    except ZeroDivisionError:
        return np.array([observed, 0.0])


def accuracies_7(expert_actions, policy_actions, number):
    edges = np.arange(number + 1) - 0.5
    joint, _, _ = np.histogram2d(expert_actions, policy_actions, bins=(edges, edges))
    joint = joint / len(expert_actions)
    o = np.diag(joint).sum()
    c = np.outer(joint.sum(1), joint.sum(0)).trace()
    return np.array([o, 0.0 if c >= 1 else (o - c) / (1 - c)])


def accuracies_8(expert_actions, policy_actions, number):
    def frequencies(actions):
        return (
            np.array([np.count_nonzero(actions == a) for a in range(number)])
            / actions.size
        )

    o = 1 - np.count_nonzero(expert_actions - policy_actions) / expert_actions.size
    c = (frequencies(expert_actions) * frequencies(policy_actions)).sum()
    with np.errstate(all="ignore"):
        return np.nan_to_num(
            np.array([o, np.float64(o - c) / np.float64(1 - c)]), nan=0.0
        )
