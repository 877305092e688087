"""Agent and environment, step by step (Fig. 2.1): episodes of any Gymnasium environment with discrete spaces."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

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


def uniform_stream(rng: np.random.Generator) -> Iterator[float]:
    """Endless stream of numbers drawn uniformly from [0, 1)."""
    while True:
        yield from rng.random(BLOCK).tolist()


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


class EpisodeRunner:
    """Episodes of an environment, one after the other, with their returns and lengths.

    The loop of every learner::

        for state in runner.episodes():
            while not runner.done:
                next_state, reward, terminated = runner.step(action)

    An episode is over when the environment ends it or cuts it off, or after ``max_steps``. With ``record``, the states
    of each episode stay in ``visited_states``, and a copy of the array or nested list given to :meth:`watch` is kept
    before the first episode and after each. The environment's seed is drawn from the range ``seeds``.
    """

    def __init__(
        self,
        env: gym.Env[Any, Any],
        episodes: int,
        *,
        max_steps: int,
        rng: np.random.Generator,
        seeds: range = TRAINING,
        record: bool = False,
        progress: Progress | None = None,
    ) -> None:
        self.n_episodes = episodes
        self.max_steps = max_steps
        self.episode = 0
        self.returns: list[float] = []
        self.lengths: list[int] = []
        self.visited_states: list[list[Any]] = []
        self.done = True
        self._step: Callable[[int], tuple[Any, Any, bool, bool, Any]] = env.step
        self._reset = env.reset
        self._env_seed = int(rng.integers(seeds.start, seeds.stop))
        self._record = record
        self._watched: Any = None
        self._history: list[NDArray[Any]] = []
        self._progress = progress

    def watch(self, table: Any) -> Any:
        """Keep a copy of ``table`` now and after each episode, if recording; returns the table itself."""
        self._watched = table
        if self._record:
            self._history.append(np.array(table))
        return table

    @property
    def history(self) -> NDArray[Any] | None:
        """The copies of the watched table, (episodes + 1, ...), or None if nothing is recorded."""
        return np.stack(self._history) if self._record else None

    def episodes(self) -> Iterator[Any]:
        """First state of each episode; ``episode`` is the number of the episode, from 0."""
        for episode in range(self.n_episodes):
            self.episode = episode
            state, _ = self._reset(seed=self._env_seed if episode == 0 else None)
            self.done, self._return, self._passed = False, 0.0, [state]
            yield state
            self.returns.append(self._return)
            self.lengths.append(len(self._passed) - 1)
            if self._record:
                self.visited_states.append(self._passed)
                if self._watched is not None:
                    self._history.append(np.array(self._watched))
            if self._progress is not None:
                self._progress(episode + 1, self.n_episodes)

    def step(self, action: int) -> tuple[Any, float, bool]:
        """Take an action: next state, reward, and whether that state is terminal (a cut-off one is not)."""
        state, reward, terminated, truncated, _ = self._step(action)
        self._return += reward
        self._passed.append(state)
        self.done = terminated or truncated or len(self._passed) > self.max_steps
        return state, reward, terminated

    def rollout(self, state: int, choose: Callable[[int], int]) -> Trajectory:
        """Run the episode from ``state`` to its end with the actions ``choose(state)``."""
        states, actions, rewards, terminated = [state], [], [], False
        while not self.done:
            action = choose(state)
            state, reward, terminated = self.step(action)
            states.append(state)
            actions.append(action)
            rewards.append(reward)
        return Trajectory(
            np.array(states),
            np.array(actions),
            np.array(rewards, dtype=float),
            bool(terminated),
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
    draw = uniform_stream(rng)
    return lambda state: int(
        np.searchsorted(thresholds[state], next(draw), side="right")
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
    choose = policy_sampler(policy, *space_sizes(env), rng)
    runner = EpisodeRunner(
        env, episodes, max_steps=max_steps, rng=rng, seeds=TESTING, progress=progress
    )
    return [runner.rollout(state, choose) for state in runner.episodes()]
