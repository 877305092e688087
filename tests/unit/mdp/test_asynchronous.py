"""Prioritised sweeping as written and compiled; in-place sweeps are tested with the other planners."""

import inspect

import numpy as np
import pytest
import scipy.sparse as sp

from robonav.mdp import (
    FiniteMDP,
    four_by_three,
    policy_iteration,
    prioritized_sweeping,
)


@pytest.mark.parametrize("seed", range(4))
def test_compiled_prioritized_sweeping(seed):
    """Bit for bit where no two priorities are equal."""
    rng = np.random.default_rng(seed)
    transitions = rng.dirichlet(np.full(20, 0.1), size=(3, 20))
    sparse = [sp.csr_array(np.where(t > 1e-3, t, 0)) for t in transitions]
    sparse = [sp.csr_array(sp.diags_array(1 / t.sum(axis=1)) @ t) for t in sparse]
    mdp = FiniteMDP(sparse, rng.normal(size=(20, 3)), 0.9)
    algorithm = inspect.unwrap(prioritized_sweeping)
    compiled = prioritized_sweeping(mdp)
    readable = algorithm(mdp)
    for name in ("values", "policy", "iterations", "residual", "converged"):
        np.testing.assert_array_equal(getattr(compiled, name), getattr(readable, name))


def test_prioritized_sweeping_as_written_where_priorities_tie():
    mdp = four_by_three().mdp(0.95)
    best = policy_iteration(mdp).values
    readable = inspect.unwrap(prioritized_sweeping)(mdp)
    np.testing.assert_allclose(readable.values, best, atol=1e-6)
