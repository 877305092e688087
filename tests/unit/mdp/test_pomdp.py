"""Beliefs, their update and their MDP, against brute force over whole histories."""

import itertools
import numbers

import numpy as np
import pytest
import scipy.sparse as sp
from hypothesis import given, settings
from hypothesis import strategies as st

from robonav.mdp import (
    POMDP,
    BeliefMDP,
    FiniteMDP,
    bayes,
    belief_rollout,
    corridor,
    entropy,
    tiger,
    without_sensing,
)

SEEDS = st.integers(0, 10**6)


def random_pomdp(seed, states=4, actions=3, observations=3, sparse=False):
    """A POMDP with some impossible transitions and observations."""
    rng = np.random.default_rng(seed)

    def as_distributions(*shape):
        weights = rng.random(shape) * (rng.random(shape) < 0.6)
        weights[..., 0] += 1e-3
        return weights / weights.sum(axis=-1, keepdims=True)

    transitions = as_distributions(actions, states, states)
    if sparse:
        transitions = [sp.csr_array(matrix) for matrix in transitions]
    mdp = FiniteMDP(transitions, rng.normal(size=(states, actions)), 0.9)
    return POMDP(mdp, as_distributions(actions, states, observations)), rng


def history_posterior(pomdp, start, actions, observations):
    """The belief after a history, by summing the probability of every path of states that could have made it."""
    transitions = [
        np.asarray(m.todense()) if sp.issparse(m) else m for m in pomdp.mdp.transitions
    ]
    posterior = np.zeros(pomdp.mdp.n_states)
    for path in itertools.product(range(pomdp.mdp.n_states), repeat=len(actions) + 1):
        probability = start[path[0]]
        for s, t, a, o in zip(path[:-1], path[1:], actions, observations, strict=True):
            probability *= transitions[a][s, t] * pomdp.observations[a, t, o]
        posterior[path[-1]] += probability
    return posterior


@pytest.mark.parametrize("sparse", [False, True])
@settings(deadline=None)
@given(seed=SEEDS)
def test_the_update_is_bayes_over_whole_histories(seed, sparse):
    pomdp, rng = random_pomdp(seed, sparse=sparse)
    start = rng.dirichlet(np.ones(4))
    run = belief_rollout(
        pomdp, lambda belief: int(rng.integers(3)), 4, belief=start, seed=rng
    )
    joint = history_posterior(pomdp, start, run.actions, run.observations)
    np.testing.assert_allclose(run.beliefs[-1], joint / joint.sum(), atol=1e-10)
    np.testing.assert_allclose(run.beliefs.sum(axis=1), 1, atol=1e-12)


@settings(deadline=None)
@given(SEEDS)
def test_observation_probabilities_and_rewards_are_their_sums(seed):
    """Eqs. (2.20) and (2.21), written out."""
    pomdp, rng = random_pomdp(seed)
    belief = rng.dirichlet(np.ones(4))
    t, z, r = pomdp.mdp.transitions, pomdp.observations, pomdp.mdp.rewards
    for a in range(3):
        expected = [
            sum(
                belief[s] * t[a, s, s2] * z[a, s2, o]
                for s in range(4)
                for s2 in range(4)
            )
            for o in range(3)
        ]
        np.testing.assert_allclose(
            pomdp.observation_probabilities(belief, a), expected, atol=1e-12
        )
        assert pomdp.expected_rewards(belief)[a] == pytest.approx(
            sum(belief[s] * r[s, a] for s in range(4))
        )


@settings(deadline=None)
@given(SEEDS)
def test_on_average_observing_changes_nothing(seed):
    """Over the observations, beliefs average to the prediction: no evidence can be expected to favour a state."""
    pomdp, rng = random_pomdp(seed)
    belief = rng.dirichlet(np.ones(4))
    for action in range(3):
        beliefs, probabilities = BeliefMDP(pomdp).successors(belief, action)
        assert probabilities.sum() == pytest.approx(1)
        np.testing.assert_allclose(
            probabilities @ beliefs, pomdp.predict(belief, action), atol=1e-12
        )


@settings(deadline=None)
@given(SEEDS)
def test_tau_sums_the_observations_that_lead_to_a_belief(seed):
    """Eq. (2.22) by its definition."""
    pomdp, rng = random_pomdp(seed)
    belief = rng.dirichlet(np.ones(4))
    beliefs = BeliefMDP(pomdp)
    for action in range(3):
        probabilities = pomdp.observation_probabilities(belief, action)
        reached = [
            pomdp.update(belief, action, o) if probabilities[o] > 0 else None
            for o in range(3)
        ]
        for successor in (b for b in reached if b is not None):
            expected = sum(
                p
                for p, b in zip(probabilities, reached, strict=True)
                if b is not None and np.allclose(b, successor)
            )
            assert beliefs.transition(belief, action, successor) == pytest.approx(
                expected
            )
        assert beliefs.transition(belief, action, np.roll(belief, 1)) in (
            0,
            pytest.approx(1),
        )
        assert beliefs.reward(belief, action) == pomdp.expected_rewards(belief)[action]
    assert beliefs.discount == 0.9


def test_two_observations_that_lead_to_one_belief_count_together():
    """After a door of the tiger's is opened, both sounds mean nothing: one successor, probability one."""
    beliefs, probabilities = BeliefMDP(tiger()).successors([0.2, 0.8], 1)
    np.testing.assert_allclose(beliefs, [[0.5, 0.5]])
    np.testing.assert_allclose(probabilities, [1])


def test_the_tiger_heard_once_and_twice():
    pomdp = tiger()
    once = pomdp.update([0.5, 0.5], 0, 0)
    np.testing.assert_allclose(once, [0.85, 0.15])
    np.testing.assert_allclose(
        pomdp.update(once, 0, 0),
        [0.85**2 / (0.85**2 + 0.15**2), 0.15**2 / (0.85**2 + 0.15**2)],
    )
    np.testing.assert_allclose(pomdp.update(once, 0, 1), [0.5, 0.5])


def test_the_state_that_comes_is_observed_not_the_one_that_was():
    """From cell 0 the robot moves to cell 1, which has the door: seeing a door must be likely, and confirm cell 1."""
    pomdp = corridor(".D.", accuracy=0.9, slip=0.2)
    prior = pomdp.predict([1, 0, 0], 1)
    np.testing.assert_allclose(prior, [0.2, 0.8, 0])
    np.testing.assert_allclose(
        pomdp.observation_probabilities([1, 0, 0], 1)[1], 0.8 * 0.9 + 0.2 * 0.1
    )
    np.testing.assert_allclose(
        pomdp.update([1, 0, 0], 1, 1), [0.2 * 0.1 / 0.74, 0.8 * 0.9 / 0.74, 0]
    )


def test_an_observation_that_cannot_be_is_an_error_that_says_so():
    pomdp = corridor("D..", accuracy=1.0, slip=0.0)
    with pytest.raises(
        ValueError,
        match="observation must be possible: 1 has probability zero after action 1",
    ):
        pomdp.update([1, 0, 0], 1, 1)
    with pytest.raises(ValueError, match="probability zero in every state"):
        bayes(np.array([1.0, 0.0]), np.array([0.0, 1.0]))


@pytest.mark.parametrize(
    ("belief", "action", "observation", "message"),
    [
        (
            [0.5, 0.6],
            0,
            0,
            "belief must be a distribution over the 2 states, got sum 1.1",
        ),
        (
            [1.5, -0.5],
            0,
            0,
            "belief must be a distribution over the 2 states, got a probability of -0.5",
        ),
        ([1.0], 0, 0, r"belief must have shape \(2,\)"),
        ([0.5, np.nan], 0, 0, "belief must hold finite numbers"),
        ([0.5, 0.5], 3, 0, "action must be at most 2, got 3"),
        ([0.5, 0.5], 0, 2, "observation must be at most 1, got 2"),
        ([0.5, 0.5], 0, -1, "observation must be at least 0, got -1"),
    ],
)
def test_wrong_arguments_get_one_clear_sentence(belief, action, observation, message):
    with pytest.raises(ValueError, match=message):
        tiger().update(belief, action, observation)


def test_observations_are_checked():
    mdp = tiger().mdp
    with pytest.raises(
        ValueError, match=r"observations must have shape \(3, 2, O\), got \(2, 2, 2\)"
    ):
        POMDP(mdp, np.full((2, 2, 2), 0.5))
    wrong = np.full((3, 2, 2), 0.5)
    wrong[1, 0] = [0.7, 0.7]
    with pytest.raises(ValueError, match=r"got .* at action 1, state 0"):
        POMDP(mdp, wrong)
    with pytest.raises(TypeError, match="mdp must be FiniteMDP, got str"):
        POMDP("mdp", wrong)


@pytest.mark.parametrize(
    ("arguments", "sentence"),
    [
        (
            ([0.5, 0.5], [0.1, -0.9]),
            "likelihood must hold no negative numbers, got -0.9",
        ),
        (([0.5, -0.5], [0.1, 0.9]), "prior must hold no negative numbers, got -0.5"),
        (
            ([0.5, 0.5], [0.1, 0.2, 0.7]),
            r"likelihood must have shape \(2,\), got \(3,\)",
        ),
        (([0.5, 0.5], [0.1, np.nan]), "likelihood must hold finite numbers"),
    ],
)
def test_evidence_is_checked(arguments, sentence):
    with pytest.raises(ValueError, match=sentence):
        bayes(*arguments)


def test_bayes_takes_lists():
    posterior, probability = bayes([0.5, 0.5], [0.1, 0.9])
    np.testing.assert_allclose(posterior, [0.1, 0.9])
    assert probability == pytest.approx(0.5)


@pytest.mark.parametrize("belief", [[5, -3], [0.5, 0.4], [[0.5, 0.5]], []])
def test_only_a_belief_has_an_entropy(belief):
    with pytest.raises(ValueError, match="belief must"):
        entropy(belief)


@pytest.mark.parametrize(
    ("options", "error", "sentence"),
    [
        ({"state": -1}, ValueError, "state must be at least 0, got -1"),
        ({"state": 99}, ValueError, "state must be at most 1, got 99"),
        ({"policy": lambda belief: 99}, ValueError, "action must be at most 2, got 99"),
        (
            {"policy": lambda belief: 0.5},
            TypeError,
            "action must be a whole number, got 0.5",
        ),
        ({"pomdp": tiger().mdp}, TypeError, "pomdp must be POMDP, got FiniteMDP"),
    ],
)
def test_walks_check_what_they_are_given(options, error, sentence):
    with pytest.raises(error, match=sentence):
        belief_rollout(
            **{
                "pomdp": tiger(),
                "policy": lambda belief: 0,
                "steps": 2,
                "seed": 0,
                **options,
            }
        )


def test_only_an_mdp_can_be_robbed_of_its_sensing():
    with pytest.raises(TypeError, match="mdp must be FiniteMDP, got POMDP"):
        without_sensing(tiger())
    with pytest.raises(TypeError, match="pomdp must be POMDP, got FiniteMDP"):
        BeliefMDP(tiger().mdp)


def test_without_sensing_a_move_against_the_wall_still_tells():
    """A blind robot in a corridor of five cells that never slips: four steps left, and it knows where it is."""
    blind = without_sensing(corridor(".....", slip=0.0).mdp)
    belief = blind.uniform()
    for _ in range(4):
        belief = blind.update(belief, 0, 0)
    np.testing.assert_allclose(belief, [1, 0, 0, 0, 0])


def test_without_sensing_the_belief_is_the_markov_chain_alone():
    pomdp, rng = random_pomdp(3)
    blind = without_sensing(pomdp.mdp)
    belief = rng.dirichlet(np.ones(4))
    np.testing.assert_allclose(
        blind.update(belief, 1, 0), belief @ pomdp.mdp.transitions[1]
    )


def test_entropy_in_bits():
    assert entropy([1, 0, 0]) == 0
    assert entropy(np.full(8, 1 / 8)) == pytest.approx(3)
    assert entropy([0.5, 0.25, 0.25]) == pytest.approx(1.5)


def test_walks_reproduce():
    runs = [
        belief_rollout(corridor(), lambda belief: 1, 30, seed=seed)
        for seed in (1, 1, 2)
    ]
    np.testing.assert_array_equal(runs[0].beliefs, runs[1].beliefs)
    assert (runs[0].states != runs[2].states).any() or (
        runs[0].observations != runs[2].observations
    ).any()
    assert runs[0].beliefs.shape == (31, 15)


def test_a_belief_is_calibrated():
    """Of all the times a state is believed with 30 to 70 %, it is the true one about as often as was believed."""
    believed, true = [], []
    for seed in range(150):
        run = belief_rollout(corridor("D..D."), lambda belief: 1, 12, seed=seed)
        believed.append(run.beliefs.ravel())
        true.append(np.eye(5)[run.states].ravel())
    believed, true = np.concatenate(believed), np.concatenate(true)
    middle = (believed > 0.3) & (believed < 0.7)
    assert middle.sum() > 200
    assert true[middle].mean() == pytest.approx(believed[middle].mean(), abs=0.06)


@pytest.mark.parametrize("cells", ["", "D-D"])
def test_a_corridor_is_made_of_doors_and_walls(cells):
    with pytest.raises(ValueError, match="cells must be letters"):
        corridor(cells)


def test_a_ring_closes():
    ring = corridor("D...", slip=0.0, ring=True)
    np.testing.assert_allclose(ring.predict([1, 0, 0, 0], 0), [0, 0, 0, 1])
    np.testing.assert_allclose(
        corridor("D...", slip=0.0).predict([1, 0, 0, 0], 0), [1, 0, 0, 0]
    )


def test_belief_rollout_of_no_steps_keeps_the_types():
    none, one = (
        belief_rollout(tiger(), lambda belief: 0, steps, seed=0) for steps in (0, 1)
    )
    for name in ("states", "actions", "observations", "rewards", "beliefs"):
        assert getattr(none, name).dtype == getattr(one, name).dtype
    assert none.beliefs.shape == (1, 2)


@pytest.mark.parametrize(
    "wrong", [1.0, np.float64(1.0), True, "1", None, [0, 1], slice(None), -1, 3]
)
def test_action_is_checked_by_every_method(wrong):
    """The action is used as it was checked, not as it came: -1 is not the last action, nor True the second."""
    pomdp = tiger()
    for use in (
        lambda: pomdp.update([0.5, 0.5], wrong, 0),
        lambda: pomdp.predict([0.5, 0.5], wrong),
        lambda: pomdp.likelihood(wrong, 0),
        lambda: pomdp.observation_probabilities([0.5, 0.5], wrong),
        lambda: BeliefMDP(pomdp).successors([0.5, 0.5], wrong),
        lambda: BeliefMDP(pomdp).reward([0.5, 0.5], wrong),
    ):
        with pytest.raises((TypeError, ValueError), match="action must be"):
            use()


class Third(numbers.Integral):
    """A whole number 2 that cannot serve as an index before it is turned into an int."""

    def __int__(self):
        return 2


Third.__abstractmethods__ = frozenset()


def test_update_uses_the_checked_action():
    np.testing.assert_array_equal(
        tiger().update([0.9, 0.1], Third(), 0), tiger().update([0.9, 0.1], 2, 0)
    )
