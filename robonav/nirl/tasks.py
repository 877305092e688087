"""Tasks on which a policy makes its episodes (line 4 of Algorithm 10): the robot in new maps, or a finite MDP."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.lfd.demonstrations import LEARNED
from robonav.networks.multilayer_perceptron import Network
from robonav.networks.policy import NetworkPolicy, sample_actions
from robonav.robot import (
    COLLISION_DISTANCE,
    REFLEX,
    Encoder,
    ReflexRule,
    Sensing,
    Simulator,
    Worlds,
    random_worlds,
    run_episodes,
    sense,
)
from robonav.robot._fast import ARRIVED, COLLIDED
from robonav.validation import check_integer, check_positive

from .decisions import ENCODER, Decisions, Floats, Ints, add_constant
from .policy import ActionProbabilities
from .reward_free_mdp import RewardFreeMDP, Trajectories


class Task(Protocol):
    """A task on which a policy makes episodes.

    Examples
    --------
    >>> from robonav.nirl import RobotTask, Task
    >>> task: Task = RobotTask()
    >>> task.n_inputs, task.n_actions
    (17, 5)
    """

    @property
    def n_inputs(self) -> int:
        """k, the number of a policy's inputs."""

    @property
    def n_actions(self) -> int:
        """A, the number of actions."""

    def rollout(
        self, policy: ActionProbabilities, rng: np.random.Generator
    ) -> Decisions:
        """A few episodes with a policy, each from a new start.

        Parameters
        ----------
        policy : callable
            ``policy(inputs)`` returns the probabilities (M, A) of the actions.
        rng : numpy.random.Generator
            Of the random numbers.

        Returns
        -------
        Decisions

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.nirl import TabularTask, terrain
        >>> task, rng = TabularTask(terrain()[1], n_episodes=2, max_steps=3), np.random.default_rng(0)
        >>> len(task.rollout(lambda inputs: np.full((len(inputs), 4), 0.25), rng))
        6
        """

    def rollout_from(
        self,
        demonstrations: Decisions,
        index: Ints,
        policy: ActionProbabilities,
        n_decisions: int,
        rng: np.random.Generator,
    ) -> Decisions:
        """Segments of ``n_decisions`` decisions at most, each begun where a demonstrated decision was made.

        Parameters
        ----------
        demonstrations : Decisions
            Decisions of an expert.
        index : (K,) array of int
            The decisions where the K segments begin.
        policy : callable
            ``policy(inputs)`` returns the probabilities (M, A) of the actions.
        n_decisions : int
            Decisions of a segment, at most.
        rng : numpy.random.Generator
            Of the random numbers.

        Returns
        -------
        Decisions

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.nirl import TabularTask, terrain
        >>> task, rng = TabularTask(terrain()[1]), np.random.default_rng(0)
        >>> expert = task.demonstrate(np.zeros(42, dtype=int), 1, seed=0)
        >>> uniform = lambda inputs: np.full((len(inputs), 4), 0.25)
        >>> len(task.rollout_from(expert, np.array([0, 2]), uniform, 3, rng))
        6
        """

    def greedy(self, network: Network) -> Any:
        """The policy that always takes the action with the largest output of a network.

        Parameters
        ----------
        network : Network
            A trained network.

        Returns
        -------
        object
            A policy of the task's own kind.

        Examples
        --------
        >>> from robonav.networks import random_network
        >>> from robonav.nirl import TabularTask, terrain
        >>> TabularTask(terrain()[1]).greedy(random_network((42, 5, 4), seed=0)).shape
        (42,)
        """


@dataclass(frozen=True, eq=False)
class RobotTask:
    """The robot in new random maps. Its reflex acts as usual; only the decisions of the policy are kept.

    Attributes
    ----------
    n_episodes : int
        Episodes of a rollout, each in a map of its own.
    obstacles, moving : int
        Of the maps.
    speed : float
        m/s.
    max_steps : int
        Seconds after which an episode ends.
    encoder : Encoder
        phi.
    reflex : callable, optional
        What the robot does before the policy is asked, see :class:`robonav.robot.Reflex`.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import RobotTask
    >>> task = RobotTask(n_episodes=2, obstacles=5)
    >>> uniform = lambda inputs: np.full((len(inputs), 5), 0.2)
    >>> len(task.rollout(uniform, np.random.default_rng(0)).arrived)
    2
    """

    n_episodes: int = 10
    obstacles: int = 20
    moving: int = 0
    speed: float = 2.0
    max_steps: int = 200
    encoder: Encoder = ENCODER
    reflex: ReflexRule | None = REFLEX

    def __post_init__(self) -> None:
        check_integer("n_episodes", self.n_episodes, at_least=1)
        check_integer("max_steps", self.max_steps, at_least=1)
        check_positive("speed", self.speed)

    @property
    def n_inputs(self) -> int:
        return self.encoder.size

    @property
    def n_actions(self) -> int:
        return LEARNED

    def greedy(self, network: Network) -> NetworkPolicy:
        """The network as a policy that :func:`robonav.robot.navigate` takes.

        Parameters
        ----------
        network : Network
            A trained network.

        Returns
        -------
        NetworkPolicy

        Examples
        --------
        >>> from robonav.networks import random_network
        >>> from robonav.nirl import RobotTask
        >>> task = RobotTask()
        >>> task.greedy(random_network((task.n_inputs, 5, task.n_actions), seed=0)).network.sizes
        (17, 5, 5)
        """
        return NetworkPolicy(network, self.encoder)

    def rollout(
        self, policy: ActionProbabilities, rng: np.random.Generator
    ) -> Decisions:
        """``n_episodes`` episodes, each in a new map.

        Parameters
        ----------
        policy : callable
            ``policy(inputs)`` returns the probabilities (M, A) of the actions.
        rng : numpy.random.Generator
            Of the random numbers.

        Returns
        -------
        Decisions

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.nirl import RobotTask
        >>> task, rng = RobotTask(obstacles=20, n_episodes=2), np.random.default_rng(0)
        >>> uniform = lambda inputs: np.full((len(inputs), task.n_actions), 1 / task.n_actions)
        >>> len(task.rollout(uniform, rng).collided)
        2
        """
        worlds = random_worlds(self.n_episodes, self.obstacles, self.moving, seed=rng)
        simulator = Simulator(worlds, self.speed, max_steps=self.max_steps)
        return collect(simulator, policy, self.encoder, rng, reflex=self.reflex)

    def rollout_from(
        self,
        demonstrations: Decisions,
        index: Ints,
        policy: ActionProbabilities,
        n_decisions: int,
        rng: np.random.Generator,
    ) -> Decisions:
        """Segments begun at the poses of demonstrated decisions; obstacles stand where they start.

        Parameters
        ----------
        demonstrations : Decisions
            Decisions of an expert, with the robot's states.
        index : (K,) array of int
            The decisions where the K segments begin.
        policy : callable
            ``policy(inputs)`` returns the probabilities (M, A) of the actions.
        n_decisions : int
            Decisions of a segment, at most.
        rng : numpy.random.Generator
            Of the random numbers.

        Returns
        -------
        Decisions

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.lfd import demonstrate
        >>> from robonav.nirl import RobotTask, expert_decisions
        >>> from robonav.robot import random_worlds
        >>> expert = expert_decisions(demonstrate(random_worlds(2, obstacles=20, seed=3)))
        >>> task, rng = RobotTask(), np.random.default_rng(0)
        >>> uniform = lambda inputs: np.full((len(inputs), task.n_actions), 1 / task.n_actions)
        >>> len(task.rollout_from(expert, np.array([0, 1]), uniform, 1, rng))
        2
        """
        states = demonstrations.states
        if states is None:
            raise ValueError("demonstrations must hold the robot's states, got none")
        worlds = states.worlds[demonstrations.trajectory[index]]
        simulator = Simulator(worlds, states.speed, max_steps=self.max_steps)
        simulator.poses = np.ascontiguousarray(states.poses[index], dtype=float)
        return collect(
            simulator, policy, self.encoder, rng, reflex=self.reflex, n_decisions=n_decisions
        )  # fmt: skip


def collect(
    simulator: Simulator,
    policy: ActionProbabilities,
    encoder: Encoder,
    rng: np.random.Generator,
    *,
    reflex: ReflexRule | None = REFLEX,
    n_decisions: int | None = None,
) -> Decisions:
    """Run the robots of a simulator with a policy, for ``n_decisions`` decisions each at most."""
    made = np.zeros(len(simulator), dtype=np.int64)
    rows: list[tuple[Ints, Floats, Ints, Ints]] = []

    def select_actions(simulator: Simulator, sensing: Sensing, robots: Ints) -> Ints:
        inputs = encoder(sensing)
        actions = sample_actions(policy(inputs), rng.random(len(inputs)))
        rows.append((robots, inputs, actions, simulator.steps[robots]))
        made[robots] += 1
        return actions

    for _ in run_episodes(simulator, select_actions, reflex=reflex):
        if n_decisions is not None:
            simulator.stop(np.flatnonzero(made >= n_decisions))
    return _by_episode(rows, encoder.size, simulator.outcome)


def _by_episode(
    rows: list[tuple[Ints, Floats, Ints, Ints]], width: int, outcome: NDArray[np.int8]
) -> Decisions:
    """Decisions sorted by episode, from decisions sorted by time."""
    nothing = np.empty(0, np.int64)
    empty = (nothing, np.empty((0, width)), nothing, nothing)
    owner, inputs, actions, times = (
        np.concatenate(column) for column in zip(empty, *rows, strict=True)
    )
    order = np.argsort(owner, kind="stable")
    return Decisions(
        inputs[order],
        actions[order],
        owner[order],
        times[order],
        outcome == COLLIDED,
        outcome == ARRIVED,
    )


@dataclass(frozen=True, eq=False)
class TabularTask:
    """A finite MDP with one input a state. An episode ends in a terminal state, or after ``max_steps``.

    Attributes
    ----------
    mdp : RewardFreeMDP
        S states, A actions.
    n_episodes : int
        Episodes of a rollout.
    max_steps : int
        Steps of each at most.

    Examples
    --------
    >>> from robonav.nirl import TabularTask, terrain
    >>> grid, mdp = terrain()
    >>> task = TabularTask(mdp)
    >>> task.n_inputs, task.n_actions
    (42, 4)
    """

    mdp: RewardFreeMDP
    n_episodes: int = 10
    max_steps: int = 40

    @property
    def n_inputs(self) -> int:
        return self.mdp.n_states

    @property
    def n_actions(self) -> int:
        return self.mdp.n_actions

    def greedy(self, network: Network) -> NDArray[np.intp]:
        """The best action of each state.

        Parameters
        ----------
        network : Network
            A trained network.

        Returns
        -------
        (S,) array of int

        Examples
        --------
        >>> from robonav.networks import random_network
        >>> from robonav.nirl import TabularTask, terrain
        >>> TabularTask(terrain()[1]).greedy(random_network((42, 5, 4), seed=0)).shape
        (42,)
        """
        return network.decide(np.eye(self.mdp.n_states))

    def rollout(
        self, policy: ActionProbabilities, rng: np.random.Generator
    ) -> Decisions:
        """``n_episodes`` episodes from the initial state.

        Parameters
        ----------
        policy : callable
            ``policy(inputs)`` returns the probabilities (S, A) of the actions.
        rng : numpy.random.Generator
            Of the random numbers.

        Returns
        -------
        Decisions

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.nirl import TabularTask, terrain
        >>> task, rng = TabularTask(terrain()[1], n_episodes=2, max_steps=3), np.random.default_rng(0)
        >>> len(task.rollout(lambda inputs: np.full((len(inputs), 4), 0.25), rng))
        6
        """
        probabilities = policy(np.eye(self.mdp.n_states))
        return self.demonstrate(probabilities, self.n_episodes, seed=rng)

    def rollout_from(
        self,
        demonstrations: Decisions,
        index: Ints,
        policy: ActionProbabilities,
        n_decisions: int,
        rng: np.random.Generator,
    ) -> Decisions:
        """Segments begun in the states of demonstrated decisions.

        Parameters
        ----------
        demonstrations : Decisions
            Decisions of an expert.
        index : (K,) array of int
            The decisions where the K segments begin.
        policy : callable
            ``policy(inputs)`` returns the probabilities (S, A) of the actions.
        n_decisions : int
            Decisions of a segment, at most.
        rng : numpy.random.Generator
            Of the random numbers.

        Returns
        -------
        Decisions

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.nirl import TabularTask, terrain
        >>> task, rng = TabularTask(terrain()[1]), np.random.default_rng(0)
        >>> expert = task.demonstrate(np.zeros(42, dtype=int), 1, seed=0)
        >>> uniform = lambda inputs: np.full((len(inputs), 4), 0.25)
        >>> len(task.rollout_from(expert, np.array([0, 2]), uniform, 3, rng))
        6
        """
        first = demonstrations.inputs[index].argmax(axis=1)
        probabilities = policy(np.eye(self.mdp.n_states))
        n = len(first)
        return self._decisions(
            self.mdp.rollout(probabilities, n, n_decisions, seed=rng, first=first)
        )

    def demonstrate(
        self, policy: ArrayLike, n_episodes: int, *, seed: int | np.random.Generator
    ) -> Decisions:
        """Episodes with a known policy, for instance an expert's.

        Parameters
        ----------
        policy : (S,) array of int or (S, A) array
            Actions or probabilities.
        n_episodes : int
            How many episodes.
        seed : int or Generator
            Of the random numbers.

        Returns
        -------
        Decisions

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.nirl import TabularTask, terrain
        >>> task = TabularTask(terrain()[1], max_steps=5)
        >>> len(task.demonstrate(np.zeros(42, dtype=int), 2, seed=0))
        10
        """
        return self._decisions(
            self.mdp.rollout(policy, n_episodes, self.max_steps, seed=seed)
        )

    def _decisions(self, trajectories: Trajectories) -> Decisions:
        """The decisions of trajectories, up to the terminal states."""
        alive = ~self.mdp.terminal[trajectories.states]
        steps = np.broadcast_to(np.arange(alive.shape[1]), alive.shape)
        return Decisions(
            np.eye(self.mdp.n_states)[trajectories.states[alive]],
            trajectories.actions[alive],
            trajectories.trajectory[alive.ravel()],
            steps[alive],
            np.zeros(len(alive), dtype=bool),
            ~alive[:, -1],
        )


def reward_map(
    world: Worlds, weights: ArrayLike, encoder: Encoder, *, spacing: float = 1.0
) -> Floats:
    """The reward of going straight on at the points of a grid over a world, if the robot faces the target.

    It is NaN within a metre of an obstacle, and where nothing is in range: there the policy decides nothing.

    Parameters
    ----------
    world : Worlds
        Batch of one: the map.
    weights : (5, k + 1) array
        theta, a row for each action.
    encoder : Encoder
        Turns what the robot senses into inputs.
    spacing : float
        Metres between two points of the grid.

    Returns
    -------
    (n, n) array
        Rows from the lower border of the map to the upper one.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.nirl import ENCODER
    >>> from robonav.nirl.tasks import reward_map
    >>> from robonav.robot import make_world
    >>> weights = np.eye(5, ENCODER.size + 1)
    >>> reward = reward_map(make_world(circles=[(50, 50, 3)]), weights, ENCODER, spacing=5.0)
    >>> reward.shape, bool(np.isnan(reward[10, 10]))  # inside the obstacle
    ((20, 20), True)
    """
    ticks = np.arange(spacing / 2, world.size, spacing)
    x, y = (part.ravel() for part in np.meshgrid(ticks, ticks))
    heading = np.arctan2(world.targets[0, 1] - y, world.targets[0, 0] - x)
    poses = np.column_stack([x, y, heading])
    sensing = sense(world[np.zeros(len(x), dtype=int)], poses)
    reward = add_constant(encoder(sensing)) @ np.asarray(weights, dtype=float)[0]
    reward[sensing.safe | (sensing.ranges.min(axis=1) < COLLISION_DISTANCE)] = np.nan
    return reward.reshape(len(ticks), -1)
