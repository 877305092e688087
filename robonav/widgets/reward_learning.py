"""Learn a reward in the page from demonstrations, see it as a map, and train robots with it."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from robonav.lfd.demonstrations import Demonstrations
from robonav.networks.multilayer_perceptron import Network
from robonav.networks.policy import NetworkPolicy
from robonav.nirl import (
    METHODS,
    IRLResult,
    ReplaySGD,
    RobotTask,
    accuracy,
    balanced_accuracy,
    expert_decisions,
    greedy_actions,
    learn,
)
from robonav.nirl.decisions import Decisions, Floats
from robonav.nirl.policy_improvement import Improved
from robonav.robot import Worlds, random_worlds
from robonav.validation import check_integer, check_one_of

from .kernel_training import (
    TRIED,
    KernelTraining,
    Report,
    sentence_on_rates,
    success_rates,
)
from .shared import front_end, packed, style_sheet
from .simulator import page_demonstrations, page_policy, page_world

FILES = (
    "simulator",
    "maps",
    "files",
    "learning/random",
    "learning/worlds",
    "learning/network",
    "learning/nirl",
    "learning/trials",
    "kept_demonstrations",
    "kept_robots",
    "learning/worker",
    "learning/training_panel",
    "learning/kernel_panel",
    "reward_learning",
)


Callback = Callable[[Network, Decisions, Floats], None]
"""``callback(network, decisions, rewards)``: the network after an improvement, its decisions and their rewards (M,)."""


@dataclass(frozen=True)
class ReplaySGDWithCallback(ReplaySGD):
    """The improvement of the policy with a callback: ``callback(network, decisions, rewards)`` is called after each.

    Examples
    --------
    >>> from robonav.lfd import demonstrate
    >>> from robonav.nirl import learn
    >>> from robonav.robot import random_worlds
    >>> from robonav.widgets.reward_learning import ReplaySGDWithCallback
    >>> arrived = []
    >>> improver = ReplaySGDWithCallback(
    ...     callback=lambda network, episodes, rewards: arrived.append(episodes.arrived.mean())
    ... )
    >>> demonstrations = demonstrate(random_worlds(2, 20, seed=3))
    >>> result = learn(demonstrations, iterations=3, improver=improver)
    >>> len(arrived)
    3
    """

    callback: Callback = lambda _network, _decisions, _rewards: None

    def improve(
        self,
        network: Network,
        decisions: Decisions,
        rewards: Floats,
        fraction: float,
        rng: np.random.Generator,
    ) -> Improved:
        improved = super().improve(network, decisions, rewards, fraction, rng)
        self.callback(improved.network, decisions, rewards)
        return improved


class RewardLearning(KernelTraining):
    """Learn a reward from demonstrations, see it as a map, and train a robot with it in other worlds.

    In the page the method is NIRL. With a kernel, Python learns by any of the four methods, several robots in turn.
    """

    _esm = front_end(*FILES)
    _css = style_sheet(
        "maps", "kept_demonstrations", "robot_playground", "learning/training_panel"
    )

    def __init__(
        self, data: dict[str, Any], demonstrations: Sequence[Demonstrations]
    ) -> None:
        super().__init__(data)
        self._demonstrations = demonstrations

    def train(self, request: dict[str, Any], report: Report) -> dict[str, Any]:
        """Learn rewards and policies, and return the ones that predict the demonstrations best."""
        settings = request["settings"]
        method = check_one_of("method", request["method"], METHODS)
        robots = check_integer("robots", request["robots"], at_least=1)
        iterations = check_integer("iterations", settings["iterations"], at_least=1)
        seed = check_integer("seed", settings["seed"], at_least=0)
        demonstrations = (
            self._demonstrations[request["set"]]
            if request["demonstrations"] is None
            else page_demonstrations(request["demonstrations"])
        )
        obstacles = check_integer("obstacles", settings["obstacles"], at_least=0)
        task = RobotTask(obstacles=obstacles)
        expert = expert_decisions(demonstrations, task.encoder)
        worlds = random_worlds(TRIED, obstacles, seed=self.data["seed"])
        results: list[IRLResult] = []
        rates: list[float] = []
        for robot in range(robots):
            callback = iteration_callback(
                expert, task, report, robot * iterations, robots * iterations
            )
            results.append(
                learn(
                    demonstrations,
                    method,
                    seed + robot,
                    task=task,
                    improver=ReplaySGDWithCallback(callback=callback),
                    iterations=iterations,
                    hidden=check_integer("hidden", settings["hidden"], at_least=1),
                    inverse_temperature=settings["inverseTemperature"],
                )
            )
            rates += success_rates([results[-1].policy], worlds)
            report((robot + 1) * iterations, robots * iterations)
        self.trainings = results
        best = max(results, key=lambda result: result.history.balanced[result.chosen])
        return {
            "sentence": sentence_on_rates(rates, TRIED),
            "theta": best.reward_weights.ravel().tolist(),
            "policy": page_policy(best.policy),
            "iteration": best.chosen,
            "balanced": float(best.history.balanced[best.chosen]),
        }


def iteration_callback(
    expert: Decisions, task: RobotTask, report: Report, before: int, total: int
) -> Callback:
    """A function that reports the latest policy of a robot, after the ``before`` iterations of earlier robots."""
    done = 0

    def callback(network: Network, decisions: Decisions, _rewards: Floats) -> None:
        """Tell the page about an iteration."""
        nonlocal done
        done += 1
        predicted = greedy_actions(network, expert.inputs)
        report(
            before + done,
            total,
            at=done,
            accuracy=100 * accuracy(predicted, expert.actions),
            balanced=100 * balanced_accuracy(predicted, expert.actions),
            arrived=100 * float(decisions.arrived[-task.n_episodes :].mean()),
        )

    return callback


def reward_learning(
    demonstrations: Mapping[str, Demonstrations],
    world: Worlds,
    policies: Mapping[str, NetworkPolicy],
    *,
    n_worlds: int = 200,
    seed: int,
) -> RewardLearning:
    """Make the widget that learns a reward.

    Parameters
    ----------
    demonstrations : mapping of str to Demonstrations
        Sets of demonstrations to choose from, by name.
    world : Worlds
        A batch of one: the map on which the reward is drawn.
    policies : mapping of str to NetworkPolicy
        Policies to compare the learned one with. The rule that goes straight on is always among them.
    n_worlds : int
        The number of maps in which the robots are tried.
    seed : int
        The seed of these maps.

    Returns
    -------
    RewardLearning

    Raises
    ------
    ValueError
        If there is no decision in the demonstrations, or ``n_worlds`` is below 1.

    Examples
    --------
    >>> from robonav.lfd import demonstrate
    >>> from robonav.robot import random_worlds
    >>> from robonav.widgets.reward_learning import reward_learning
    >>> demonstrations = demonstrate(random_worlds(2, 20, seed=3))
    >>> widget = reward_learning({"two": demonstrations}, random_worlds(1, 20, seed=4), {}, seed=5)
    >>> [policy["name"] for policy in widget.data["policies"]]
    ['straight on']
    """
    sets = []
    for name, shown in demonstrations.items():
        decisions = expert_decisions(shown)
        sets.append(
            {
                "name": name,
                "demonstrations": len(shown.worlds),
                "inputs": packed(decisions.inputs),
                "actions": packed(decisions.actions, np.uint8),
            }
        )
    networks = [
        {"name": name, **page_policy(policy)} for name, policy in policies.items()
    ]
    return RewardLearning(
        {
            "sets": sets,
            "world": page_world(world),
            "policies": [{"name": "straight on", "rule": "straight"}, *networks],
            "maps": check_integer("n_worlds", n_worlds, at_least=1),
            "seed": check_integer("seed", seed, at_least=0),
        },
        list(demonstrations.values()),
    )
