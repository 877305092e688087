"""PPO in randomised simulators: each update has a speed, slips and errors of its own (domain randomisation)."""

from __future__ import annotations

from itertools import count
from typing import Any

import numpy as np

from robonav.deep import ppo_on_episodes
from robonav.deep.episodes import Draw
from robonav.networks.policy import NetworkPolicy
from robonav.progress import Progress
from robonav.robot import (
    REFLEX,
    Encoder,
    ReflexRule,
    Simulator,
    neighbour_slip,
    random_worlds,
)


def train_in(
    draw: Draw,
    updates: int = 60,
    *,
    reflex: ReflexRule | None = REFLEX,
    batches: int = 8,
    seed: int,
    progress: Progress | None = None,
    **settings: Any,
) -> NetworkPolicy:
    """Train a policy by PPO; each update draws a new simulator.

    The loop is that of :func:`robonav.deep.ppo_on_episodes`, which also checks the arguments.

    Parameters
    ----------
    draw : callable
        ``draw(rng)`` returns a simulator; :func:`ideal` and :func:`randomised` make such functions.
    updates : int
        How often the robots act, and the networks learn from it.
    reflex : callable, optional
        What a robot does before the policy is asked.
    batches : int
        Minibatches into which an epoch divides the steps.
    seed : int
        Of the weights, the simulators, the actions and the minibatches.
    progress : callable, optional
        Called as ``progress(updates done, updates)``.
    **settings
        Other keyword arguments of :func:`robonav.deep.ppo_on_episodes`, which also has their defaults.

    Returns
    -------
    NetworkPolicy
        It draws its actions as it did in training.

    Examples
    --------
    >>> from robonav.body import randomised, train_in
    >>> train_in(randomised(robots=2, obstacles=5), updates=1, seed=0).network.sizes
    (12, 32, 5)
    """
    done = count(1)

    def report(_: Simulator) -> None:
        """Say that one more update is done."""
        if progress is not None:
            progress(next(done), updates)

    learned = ppo_on_episodes(
        draw,
        updates,
        reflex=reflex,
        after=report,
        batches=batches,
        seed=seed,
        **settings,
    )
    return NetworkPolicy(learned.policy, Encoder(), temperature=1.0)


def ideal(robots: int = 32, obstacles: int = 20) -> Draw:
    """Return a function that draws simulators of section 2.5, in which every action does what it says.

    Parameters
    ----------
    robots : int
        How many act for an update, each in a world of its own.
    obstacles : int
        Obstacles of a world.

    Returns
    -------
    callable
        For :func:`train_in`.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.body import ideal
    >>> len(ideal(robots=3)(np.random.default_rng(0)))
    3
    """
    return lambda rng: Simulator(
        random_worlds(robots, obstacles, seed=rng), max_steps=300
    )


def randomised(robots: int = 32, obstacles: int = 20) -> Draw:
    """Return a function that draws simulators of section 2.5 with a speed, slips and errors of the ranges at random.

    The speed is 1.5 to 3 m/s, up to half of the actions slip to a neighbour, and ranges are off by up to 0.5 m. None of
    the three is what a body does. Together they make a policy that does not rely on what one step brings.

    Parameters
    ----------
    robots : int
        How many act for an update, each in a world of its own.
    obstacles : int
        Obstacles of a world.

    Returns
    -------
    callable
        For :func:`train_in`.

    Examples
    --------
    >>> import numpy as np
    >>> from robonav.body import randomised
    >>> 1.5 < randomised(robots=3)(np.random.default_rng(0)).speed < 3
    True
    """

    def draw(rng: np.random.Generator) -> Simulator:
        """Put robots into new worlds, with another speed, slip and noise."""
        return Simulator(
            random_worlds(robots, obstacles, seed=rng),
            rng.uniform(1.5, 3.0),
            slip=neighbour_slip(rng.uniform(0.0, 0.5)),
            noise=rng.uniform(0.0, 0.5),
            max_steps=300,
        )

    return draw
