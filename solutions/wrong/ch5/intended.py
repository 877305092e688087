"""Known mistakes in 5.2; a function's docstring is its hint."""

import numpy as np


def _meant(states, done, slip, prior, size, *, unseen=-1, use_prior=True, turned=False, prior_each=False):
    with np.errstate(divide="ignore"):
        log_slip, log_prior = np.log(slip.T if turned else slip), np.log(prior if use_prior else np.ones_like(prior))
    meant = np.full(size, unseen)
    for state in np.unique(states):
        seen = done[states == state]
        meant[state] = np.argmax(log_prior * (len(seen) if prior_each else 1) + log_slip[:, seen].sum(axis=1))
    return meant


def most_frequent(states, done, slip, prior, size):
    """This is what was done most often; what was meant may be another action, if that one slips."""
    meant = np.full(size, -1)
    for state in np.unique(states):
        meant[state] = np.bincount(done[states == state], minlength=len(prior)).argmax()
    return meant


def no_prior(*arguments):
    """Multiply by the prior: of two actions that explain what was done alike, the expert means the usual one."""
    return _meant(*arguments, use_prior=False)


def prior_each_time(*arguments):
    """The prior counts once for a state, not once for each time it was seen."""
    return _meant(*arguments, prior_each=True)


def turned_around(*arguments):
    """A row of the slip matrix is what was meant, a column what was done."""
    return _meant(*arguments, turned=True)


def first_action_unseen(*arguments):
    """A state that was never seen has no action: answer with -1."""
    return _meant(*arguments, unseen=0)


def products(states, done, slip, prior, size):
    """A product of many probabilities is zero for a computer: add up their logarithms."""
    meant = np.full(size, -1)
    for state in np.unique(states):
        meant[state] = np.argmax(prior * slip[:, done[states == state]].prod(axis=1))
    return meant
