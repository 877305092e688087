"""Eight ways to write exercise 6.4, as students who do not know each other would."""

import numpy as np


def advantages_1(
    rewards, values, next_values, seconds, terminated, truncated, discount, decay
):
    T, N = rewards.shape
    result = np.zeros((T, N))
    for n in range(N):
        advantage = 0.0
        for t in reversed(range(T)):
            gamma = discount ** seconds[t, n]
            v_next = 0.0 if terminated[t, n] else next_values[t, n]
            delta = rewards[t, n] + gamma * v_next - values[t, n]
            if terminated[t, n] or truncated[t, n]:
                advantage = delta
            else:
                advantage = delta + gamma * decay * advantage
            result[t, n] = advantage
    return result


def advantages_2(
    rewards, values, next_values, seconds, terminated, truncated, discount, decay
):
    gamma = np.power(discount, seconds)
    delta = rewards - values + gamma * next_values * (1 - terminated)
    done = np.logical_or(terminated, truncated)
    A = delta.copy()
    for t in range(len(A) - 2, -1, -1):
        A[t] += ~done[t] * gamma[t] * decay * A[t + 1]
    return A


def advantages_3(
    rewards, values, next_values, seconds, terminated, truncated, discount, decay
):
    def robot(r, v, v2, tau, end, cut):
        found, later = [], 0.0
        for step in list(zip(r, v, v2, tau, end, cut))[::-1]:
            reward, value, following, duration, term, trunc = step
            g = discount**duration
            error = reward + (0 if term else g * following) - value
            later = error + (0 if term or trunc else g * decay * later)
            found.append(later)
        return found[::-1]

    tables = (rewards, values, next_values, seconds, terminated, truncated)
    columns = [robot(*(x[:, n] for x in tables)) for n in range(rewards.shape[1])]
    return np.array(columns).reshape(rewards.shape[1], rewards.shape[0]).T


def advantages_4(
    rewards, values, next_values, seconds, terminated, truncated, discount, decay
):
    if len(rewards) == 0:
        return np.zeros_like(rewards)
    rest = advantages_4(
        rewards[1:],
        values[1:],
        next_values[1:],
        seconds[1:],
        terminated[1:],
        truncated[1:],
        discount,
        decay,
    )
    g = discount ** seconds[0]
    own = rewards[0] + g * np.where(terminated[0], 0, next_values[0]) - values[0]
    following = rest[0] if len(rest) else np.zeros_like(own)
    own = own + np.where(terminated[0] | truncated[0], 0, g * decay * following)
    return np.vstack([own[None], rest])


def advantages_5(
    rewards, values, next_values, seconds, terminated, truncated, discount, decay
):
    steps = len(rewards)
    factor = discount**seconds
    bootstrapped = next_values.copy()
    bootstrapped[terminated] = 0
    td_error = rewards + factor * bootstrapped - values
    carry = factor * decay
    carry[terminated] = 0
    carry[truncated] = 0
    out = np.zeros((steps + 1, rewards.shape[1]))
    t = steps - 1
    while t >= 0:
        out[t] = td_error[t] + carry[t] * out[t + 1]
        t -= 1
    return out[:-1]


def advantages_6(
    rewards, values, next_values, seconds, terminated, truncated, discount, decay
):
    # a sum over all later steps, each with the product of what lies between
    T = len(rewards)
    g = discount**seconds
    delta = rewards + g * next_values * ~terminated - values
    c = decay * g * ~(terminated | truncated)
    A = np.zeros_like(delta)
    for t in range(T):
        weight = np.ones(delta.shape[1])
        for k in range(t, T):
            A[t] += weight * delta[k]
            weight = weight * c[k]
    return A


def advantages_7(
    rewards, values, next_values, seconds, terminated, truncated, discount, decay
):
    T, N = rewards.shape
    g = np.exp(seconds * np.log(discount)) if discount > 0 else np.zeros((T, N))
    delta = rewards + np.where(terminated, 0.0, g * next_values) - values
    k = np.where(np.logical_or(terminated, truncated), 0.0, decay * g)
    A = np.empty((T, N))
    for n in range(N):
        system = np.eye(T) - np.diag(k[:-1, n], 1)
        A[:, n] = np.linalg.solve(system, delta[:, n])
    return A


def advantages_8(
    rewards, values, next_values, seconds, terminated, truncated, discount, decay
):
    from itertools import accumulate

    def back(later, row):
        r, v, v2, tau, term, cut = row
        g = discount**tau
        flows = 1.0 - np.maximum(term, cut)
        return r - v + g * ((1.0 - term) * v2 + decay * flows * later)

    rows = zip(
        rewards,
        values,
        next_values,
        seconds,
        terminated.astype(float),
        truncated.astype(float),
    )
    found = list(
        accumulate(reversed(list(rows)), back, initial=np.zeros(rewards.shape[1]))
    )
    return np.array(found[1:][::-1])
