"""The compiled loops of asynchronous value iteration and the readable ones do the same."""

import numpy as np
import pytest
import scipy.sparse as sp

from robonav.mdp import (
    FiniteMDP,
    four_by_three,
    policy_iteration,
    prioritized_sweeping,
)
from robonav.mdp._fast import in_place_sweep as compiled_sweep
from robonav.mdp.asynchronous import in_place_sweep, prioritized_backups


def random_model(seed):
    rng = np.random.default_rng(seed)
    transitions = rng.dirichlet(np.full(20, 0.1), size=(3, 20))
    sparse = [sp.csr_array(np.where(t > 1e-3, t, 0)) for t in transitions]
    sparse = [sp.csr_array(sp.diags_array(1 / t.sum(axis=1)) @ t) for t in sparse]
    return FiniteMDP(sparse, rng.normal(size=(20, 3)), 0.9)


MODELS = [four_by_three().mdp(0.95), *map(random_model, range(4))]


@pytest.mark.parametrize("mdp", MODELS, ids=range(len(MODELS)))
def test_in_place_sweep_twins(mdp):
    readable, compiled = np.zeros((2, mdp.n_states))
    for _ in range(5):
        assert in_place_sweep(mdp, readable) == compiled_sweep(*mdp.arrays, compiled)
        np.testing.assert_array_equal(readable, compiled)


@pytest.mark.parametrize("mdp", MODELS, ids=range(len(MODELS)))
def test_prioritized_backups_twins(mdp):
    """Bit for bit where no two priorities are equal; on the grid, where they are, within the tolerance."""
    values = np.zeros(mdp.n_states)
    backups, largest = prioritized_backups(mdp, values, 1e-6 * 0.1 / 2, 100_000)
    compiled = prioritized_sweeping(mdp, 1e-6 * 0.1 / (1 - mdp.discount))
    if mdp is MODELS[0]:
        best = policy_iteration(mdp).values
        np.testing.assert_allclose(values, best, atol=1e-5)
        np.testing.assert_allclose(compiled.values, best, atol=1e-5)
        return
    np.testing.assert_array_equal(values, compiled.values)
    assert (backups, largest) == (compiled.iterations, compiled.residual)
