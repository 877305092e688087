"""From demonstrations to a policy and its reward, by any of the four methods of Table 5.2."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from robonav.lfd.demonstrations import Demonstrations
from robonav.validation import check_instance, check_one_of

from .decisions import Decisions, Floats, expert_decisions
from .nirl import nirl
from .refinement import Refined
from .relative_entropy import relative_entropy
from .robot_apprenticeship import apprenticeship
from .scirl import scirl
from .tasks import RobotTask
from .training import IRLResult, train_under_reward

METHODS: dict[str, Callable[..., IRLResult]] = {
    "nirl": nirl,
    "apprenticeship": apprenticeship,
    "relative-entropy": relative_entropy,
    "scirl": scirl,
}

Refinement = Callable[[Any, Any, int], Refined]
"""``refine(states, actions, n_actions)``, such as :func:`most_frequent`."""


def learn(
    demonstrations: Demonstrations,
    method: str = "nirl",
    seed: int | np.random.Generator = 0,
    *,
    task: RobotTask | None = None,
    refine: Refinement | None = None,
    **settings: Any,
) -> IRLResult:
    """Learn a reward and a policy from demonstrations of the robot.

    Parameters
    ----------
    demonstrations : Demonstrations
        Of any expert.
    method : str
        "nirl", "apprenticeship", "relative-entropy" or "scirl", as on the leaderboard. The name of the function,
        "relative_entropy", is accepted too.
    seed : int or Generator
        Seed of the network's initial weights and of all other random numbers.
    task : RobotTask, optional
        The task on which the robot trains; by default 10 episodes in each iteration, 20 obstacles, 2 m/s.
    refine : callable, optional
        :func:`most_frequent` or :func:`map_uniform_prior`, for an expert that contradicts itself.
    **settings
        Other arguments of the method.

    Returns
    -------
    IRLResult

    Raises
    ------
    ValueError, TypeError
        For another method, demonstrations without an effective pair, or arguments out of bounds.

    Examples
    --------
    >>> from robonav.lfd import demonstrate
    >>> from robonav.nirl import learn
    >>> from robonav.robot import navigate, random_worlds
    >>> demonstrations = demonstrate(random_worlds(2, obstacles=20, seed=3))
    >>> result = learn(demonstrations, "scirl", iterations=2)
    >>> navigate(result.policy, random_worlds(1, seed=4)).outcome.shape
    (1,)
    """
    name = "relative-entropy" if method == "relative_entropy" else method
    learner = METHODS[check_one_of("method", name, METHODS)]
    task = RobotTask() if task is None else check_instance("task", task, RobotTask)
    expert = robot_decisions(demonstrations, task, refine)
    return learner(expert, task, seed=seed, **settings)


def robot_decisions(
    demonstrations: Demonstrations, task: RobotTask, refine: Refinement | None = None
) -> Decisions:
    """The expert's decisions, with the states as the task's encoder gives them, and refined on request.

    Two states are equal if all inputs of the network are equal.
    """
    expert = expert_decisions(demonstrations, task.encoder)
    if refine is None:
        return expert
    refined = refine(expert.inputs.round(6), expert.actions, task.n_actions)
    return expert.with_actions(refined.actions)


def learn_under_reward(
    demonstrations: Demonstrations,
    weights: Floats,
    *,
    task: RobotTask | None = None,
    seed: int | np.random.Generator = 0,
    **settings: Any,
) -> IRLResult:
    """Learn a policy for a given reward: a control (zero, random), or a reward learned elsewhere.

    The demonstrations are used only to choose among the policies found.

    Parameters
    ----------
    demonstrations : Demonstrations
        Of any expert.
    weights : (5, k + 1) array
        theta.
    task : RobotTask, optional
        The task on which the robot trains.
    seed : int or Generator
        Seed of all random numbers.
    **settings
        Other arguments of :func:`train_under_reward`.

    Returns
    -------
    IRLResult

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.lfd import demonstrate
    >>> from robonav.nirl import learn_under_reward
    >>> from robonav.robot import random_worlds
    >>> demonstrations = demonstrate(random_worlds(2, obstacles=20, seed=3))
    >>> learn_under_reward(demonstrations, np.zeros((5, 18)), iterations=2).reward_weights.any()
    np.False_
    """
    task = RobotTask() if task is None else check_instance("task", task, RobotTask)
    expert = robot_decisions(demonstrations, task)
    return train_under_reward(expert, task, weights, seed=seed, **settings)
