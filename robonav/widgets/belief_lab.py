"""Belief lab: a robot in a corridor moves and senses, and the page computes its belief by Bayes' rule."""

from __future__ import annotations

from collections.abc import Mapping

import anywidget
import numpy as np
import traitlets
from numpy.typing import NDArray

from robonav.mdp import corridor, without_sensing
from robonav.validation import check_integer

from .shared import front_end, packed, style_sheet

SENSORS: Mapping[str, float | None] = {
    "right 9 times in 10": 0.9,
    "right 7 times in 10": 0.7,
    "always right": 1.0,
    "no sensing at all": None,
}
WHEELS: Mapping[str, float] = {
    "1 move in 10 fails": 0.1,
    "no move fails": 0.0,
    "3 moves in 10 fail": 0.3,
}


class BeliefLab(anywidget.AnyWidget):
    """Move and sense in a corridor, and see the prediction, the likelihood and the belief of every cell."""

    _esm = front_end("random_numbers", "belief", "belief_lab")
    _css = style_sheet("belief_lab")
    data = traitlets.Dict().tag(sync=True)


def belief_lab(
    corridors: Mapping[str, str],
    *,
    sensors: Mapping[str, float | None] = SENSORS,
    wheels: Mapping[str, float] = WHEELS,
    seed: int = 1,
) -> BeliefLab:
    """Make the lab for some corridors, each with every combination of sensors and wheels.

    Parameters
    ----------
    corridors : mapping of str to str
        Plans by name, as :func:`robonav.mdp.corridor` takes them.
    sensors : mapping of str to float or None
        The accuracy of a sensor by its description; None for a robot without sensing.
    wheels : mapping of str to float
        The share of moves that fail, by description.
    seed : int
        The seed of the first run in the page. Each further run adds 1 to it.

    Returns
    -------
    BeliefLab

    Raises
    ------
    ValueError
        If there is no corridor, sensor or wheel to choose from.

    Examples
    --------
    >>> from robonav.widgets.belief_lab import belief_lab
    >>> lab = belief_lab({"two doors": ".D.D"}, sensors={"good": 0.9}, wheels={"good": 0.0})
    >>> len(lab.data) > 0
    True
    """
    for name, choices in (
        ("corridors", corridors),
        ("sensors", sensors),
        ("wheels", wheels),
    ):
        if not choices:
            raise ValueError(f"{name} must hold at least one choice, got none")
    return BeliefLab(
        data={
            "corridors": [
                {"name": name, "cells": cells} for name, cells in corridors.items()
            ],
            "sensors": list(sensors),
            "wheels": list(wheels),
            "transitions": [
                [
                    packed(corridor(cells, slip=slip).mdp.transitions)
                    for slip in wheels.values()
                ]
                for cells in corridors.values()
            ],
            "observations": [
                [
                    packed(_observations(cells, accuracy))
                    for accuracy in sensors.values()
                ]
                for cells in corridors.values()
            ],
            "seed": check_integer("seed", seed, at_least=0),
        }
    )


def _observations(cells: str, accuracy: float | None) -> NDArray[np.float64]:
    """Return the observation probabilities Z (3, S, O) of a corridor for a sensor of some accuracy, or for none."""
    pomdp = (
        without_sensing(corridor(cells).mdp)
        if accuracy is None
        else corridor(cells, accuracy=accuracy)
    )
    return np.asarray(pomdp.observations)
