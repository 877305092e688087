"""Network lab: the robot's 11-8-5 network over its training, and what it answers wherever the reader puts the robot."""

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
    """Step through a training; touch the sensors and see every unit answer."""

    _esm = front_end("network_lab")
    _css = style_sheet("network_lab")
    data = traitlets.Dict().tag(sync=True)


def network_lab(
    training: TrainingHistory,
    situations: Mapping[str, tuple[Sequence[int], int]],
    *,
    frames: int = 60,
) -> NetworkLab:
    """The lab for one recorded training.

    Parameters
    ----------
    training : of a network that reads ``Encoder(target="number")`` and answers the five actions; recorded.
    situations : named moments of demonstrations: the state of 11 numbers, Eq. (3.17), and the expert's action 0 to 4.
    frames : iterations to show, at most.

    Raises
    ------
    ValueError : if the training has no record of its networks, or these have other inputs or outputs.
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
