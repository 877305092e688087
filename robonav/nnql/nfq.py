"""Neural fitted Q iteration (Riedmiller 2005): collect, then fit a network to all that was ever collected."""

from __future__ import annotations

from collections.abc import Sequence
from functools import partial
from typing import Any, Unpack

import numpy as np
from numpy.typing import NDArray
from scipy.special import expit

from robonav.validation import check_integer, check_real

from .agents import Agent, Transitions
from .networks import Array, Networks, Rows
from .replay_buffer import ReplayBuffer
from .schedules import Schedule
from .targets import clip
from .trainer import NavigationTask
from .training import Common, TrainingResult, run_training

_GROW, _SHRINK, _FIRST_STEP, _SIZES = (
    1.2,
    0.5,
    0.01,
    (1e-6, 50.0),
)  # of Rprop, as its authors have them


class NFQAgent(Agent):
    """Keeps every step, and refits the network to all of them after every so many episodes.

    Parameters
    ----------
    networks : of S seeds.
    shape : (S, n).
    discount : gamma.
    episodes_per_fit : episodes between two refits.
    sweeps : targets are computed anew so often in a refit.
    epochs, tolerance : Rprop goes over all steps at most so many times, and until the mean cost settles.
    """

    def __init__(
        self,
        networks: Networks,
        shape: tuple[int, int],
        *,
        discount: float,
        episodes_per_fit: int,
        sweeps: int,
        epochs: int,
        tolerance: float,
    ) -> None:
        super().__init__(networks)
        self.memory = ReplayBuffer(*shape)
        (
            self.discount,
            self.episodes_per_fit,
            self.sweeps,
            self.epochs,
            self.tolerance,
        ) = (
            discount,
            episodes_per_fit,
            sweeps,
            epochs,
            tolerance,
        )

    def observe(self, rows: Rows, steps: Transitions) -> None:
        self.memory.append(rows, steps)

    def close(self, rows: Rows, episodes: Rows) -> None:
        for row in rows[
            (episodes % self.episodes_per_fit == 0) & (self.memory.count[rows] > 0)
        ]:
            self._refit(np.array([row]))

    def _refit(self, row: Rows) -> None:
        """Fit one network to its memory, ``sweeps`` times over."""
        x, actions, rewards, reached, terminal = self.memory.all_of(row)
        for _ in range(self.sweeps):
            following = expit(self.networks.logits(row, reached).max(axis=2))
            targets = clip(rewards + self.discount * np.where(terminal, 0.0, following))
            fit(
                self.networks,
                row,
                x,
                actions,
                targets,
                epochs=self.epochs,
                tolerance=self.tolerance,
            )

    def state(self) -> dict[str, NDArray]:
        return super().state() | self.memory.state()

    def restore(self, state: dict[str, NDArray]) -> None:
        super().restore(state)
        self.memory.restore(state)


def fit(
    networks: Networks,
    rows: Rows,
    x: Array,
    actions: NDArray[np.int64],
    targets: Array,
    *,
    epochs: int,
    tolerance: float,
) -> None:
    """Fit networks to the values of the actions taken, by Rprop on the whole batch.

    Parameters
    ----------
    rows : (K,) which networks.
    x : inputs (K, m, n).
    actions, targets : (K, m) taken, and what their values should be, in [0, 1]. Other outputs are left free.
    epochs : at most.
    tolerance : ends when no mean cross-entropy moves by more in an epoch.
    """
    last, size, before = (
        np.full(len(rows), np.inf),
        np.array(_FIRST_STEP),
        np.array(0.0),
    )
    for _ in range(epochs):
        slope, cost = networks.slopes(rows, x, actions, targets, linear=False)
        step, size, before = rprop(slope, size, before)
        networks.subtract(rows, step)
        if (np.abs(last - cost) < tolerance).all():
            break
        last = cost


def rprop(slope: Array, size: Array, before: Array) -> tuple[Array, Array, Array]:
    """One step of Rprop (Riedmiller and Braun 1993): only the signs of the slopes count.

    A parameter's step grows while its slope keeps its sign. Where the sign turned, a minimum was jumped over: the
    step shrinks, and the parameter waits for once.

    Parameters
    ----------
    slope : (...) of the cost.
    size : (...) of the last step, positive; or one number for all.
    before : (...) the slope before, 0 where the parameter waited or at the first step.

    Returns
    -------
    What to take off the parameters; ``size`` and ``before`` for the next step.
    """
    turned = slope * before
    factor = np.where(turned > 0, _GROW, np.where(turned < 0, _SHRINK, 1.0))
    size = np.clip(size * factor, *_SIZES)
    slope = np.where(turned < 0, 0.0, slope)
    return np.sign(slope) * size, size, slope


def nfq(
    seeds: int | Sequence[int] = 16,
    episodes: int = 300,
    *,
    discount: float = 0.9,
    temperature: Schedule = (0.9, 0.05),
    episodes_per_fit: int = 20,
    sweeps: int = 20,
    epochs: int = 30,
    tolerance: float = 1e-5,
    **common: Unpack[Common],
) -> TrainingResult:
    """Neural fitted Q iteration: after every so many episodes, fit the network to all steps ever made.

    Targets are ``r + gamma max Q`` in [0, 1], computed anew at every sweep, and the whole batch is fitted with Rprop
    until its cost settles. Riedmiller's network takes state and action as inputs and has one output; ours has one
    output an action, as in Fig. 4.1, of which only that of the action taken is fitted.

    Parameters
    ----------
    seeds : S, or the seeds themselves.
    episodes : E, each in a new world.
    discount : gamma.
    temperature : T of the Boltzmann policy, Eq. (4.7); a number, or its start and end.
    episodes_per_fit : episodes between two refits.
    sweeps : how often a refit computes its targets anew.
    epochs, tolerance : Rprop goes over all steps at most so many times a sweep, and until the mean cost settles.
    common : see :class:`Common`.

    Raises
    ------
    ValueError, TypeError : if an argument is out of bounds.
    """
    settings: dict[str, Any] = {
        "discount": check_real("discount", discount, at_least=0, at_most=1),
        "episodes_per_fit": check_integer(
            "episodes_per_fit", episodes_per_fit, at_least=1
        ),
        "sweeps": check_integer("sweeps", sweeps, at_least=1),
        "epochs": check_integer("epochs", epochs, at_least=1),
        "tolerance": check_real("tolerance", tolerance, at_least=0),
    }
    make = partial(_fitting, settings=settings)
    return run_training(
        "nfq",
        make,
        seeds,
        episodes,
        temperature=temperature,
        settings=settings,
        **common,
    )


def _fitting(
    networks: Networks,
    seeds: tuple[int, ...],
    task: NavigationTask,
    *,
    settings: dict[str, Any],
) -> NFQAgent:
    return NFQAgent(networks, (len(seeds), task.encoder.size), **settings)
