"""The four methods of Table 5.2 on the robot: one function each, from demonstrations to a policy and its reward."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np

from robonav.lfd.demonstrations import Demonstrations
from robonav.networks.policy import NetworkPolicy
from robonav.progress import Progress
from robonav.validation import check_generator, check_integer, check_one_of, check_real

from .apprenticeship import projection_method
from .feature_expectations import discounted_feature_sums, empirical_expectations
from .features import all_action_features, state_action_features
from .model_selection import balanced_accuracy
from .nirl import Found, History, Practice, Score, nirl, train_under_reward
from .policy_improvement import ReplaySGD
from .refinement import Refined
from .relative_entropy import relative_entropy
from .reward_update import balance
from .scirl import heuristic_mu, lstd_mu, structured_classification
from .tasks import RobotTask, collect, start_at
from .transitions import Floats, Steps, expert_transitions

Refinement = Callable[[Any, Any, int], Refined]


@dataclass(frozen=True, eq=False)
class Learned:
    """A policy that drives, and the reward it was made for.

    Attributes
    ----------
    policy : takes the action of the network's strongest output.
    reward_weights : theta (5, k + 1) of the iteration that the policy comes from; row a holds the weights of
        phi(s) and of the constant for action a.
    history : of all iterations.
    chosen : which of the history's networks the policy is.
    """

    policy: NetworkPolicy
    reward_weights: Floats
    history: History
    chosen: int


def learn(
    demonstrations: Demonstrations, method: str = "nirl", seed: int = 0, **settings: Any
) -> Learned:
    """Learn a reward and a policy from demonstrations: ``METHODS[method](demonstrations, seed=seed, **settings)``.

    Parameters
    ----------
    demonstrations : of any expert.
    method : "nirl", "apprenticeship", "relative_entropy" or "scirl".
    seed : of the network's first weights and of everything random in practice.
    settings : of the method.

    Raises
    ------
    ValueError, TypeError : for another method, demonstrations without an effective pair, or arguments out of bounds.
    """
    return METHODS[check_one_of("method", method, METHODS)](
        demonstrations, seed=seed, **settings
    )


def prepared(
    demonstrations: Demonstrations, course: RobotTask, refine: Refinement | None
) -> Steps:
    """The expert's decisions as the course's encoder sees them, refined if asked for.

    States count as equal where all that the network reads is equal.
    """
    shown = expert_transitions(demonstrations, course.encoder)
    if refine is None:
        return shown
    return shown.with_actions(
        refine(shown.inputs.round(6), shown.actions, course.actions).actions
    )


def learn_nirl(
    demonstrations: Demonstrations,
    *,
    course: RobotTask | None = None,
    refine: Refinement | None = None,
    seed: int | np.random.Generator,
    **settings: Any,
) -> Learned:
    """Algorithm 10 on the robot.

    Parameters
    ----------
    demonstrations : of an expert.
    course : where the robot practises: by default 10 drives an iteration, 20 obstacles, 2 m/s.
    refine : :func:`most_frequent` or :func:`map_uniform_prior`, for an expert that contradicts itself (5.12).
    settings : of :func:`~robonav.nirl.nirl`: iterations, eta, reward, improve, score and so on.
    """
    ground = course or RobotTask()
    return _learned(
        nirl(prepared(demonstrations, ground, refine), ground, seed=seed, **settings),
        ground,
    )


Expectations = Callable[[Steps, int, float], Floats]
"""``expectations(steps, actions, discount) -> (A (k + 1),)``: feature expectations of a driver."""


def from_initial_state(steps: Steps, actions: int, discount: float) -> Floats:
    """Discounted from each drive's first decision on: Eq. (5.13). What comes a dozen decisions later hardly counts."""
    return empirical_expectations(
        state_action_features(steps.features, steps.actions, actions),
        steps.trajectory,
        discount,
    )


def from_all_states(steps: Steps, actions: int, discount: float) -> Floats:
    """Discounted from every decision on, and averaged over them all: each part of a drive counts alike."""
    features = state_action_features(steps.features, steps.actions, actions)
    return discounted_feature_sums(features, steps.trajectory, discount).mean(axis=0)


def learn_apprenticeship(
    demonstrations: Demonstrations,
    *,
    course: RobotTask | None = None,
    refine: Refinement | None = None,
    search: Callable[..., Any] = projection_method,
    expectations: Expectations = from_all_states,
    guesses: int = 14,
    iterations: int = 140,
    hidden: int = 10,
    eta: float = 25.0,
    improve: ReplaySGD | None = None,
    score: Score = balanced_accuracy,
    seed: int | np.random.Generator,
    progress: Progress | None = None,
) -> Learned:
    """Apprenticeship learning (Abbeel and Ng 2004), the best policy for each reward found by neural policy iteration.

    Parameters
    ----------
    search : :func:`projection_method` or :func:`max_margin_method`.
    expectations : :func:`from_all_states`, or :func:`from_initial_state` to the letter.
    guesses : rewards tried. They share the ``iterations``, and the network goes on from reward to reward.

    The others are those of :func:`learn_nirl`.
    """
    ground = course or RobotTask()
    shown = prepared(demonstrations, ground, refine)
    better = improve or ReplaySGD()
    each = max(
        check_integer("iterations", iterations, at_least=1)
        // check_integer("guesses", guesses, at_least=1),
        1,
    )
    practice = Practice(shown, ground, hidden, eta, better, seed)

    def met() -> Floats:
        """Feature expectations of the latest policy; where it decided nothing there is nothing."""
        steps = practice.drive()
        return (
            expectations(steps, ground.actions, better.discount)
            if len(steps)
            else np.zeros_like(mu)
        )

    def solve(weights: Floats) -> tuple[None, Floats]:
        for k in range(each):
            if k > 0:
                practice.drive()
            done = len(practice.notes) / max(guesses * each - 1, 1)
            practice.iterate(weights.reshape(ground.actions, -1), min(done, 1.0))
            if progress is not None:
                progress(len(practice.notes), guesses * each)
        return None, met()

    mu = expectations(shown, ground.actions, better.discount)
    search(mu, solve, (None, met()), tolerance=0.0, iterations=guesses)
    return _learned(practice.found(score), ground)


def learn_relative_entropy(
    demonstrations: Demonstrations,
    *,
    course: RobotTask | None = None,
    refine: Refinement | None = None,
    samples: int = 6000,
    horizon: int = 5,
    slack: float = 0.05,
    improve: ReplaySGD | None = None,
    seed: int | np.random.Generator,
    **settings: Any,
) -> Learned:
    """Relative-entropy IRL (Boularias et al. 2011): a reward from random segments, then policy iteration under it.

    A whole drive by chance never looks like an expert's. So the trajectories compared are segments of ``horizon``
    decisions: the expert's own, and as many by chance that begin where one of the expert's decisions was made.

    Parameters
    ----------
    samples : segments driven by chance, every action alike.
    horizon : decisions a segment.
    slack : eps, as a share of each feature's standard deviation among the samples.

    The others are those of :func:`learn_nirl`. The maps must stand still: segments begin in the middle of a drive.
    """
    ground = course or RobotTask()
    shown = prepared(demonstrations, ground, refine)
    better, rng = improve or ReplaySGD(), check_generator("seed", seed)
    expert = segments(
        shown,
        ground.actions,
        better.discount,
        check_integer("horizon", horizon, at_least=1),
    )
    random = random_segments(
        demonstrations,
        ground,
        check_integer("samples", samples, at_least=1),
        horizon,
        rng,
    )
    drawn = discounted_feature_sums(
        state_action_features(random.features, random.actions, ground.actions),
        random.trajectory,
        better.discount,
    )[np.flatnonzero(np.diff(random.trajectory, prepend=-1))]
    eps = check_real("slack", slack, at_least=0) * drawn.std(axis=0)
    found = relative_entropy(
        expert.mean(axis=0), drawn, np.zeros(len(drawn)), slack=eps
    )
    theta = found.weights.reshape(ground.actions, -1)
    return _learned(
        train_under_reward(shown, ground, theta, improve=better, seed=rng, **settings),
        ground,
    )


def segments(steps: Steps, actions: int, discount: float, horizon: int) -> Floats:
    """Discounted features of ``horizon`` decisions from each one on, (M, A (k + 1)); fewer at the end of a drive."""
    features = state_action_features(steps.features, steps.actions, actions)
    to_go = discounted_feature_sums(features, steps.trajectory, discount)
    beyond = np.arange(len(steps)) + horizon
    inside = beyond < len(steps)
    inside[inside] = steps.trajectory[beyond[inside]] == steps.trajectory[inside]
    to_go[inside] -= (
        discount**horizon
        * discounted_feature_sums(features, steps.trajectory, discount)[beyond[inside]]
    )
    return to_go


def random_segments(
    demonstrations: Demonstrations,
    course: RobotTask,
    samples: int,
    horizon: int,
    rng: np.random.Generator,
) -> Steps:
    """Segments of ``horizon`` decisions by chance, begun at poses where the expert had to decide."""
    pairs = demonstrations.effective
    begin = rng.integers(len(pairs), size=samples)
    worlds = pairs.worlds[pairs.trajectory[begin]]
    simulator = start_at(worlds, pairs.poses[begin], pairs.speed, course.max_steps)

    def alike(inputs: Floats) -> Floats:
        return np.full((len(inputs), course.actions), 1 / course.actions)

    return collect(simulator, alike, course.encoder, rng, decisions=horizon)


Estimate = Callable[[Steps, int, float], Floats]
"""``estimate(shown, actions, discount) -> (M, A, A (k + 1))``: mu_E(s_t, a) of every action in the states shown."""


def lstd_estimate(shown: Steps, actions: int, discount: float) -> Floats:
    """LSTD-mu over the state-action features themselves: what one action leads to is guessed from similar states."""
    own = state_action_features(shown.features, shown.actions, actions)
    following = np.where(shown.after[:, None] >= 0, own[shown.after], 0.0)
    coefficients = lstd_mu(own, following, own, discount, ridge=1e-3)
    return all_action_features(shown.features, actions) @ coefficients


def heuristic_estimate(shown: Steps, actions: int, discount: float) -> Floats:
    """Monte Carlo for the expert's own actions; gamma times that for all others (Klein et al. 2012)."""
    own = state_action_features(shown.features, shown.actions, actions)
    return heuristic_mu(
        discounted_feature_sums(own, shown.trajectory, discount),
        shown.actions,
        actions,
        discount,
    )


def learn_scirl(
    demonstrations: Demonstrations,
    *,
    course: RobotTask | None = None,
    refine: Refinement | None = None,
    estimate: Estimate = lstd_estimate,
    ridge: float = 1e-6,
    power: float = 1.0,
    improve: ReplaySGD | None = None,
    seed: int | np.random.Generator,
    **settings: Any,
) -> Learned:
    """SCIRL (Klein et al. 2012): a reward by classification, no driving needed; then policy iteration under it.

    Parameters
    ----------
    estimate : of mu_E, :func:`lstd_estimate` or :func:`heuristic_estimate`.
    ridge : lambda of the classifier.
    power : how far rare actions are made up for, see :func:`balance`; 0 is the paper's cost, to which they are too few
        to matter.

    The others are those of :func:`learn_nirl`.
    """
    ground = course or RobotTask()
    shown = prepared(demonstrations, ground, refine)
    better = improve or ReplaySGD()
    mu = estimate(shown, ground.actions, better.discount)
    share = balance(shown.actions, ground.actions, power=power)
    classified = structured_classification(
        mu, shown.actions, step_weights=share, ridge=ridge
    )
    theta = classified.weights.reshape(ground.actions, -1)
    return _learned(
        train_under_reward(shown, ground, theta, improve=better, seed=seed, **settings),
        ground,
    )


METHODS: dict[str, Callable[..., Learned]] = {
    "nirl": learn_nirl,
    "apprenticeship": learn_apprenticeship,
    "relative_entropy": learn_relative_entropy,
    "scirl": learn_scirl,
}


def learn_under_reward(
    demonstrations: Demonstrations,
    weights: Floats,
    *,
    course: RobotTask | None = None,
    seed: int | np.random.Generator,
    **settings: Any,
) -> Learned:
    """A policy for a given reward theta (5, k + 1): a control (zero, random), or a reward learned elsewhere.

    The demonstrations only choose among the policies found. Settings: see :func:`~robonav.nirl.train_under_reward`.
    """
    ground = course or RobotTask()
    return _learned(
        train_under_reward(
            expert_transitions(demonstrations, ground.encoder),
            ground,
            weights,
            seed=seed,
            **settings,
        ),
        ground,
    )


def _learned(found: Found, course: RobotTask) -> Learned:
    return Learned(
        NetworkPolicy(found.network, course.encoder),
        found.weights,
        found.history,
        found.chosen,
    )
