"""An agent and its environment, step by step (Fig. 2.1): episodes of any Gymnasium environment with discrete spaces."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any

import gymnasium as gym
import numpy as np
from gymnasium import spaces
from gymnasium.wrappers import TransformAction, TransformObservation
from numpy.typing import ArrayLike, NDArray

from robonav.progress import Progress
from robonav.validation import check_array, check_generator, check_integer, check_real

from . import policies

BLOCK = 4096  # random numbers drawn at a time: one by one they would cost more than the environment's step

# Seeds of environments. What is learned from one is tested on the other: they never meet, whatever seeds are given.
TRAINING, TESTING = range(2**31 - 1), range(2**31 - 1, 2**32 - 2)


def uniform_stream(rng: np.random.Generator) -> Iterator[float]:
    """Numbers drawn evenly from [0, 1), one after the other, without end."""
    while True:
        yield from rng.random(BLOCK).tolist()


def discounted_return(rewards: ArrayLike, discount: float) -> NDArray[np.float64]:
    """What is still to come from each step on, (T,): ``G[t] = r[t] + discount * G[t + 1]``.

    ``G[0]`` is the return of the whole run, Eqs. (2.3), (2.28), without discount Eq. (2.27).
    """
    returns: NDArray[np.float64] = check_array("rewards", rewards, shape=("T",)).copy()
    gamma = check_real("discount", discount, at_least=0, at_most=1)
    for step in range(len(returns) - 2, -1, -1):
        returns[step] += gamma * returns[step + 1]
    return returns


@dataclass(frozen=True)
class Trajectory:
    """One walk s, a, r, s', a', ... (Fig. 2.2).

    Attributes
    ----------
    states : (T + 1,) of state numbers, the last one included.
    actions : (T,) of action numbers.
    rewards : (T,), ``rewards[t]`` for taking ``actions[t]`` in ``states[t]``.
    terminated : whether the walk ended in a terminal state; if not, it was cut off.
    """

    states: NDArray[np.int64]
    actions: NDArray[np.int64]
    rewards: NDArray[np.float64]
    terminated: bool


# -- spaces ------------------------------------------------------------------------------------------------------------


def count(name: str, space: gym.Space[Any]) -> int:
    """How many elements a discrete space has: Discrete, MultiDiscrete, or a tuple of such; TypeError otherwise."""
    if isinstance(space, spaces.Discrete):
        return int(space.n)
    if isinstance(space, spaces.MultiDiscrete):
        return int(np.prod(space.nvec))
    if isinstance(space, spaces.Tuple):
        return int(np.prod([count(name, part) for part in space]))
    raise TypeError(
        f"{name} must be discrete (Discrete, MultiDiscrete or a tuple of Discrete), got {space}"
    )


def number(space: gym.Space[Any], element: Any) -> int:
    """The place of an element in a discrete space, 0 for the first; several parts are read like the digits of one."""
    if isinstance(space, spaces.Discrete):
        return int(element) - int(space.start)
    if isinstance(space, spaces.MultiDiscrete):
        return int(
            np.ravel_multi_index(
                tuple(np.ravel(element - space.start)), tuple(np.ravel(space.nvec))
            )
        )
    place = 0
    for part, piece in zip(space, element, strict=True):  # type: ignore[call-overload]
        place = place * count("part", part) + number(part, piece)
    return place


def element(space: gym.Space[Any], place: int) -> Any:
    """The element of a discrete space that has this number: the inverse of :func:`number`."""
    if isinstance(space, spaces.Discrete):
        return place + int(space.start)
    if isinstance(space, spaces.MultiDiscrete):
        return (
            np.reshape(
                np.unravel_index(place, tuple(np.ravel(space.nvec))), space.nvec.shape
            )
            + space.start
        )
    pieces = []
    for part in reversed(space.spaces):  # type: ignore[attr-defined]
        place, digit = divmod(place, count("part", part))
        pieces.append(element(part, digit))
    return tuple(reversed(pieces))


def discretise_spaces(env: gym.Env[Any, Any]) -> gym.Env[int, int]:
    """The environment with its states numbered 0 ... S - 1 and its actions 0 ... A - 1.

    FrozenLake, Taxi and CliffWalking come back as they are; Blackjack, whose state is a tuple, wrapped.

    Raises
    ------
    TypeError : if ``env`` is no Gymnasium environment, or one with spaces that are not discrete.
    """
    env = discretise_actions(env)
    observations = env.observation_space
    states = count("env.observation_space", observations)
    if not (isinstance(observations, spaces.Discrete) and observations.start == 0):
        env = TransformObservation(
            env, lambda seen: number(observations, seen), spaces.Discrete(states)
        )
    return env


def discretise_actions(env: gym.Env[Any, Any]) -> gym.Env[Any, int]:
    """The environment with its actions numbered 0 ... A - 1, its observations whatever they are."""
    if not isinstance(env, gym.Env):
        raise TypeError(
            f"env must be a Gymnasium environment, got {type(env).__name__}"
        )
    actions = env.action_space
    size = count("env.action_space", actions)
    if not (isinstance(actions, spaces.Discrete) and actions.start == 0):
        env = TransformAction(
            env, lambda action: element(actions, action), spaces.Discrete(size)
        )
    return env


# -- episodes ----------------------------------------------------------------------------------------------------------


class EpisodeRunner:
    """Episodes of an environment, one after the other, counted as they pass.

    The loop of every learner::

        for state in course.episodes():
            while not course.over:
                successor, reward, terminated = course.step(action)

    An episode is over when the environment ends it or cuts it off, or after ``max_steps``. With ``record`` the states
    that it passed stay in ``walks``. The environment's seed is drawn from ``seeds``: those of training, or of testing.
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
        self.total = check_integer("episodes", episodes, at_least=1)
        self.max_steps = check_integer("max_steps", max_steps, at_least=1)
        self.number = 0
        self.returns: list[float] = []
        self.lengths: list[int] = []
        self.visited_states: list[list[Any]] = []
        self.over = True
        self._step: Callable[[int], tuple[Any, Any, bool, bool, Any]] = env.step
        self._reset = env.reset
        self._env_seed = int(rng.integers(seeds.start, seeds.stop))
        self._record = record
        self._progress = progress

    def episodes(self) -> Iterator[Any]:
        """The first state of each episode; ``number`` says which it is, from 0."""
        for number in range(self.total):
            self.number = number
            state, _ = self._reset(seed=self._env_seed if number == 0 else None)
            self.over, self._earned, self._walk = False, 0.0, [state]
            yield state
            self.returns.append(self._earned)
            self.lengths.append(len(self._walk) - 1)
            if self._record:
                self.visited_states.append(self._walk)
            if self._progress is not None:
                self._progress(number + 1, self.total)

    def step(self, action: int) -> tuple[Any, float, bool]:
        """Take an action: the next state, the reward, and whether that state is terminal (cut off is not terminal)."""
        state, reward, terminated, truncated, _ = self._step(action)
        self._earned += reward
        self._walk.append(state)
        self.over = terminated or truncated or len(self._walk) > self.max_steps
        return state, reward, terminated

    def walk(self, state: int, choose: Callable[[int], int]) -> Trajectory:
        """The rest of this episode from ``state``, with the actions that ``choose(state)`` names."""
        states, actions, rewards, terminated = [state], [], [], False
        while not self.over:
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
    policy: ArrayLike, states: int, actions: int, rng: np.random.Generator
) -> Callable[[int], int]:
    """A policy as a function from state to action; the one that draws where the policy is stochastic.

    ``policy`` is (S,) of action numbers or (S, A) of probabilities.
    """
    table = policies.as_policy(policy, states, actions)
    if table.ndim == 1:
        return table.tolist().__getitem__
    thresholds = np.cumsum(table, axis=1)
    thresholds /= thresholds[:, -1:]
    draw = uniform_stream(rng)
    return lambda state: int(
        np.searchsorted(thresholds[state], next(draw), side="right")
    )


def rollouts(
    env: gym.Env[Any, Any],
    policy: ArrayLike,
    episodes: int,
    *,
    max_steps: int = 10_000,
    seed: int | np.random.Generator,
    progress: Progress | None = None,
) -> Sequence[Trajectory]:
    """Walk a policy through whole episodes: how well does it really do?

    Parameters
    ----------
    env : Gymnasium environment with S discrete states and A actions.
    policy : (S,) of action numbers, or (S, A) of probabilities.
    episodes : how many.
    max_steps : steps after which an episode is cut off.
    seed : for the environment's chance and the policy's. The environment never gets a seed that learners give theirs,
        so that a policy is not tested on the episodes it was learned from, though the number here be the same.

    Raises
    ------
    TypeError, ValueError : if the spaces are not discrete or the policy does not fit them.
    """
    env, rng = discretise_spaces(env), check_generator("seed", seed)
    choose = policy_sampler(policy, *space_sizes(env), rng)
    course = EpisodeRunner(
        env, episodes, max_steps=max_steps, rng=rng, seeds=TESTING, progress=progress
    )
    return [course.walk(state, choose) for state in course.episodes()]


def space_sizes(env: gym.Env[int, int]) -> tuple[int, int]:
    """S and A of a numbered environment."""
    return count("env.observation_space", env.observation_space), count(
        "env.action_space", env.action_space
    )
