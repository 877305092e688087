"""Eight ways to write exercise 4.2, as students who do not know each other would."""

import numpy as np


def shaped_1(rewards, potentials, ended, discount):
    phi = np.array(potentials, dtype=float)
    if ended:
        phi_next = np.append(phi[1:-1], 0.0)
    else:
        phi_next = phi[1:]
    return rewards + discount * phi_next[: len(rewards)] - phi[: len(rewards)]


def shaped_2(rewards, potentials, ended, discount):
    T = len(rewards)
    result = np.zeros(T)
    for t in range(T):
        next_potential = potentials[t + 1]
        if t == T - 1 and ended:
            next_potential = 0
        result[t] = rewards[t] + discount * next_potential - potentials[t]
    return result


def shaped_3(rewards, potentials, ended, discount):
    steps = zip(rewards, potentials, potentials[1:])
    out = [r + discount * after - before for r, before, after in steps]
    if ended and out:
        out[-1] -= discount * potentials[-1]
    return np.array(out)


def shaped_4(rewards, potentials, ended, discount):
    keep = np.ones(len(rewards))
    if len(keep) > 0:
        keep[-1] = 1 - bool(ended)
    bonus = discount * keep * potentials[1:] - potentials[:-1]
    return np.add(rewards, bonus)


def shaped_5(rewards, potentials, ended, discount):
    def phi(t):
        return 0.0 if ended and t == len(rewards) else float(potentials[t])

    n = range(len(rewards))
    return np.array([rewards[t] + (discount * phi(t + 1) - phi(t)) for t in n])


def shaped_6(rewards, potentials, ended, discount):
    p = potentials.copy()
    # the first state of the episode is never the last one of a step
    if ended and rewards.size:
        p[rewards.size] = 0
    shaped = rewards.astype(float).copy()
    shaped -= p[:-1]
    shaped += np.multiply(discount, p[1:])
    return shaped


def shaped_7(rewards, potentials, ended, discount):
    answer = []
    k = 0
    while k < len(rewards):
        total = rewards[k]
        total -= potentials[k]
        if not (ended and k + 1 == len(rewards)):
            total += discount * potentials[k + 1]
        answer.append(total)
        k += 1
    return np.array(answer)


def shaped_8(rewards, potentials, ended, discount):
    T = len(rewards)
    matrix = discount * np.eye(T + 1, k=1)[:T] - np.eye(T + 1)[:T]
    if ended:
        matrix[:, T] = 0
    return rewards + matrix @ potentials
