"""Robots that a widget trains in the kernel, side by side, to act as in demonstrations."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import zip_longest
from typing import Any

import numpy as np

from robonav.lfd import Demonstrations, labelled_states
from robonav.lfd.demonstrations import LEARNED
from robonav.networks import random_network
from robonav.networks.policy import NetworkPolicy
from robonav.networks.training_history import Iterate
from robonav.robot import Encoder, Worlds
from robonav.validation import check_integer, check_real

from .kernel_training import Report, sentence_on_rates, success_rates
from .simulator import page_policy


def train_imitators(
    demonstrations: Demonstrations,
    settings: dict[str, Any],
    worlds: Worlds,
    report: Report,
    *,
    robots: int,
    done: int = 0,
) -> tuple[list[NetworkPolicy], dict[str, Any]]:
    """Train robots side by side by L-BFGS, and try them in new worlds.

    Parameters
    ----------
    demonstrations : Demonstrations
        What they learn from.
    settings : dict
        What the page says: ``hidden``, ``regularisation``, ``iterations`` and ``seed``.
    worlds : Worlds
        The new worlds.
    report : Report
        Gets the mean cost and accuracy of every iteration.
    robots : int
        The number of robots, each with a seed of its own.
    done : int
        The steps that the page has seen already.

    Returns
    -------
    policies : list of NetworkPolicy
        One of each robot.
    ended : dict
        For the page: a sentence on the robots, and the policy with the least cost.

    Examples
    --------
    >>> import threading
    >>> from robonav.lfd import demonstrate
    >>> from robonav.robot import random_worlds
    >>> from robonav.widgets.imitation_training import train_imitators
    >>> from robonav.widgets.kernel_training import Report
    >>> settings = {"hidden": 4, "regularisation": 0.1, "iterations": 3, "seed": 0}
    >>> report = Report(lambda message: None, threading.Event())
    >>> demonstrations = demonstrate(random_worlds(2, 10, seed=1))
    >>> policies, ended = train_imitators(demonstrations, settings, random_worlds(5, 10, seed=2), report, robots=2)
    >>> len(policies), sorted(ended)
    (2, ['policy', 'sentence'])
    """
    # It loads torch, which a page without a training does not need.
    from robonav.networks.torch_lbfgs import lbfgs_iterates

    count = check_integer("robots", robots, at_least=1)
    iterations = check_integer("iterations", settings["iterations"], at_least=1)
    hidden = check_integer("hidden", settings["hidden"], at_least=1)
    seed = check_integer("seed", settings["seed"], at_least=0)
    decay = check_real("regularisation", settings["regularisation"], at_least=0)
    x, y = labelled_states(demonstrations)
    trainings = [
        lbfgs_iterates(
            random_network((Encoder().size, hidden, LEARNED), seed=seed + robot),
            x,
            y,
            regularisation=decay,
            iterations=iterations,
        )
        for robot in range(count)
    ]
    total = done + iterations + count
    for at, iterates in enumerate(_side_by_side(trainings)):
        report(
            done + at,
            total,
            at=at,
            cost=float(np.mean([iterate.cost for iterate in iterates])),
            accuracy=100 * float(np.mean([iterate.accuracy for iterate in iterates])),
        )
    policies = [NetworkPolicy(iterate.network, Encoder()) for iterate in iterates]
    rates: list[float] = []
    for policy in policies:
        rates += success_rates([policy], worlds)
        report(done + iterations + len(rates), total)
    best = policies[int(np.argmin([iterate.cost for iterate in iterates]))]
    return policies, {
        "sentence": sentence_on_rates(rates, len(worlds)),
        "policy": page_policy(best),
    }


def _side_by_side(trainings: Sequence[Iterator[Iterate]]) -> Iterator[list[Iterate]]:
    """The iterates of several trainings, one of each; a training that has ended stays at its last."""
    latest: list[Iterate] = []
    for iterates in zip_longest(*trainings):
        latest = [iterate or latest[robot] for robot, iterate in enumerate(iterates)]
        yield latest
