"""Eight ways to write exercise 4.7, as students who do not know each other would."""

import numpy as np


def band_1(successes, block, draws):
    S, E = successes.shape
    B = E // block
    counts = np.zeros((S, B))
    for b in range(B):
        counts[:, b] = successes[:, b * block : (b + 1) * block].sum(axis=1)
    means = counts.mean(axis=0)
    boot = np.array([counts[d].mean(axis=0) for d in draws])
    return means, np.percentile(boot, [2.5, 97.5], axis=0)


def band_2(successes, block, draws):
    per_seed = []
    for row in successes:
        line = []
        for start in range(0, len(row) - block + 1, block):
            line.append(sum(int(x) for x in row[start : start + block]))
        per_seed.append(line)
    per_seed = np.array(per_seed)
    resamples = []
    for drawn in draws:
        resamples.append(np.mean([per_seed[s] for s in drawn], axis=0))
    lower = np.percentile(resamples, 2.5, axis=0)
    upper = np.percentile(resamples, 97.5, axis=0)
    return np.mean(per_seed, axis=0), np.array([lower, upper])


def band_3(successes, block, draws):
    n = successes.shape[1] - successes.shape[1] % block
    pieces = np.split(successes[:, :n], n // block, axis=1) if n else []
    hits = np.array([piece.sum(axis=1) for piece in pieces])  # (B, S)
    means = hits.mean(axis=1)
    drawn = hits[:, draws].mean(axis=2)
    return means, np.percentile(drawn, (2.5, 97.5), axis=1)


def band_4(successes, block, draws):
    cumulative = np.cumsum(successes, axis=1)
    ends = cumulative[:, block - 1 :: block]
    counts = np.diff(ends, axis=1, prepend=0)
    sample_means = np.mean(np.take(counts, draws, axis=0), axis=1)
    return np.mean(counts, axis=0), np.percentile(sample_means, q=[2.5, 97.5], axis=0)


def band_5(successes, block, draws):
    blocks = successes.shape[1] // block
    # how often each seed is in each resample
    times = np.array([np.bincount(d, minlength=len(successes)) for d in draws])
    membership = np.repeat(np.eye(blocks), block, axis=0)
    counts = successes[:, : blocks * block].astype(int) @ membership
    resampled = times @ counts / draws.shape[1]
    return counts.sum(axis=0) / len(counts), np.percentile(
        resampled, [2.5, 97.5], axis=0
    )


def band_6(successes, block, draws):
    starts = np.arange(0, successes.shape[1] // block * block, block)
    cut = successes[:, : len(starts) * block]
    counts = np.add.reduceat(cut.astype(int), starts, axis=1)
    curve = counts.mean(0)
    ends = np.zeros((2, len(starts)))
    for b in range(len(starts)):
        column = counts[:, b]
        ends[:, b] = np.percentile(column[draws].mean(1), [2.5, 97.5])
    return curve, ends


def band_7(successes, block, draws):
    def count(seed, b):
        return np.count_nonzero(successes[seed, b * block : b * block + block])

    S, B = len(successes), successes.shape[1] // block
    table = np.array([[count(s, b) for b in range(B)] for s in range(S)])
    mean = table.sum(axis=0) / S
    stars = np.empty((len(draws), B))
    for r, seeds in enumerate(draws):
        stars[r] = table[list(seeds)].sum(axis=0) / len(seeds)
    return mean, np.vstack([np.percentile(stars, p, axis=0) for p in (2.5, 97.5)])


def band_8(successes, block, draws):
    import pandas as pd

    B = successes.shape[1] // block
    table = pd.DataFrame(successes[:, : B * block].astype(int).T)
    counts = table.groupby(np.arange(B * block) // block).sum().to_numpy()
    star = np.stack([counts[:, d].mean(axis=1) for d in draws])
    low, high = np.percentile(star, [2.5, 97.5], axis=0)
    return counts.mean(axis=1), np.stack([low, high])
