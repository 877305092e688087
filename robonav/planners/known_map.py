"""The planner that knows the map, as the upper end of what planning can reach."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from robonav.lfd import ComputerExpert
from robonav.robot import ActionSelector, Sensing, Simulator
from robonav.validation import check_real


@dataclass(frozen=True)
class KnownMap:
    """A policy that plans with modified A* (Algorithm 4) in the map, and again whenever it has left its plan.

    It is the expert of chapter 3. It knows the whole map, its own place and that of the target, and where moving
    obstacles are now.

    Parameters
    ----------
    margin, caution : float
        As in :class:`robonav.lfd.ComputerExpert`.

    Raises
    ------
    ValueError
        If a number is out of bounds.

    Examples
    --------
    >>> from robonav.planners import KnownMap
    >>> from robonav.robot import navigate, random_worlds
    >>> float(navigate(KnownMap(), random_worlds(20, obstacles=20, seed=1)).success.mean())
    1.0
    """

    margin: float = 3.0
    caution: float = 2.0

    def __post_init__(self) -> None:
        check_real("margin", self.margin, at_least=1)
        check_real("caution", self.caution, at_least=0)

    def begin(self, simulator: Simulator, rng: np.random.Generator) -> ActionSelector:
        """Return the selector of actions for the robots of a simulator.

        Parameters
        ----------
        simulator : Simulator
            Its N robots are driven.
        rng : numpy.random.Generator
            Of random numbers. Not used.

        Returns
        -------
        callable
            ``select_actions(simulator, sensing, robots)`` returns actions.

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.planners import KnownMap
        >>> from robonav.robot import Simulator, random_worlds
        >>> simulator, rng = Simulator(random_worlds(2, seed=1)), np.random.default_rng(0)
        >>> KnownMap().begin(simulator, rng)(simulator, simulator.sense(), np.arange(2))
        array([1, 1])
        """
        expert = ComputerExpert(self.margin, self.caution)

        def select_actions(
            simulator: Simulator, sensing: Sensing, robots: NDArray[np.int64]
        ) -> NDArray[np.int64]:
            """Return the next actions (K,) of the plans of K robots."""
            return expert(simulator, robots)

        return select_actions
