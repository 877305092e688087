"""Known mistakes in 4.7; a function's docstring is its hint."""

import numpy as np


def _counts(successes, block):
    blocks = successes.shape[1] // block
    return (
        successes[:, : blocks * block]
        .reshape(len(successes), blocks, block)
        .sum(axis=2)
    )


def spread_of_seeds(successes, block, draws):
    """This is the spread of single seeds. Resample the seeds, and take the mean of each resample."""
    counts = _counts(successes, block)
    return counts.mean(axis=0), np.percentile(counts, [2.5, 97.5], axis=0)


def same_for_all_blocks(successes, block, draws):
    """Compute an interval for every block: take the mean of each resample over its seeds only."""
    counts = _counts(successes, block)
    ends = np.percentile(counts[draws].mean(axis=(1, 2)), [2.5, 97.5])
    return counts.mean(axis=0), np.repeat(ends[:, None], counts.shape[1], axis=1)


def fractions(successes, block, draws):
    """Count the successes in a block; do not divide by its length."""
    counts = _counts(successes, block) / block
    return counts.mean(axis=0), np.percentile(
        counts[draws].mean(axis=1), [2.5, 97.5], axis=0
    )


def sums_over_seeds(successes, block, draws):
    """Take the mean over the seeds, not their sum."""
    counts = _counts(successes, block)
    return counts.sum(axis=0), np.percentile(
        counts[draws].sum(axis=1), [2.5, 97.5], axis=0
    )


def wide_as_ninety(successes, block, draws):
    """A 95 % interval leaves out 2.5 % at either end."""
    counts = _counts(successes, block)
    return counts.mean(axis=0), np.percentile(
        counts[draws].mean(axis=1), [5, 95], axis=0
    )


def strides(successes, block, draws):
    """A block is made of episodes that follow one another."""
    blocks = successes.shape[1] // block
    counts = (
        successes[:, : blocks * block]
        .reshape(len(successes), block, blocks)
        .sum(axis=1)
    )
    return counts.mean(axis=0), np.percentile(
        counts[draws].mean(axis=1), [2.5, 97.5], axis=0
    )


def as_if_normal(successes, block, draws):
    """Use the percentiles of the resamples' means: they assume no normal distribution."""
    counts = _counts(successes, block)
    spread = 1.96 * counts[draws].mean(axis=1).std(axis=0)
    mean = counts.mean(axis=0)
    return mean, np.stack([mean - spread, mean + spread])


def as_if_normal_without_draws(successes, block, draws):
    """Use the percentiles of the resamples' means: they assume no normal distribution."""
    counts = _counts(successes, block)
    mean = counts.mean(axis=0)
    spread = 1.96 * counts.std(axis=0, ddof=1) / np.sqrt(len(counts))
    return mean, np.stack([mean - spread, mean + spread])


def mean_and_deviation(successes, block, draws):
    """A standard deviation says how far single seeds are apart. Here the interval of their mean is asked for."""
    counts = _counts(successes, block)
    mean, spread = counts.mean(axis=0), counts.std(axis=0)
    return mean, np.stack([mean - spread, mean + spread])


def mean_and_sample_deviation(successes, block, draws):
    """A standard deviation says how far single seeds are apart. Here the interval of their mean is asked for."""
    counts = _counts(successes, block)
    mean, spread = counts.mean(axis=0), counts.std(axis=0, ddof=1)
    return mean, np.stack([mean - spread, mean + spread])


def sums_of_resamples(successes, block, draws):
    """Take the mean of each resample over its seeds, not the sum."""
    counts = _counts(successes, block)
    sums = counts[draws].sum(axis=1)
    return counts.mean(axis=0), np.percentile(sums, [2.5, 97.5], axis=0)


def mean_over_resamples(successes, block, draws):
    """Take each resample's mean over its seeds, then the percentiles over the resamples."""
    counts = _counts(successes, block)
    return counts.mean(axis=0), np.percentile(
        counts[draws].mean(axis=0), [2.5, 97.5], axis=0
    )


def centre_of_the_resamples(successes, block, draws):
    """The curve is the mean over the seeds themselves: the resamples are for its interval."""
    resampled = _counts(successes, block)[draws].mean(axis=1)
    return resampled.mean(axis=0), np.percentile(resampled, [2.5, 97.5], axis=0)


def counts_the_rest(successes, block, draws):
    """Leave out the last episodes if they do not fill a block."""
    rest = -successes.shape[1] % block
    filled = np.pad(successes, ((0, 0), (0, rest)))
    counts = filled.reshape(len(successes), -1, block).sum(axis=2)
    return counts.mean(axis=0), np.percentile(
        counts[draws].mean(axis=1), [2.5, 97.5], axis=0
    )
