"""Twelve ways to write exercise 2.6, as students who do not know each other would."""

from collections import defaultdict

import numpy as np


def first_visits_1(states, rewards, discount, size):
    total = np.zeros(size)
    count = np.zeros(size, dtype=int)
    for episode, reward in zip(states, rewards):
        G = 0
        returns = np.zeros(len(episode))
        for t in range(len(episode) - 1, -1, -1):
            G = reward[t] + discount * G
            returns[t] = G
        seen = set()
        for t, s in enumerate(episode):
            if s not in seen:
                seen.add(s)
                total[s] += returns[t]
                count[s] += 1
    return np.divide(total, count, out=np.zeros(size), where=count > 0), count


def first_visits_2(states, rewards, discount, size):
    returns = [[] for _ in range(size)]
    for episode, reward in zip(states, rewards):
        for s in set(episode):
            first = episode.index(s)
            G = 0.0
            for k, r in enumerate(reward[first:]):
                G += discount**k * r
            returns[s].append(G)
    values = [np.mean(x) if x else 0.0 for x in returns]
    counts = [len(x) for x in returns]
    return np.array(values), np.array(counts)


def first_visits_3(states, rewards, discount, size):
    values, visits = np.zeros(size), np.zeros(size, int)
    for path, gains in zip(states, rewards):
        g, latest = 0.0, {}
        for s, r in zip(path[::-1], gains[::-1]):
            g = r + discount * g
            latest[s] = g
        for s, g in latest.items():
            visits[s] += 1
            values[s] += (g - values[s]) / visits[s]
    return values, visits


def first_visits_4(states, rewards, discount, size):
    sums = defaultdict(float)
    number = defaultdict(int)
    for i in range(len(states)):
        s_list, r_list = states[i], rewards[i]
        powers = discount ** np.arange(len(r_list))
        for t in range(len(s_list)):
            if s_list[t] in s_list[:t]:
                continue
            sums[s_list[t]] += np.dot(powers[: len(r_list) - t], r_list[t:])
            number[s_list[t]] += 1
    v = [sums[s] / number[s] if number[s] else 0 for s in range(size)]
    return v, [number[s] for s in range(size)]


def first_visits_5(states, rewards, discount, size):
    N = np.zeros(size, dtype=np.int64)
    V = np.zeros(size)
    for e in range(len(states)):
        future = 0.0
        for t in reversed(range(len(states[e]))):
            future = discount * future + rewards[e][t]
            if states[e].index(states[e][t]) == t:
                N[states[e][t]] += 1
                V[states[e][t]] += future
    V[N > 0] /= N[N > 0]
    return V, N


def first_visits_6(states, rewards, discount, size):
    table = np.full((len(states), size), np.nan)
    for row, (visited, earned) in enumerate(zip(states, rewards)):
        ret = 0.0
        for k in range(len(visited)):
            j = len(visited) - 1 - k
            ret = earned[j] + discount * ret
            table[row, visited[j]] = ret
    count = (~np.isnan(table)).sum(axis=0)
    mean = np.nansum(table, axis=0) / np.where(count == 0, 1, count)
    return mean, count


def first_visits_7(states, rewards, discount, size):
    def discounted(rs):
        return rs[0] + discount * discounted(rs[1:]) if len(rs) else 0.0

    total, n = [0.0] * size, [0] * size
    for ep, rs in zip(states, rewards):
        for s in range(size):
            if s in ep:
                n[s] += 1
                total[s] += discounted(list(rs)[ep.index(s) :])
    return [a / max(b, 1) for a, b in zip(total, n)], n


def first_visits_8(states, rewards, discount, size):
    collected = {}
    for ep, rew in zip(states, rewards):
        ep, rew = np.array(ep), np.array(rew, dtype=float)
        unique, where = np.unique(ep, return_index=True)
        for s, start in zip(unique, where):
            tail = rew[start:]
            value = (tail * discount ** np.arange(tail.size)).sum()
            collected.setdefault(int(s), []).append(value)
    mean = np.zeros(size)
    count = np.zeros(size, dtype=int)
    for s, all_returns in collected.items():
        mean[s] = sum(all_returns) / len(all_returns)
        count[s] = len(all_returns)
    return mean, count


def first_visits_9(states, rewards, discount, size):
    values = []
    counts = []
    for state in range(size):
        gathered, hits = 0.0, 0
        for ep, rw in zip(states, rewards):
            started, weight, g = False, 1.0, 0.0
            for s, r in zip(ep, rw):
                started = started or s == state
                if started:
                    g += weight * r
                    weight *= discount
            if started:
                gathered += g
                hits += 1
        values.append(gathered / hits if hits else 0.0)
        counts.append(hits)
    return values, counts


def first_visits_10(states, rewards, discount, size):
    total, visits = np.zeros(size), np.zeros(size, dtype=int)
    for s_seq, r_seq in zip(states, rewards):
        first = [t for t, s in enumerate(s_seq) if s_seq.index(s) == t]
        g = [0.0] * (len(s_seq) + 1)
        for t in range(len(s_seq))[::-1]:
            g[t] = r_seq[t] + discount * g[t + 1]
        for t in first:
            total[s_seq[t]] += g[t]
            visits[s_seq[t]] += 1
    with np.errstate(invalid="ignore"):
        return np.nan_to_num(total / visits), visits


def first_visits_11(states, rewards, discount, size):
    pairs = []
    for ep, rw in zip(states, rewards):
        done = []
        open_returns = {}
        for s, r in zip(ep, rw):
            if s not in done:
                done.append(s)
                open_returns[s] = [0.0, 1.0]
            for entry in open_returns.values():
                entry[0] += entry[1] * r
                entry[1] *= discount
        pairs += [(s, entry[0]) for s, entry in open_returns.items()]
    ids = np.array([s for s, _ in pairs], dtype=int)
    gs = np.array([g for _, g in pairs])
    count = np.bincount(ids, minlength=size)
    return np.bincount(ids, gs, minlength=size) / np.maximum(count, 1), count


def first_visits_12(states, rewards, discount, size):
    average = np.zeros(size)
    episodes = np.zeros(size, dtype=int)
    for n in range(len(states)):
        length = len(states[n])
        matrix = np.triu(
            discount ** np.abs(np.subtract.outer(np.arange(length), np.arange(length)))
        )
        following = matrix @ np.array(rewards[n], dtype=float)
        for t in reversed(range(length)):
            if states[n][t] not in states[n][:t]:
                s = states[n][t]
                average[s] = average[s] * episodes[s] + following[t]
                episodes[s] += 1
                average[s] /= episodes[s]
    return average, episodes
