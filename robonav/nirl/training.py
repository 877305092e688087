"""Neural policy iteration for a reward, which all methods share, with its record and its result."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import wraps
from typing import Any

import numpy as np
from numpy.typing import NDArray

from robonav.documentation import documents, with_signature
from robonav.networks import random_network
from robonav.networks.multilayer_perceptron import Network
from robonav.networks.network_stack import NetworkStack, stacked
from robonav.progress import Progress

from ._arguments import checked
from .decisions import Decisions, Floats, concatenate_decisions
from .max_margin import project_to_unit_ball
from .model_selection import Score, accuracy, balanced_accuracy
from .policy import exploring_policy, greedy_actions
from .policy_improvement import Improver, ReplaySGD, decision_rewards
from .reward_update import expert_margin
from .tasks import Task


@dataclass(frozen=True, eq=False)
class IRLHistory:
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
    >>> from robonav.nirl import IRLHistory, learn
    >>> from robonav.robot import random_worlds
    >>> result = learn(demonstrate(random_worlds(2, obstacles=20, seed=3)), iterations=2)
    >>> isinstance(result.history, IRLHistory), len(result.history.costs)
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
        """Sum of absolute changes of each layer's weights in each iteration, (n, 2), Fig. 5.11.

        The biases count too, because they are column 0 of the matrices in Eq. (5.8).
        """
        layers = zip(self.networks.weights, self.networks.biases, strict=True)
        matrices = [np.concatenate([b[..., None], w], axis=-1) for w, b in layers]
        return np.stack([abs(np.diff(w, axis=0)).sum(axis=(1, 2)) for w in matrices], 1)


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
    history : IRLHistory
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
    history: IRLHistory
    chosen: int
    network: Network


@dataclass(frozen=True, eq=False)
class Iteration:
    """What an algorithm yields after each of its iterations.

    Attributes
    ----------
    episodes : Decisions
        The episodes of the iteration.
    theta : (A, k + 1) array
        Its reward weights.
    network : Network
        The network after it.
    cost : float
        The cost of the network.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import random_network
    >>> from robonav.nirl import Iteration, TabularTask, terrain
    >>> episodes = TabularTask(terrain()[1]).demonstrate(np.zeros(42, dtype=int), 1, seed=0)
    >>> Iteration(episodes, np.zeros((4, 43)), random_network((42, 5, 4), seed=0), 0.7).cost
    0.7
    """

    episodes: Decisions
    theta: Floats
    network: Network
    cost: float


class IRLRecorder:
    """The record of a training: it takes in each iteration, and makes the result at the end.

    Parameters
    ----------
    demonstrations : Decisions
        M decisions of the expert. Every network is scored by how well it predicts them.
    task : Task
        The task on which the network trains.
    network : Network
        The network before the first iteration.
    inverse_temperature : float
        eta of Eq. (5.10).
    iterations : int
        Iterations at most.
    progress : callable, optional
        Called as ``progress(done, iterations)`` after each iteration.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.networks import random_network
    >>> from robonav.nirl import Iteration, TabularTask, accuracy, terrain
    >>> from robonav.nirl.training import IRLRecorder
    >>> task, network = TabularTask(terrain()[1]), random_network((42, 5, 4), seed=0)
    >>> expert = task.demonstrate(np.zeros(42, dtype=int), 1, seed=0)
    >>> recorder = IRLRecorder(expert, task, network, inverse_temperature=25.0, iterations=1)
    >>> recorder.add(Iteration(expert, np.zeros((4, 43)), network, cost=0.7))
    >>> recorder.result(accuracy).history.costs
    array([0.7])
    """

    def __init__(
        self,
        demonstrations: Decisions,
        task: Task,
        network: Network,
        inverse_temperature: float,
        iterations: int,
        progress: Progress | None = None,
    ) -> None:
        self._demonstrations, self._task = demonstrations, task
        self._inverse_temperature = inverse_temperature
        self._most, self._progress = iterations, progress
        self._networks = [network]
        self._iterations: list[Iteration] = []
        self._margins: list[float] = []

    def add(self, iteration: Iteration) -> None:
        """Record an iteration.

        Parameters
        ----------
        iteration : Iteration
            Its episodes, its reward, the network after it, and the cost.

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.networks import random_network
        >>> from robonav.nirl import Iteration, TabularTask, terrain
        >>> from robonav.nirl.training import IRLRecorder
        >>> task, network = TabularTask(terrain()[1]), random_network((42, 5, 4), seed=0)
        >>> expert = task.demonstrate(np.zeros(42, dtype=int), 1, seed=0)
        >>> counts = []
        >>> def progress(done, all_of_them):
        ...     counts.append((done, all_of_them))
        >>> recorder = IRLRecorder(expert, task, network, 25.0, iterations=1, progress=progress)
        >>> recorder.add(Iteration(expert, np.zeros((4, 43)), network, cost=0.7))
        >>> counts
        [(1, 1)]
        """
        policy = exploring_policy(self._networks[-1], self._inverse_temperature)
        probabilities = policy(self._demonstrations.inputs)
        margin = expert_margin(self._demonstrations, probabilities, iteration.theta)
        self._margins.append(margin)
        self._networks.append(iteration.network)
        self._iterations.append(iteration)
        if self._progress is not None:
            self._progress(len(self._iterations), self._most)

    def result(self, score: Score) -> IRLResult:
        """The network that predicts the demonstrations best, and the history.

        Parameters
        ----------
        score : callable
            ``score(predicted, actions)``, such as :func:`accuracy`.

        Returns
        -------
        IRLResult

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.networks import random_network
        >>> from robonav.nirl import Iteration, TabularTask, accuracy, terrain
        >>> from robonav.nirl.training import IRLRecorder
        >>> task, network = TabularTask(terrain()[1]), random_network((42, 5, 4), seed=0)
        >>> expert = task.demonstrate(np.zeros(42, dtype=int), 1, seed=0)
        >>> recorder = IRLRecorder(expert, task, network, inverse_temperature=25.0, iterations=1)
        >>> recorder.add(Iteration(expert, np.zeros((4, 43)), network, cost=0.7))
        >>> recorder.result(accuracy).history.costs
        array([0.7])
        """
        expert = self._demonstrations
        predictions = [greedy_actions(net, expert.inputs) for net in self._networks]
        scores = [score(predicted, expert.actions) for predicted in predictions]
        chosen = int(np.argmax(scores))
        made = self._iterations
        n, shape = len(made), (self._task.n_actions, expert.features.shape[1])
        weights = np.array([one.theta for one in made]).reshape(n, *shape)
        history = IRLHistory(
            networks=stacked(self._networks),
            weights=weights,
            margins=np.array(self._margins),
            costs=np.array([one.cost for one in made]),
            arrived=np.array([one.episodes.arrived.mean() for one in made]),
            collided=np.array([one.episodes.collided.mean() for one in made]),
            decisions=np.array([len(one.episodes) for one in made], dtype=np.int64),
            accuracies=np.array([accuracy(p, expert.actions) for p in predictions]),
            balanced=np.array(
                [balanced_accuracy(p, expert.actions) for p in predictions]
            ),
        )
        network = self._networks[chosen]
        trained_for = weights[max(chosen - 1, 0)] if n else np.zeros(shape)
        return IRLResult(
            self._task.greedy(network), trained_for, history, chosen, network
        )


def training_method(
    algorithm: Callable[..., Iterator[Iteration]],
) -> Callable[..., IRLResult]:
    """Make a method of inverse reinforcement learning of an algorithm that trains a network.

    The algorithm is a generator: it gets a ``network`` with random weights and the generator ``rng`` of the random
    numbers, and yields each of its iterations. The function that users call checks its arguments, makes the network and
    ``rng``, records what the algorithm yields, and returns the network that predicts the demonstrations best. In place
    of ``network`` and ``rng`` it takes ``hidden``, ``score``, ``seed`` and ``progress``. ``inspect.unwrap`` of it is
    the algorithm as written.

    Parameters
    ----------
    algorithm : callable
        Its keyword arguments include ``iterations`` and ``inverse_temperature``.

    Returns
    -------
    callable

    Examples
    --------
    >>> import inspect
    >>> from robonav.nirl import nirl
    >>> sorted(set(inspect.signature(nirl).parameters) - set(inspect.signature(inspect.unwrap(nirl)).parameters))
    ['hidden', 'progress', 'score', 'seed']
    """
    signature = inspect.signature(algorithm)
    own = [p for name, p in signature.parameters.items() if name not in MADE]
    signature = signature.replace(parameters=own + ADDED, return_annotation="IRLResult")

    @wraps(algorithm)
    def train(*args: Any, **kwargs: Any) -> IRLResult:
        """Make the network, run the algorithm, and record it."""
        bound = signature.bind(*args, **kwargs)
        bound.apply_defaults()
        settings = bound.arguments
        hidden, score, seed, progress = (settings.pop(p.name) for p in ADDED)
        rng, task = np.random.default_rng(seed), settings["task"]
        network = random_network((task.n_inputs, hidden, task.n_actions), seed=rng)
        recorder = IRLRecorder(
            settings["demonstrations"], task, network,
            settings["inverse_temperature"], settings["iterations"], progress,
        )  # fmt: skip
        for iteration in algorithm(**settings, network=network, rng=rng):
            recorder.add(iteration)
        return recorder.result(score)

    documented = documents(DOCUMENTED, returns="IRLResult")
    return checked(documented(with_signature(train, signature)))


MADE = ("network", "rng")
"""What :func:`training_method` makes for an algorithm."""

ADDED = [
    inspect.Parameter(
        name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=kind
    )
    for name, default, kind in (
        ("hidden", 10, "int"),
        ("score", balanced_accuracy, "Score"),
        ("seed", 0, "int | np.random.Generator"),
        ("progress", None, "Progress | None"),
    )
]
"""What the function that :func:`training_method` makes takes in their place."""

DOCUMENTED = {
    "demonstrations": """Decisions
    The expert's decisions.""",
    "task": """Task
    The task on which the network trains.""",
    "iterations": """int
    Iterations at most.""",
    "inverse_temperature": """float
    eta of the Boltzmann policy, Eq. (5.10), over the network's outputs. These lie between 0 and 1.""",
    "hidden": """int
    Hidden units of the network.""",
    "score": """callable
    Measures how well a policy predicts the demonstrations: :func:`balanced_accuracy`, or the thesis's
    :func:`accuracy`. The best policy is the result.""",
    "seed": """int or numpy.random.Generator
    Seed of all random numbers.""",
    "progress": """callable, optional
    Called as ``progress(done, iterations)``.""",
}
"""Type and description of the arguments that all training methods share."""


@training_method
def train_under_reward(
    demonstrations: Decisions,
    task: Task,
    weights: Floats,
    network: Network,
    *,
    iterations: int = 140,
    inverse_temperature: float = 25.0,
    improver: Improver = ReplaySGD(),  # noqa: B008 - frozen
    rng: np.random.Generator,
) -> Iterator[Iteration]:
    """Neural policy iteration under a fixed reward: NIRL without its line 5.

    The demonstrations are used only to choose among the policies found.

    Parameters
    ----------
    weights : (A, k + 1) array
        theta of the reward.
    iterations : int
        Number of rollouts, each followed by an improvement.
    improver : Improver
        Improves the network.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import TabularTask, terrain, train_under_reward
    >>> task = TabularTask(terrain()[1])
    >>> expert = task.demonstrate(np.zeros(42, dtype=int), 1, seed=0)
    >>> train_under_reward(expert, task, np.zeros((4, 43)), iterations=2).policy.shape
    (42,)
    """
    theta = project_to_unit_ball(weights)
    episodes: list[Decisions] = []
    for iteration in range(iterations):
        policy = exploring_policy(network, inverse_temperature)
        episodes.append(task.rollout(policy, rng))
        pairs = concatenate_decisions(episodes[-improver.replay :])
        rewards = decision_rewards(theta, pairs)  # theta . f(s, a)
        fraction = iteration / max(iterations - 1, 1)
        network, cost = improver.improve(network, pairs, rewards, fraction, rng)
        yield Iteration(episodes[-1], theta, network, cost)
