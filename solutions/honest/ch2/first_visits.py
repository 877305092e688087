"""Thirty ways to write exercise 2.6, as students who do not know each other would."""

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


def first_visits_13(states, rewards, discount, size):
    sum_of_returns = [0.0 for _ in range(size)]
    number_of_episodes = [0 for _ in range(size)]
    for episode_number in range(len(states)):
        episode_states = states[episode_number]
        episode_rewards = rewards[episode_number]
        visited = [False] * size
        for start in range(len(episode_states)):
            state = episode_states[start]
            if visited[state]:
                continue
            visited[state] = True
            the_return = 0.0
            factor = 1.0
            for later in range(start, len(episode_rewards)):
                the_return = the_return + factor * episode_rewards[later]
                factor = factor * discount
            sum_of_returns[state] += the_return
            number_of_episodes[state] += 1
    means = []
    for state in range(size):
        if number_of_episodes[state] == 0:
            means.append(0.0)
        else:
            means.append(sum_of_returns[state] / number_of_episodes[state])
    return np.array(means), np.array(number_of_episodes)


def first_visits_14(states, rewards, discount, size):
    from itertools import accumulate

    found = [dict() for _ in states]
    for d, s, r in zip(found, states, rewards):
        gs = list(accumulate(reversed(r), lambda g, x: x + discount * g))[::-1]
        d.update(zip(reversed(s), reversed(gs)))
    counts = np.array([sum(s in d for d in found) for s in range(size)], dtype=int)
    sums = np.array([sum(d.get(s, 0.0) for d in found) for s in range(size)])
    return sums / np.maximum(counts, 1), counts


def first_visits_15(states, rewards, discount, size):
    class Average:
        def __init__(self):
            self.n = 0
            self.mean = 0.0

        def add(self, x):
            self.n += 1
            self.mean += (x - self.mean) / self.n

    table = [Average() for _ in range(size)]
    for path, payoff in zip(states, rewards):
        G = 0.0
        for t in range(len(path) - 1, -1, -1):
            G = discount * G + payoff[t]
            if path[t] not in path[:t]:
                table[path[t]].add(G)
    return np.array([a.mean for a in table]), np.array([a.n for a in table])


def first_visits_16(states, rewards, discount, size):
    V = np.zeros(size)
    N = np.zeros(size, dtype=int)
    for ep, rew in zip(map(np.asarray, states), map(np.asarray, rewards)):
        if ep.size == 0:
            continue
        weights = discount ** np.arange(ep.size)
        for s in np.unique(ep):
            t = np.argmax(ep == s)
            V[s] += weights[: ep.size - t] @ rew[t:]
            N[s] += 1
    seen = N > 0
    V[seen] = V[seen] / N[seen]
    return V, N


def first_visits_17(states, rewards, discount, size):
    def returns(rs):
        out = [0.0]
        for r in reversed(rs):
            out.insert(0, r + discount * out[0])
        return out[:-1]

    gathered = defaultdict(list)
    for ep, rs in zip(states, rewards):
        remaining = set(ep)
        for s, g in zip(ep, returns(rs)):
            if s in remaining:
                remaining.remove(s)
                gathered[s].append(g)
    mean = [float(np.mean(gathered[s])) if s in gathered else 0.0 for s in range(size)]
    return mean, [len(gathered[s]) if s in gathered else 0 for s in range(size)]


def first_visits_18(states, rewards, discount, size):
    first = np.full((len(states), size), -1)
    for e, ep in enumerate(states):
        for t in range(len(ep)):
            if first[e, ep[t]] < 0:
                first[e, ep[t]] = t
    totals = np.zeros(size)
    for e in range(len(states)):
        G = np.zeros(len(rewards[e]) + 1)
        for t in range(len(rewards[e]) - 1, -1, -1):
            G[t] = rewards[e][t] + discount * G[t + 1]
        for s in np.where(first[e] >= 0)[0]:
            totals[s] += G[first[e, s]]
    visited = (first >= 0).sum(axis=0)
    return np.where(visited, totals / np.maximum(visited, 1), 0.0), visited


def first_visits_19(states, rewards, discount, size):
    count = np.zeros(size, dtype=int)
    total = np.zeros(size)
    for s_list, r_list in zip(states, rewards):
        active = {}
        factor = {}
        for s, r in zip(s_list, r_list):
            active.setdefault(s, 0.0)
            factor.setdefault(s, 1.0)
            for key in active:
                active[key] += factor[key] * r
                factor[key] *= discount
        for key, value in active.items():
            count[key] += 1
            total[key] += value
    for s in range(size):
        if count[s] > 1:
            total[s] /= count[s]
    return total, count


def first_visits_20(states, rewards, discount, size):
    if len(states) == 0:
        return np.zeros(size), np.zeros(size, dtype=int)
    values, counts = first_visits_20(states[:-1], rewards[:-1], discount, size)
    ep, rs = states[-1], rewards[-1]
    g = 0.0
    newest = np.full(size, np.nan)
    for k in range(len(ep)):
        g = rs[-1 - k] + discount * g
        newest[ep[-1 - k]] = g
    hit = np.isfinite(newest)
    values[hit] = (values[hit] * counts[hit] + newest[hit]) / (counts[hit] + 1)
    counts[hit] += 1
    return values, counts


def first_visits_21(states, rewards, discount, size):
    rows = []
    for i, ep in enumerate(states):
        T = len(ep)
        for t, s in enumerate(ep):
            rows.append(
                (i, s, t, sum(discount ** (k - t) * rewards[i][k] for k in range(t, T)))
            )
    rows.sort()
    picked = {}
    for i, s, t, g in rows:
        if (i, s) not in picked:
            picked[i, s] = g
    n = np.zeros(size, dtype=int)
    v = np.zeros(size)
    for (_, s), g in picked.items():
        v[s] += g
        n[s] += 1
    n_safe = n + (n == 0)
    return v / n_safe, n


def first_visits_22(states, rewards, discount, size):
    visits = np.array([sum(s in ep for ep in states) for s in range(size)], dtype=int)
    values = np.zeros(size)
    for s in range(size):
        for ep, rew in zip(states, rewards):
            try:
                start = list(ep).index(s)
            except ValueError:
                continue
            tail = rew[start:]
            values[s] += np.polyval(tail[::-1], discount) / visits[s]
    return values, visits


def first_visits_23(states, rewards, discount, size):
    S = np.zeros((size, 2))
    for episode in range(len(states)):
        already = np.zeros(size, dtype=bool)
        t = 0
        while t < len(states[episode]):
            s = states[episode][t]
            if not already[s]:
                already[s] = True
                ret, k = 0, t
                while k < len(rewards[episode]):
                    ret += discount ** (k - t) * rewards[episode][k]
                    k += 1
                S[s] += [ret, 1]
            t += 1
    counts = S[:, 1].astype(int)
    counts_or_one = np.where(counts > 0, counts, 1)
    return S[:, 0] / counts_or_one, counts


def first_visits_24(states, rewards, discount, size):
    from collections import Counter

    n, g_total = Counter(), Counter()
    for ep, rs in zip(states, rewards):
        n.update(set(ep))
        future = {}
        g = 0.0
        for s, r in reversed(list(zip(ep, rs))):
            g = r + discount * g
            future[s] = g
        g_total.update(future)
    value = np.array([g_total[s] / n[s] if n[s] else 0.0 for s in range(size)])
    return value, np.array([n[s] for s in range(size)])


def first_visits_25(states, rewards, discount, size):
    def per_episode(ep, rs):
        g, seen_returns = 0.0, np.zeros(size)
        for s, r in zip(reversed(ep), reversed(rs)):
            g = r + discount * g
            seen_returns[s] = g
        indicator = np.zeros(size, dtype=int)
        indicator[list(ep)] = 1
        return seen_returns, indicator

    results = [per_episode(list(ep), list(rs)) for ep, rs in zip(states, rewards)]
    total = sum((x for x, _ in results), np.zeros(size))
    number = sum((c for _, c in results), np.zeros(size, dtype=int))
    return np.divide(total, number, where=number != 0, out=np.zeros(size)), number


def first_visits_26(states, rewards, discount, size):
    from scipy.signal import lfilter

    lists = {s: [] for s in range(size)}
    for ep, rs in zip(states, rewards):
        if not ep:
            continue
        returns = lfilter([1.0], [1.0, -discount], np.array(rs, float)[::-1])[::-1]
        order = list(dict.fromkeys(ep))
        for s in order:
            lists[s].append(returns[ep.index(s)])
    averages = [sum(x) / len(x) if len(x) else 0.0 for x in lists.values()]
    return np.array(averages), np.array([len(x) for x in lists.values()])


def first_visits_27(states, rewards, discount, size):
    mean = np.zeros(size)
    N = np.zeros(size, dtype=int)
    for i in range(len(states)):
        G_t = {}
        G = 0
        for t in list(range(len(states[i])))[::-1]:
            G *= discount
            G += rewards[i][t]
            G_t[t] = G
        for s in range(size):
            times = [t for t in range(len(states[i])) if states[i][t] == s]
            if times:
                N[s] += 1
                mean[s] = mean[s] * (N[s] - 1) / N[s] + G_t[min(times)] / N[s]
    return mean, N


def first_visits_28(states, rewards, discount, size):
    samples = []
    for ep, rw in zip(states, rewards):
        returns = np.zeros(len(ep))
        running = 0.0
        for t in range(len(ep)):
            running = rw[len(ep) - 1 - t] + discount * running
            returns[len(ep) - 1 - t] = running
        where = {}
        for t in range(len(ep)):
            if ep[t] not in where:
                where[ep[t]] = t
        samples.extend((s, returns[t]) for s, t in where.items())
    counts = np.zeros(size, dtype=int)
    sums = np.zeros(size)
    np.add.at(counts, [s for s, _ in samples], 1)
    np.add.at(sums, [s for s, _ in samples], [g for _, g in samples])
    sums[counts > 0] /= counts[counts > 0]
    return sums, counts


def first_visits_29(states, rewards, discount, size):
    episodes = list(zip(states, rewards))

    def first_return(state, ep, rs):
        position = ep.index(state)
        g = 0.0
        for r in rs[: position - 1 if position else None : -1]:
            g = r + discount * g
        return g

    values = np.zeros(size)
    counts = np.zeros(size, dtype=np.int64)
    for state in range(size):
        with_it = [(list(ep), list(rs)) for ep, rs in episodes if state in ep]
        counts[state] = len(with_it)
        if with_it:
            values[state] = np.mean([first_return(state, *pair) for pair in with_it])
    return values, counts


def first_visits_30(states, rewards, discount, size):
    v_sum, v_num = np.zeros(size), np.zeros(size, dtype=int)
    for path, rs in zip(states, rewards):
        n = len(path)
        g = np.array(rs, dtype=float)
        for t in range(n - 2, -1, -1):
            g[t] += discount * g[t + 1]
        for t in range(n):
            repeated = False
            for u in range(t):
                if path[u] == path[t]:
                    repeated = True
            if not repeated:
                v_sum[path[t]] += g[t]
                v_num[path[t]] += 1
    v_sum[v_num == 0] = 0
    return v_sum / np.clip(v_num, 1, None), v_num
