"""S agents a method: what each learns from a step, and at the end of an episode."""

from __future__ import annotations

from copy import deepcopy
from dataclasses import dataclass
from inspect import unwrap
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.special import expit

from .. import schedules, updates
from ..dqn import TargetRule, double_dqn_targets, dqn_targets
from ..schedules import Schedule
from ..task import REPLAYING, make_rng
from .networks import Array, BatchedNetworks, Rows
from .replay_buffers import ReplayBuffers

# Called in every step with arrays of this module, and so without the checks of their arguments.
geometric_schedule = unwrap(schedules.geometric_schedule)
q_targets, clip = unwrap(updates.q_targets), unwrap(updates.clip)
RESCALE = {name: unwrap(rescale) for name, rescale in updates.RESCALE.items()}


@dataclass(frozen=True, eq=False)
class Experience:
    """What K robots went through in a step that their policy decided.

    Attributes
    ----------
    inputs, reached : (K, n) arrays
        What the network reads before and after the step.
    values : (K, A) array
        Q-values before the step.
    actions, rewards : (K,) arrays
        Actions taken and rewards received.
    terminal : (K,) array of bool
        Whether the robot has arrived or collided.
    fraction : (K,) array
        How much of the training was over when the episode began, 0 to 1.
    """

    inputs: Array
    values: Array
    actions: NDArray[np.int64]
    rewards: Array
    reached: Array
    terminal: NDArray[np.bool_]
    fraction: Array


class Agent:
    """S networks that act and do not learn. The methods are subclasses, which do.

    The networks' outputs, between 0 and 1, are the Q-values.

    Parameters
    ----------
    networks : BatchedNetworks
        One network for each seed.
    """

    def __init__(self, networks: BatchedNetworks) -> None:
        self.networks = networks

    def values(self, rows: Rows, x: Array) -> Array:
        """Q-values (K, A) by the networks ``rows`` (K,), each for one input of ``x`` (K, n)."""
        q: Array = expit(self.networks.logits(rows, x[:, None])[:, 0])
        return q

    def observe(self, rows: Rows, decisions: Experience) -> None:
        """Learn from one step of each of ``rows``."""

    def end_episode(self, rows: Rows, episodes: Rows) -> None:
        """Learn at the end of an episode: each of ``rows`` has now finished ``episodes`` of them."""

    def state(self) -> dict[str, NDArray]:
        """Copies, by name, of all arrays that training continues from between episodes."""
        return {"parameters": self.networks.parameters()}

    def restore(self, state: dict[str, NDArray]) -> None:
        """Continue from a :meth:`state`."""
        self.networks.load(np.arange(len(state["parameters"])), state["parameters"])


class NNQLAgent(Agent):
    """The twin of :func:`robonav.nnql.nnql` and, with a memory of one pair, of :func:`robonav.nnql.online`.

    Parameters
    ----------
    networks : BatchedNetworks
        One network for each seed.
    shape : (S, L, n, A)
        Seeds, steps that an episode lasts at most, inputs, actions.
    pairs : int
        How many of the latest pairs to train on; L is NNQL, 1 is online Q-learning.
    learning_rate, discount, gradient_step, rescale, passes, tolerance
        See :func:`robonav.nnql.nnql`.
    """

    def __init__(
        self,
        networks: BatchedNetworks,
        shape: tuple[int, int, int, int],
        *,
        pairs: int,
        learning_rate: Schedule,
        discount: float,
        gradient_step: Schedule,
        rescale: str,
        passes: int,
        tolerance: float,
    ) -> None:
        super().__init__(networks)
        seeds, steps, inputs, actions = shape
        self.inputs = np.empty((seeds, steps, inputs))
        self.targets = np.empty((seeds, steps, actions))
        self.count = np.zeros(seeds, np.int64)
        self.pairs, self.discount = pairs, discount
        self.learning_rate, self.gradient_step = learning_rate, gradient_step
        self.rescale, self.passes, self.tolerance = RESCALE[rescale], passes, tolerance

    def observe(self, rows: Rows, decisions: Experience) -> None:
        future = self.values(rows, decisions.reached).max(axis=1)
        q = q_targets(
            decisions.values,
            decisions.actions,
            decisions.rewards,
            np.where(decisions.terminal, 0.0, future),
            geometric_schedule(self.learning_rate, decisions.fraction),
            self.discount,
        )
        self.inputs[rows, self.count[rows]] = decisions.inputs
        self.targets[rows, self.count[rows]] = self.rescale(q)
        self.count[rows] += 1
        last = self.count[rows]
        self.networks.sgd(
            rows, self.inputs, self.targets, np.maximum(last - self.pairs, 0), last,
            gradient_step=geometric_schedule(self.gradient_step, decisions.fraction),
            passes=self.passes, tolerance=self.tolerance,
        )  # fmt: skip

    def end_episode(self, rows: Rows, episodes: Rows) -> None:
        self.count[rows] = 0  # the next episode gathers its own pairs


class NFQAgent(Agent):
    """The twin of :func:`robonav.nnql.nfq`.

    Parameters
    ----------
    networks : BatchedNetworks
        One network for each seed.
    shape : (S, n)
        Seeds, inputs.
    discount, episodes_per_fit, sweeps, epochs, tolerance
        See :func:`robonav.nnql.nfq`.
    """

    def __init__(
        self,
        networks: BatchedNetworks,
        shape: tuple[int, int],
        *,
        discount: float,
        episodes_per_fit: int,
        sweeps: int,
        epochs: int,
        tolerance: float,
    ) -> None:
        super().__init__(networks)
        self.buffers = ReplayBuffers(*shape)
        self.discount, self.episodes_per_fit = discount, episodes_per_fit
        self.sweeps, self.epochs, self.tolerance = sweeps, epochs, tolerance

    def observe(self, rows: Rows, decisions: Experience) -> None:
        self.buffers.append(
            rows, decisions.inputs, decisions.actions, decisions.rewards, decisions.reached, decisions.terminal,
        )  # fmt: skip

    def end_episode(self, rows: Rows, episodes: Rows) -> None:
        due = (episodes % self.episodes_per_fit == 0) & (self.buffers.count[rows] > 0)
        for row in rows[due]:
            self._fit(np.array([row]))

    def _fit(self, row: Rows) -> None:
        """Fit one network to its buffer, ``sweeps`` times over."""
        x, actions, rewards, reached, terminal = self.buffers.all_of(row)
        for _ in range(self.sweeps):
            future = expit(self.networks.logits(row, reached).max(axis=2))
            targets = clip(rewards + self.discount * np.where(terminal, 0.0, future))
            self._rprop_fit(row, x, actions, targets)

    def _rprop_fit(
        self, row: Rows, x: Array, actions: NDArray[np.int64], targets: Array
    ) -> None:
        previous, sizes, last = np.inf, np.array(_FIRST_STEP), np.array(0.0)
        for _ in range(self.epochs):
            gradient, cost = self.networks.gradients(
                row, x, actions, targets, linear=False
            )
            update, sizes, last = rprop(gradient, sizes, last)
            self.networks.apply_update(row, update)
            if abs(previous - cost[0]) < self.tolerance:
                break
            previous = cost[0]

    def state(self) -> dict[str, NDArray]:
        return super().state() | self.buffers.state()

    def restore(self, state: dict[str, NDArray]) -> None:
        super().restore(state)
        self.buffers.restore(state)


class DQNAgent(Agent):
    """The twin of :func:`robonav.nnql.dqn`; the outputs are linear.

    Parameters
    ----------
    networks : BatchedNetworks
        One network for each seed.
    seeds : (S,) tuple of int
        For the generators of the replay.
    inputs : int
        n.
    discount, gradient_step, batch_size, target_update_interval
        See :func:`robonav.nnql.dqn`.
    targets : callable
        :func:`robonav.nnql.dqn_targets` or :func:`robonav.nnql.double_dqn_targets`.

    Raises
    ------
    ValueError
        If ``targets`` is another function, which has no twin here.
    """

    def __init__(
        self,
        networks: BatchedNetworks,
        seeds: tuple[int, ...],
        inputs: int,
        *,
        discount: float,
        gradient_step: float,
        batch_size: int,
        target_update_interval: int,
        targets: TargetRule = dqn_targets,
    ) -> None:
        super().__init__(networks)
        if targets not in (dqn_targets, double_dqn_targets):
            raise ValueError(
                f"targets must be dqn_targets or double_dqn_targets in fast training, got {targets}"
            )
        self.targets = targets
        self.target, self.seeds = deepcopy(networks), seeds
        self.discount, self.gradient_step = discount, gradient_step
        self.batch_size, self.interval = batch_size, target_update_interval
        self.buffers = ReplayBuffers(len(seeds), inputs)
        self.first, self.second = (
            np.zeros_like(networks.parameters()) for _ in range(2)
        )
        self.episodes = np.zeros(len(seeds), np.int64)
        self.rngs = [make_rng(seed, REPLAYING, 0) for seed in seeds]

    def values(self, rows: Rows, x: Array) -> Array:
        return self.networks.logits(rows, x[:, None])[:, 0]

    def observe(self, rows: Rows, decisions: Experience) -> None:
        self.buffers.append(
            rows, decisions.inputs, decisions.actions, decisions.rewards, decisions.reached, decisions.terminal,
        )  # fmt: skip
        ready = rows[self.buffers.count[rows] >= self.batch_size]
        if len(ready):
            updates = self.buffers.count[ready] - self.batch_size + 1
            self._update(ready, updates)
            due = ready[updates % self.interval == 0]
            if len(due):
                self.target.load(due, self.networks.parameters()[due])

    def end_episode(self, rows: Rows, episodes: Rows) -> None:
        """Give each episode a generator of its own, so that training can continue from here."""
        self.episodes[rows] = episodes
        for row in rows:
            episode = int(self.episodes[row])
            self.rngs[row] = make_rng(self.seeds[row], REPLAYING, episode)

    def _update(self, rows: Rows, number: NDArray[np.int64]) -> None:
        """Update ``number`` (K,) of each of ``rows`` (K,): a step of Adam on a batch of its own."""
        drawn = [
            self.rngs[row].integers(self.buffers.count[row], size=self.batch_size)
            for row in rows
        ]
        x, actions, rewards, reached, terminal = self.buffers.at(rows, np.array(drawn))
        values = self.target.logits(rows, reached)
        double = self.targets is double_dqn_targets
        choosing = self.networks.logits(rows, reached) if double else values
        best = choosing.argmax(axis=2)[..., None]
        future = np.take_along_axis(values, best, axis=2)
        targets = rewards + self.discount * np.where(terminal, 0.0, future[..., 0])
        gradient, _ = self.networks.gradients(rows, x, actions, targets, linear=True)
        direction, self.first[rows], self.second[rows] = adam(
            gradient, self.first[rows], self.second[rows], number[:, None]
        )
        self.networks.apply_update(rows, self.gradient_step * direction)

    def state(self) -> dict[str, NDArray]:
        more = {"target": self.target.parameters()}
        more |= {
            name: getattr(self, name).copy() for name in ("first", "second", "episodes")
        }
        return super().state() | self.buffers.state() | more

    def restore(self, state: dict[str, NDArray]) -> None:
        super().restore(state)
        self.buffers.restore(state)
        everyone = np.arange(len(self.seeds))
        self.target.load(everyone, state["target"])
        self.first, self.second = state["first"].copy(), state["second"].copy()
        self.end_episode(everyone, state["episodes"])


_MOMENTS = (0.9, 0.999)  # of Adam, as in Kingma and Ba (2015)


def adam(
    gradient: Array, first: Array, second: Array, number: ArrayLike
) -> tuple[Array, Array, Array]:
    """The direction of Adam (Kingma and Ba 2015), for networks that have made different numbers of steps.

    torch's Adam has one count of steps for all parameters. Here each row of a batch has its own, because the episodes
    of the robots have different lengths.

    Parameters
    ----------
    gradient : (...) array
        Of the cost.
    first, second : (...) arrays
        Moments before this step.
    number : (...) array of int
        Number of this step, from 1 on; broadcasts with the gradient.

    Returns
    -------
    direction : (...) array
        What to subtract from the parameters, times the step.
    first, second : (...) arrays
        Moments after this step.
    """
    (a, b), count = _MOMENTS, np.asarray(number, dtype=float)
    first, second = a * first + (1 - a) * gradient, b * second + (1 - b) * gradient**2
    return (
        first / (1 - a**count) / (np.sqrt(second / (1 - b**count)) + 1e-8),
        first,
        second,
    )


_GROW, _SHRINK, _FIRST_STEP, _SIZES = 1.2, 0.5, 0.01, (1e-6, 50.0)  # of Rprop's authors


def rprop(gradient: Array, sizes: Array, last: Array) -> tuple[Array, Array, Array]:
    """One step of Rprop (Riedmiller and Braun 1993): only the signs of the gradient count.

    A parameter's step grows while its derivative keeps its sign. Where the sign turned, the parameter jumped over a
    minimum: its step shrinks, and it waits for one step.

    Parameters
    ----------
    gradient : (...) array
        Of the cost.
    sizes : (...) array
        Sizes of the last step, positive; or one number for all.
    last : (...) array
        The gradient before; 0 where the parameter waited, and at the first step.

    Returns
    -------
    update : (...) array
        What to subtract from the parameters.
    sizes, last : (...) arrays
        For the next step.
    """
    turned = gradient * last
    factor = np.where(turned > 0, _GROW, np.where(turned < 0, _SHRINK, 1.0))
    sizes = np.clip(sizes * factor, *_SIZES)
    gradient = np.where(turned < 0, 0.0, gradient)
    return np.sign(gradient) * sizes, sizes, gradient


def make_agent(
    method: str,
    networks: BatchedNetworks,
    seeds: tuple[int, ...],
    steps: int,
    sizes: tuple[int, ...],
    settings: dict[str, Any],
) -> Agent:
    """The agents of a method for S seeds.

    Parameters
    ----------
    method : {"nnql", "online", "nfq", "dqn"}
        The method.
    networks : BatchedNetworks
        With random weights.
    seeds : (S,) tuple of int
        The seeds.
    steps : int
        Steps that an episode lasts at most.
    sizes : (n, H, A)
        Of the networks.
    settings : dict
        Of the method, by name.
    """
    if method == "nfq":
        return NFQAgent(networks, (len(seeds), sizes[0]), **settings)
    if method == "dqn":
        return DQNAgent(networks, seeds, sizes[0], **settings)
    pairs = {"nnql": steps, "online": 1}[method]
    shape = (len(seeds), steps, sizes[0], sizes[-1])
    return NNQLAgent(networks, shape, pairs=pairs, **settings)
