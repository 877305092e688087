"""Check the arguments and options of the environments, and make their observations."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import wraps
from pathlib import Path
from typing import Any, TypeVar, cast

import numpy as np
from gymnasium.envs.registration import load_env_creator
from numpy.typing import ArrayLike, NDArray

from robonav.validation import (
    check_instance,
    check_integer,
    check_one_of,
    check_positive,
    check_real,
)

from ._fast.constants import NO_REFLEX, RUNNING, TO_SECTOR
from .rollout import REFLEX, ReflexRule, undecided
from .simulator import (
    DIRECTIONS,
    NEVER,
    Reflex,
    Sensing,
    check_action,
    check_slip,
)
from .world_files import load_worlds
from .worlds import (
    MOVING_SPEEDS,
    SIZE,
    START,
    TARGET,
    Worlds,
    check_drawing,
    draw_worlds,
    random_keys,
)

R = TypeVar("R")

WorldsOrFile = Worlds | str | Path

Reward = Callable[[Sensing, Sensing, NDArray[np.int8]], ArrayLike]
"""``reward(before, after, outcome) -> (N,)``: from what N robots sensed before and after a step, and the outcomes."""

REWARD_OF_OUTCOME = np.array([0.0, 1.0, -1.0, 0.0])
"""For an episode that goes on, and for one that ended by arrival, by collision, or for lack of steps."""

NO_LIMIT = -1  # Gymnasium's sign for an episode without a limit of steps


def arrival_or_collision(
    before: Sensing, after: Sensing, outcome: NDArray[np.int8]
) -> NDArray[np.float64]:
    """Return the reward 1 for an arrival, -1 for a collision, else 0.

    Parameters
    ----------
    before, after : Sensing
        What N robots sensed before and after the step; not used.
    outcome : (N,) int array
        How their episodes stand after the step: codes into ``OUTCOMES``.

    Returns
    -------
    (N,) array

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.robot import Sensing
    >>> from robonav.robot.environment_settings import arrival_or_collision
    >>> nothing = Sensing.empty(3)
    >>> arrival_or_collision(nothing, nothing, np.array([0, 1, 2]))
    array([ 0.,  1., -1.])
    """
    return REWARD_OF_OUTCOME[outcome]


def as_sensing(observation: dict[str, Any]) -> Sensing:
    """Turn an environment's observation into the batch that encoders and policies take.

    Parameters
    ----------
    observation : dict
        Of one robot, or of N from the vector environment.

    Returns
    -------
    Sensing
        One row, or N.

    Examples
    --------
    >>> from robonav.robot.environments import NavigationEnv, as_sensing
    >>> observation, _ = NavigationEnv().reset(seed=0)
    >>> as_sensing(observation).ranges.shape
    (1, 9)
    """
    return Sensing(
        np.atleast_2d(observation["ranges"]),
        np.atleast_2d(observation["walls"]).astype(bool),
        np.atleast_1d(observation["target_region"]) + 1,
        np.atleast_1d(observation["target_seen"]).astype(bool),
    )


def takes_action(step: Callable[[Any, int], R]) -> Callable[[Any, int], R]:
    """Decorate ``step``: TypeError or ValueError for an action that does not exist."""

    @wraps(step)
    def checked(env: Any, action: int) -> R:
        """Check the action, then make the step."""
        return step(env, check_action(action))

    return checked


def while_running(step: Callable[[Any, int], Any]) -> Callable[[Any, int], Any]:
    """Decorate ``step``: ValueError outside an episode, and for an action that does not exist."""

    @wraps(step)
    def checked(env: Any, action: int) -> Any:
        """Check the state of the episode and the action, then make the step."""
        if env.outcome is None:
            raise ValueError("step: call reset first")
        if env.outcome != RUNNING:
            raise ValueError("step: the episode has ended; call reset first")
        return step(env, check_action(action))

    return checked


def as_worlds(given: WorldsOrFile | None) -> Worlds | None:
    """Return the worlds given, or those of the file with this name; there must be at least one."""
    if given is None:
        return None
    worlds = load_worlds(given) if isinstance(given, str | Path) else given
    if len(check_instance("worlds", worlds, Worlds)) == 0:
        raise ValueError("worlds must hold at least one world, got none")
    return worlds


def as_reward(given: Reward | str) -> Reward:
    """Return the function given, or the one of this name, "module:function"."""
    reward: Any = given
    if isinstance(given, str) and ":" in given:
        reward = load_env_creator(given)
    if not callable(reward):
        raise TypeError(
            "reward must be callable as reward(before, after, outcome), or a name as 'module:function', "
            f"got {given!r}"
        )
    return cast(Reward, reward)


def as_reflex(given: ReflexRule | str | None) -> ReflexRule | None:
    """Return the rule given, or the reflex that knows the direction of the target in this way."""
    if isinstance(given, str):
        return Reflex(check_one_of("reflex", given, DIRECTIONS))
    if given is not None and not callable(given):
        raise TypeError(
            "reflex must be callable as reflex(sensing, speed), 'exact', 'sector' or None, "
            f"got {given!r}"
        )
    return given


def check_reflexes(given: ArrayLike, number: int) -> NDArray[np.int64]:
    """Return the answers of a user's reflex, ``number`` whole numbers -1 to 7; raise ValueError for anything else."""
    reflexes = np.asarray(given)
    fits = reflexes.dtype.kind in "iu" and reflexes.shape == (number,)
    if not fits or (reflexes < NO_REFLEX).any() or (reflexes > TO_SECTOR).any():
        raise ValueError(
            f"reflex must give an array of {number} whole numbers -1 to 7, got {given!r}"
        )
    return reflexes.astype(np.int64)


def as_limit(given: int) -> int:
    """Return the number of steps after which an episode is truncated, for Gymnasium's ``max_episode_steps``."""
    if given == NO_LIMIT:
        return NEVER
    return check_integer("max_episode_steps", given, at_least=1, at_most=NEVER)


@dataclass(frozen=True, eq=False)
class NavigationSettings:
    """What the arguments of :class:`NavigationEnv` say, checked by :func:`check_settings`. There they are explained."""

    obstacles: int
    moving: int
    starts: Sequence[tuple[float, float]]
    targets: Sequence[tuple[float, float]]
    moving_speeds: tuple[float, float]
    worlds: Worlds | None
    speed: float
    slip: NDArray[np.float64] | None
    noise: float
    reward: Reward
    reflex: ReflexRule | None
    max_episode_steps: int

    def next_worlds(self, generators: Sequence[np.random.Generator]) -> Worlds:
        """Draw a world from each of N random generators, or choose one of ``worlds``.

        In a new world half of the obstacles are circles (radius 1.5 to 4 m) and half rectangles (sides of 3 to 8 m).
        They lie at random, at least 6 m from the start and the target. A world is drawn again if no path to
        the target stays 2 m away from the obstacles that stand still.
        """
        if self.worlds is not None:
            number = len(self.worlds)
            return self.worlds[[int(rng.integers(number)) for rng in generators]]
        return draw_worlds(
            random_keys(generators), self.obstacles, self.moving, self.starts, self.targets, self.moving_speeds
        )  # fmt: skip

    def reflexes(self, sensing: Sensing) -> NDArray[np.int64]:
        """Return the actions (N,) of the reflexes of N robots, -1 where the action given counts."""
        if self.reflex is None:
            return undecided(sensing, self.speed)
        reflexes = self.reflex(sensing, self.speed)
        if isinstance(self.reflex, Reflex):
            return reflexes
        return check_reflexes(reflexes, len(sensing))

    def rewards(
        self, before: Sensing, after: Sensing, outcome: NDArray[np.int8]
    ) -> NDArray[np.float64]:
        """Return the rewards (N,) of N robots."""
        rewards = np.asarray(self.reward(before, after, outcome), dtype=float)
        if rewards.shape != outcome.shape:
            raise ValueError(
                f"reward must give an array of shape {outcome.shape}, got {rewards.shape}"
            )
        return rewards


def check_settings(
    *,
    obstacles: int = 10,
    moving: int = 0,
    starts: Sequence[tuple[float, float]] = (START,),
    targets: Sequence[tuple[float, float]] = (TARGET,),
    moving_speeds: tuple[float, float] = MOVING_SPEEDS,
    worlds: WorldsOrFile | None = None,
    speed: float = 2.0,
    slip: ArrayLike | None = None,
    noise: float = 0.0,
    reward: Reward | str = arrival_or_collision,
    reflex: ReflexRule | str | None = REFLEX,
    max_episode_steps: int = NO_LIMIT,
) -> NavigationSettings:
    """Return the arguments of :class:`NavigationEnv`, checked.

    Raises
    ------
    TypeError, ValueError
        If an argument is of the wrong kind or out of bounds.

    Examples
    --------
    >>> from robonav.robot.environment_settings import check_settings
    >>> check_settings(speed=0)
    Traceback (most recent call last):
    ValueError: speed must be greater than 0, got 0
    """
    check_drawing(obstacles, moving, starts, targets, moving_speeds, SIZE)
    return NavigationSettings(
        obstacles=obstacles,
        moving=moving,
        starts=starts,
        targets=targets,
        moving_speeds=moving_speeds,
        worlds=as_worlds(worlds),
        speed=check_positive("speed", speed),
        slip=None if slip is None else check_slip(slip),
        noise=check_real("noise", noise, at_least=0),
        reward=as_reward(reward),
        reflex=as_reflex(reflex),
        max_episode_steps=as_limit(max_episode_steps),
    )


def worlds_in(
    options: dict[str, Any] | None, number: int, *, also: tuple[str, ...] = ()
) -> Worlds | None:
    """Return the worlds that the options of ``reset`` give, if they give any; check that they are ``number``."""
    given = check_instance("options", options or {}, dict)
    for option in given:
        check_one_of("options", option, ["worlds", *also])
    worlds: Worlds | None = given.get("worlds")
    if worlds is None:
        return None
    if len(check_instance("options['worlds']", worlds, Worlds)) != number:
        raise ValueError(
            f"options['worlds'] must hold {number} worlds, got {len(worlds)}"
        )
    return worlds


def check_render_mode(given: str | None, metadata: dict[str, Any]) -> str | None:
    """Return the render mode, if it is one of the environment's, or None."""
    mode: str | None = check_one_of(
        "render_mode", given, [None, *metadata["render_modes"]]
    )
    return mode
