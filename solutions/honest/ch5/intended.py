"""Eight ways to write exercise 5.2, as students who do not know each other would."""

import math

import numpy as np


def intended_1(states, done, slip, prior, size):
    result = np.full(size, -1)
    for s in range(size):
        acts = done[states == s]
        if len(acts) == 0:
            continue
        best, best_score = -1, -np.inf
        for a in range(len(prior)):
            if prior[a] == 0 or np.any(slip[a, acts] == 0):
                continue
            score = np.log(prior[a]) + np.sum(np.log(slip[a, acts]))
            if score > best_score:
                best, best_score = a, score
        result[s] = best
    return result


def intended_2(states, done, slip, prior, size):
    A = len(prior)
    counts = np.zeros((size, A))
    np.add.at(counts, (states, done), 1)
    with np.errstate(divide="ignore", invalid="ignore"):
        terms = counts[:, None, :] * np.log(slip)[None]
        terms[np.isnan(terms)] = 0
        score = np.log(prior) + terms.sum(axis=2)
    return np.where(counts.sum(axis=1) > 0, score.argmax(axis=1), -1)


def intended_3(states, done, slip, prior, size):
    def log(x):
        return math.log(x) if x > 0 else -math.inf

    score = {}
    for s, d in zip(states.tolist(), done.tolist()):
        row = score.setdefault(s, [log(p) for p in prior])
        for a in range(len(row)):
            row[a] += log(slip[a][d])
    return np.array(
        [score[s].index(max(score[s])) if s in score else -1 for s in range(size)]
    )


def intended_4(states, done, slip, prior, size):
    # Bayes after each step, scaled so that nothing vanishes
    posterior = np.tile(prior / prior.max(), (size, 1))
    seen = np.zeros(size, dtype=bool)
    logs = np.where(posterior > 0, np.log(np.maximum(posterior, 1e-300)), -np.inf)
    for i in range(len(states)):
        s = states[i]
        seen[s] = True
        column = slip[:, done[i]]
        logs[s] = np.where(
            column > 0, logs[s] + np.log(np.where(column > 0, column, 1)), -np.inf
        )
    best = np.argmax(logs, axis=1)
    best[~seen] = -1
    return best


def intended_5(states, done, slip, prior, size):
    answer = [-1] * size
    for s in set(states.tolist()):
        total = [0.0] * len(prior)
        possible = [p > 0 for p in prior]
        for state, action in zip(states, done):
            if state != s:
                continue
            for meant in range(len(prior)):
                if slip[meant, action] == 0:
                    possible[meant] = False
                else:
                    total[meant] += math.log(slip[meant, action])
        options = [a for a in range(len(prior)) if possible[a]]
        answer[s] = max(options, key=lambda a: total[a] + math.log(prior[a]))
    return np.array(answer)


def intended_6(states, done, slip, prior, size):
    A = prior.size
    hist = np.bincount(states * A + done, minlength=size * A).reshape(size, A)
    impossible = (hist @ (slip == 0).T.astype(int)) > 0
    safe = np.log(np.where(slip == 0, 1.0, slip))
    log_posterior = hist @ safe.T + np.log(np.where(prior == 0, 1.0, prior))
    log_posterior[impossible | (prior == 0)] = -np.inf
    found = log_posterior.argmax(1)
    found[hist.sum(1) == 0] = -1
    return found


def intended_7(states, done, slip, prior, size):
    order = np.argsort(states, kind="stable")
    sorted_states, sorted_done = states[order], done[order]
    unique, begins = np.unique(sorted_states, return_index=True)
    np.seterr(divide="ignore")
    log_slip = np.log(slip)
    meant = -np.ones(size, dtype=int)
    for s, actions in zip(unique, np.split(sorted_done, begins[1:])):
        log_likelihood = np.zeros(len(prior))
        for d in actions:
            log_likelihood += log_slip[:, d]
        meant[s] = (log_likelihood + np.log(prior)).argmax()
    return meant


def intended_8(states, done, slip, prior, size):
    class State:
        def __init__(self):
            self.scores = None

        def see(self, d):
            if self.scores is None:
                self.scores = np.log(prior)
            self.scores = self.scores + np.log(slip)[:, d]

        def best(self):
            return -1 if self.scores is None else int(self.scores.argmax())

    table = [State() for _ in range(size)]
    with np.errstate(divide="ignore"):
        for i in range(states.size):
            table[states[i]].see(done[i])
    return np.array([state.best() for state in table])
