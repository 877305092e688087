"""Agent and environment, step by step (Fig. 2.1): episodes of any Gymnasium environment with discrete spaces."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Protocol

import gymnasium as gym
import numpy as np
from numpy.typing import ArrayLike, NDArray

from robonav.progress import Progress

from . import policies
from ._arguments import checked
from .discrete_spaces import discretise_spaces, space_sizes

BLOCK = 4096  # random numbers drawn at a time: one by one they would cost more than the environment's step

# Training and evaluation draw the environment's seed from disjoint ranges, so even equal seeds give different episodes.
TRAINING, TESTING = range(2**31 - 1), range(2**31 - 1, 2**32 - 2)


class UniformNumbers:
    """The numbers that ``rng.random()`` would give, drawn in blocks; :attr:`random` gives the next one."""

    def __init__(self, rng: np.random.Generator) -> None:
        def stream() -> Iterator[float]:
            while True:
                yield from rng.random(BLOCK).tolist()

        self.random = stream().__next__


@checked
def discounted_return(rewards: ArrayLike, discount: float) -> NDArray[np.float64]:
    """Return from each step on, Eq. (2.3): ``G[t] = r[t] + discount * G[t + 1]``.

    ``G[0]`` is the return of the whole episode.

    Parameters
    ----------
    rewards : (T,) array
        Rewards of one episode.
    discount : float
        gamma, in [0, 1].

    Returns
    -------
    (T,) array

    Examples
    --------
    >>> from robonav.mdp import discounted_return
    >>> discounted_return([1, 0, 4], discount=0.5)
    array([2., 2., 4.])
    """
    returns = np.array(rewards, dtype=float)
    for t in reversed(range(len(returns) - 1)):
        returns[t] += discount * returns[t + 1]  # Eq. (2.3)
    return returns


@checked
def mean_return(trajectories: Iterable[Trajectory], discount: float) -> float:
    """Mean return of trajectories, an estimate of the value of their first state, Eq. (2.4).

    Parameters
    ----------
    trajectories : iterable of Trajectory
        Episodes of one policy that start in the same state.
    discount : float
        gamma, in [0, 1].

    Returns
    -------
    float

    Examples
    --------
    >>> from robonav.mdp import GridWorld, mean_return, rollouts
    >>> grid = GridWorld("S . G")
    >>> round(mean_return(rollouts(grid.environment(), [1, 1, 1], 10, seed=0), 0.9), 3)
    0.9
    """
    returns = [discounted_return(run.rewards, discount)[0] for run in trajectories]
    return float(np.mean(returns))  # Eq. (2.4)


@dataclass(frozen=True, eq=False)
class Trajectory:
    """One episode s, a, r, s', a', ... (Fig. 2.2).

    Attributes
    ----------
    states : (T + 1,) array of ints
        The states passed, the last one included.
    actions : (T,) array of ints
    rewards : (T,) array
        ``rewards[t]`` is the reward of taking ``actions[t]`` in ``states[t]``.
    terminated : bool
        Whether the episode ended in a terminal state; if not, it was cut off.

    Examples
    --------
    >>> from robonav.mdp import GridWorld, rollouts
    >>> rollouts(GridWorld("S . G").environment(), [1, 1, 1], 1, seed=0)[0].states
    array([0, 1, 2])
    """

    states: NDArray[np.int64]
    actions: NDArray[np.int64]
    rewards: NDArray[np.float64]
    terminated: bool


class Environment(Protocol):
    """What a learner uses of a Gymnasium environment."""

    def reset(self) -> tuple[Any, dict[str, Any]]:
        """Begin an episode: the first state, and information."""

    def step(self, action: int) -> tuple[Any, float, bool, bool, dict[str, Any]]:
        """Take an action: next state, reward, whether it is terminal, whether time is up, and information."""


class EpisodeLog(gym.Wrapper[Any, Any, Any, Any]):
    """An environment that keeps the records of its episodes.

    The first episode gets a seed, which is drawn from the range ``seeds``. An episode is cut off after ``max_steps``
    steps. It counts as done when the next one begins; call :meth:`end_episode` after the last.

    Attributes
    ----------
    returns : list of float
        Sum of the rewards of each episode, without discount.
    lengths : list of int
        Number of steps of each.
    visited_states : list of lists
        The states of each, if :meth:`record` was called.
    """

    def __init__(
        self,
        env: gym.Env[Any, Any],
        episodes: int,
        max_steps: int,
        rng: np.random.Generator,
        *,
        seeds: range = TRAINING,
        progress: Progress | None = None,
    ) -> None:
        super().__init__(env)
        self.returns: list[float] = []
        self.lengths: list[int] = []
        self.visited_states: list[list[Any]] = []
        self._seed: int | None = int(rng.integers(seeds.start, seeds.stop))
        self._step: Callable[[Any], Any] = env.step
        self._max_steps = max_steps
        self._estimates: Callable[[], NDArray[Any]] | None = None
        self._history: list[NDArray[Any]] = []
        self._states: list[Any] = []  # of the present episode
        self._progress, self._episodes = progress, episodes

    def record(self, estimates: Callable[[], NDArray[Any]]) -> None:
        """Keep the visited states, and what ``estimates()`` returns now and after each episode."""
        self._estimates = estimates
        self._history.append(estimates())

    @property
    def history(self) -> NDArray[Any] | None:
        """The recorded estimates, (episodes + 1, ...), or None if nothing was recorded."""
        return np.stack(self._history) if self._estimates else None

    def reset(
        self, *, seed: int | None = None, options: dict[str, Any] | None = None
    ) -> tuple[Any, dict[str, Any]]:
        """Begin an episode."""
        self.end_episode()
        state, info = self.env.reset(seed=self._seed, options=options)
        self._seed, self._return, self._states = None, 0.0, [state]
        return state, info

    def step(self, action: Any) -> tuple[Any, Any, bool, bool, dict[str, Any]]:
        """Take one step; the episode is truncated after ``max_steps``."""
        state, reward, terminated, truncated, info = self._step(action)
        self._return += reward
        self._states.append(state)
        truncated = truncated or len(self._states) > self._max_steps
        return state, reward, terminated, truncated, info

    def end_episode(self) -> None:
        """Add the present episode to the records, if there is one."""
        if not self._states:
            return
        self.returns.append(self._return)
        self.lengths.append(len(self._states) - 1)
        if self._estimates is not None:
            self.visited_states.append(self._states)
            self._history.append(self._estimates())
        if self._progress is not None:
            self._progress(len(self.returns), self._episodes)
        self._states = []


def rollout(env: Environment, policy: Callable[[int], int]) -> Trajectory:
    """One episode of a policy, a function from a state to an action."""
    state, _ = env.reset()
    states, actions, rewards, done = [state], [], [], False
    while not done:
        action = policy(state)
        state, reward, terminated, truncated, _ = env.step(action)
        states.append(state)
        actions.append(action)
        rewards.append(reward)
        done = terminated or truncated
    return Trajectory(
        np.array(states), np.array(actions), np.array(rewards, float), bool(terminated)
    )


def policy_sampler(
    policy: ArrayLike, n_states: int, n_actions: int, rng: np.random.Generator
) -> Callable[[int], int]:
    """Turn a policy into a function from state to action, which draws where the policy is stochastic.

    ``policy`` is (S,) actions or (S, A) probabilities.
    """
    table = policies.as_policy(policy, n_states, n_actions)
    if table.ndim == 1:
        return table.tolist().__getitem__
    thresholds = np.cumsum(table, axis=1)
    thresholds /= thresholds[:, -1:]
    numbers = UniformNumbers(rng)
    return lambda state: int(
        np.searchsorted(thresholds[state], numbers.random(), side="right")
    )


@checked
def rollouts(
    env: gym.Env[Any, Any],
    policy: ArrayLike,
    episodes: int,
    *,
    max_steps: int = 10_000,
    seed: int | np.random.Generator,
    progress: Progress | None = None,
) -> Sequence[Trajectory]:
    """Run a policy for whole episodes.

    Parameters
    ----------
    env : gymnasium.Env
        S discrete states, A discrete actions.
    policy : (S,) array of ints or (S, A) array of probabilities
    episodes : int
        Number of episodes.
    max_steps : int
        Steps after which an episode is cut off.
    seed : int or numpy.random.Generator
        For the environment and for the policy. Training and evaluation draw from disjoint seed ranges, so even equal
        seeds give different episodes.
    progress : callable, optional
        Called as ``progress(episodes done, episodes)``.

    Returns
    -------
    list of Trajectory

    Raises
    ------
    TypeError, ValueError
        If the spaces are not discrete or the policy does not fit them.

    Examples
    --------
    >>> from robonav.mdp import GridWorld, rollouts
    >>> env = GridWorld("S . G").environment()
    >>> [run.rewards.tolist() for run in rollouts(env, [1, 1, 1], 2, seed=0)]
    [[0.0, 1.0], [0.0, 1.0]]
    """
    env, rng = discretise_spaces(env), np.random.default_rng(seed)
    act = policy_sampler(policy, *space_sizes(env), rng)
    log = EpisodeLog(env, episodes, max_steps, rng, seeds=TESTING, progress=progress)
    trajectories = [rollout(log, act) for _ in range(episodes)]
    log.end_episode()
    return trajectories
