"""Network lab: the robot's 11-8-5 network during its training, and its outputs for any sensor readings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import anywidget
import numpy as np
import traitlets

from robonav.networks.training_history import TrainingHistory
from robonav.robot._fast import SENSOR_RANGE
from robonav.robot.encoding import DANGER_BORDERS
from robonav.validation import check_integer

from .shared import front_end, packed, packed_network, spread_out, style_sheet


class NetworkLab(anywidget.AnyWidget):
    """Step through a training, change the sensor readings, and see the activation of every unit."""

    _esm = front_end("network_lab")
    _css = style_sheet("network_lab")
    data = traitlets.Dict().tag(sync=True)


def network_lab(
    training: TrainingHistory,
    situations: Mapping[str, tuple[Sequence[int], int]],
    *,
    frames: int = 60,
) -> NetworkLab:
    """Make the lab for one recorded training.

    Parameters
    ----------
    training : TrainingHistory
        A recorded training of a network that reads ``Encoder(target="number")`` and has five outputs.
    situations : mapping of str to (array, int)
        Moments of demonstrations by name: the state of 11 numbers, Eq. (3.17), and the expert's action from 0 to 4.
    frames : int
        The largest number of iterations to show.

    Returns
    -------
    NetworkLab

    Raises
    ------
    ValueError
        If the training has no record of its networks, or their inputs or outputs are others.

    Examples
    --------
    >>> from robonav.lfd import demonstrate, labelled_states
    >>> from robonav.networks import lbfgs, random_network
    >>> from robonav.robot import Encoder, random_worlds
    >>> from robonav.widgets.network_lab import network_lab
    >>> x, y = labelled_states(demonstrate(random_worlds(1, 20, seed=3)), Encoder(target="number"))
    >>> training = lbfgs(random_network((11, 8, 5), seed=0), x, y, iterations=5, record=True)
    >>> lab = network_lab(training, {"first": (x[0], int(y[0].argmax()))})
    >>> len(lab.data) > 0
    True
    """
    if training.networks is None:
        raise ValueError(
            "training must hold the network of every iteration: train with record=True"
        )
    if (training.network.sizes[0], training.network.sizes[-1]) != (11, 5):
        raise ValueError(
            f"training must be of a network with 11 inputs and 5 outputs, got {training.network.sizes}"
        )
    if not situations:
        raise ValueError("situations must hold at least one moment, got none")
    shown = spread_out(training.iterations, check_integer("frames", frames, at_least=2))
    return NetworkLab(
        data={
            "networks": packed_network(training.networks[list(shown)]),
            "frames": list(shown),
            "costs": packed(training.costs[list(shown)]),
            "accuracies": packed(training.accuracies[list(shown)]),
            "situations": [
                {
                    "name": name,
                    "state": np.asarray(state).tolist(),
                    "action": int(action),
                }
                for name, (state, action) in situations.items()
            ],
            "borders": DANGER_BORDERS.tolist(),
            "range": SENSOR_RANGE,
        }
    )
