"""Neural policy iteration for a reward, which all methods share, with its record and its result."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav.networks.multilayer_perceptron import Network, random_network
from robonav.networks.network_stack import NetworkStack, stacked
from robonav.progress import Progress

from ._arguments import checked
from .max_margin import project_to_unit_ball
from .model_selection import Score, accuracy, balanced_accuracy
from .policy import (
    boltzmann_policy,
    exploring_policy,
    greedy_actions,
    neural_action_values,
)
from .policy_improvement import Improver, ReplaySGD
from .reward_update import feature_gap, inverse_frequency_weights
from .tasks import Task
from .transitions import Floats, Transitions


@dataclass(frozen=True, eq=False)
class History:
    """The record of n iterations. Networks and scores begin with the network before the first.

    Attributes
    ----------
    networks : NetworkStack
        Stack (n + 1,).
    weights : (n, A, k + 1) array
        theta of every iteration, of length 1 at most.
    margins : (n,) array
        By how much theta prefers the expert's decisions to those of the policy before the improvement (Fig. 5.7).
    costs : (n,) array
        Cost of the network (Fig. 5.8).
    arrived, collided : (n,) array
        Shares of the iteration's episodes.
    decisions : (n,) array of int
        Made in them.
    accuracies, balanced : (n + 1,) array
        Of the greedy policy's predictions of the demonstrations.

    Examples
    --------
    >>> from robonav.lfd import demonstrate
    >>> from robonav.nirl import History, learn
    >>> from robonav.robot import random_worlds
    >>> result = learn(demonstrate(random_worlds(2, obstacles=20, seed=3)), iterations=2)
    >>> isinstance(result.history, History), len(result.history.costs)
    (True, 2)
    """

    networks: NetworkStack
    weights: Floats
    margins: Floats
    costs: Floats
    arrived: Floats
    collided: Floats
    decisions: NDArray[np.int64]
    accuracies: Floats
    balanced: Floats

    @property
    def changes(self) -> Floats:
        """Sum of absolute changes of each layer's weights in each iteration, (n, 2), Fig. 5.11."""
        return np.stack(
            [
                abs(np.diff(weight, axis=0)).sum(axis=(1, 2))
                for weight in self.networks.weights
            ],
            axis=1,
        )


@dataclass(frozen=True, eq=False)
class IRLResult:
    """What a method of inverse reinforcement learning found.

    Attributes
    ----------
    policy : NetworkPolicy or array
        Takes the action with the network's largest output: for the robot a policy that ``navigate`` takes, for a finite
        MDP the actions (S,).
    reward_weights : (A, k + 1) array
        theta that the policy was trained for. Row a holds the weights of phi(s) and of the constant for action a.
    history : History
        Of all iterations.
    chosen : int
        Which of the history's networks the policy is.
    network : Network
        That network.

    Examples
    --------
    >>> from robonav.lfd import demonstrate
    >>> from robonav.nirl import learn
    >>> from robonav.robot import random_worlds
    >>> result = learn(demonstrate(random_worlds(2, obstacles=20, seed=3)), iterations=2)
    >>> result.reward_weights.shape
    (5, 18)
    """

    policy: Any
    reward_weights: Floats
    history: History
    chosen: int
    network: Network


class Trainer:
    """A network that trains on a task, and the record of its iterations.

    Parameters
    ----------
    demonstrations : Transitions
        M decisions of the expert. Every network is scored by how well it predicts them.
    task : Task
        The task on which the network trains.
    hidden : int
        Hidden units.
    inverse_temperature : float
        eta of Eq. (5.10).
    improver : Improver
        Improves the network.
    rng : Generator
        Of all random numbers.

    Attributes
    ----------
    network : Network
        The latest.
    action_values, action_probabilities : (M, A) array
        Its outputs and its exploring policy in the expert's states.
    episodes : list of Transitions
        One entry for each rollout.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import ReplaySGD, TabularTask, Trainer, accuracy, terrain
    >>> task = TabularTask(terrain()[1])
    >>> expert = task.demonstrate(np.zeros(42, dtype=int), 1, seed=0)
    >>> trainer = Trainer(expert, task, 5, 25.0, ReplaySGD(n_samples=10), np.random.default_rng(0))
    >>> episodes = trainer.rollout()
    >>> trainer.improve(np.zeros((4, 43)), fraction=0.0)
    >>> len(trainer.result(accuracy).history.costs)
    1
    """

    def __init__(
        self,
        demonstrations: Transitions,
        task: Task,
        hidden: int,
        inverse_temperature: float,
        improver: Improver,
        rng: np.random.Generator,
    ) -> None:
        self.demonstrations, self.task = demonstrations, task
        self.inverse_temperature, self.improver = inverse_temperature, improver
        self.rng = rng
        self.episodes: list[Transitions] = []
        self._balance = inverse_frequency_weights(
            demonstrations.actions, task.n_actions
        )
        self._networks: list[Network] = []
        self._weights: list[Floats] = []
        self._margins: list[float] = []
        self._costs: list[float] = []
        sizes = (task.n_inputs, hidden, task.n_actions)
        self._adopt(random_network(sizes, seed=rng))

    def _adopt(self, network: Network) -> None:
        self.network = network
        self.action_values = neural_action_values(network, self.demonstrations.inputs)
        self.action_probabilities = boltzmann_policy(
            self.action_values, self.inverse_temperature
        )
        self._networks.append(network)

    def rollout(self) -> Transitions:
        """A few more episodes with the latest network, actions drawn from its exploring policy."""
        policy = exploring_policy(self.network, self.inverse_temperature)
        self.episodes.append(self.task.rollout(policy, self.rng))
        return self.episodes[-1]

    def margin(self, theta: Floats) -> float:
        """By how much the reward theta, of length 1 at most, prefers the expert's decisions to the network's."""
        gap = feature_gap(self.demonstrations, self.action_probabilities, self._balance)
        return float((project_to_unit_ball(theta) * gap).sum())

    def improve(self, theta: Floats, fraction: float) -> None:
        """Improve the network for the reward theta; ``fraction`` (0 to 1) of the training is over."""
        weights = project_to_unit_ball(theta)
        margin = self.margin(theta)
        network, cost = self.improver(
            self.network, self.episodes, weights, fraction, self.rng
        )
        self._weights.append(weights)
        self._margins.append(margin)
        self._costs.append(cost)
        self._adopt(network)

    def result(self, score: Score) -> IRLResult:
        """The network that predicts the demonstrations best, and the history."""
        expert = self.demonstrations
        predictions = [greedy_actions(net, expert.inputs) for net in self._networks]
        scores = [score(predicted, expert.actions) for predicted in predictions]
        chosen = int(np.argmax(scores))
        n, shape = len(self._weights), (self.task.n_actions, expert.features.shape[1])
        weights = np.array(self._weights).reshape(n, *shape)
        episodes = self.episodes[:n]
        history = History(
            networks=stacked(self._networks),
            weights=weights,
            margins=np.array(self._margins),
            costs=np.array(self._costs),
            arrived=np.array([part.arrived.mean() for part in episodes]),
            collided=np.array([part.collided.mean() for part in episodes]),
            decisions=np.array([len(part) for part in episodes], dtype=np.int64),
            accuracies=np.array([accuracy(p, expert.actions) for p in predictions]),
            balanced=np.array(
                [balanced_accuracy(p, expert.actions) for p in predictions]
            ),
        )
        network = self._networks[chosen]
        trained_for = weights[max(chosen - 1, 0)] if n else np.zeros(shape)
        return IRLResult(
            self.task.greedy_policy(network), trained_for, history, chosen, network
        )


@checked
def train_under_reward(
    demonstrations: Transitions,
    task: Task,
    weights: Floats,
    *,
    iterations: int = 140,
    hidden: int = 10,
    inverse_temperature: float = 25.0,
    improver: Improver = ReplaySGD(),  # noqa: B008 - frozen
    score: Score = balanced_accuracy,
    seed: int | np.random.Generator = 0,
    progress: Progress | None = None,
) -> IRLResult:
    """Neural policy iteration under a fixed reward: NIRL without its line 5.

    The demonstrations are used only to choose among the policies found.

    Parameters
    ----------
    demonstrations : Transitions
        The expert's decisions.
    task : Task
        The task on which the network trains.
    weights : (A, k + 1) array
        theta of the reward.
    iterations : int
        Number of rollouts, each followed by an improvement.
    hidden : int
        Hidden units of the network.
    inverse_temperature : float
        eta of Eq. (5.10).
    improver : Improver
        Improves the network.
    score : callable
        Measures how well a policy predicts the demonstrations; the best one is the result.
    seed : int or Generator
        Seed of all random numbers.
    progress : callable, optional
        Called as ``progress(done, iterations)``.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import TabularTask, terrain, train_under_reward
    >>> task = TabularTask(terrain()[1])
    >>> expert = task.demonstrate(np.zeros(42, dtype=int), 1, seed=0)
    >>> train_under_reward(expert, task, np.zeros((4, 43)), iterations=2).policy.shape
    (42,)
    """
    rng = np.random.default_rng(seed)
    trainer = Trainer(demonstrations, task, hidden, inverse_temperature, improver, rng)
    for iteration in range(iterations):
        trainer.rollout()
        trainer.improve(weights, fraction=iteration / max(iterations - 1, 1))
        if progress is not None:
            progress(iteration + 1, iterations)
    return trainer.result(score)
