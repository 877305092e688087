"""Known mistakes in 5.2; a function's docstring is its hint."""

import numpy as np


def _meant(
    states,
    done,
    slip,
    prior,
    size,
    *,
    unseen=-1,
    use_prior=True,
    turned=False,
    prior_each=False,
):
    with np.errstate(divide="ignore"):
        log_slip, log_prior = (
            np.log(slip.T if turned else slip),
            np.log(prior if use_prior else np.ones_like(prior)),
        )
    meant = np.full(size, unseen)
    for state in np.unique(states):
        seen = done[states == state]
        meant[state] = np.argmax(
            log_prior * (len(seen) if prior_each else 1) + log_slip[:, seen].sum(axis=1)
        )
    return meant


def most_frequent(states, done, slip, prior, size):
    """This is the action that was done most often. The intended action may be another one, because actions slip."""
    meant = np.full(size, -1)
    for state in np.unique(states):
        meant[state] = np.bincount(done[states == state], minlength=len(prior)).argmax()
    return meant


def no_prior(*arguments):
    """Multiply by the prior: of two actions with equal likelihood, the one with the larger prior is more probable."""
    return _meant(*arguments, use_prior=False)


def prior_each_time(*arguments):
    """Multiply by the prior once for each state, not once for each step."""
    return _meant(*arguments, prior_each=True)


def turned_around(*arguments):
    """A row of the slip matrix is the intended action, and a column the action that was done."""
    return _meant(*arguments, turned=True)


def first_action_unseen(*arguments):
    """Return -1 for a state that was never seen."""
    return _meant(*arguments, unseen=0)


def prior_where_unseen(states, done, slip, prior, size):
    """Return -1 for a state that was never seen."""
    return _meant(states, done, slip, prior, size, unseen=int(np.argmax(prior)))


def products(states, done, slip, prior, size):
    """A product of many probabilities underflows to zero: add their logarithms."""
    meant = np.full(size, -1)
    for state in np.unique(states):
        meant[state] = np.argmax(prior * slip[:, done[states == state]].prod(axis=1))
    return meant


def zero_times_infinity(states, done, slip, prior, size):
    """0 times the logarithm of 0 is nan: add only the logarithms of the actions that were done."""
    with np.errstate(all="ignore"):
        log_slip, log_prior = np.log(slip), np.log(prior)
        meant = np.full(size, -1)
        for state in np.unique(states):
            counts = np.bincount(done[states == state], minlength=len(prior))
            meant[state] = np.argmax(log_prior + log_slip @ counts.astype(float))
    return meant


def nearly_zero(states, done, slip, prior, size):
    """A probability of 0 excludes an action: a small number in its place does not, if a state was seen often."""
    meant = np.full(size, -1)
    for state in np.unique(states):
        seen = done[states == state]
        likelihood = np.log(slip + 1e-9)[:, seen].sum(axis=1)
        meant[state] = np.argmax(np.log(prior + 1e-9) + likelihood)
    return meant


def last_of_equals(states, done, slip, prior, size):
    """Of several actions that are equally probable, return the one with the lowest index."""
    with np.errstate(divide="ignore"):
        log_slip, log_prior = np.log(slip), np.log(prior)
    meant = np.full(size, -1)
    for state in np.unique(states):
        log_p = log_prior + log_slip[:, done[states == state]].sum(axis=1)
        meant[state] = len(log_p) - 1 - np.argmax(log_p[::-1])
    return meant


def prior_alone(states, done, slip, prior, size):
    """Use what was done as well as the prior."""
    meant = np.full(size, -1)
    meant[np.unique(states)] = int(np.argmax(prior))
    return meant
