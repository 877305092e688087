"""Eight ways to write exercise 5.5, as students who do not know each other would."""

import math

import numpy as np


def reweighted_1(log_p, log_q, features, most):
    log_w = log_p - log_q
    log_w = log_w - np.max(log_w)
    w = np.exp(log_w)
    w = w / np.mean(w)
    w[w > most] = most
    w = w / np.sum(w)
    estimate = np.sum(w[:, None] * features, axis=0)
    return estimate, 1 / np.sum(w**2)


def reweighted_2(log_p, log_q, features, most):
    from scipy.special import logsumexp

    N = len(log_p)
    ratio = np.subtract(log_p, log_q)
    w = np.exp(ratio - logsumexp(ratio) + np.log(N))
    w = w.clip(max=most)
    w = w / w.sum()
    return np.dot(w, features), float(1.0 / np.dot(w, w))


def reweighted_3(log_p, log_q, features, most):
    differences = [p - q for p, q in zip(log_p, log_q)]
    top = max(differences)
    weights = [math.exp(d - top) for d in differences]
    mean = sum(weights) / len(weights)
    weights = [min(w / mean, most) for w in weights]
    total = sum(weights)
    weights = [w / total for w in weights]
    result = [0.0] * features.shape[1]
    for w, row in zip(weights, features):
        for j, x in enumerate(row):
            result[j] += w * x
    return np.array(result), 1 / sum(w * w for w in weights)


def reweighted_4(log_p, log_q, features, most):
    def softmax(x):
        e = np.exp(x - x.max())
        return e / e.sum()

    shares = softmax(log_p - log_q)
    clipped = np.where(shares * len(shares) > most, most / len(shares), shares)
    final = clipped / clipped.sum()
    return np.einsum("n,nk->k", final, features), 1 / np.square(final).sum()


def reweighted_5(log_p, log_q, features, most):
    # the limit is applied to the logarithm
    delta = log_p - log_q
    log_mean = np.logaddexp.reduce(delta) - math.log(len(delta))
    scaled = np.minimum(delta - log_mean, math.log(most))
    log_norm = np.logaddexp.reduce(scaled)
    weights = np.exp(scaled - log_norm)
    return features.T @ weights, float(
        np.exp(-np.logaddexp.reduce(2 * (scaled - log_norm)))
    )


def reweighted_6(log_p, log_q, features, most):
    n = log_p.shape[0]
    w = np.zeros(n)
    largest = (log_p - log_q).max()
    for i in range(n):
        w[i] = np.exp(log_p[i] - log_q[i] - largest)
    w *= n / w.sum()
    for i in range(n):
        if w[i] > most:
            w[i] = most
    w /= w.sum()
    return np.average(features, axis=0, weights=w), 1.0 / (w * w).sum()


def reweighted_7(log_p, log_q, features, most):
    importance = np.exp((log_p - log_q) - np.amax(log_p - log_q))
    importance = np.true_divide(importance, importance.mean())
    importance = np.fmin(importance, most)
    ess = importance.sum() ** 2 / (importance**2).sum()
    estimate = (importance.reshape(-1, 1) * features).sum(axis=0) / importance.sum()
    return estimate, ess


def reweighted_8(log_p, log_q, features, most):
    ratio = log_p - log_q
    order = ratio.argsort()[::-1]
    w = np.exp(ratio[order] - ratio[order[0]])
    w = w * w.size / w.sum()
    w = np.concatenate([np.full((w > most).sum(), most), w[~(w > most)]])
    w = w / np.linalg.norm(w, 1)
    return w @ features[order], float(np.linalg.norm(w) ** -2)
