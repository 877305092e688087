"""Files of trained networks in the safetensors format. Each also holds the settings of its training."""

from __future__ import annotations

import json
from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from safetensors import SafetensorError, safe_open
from safetensors.numpy import save

from robonav import atomic
from robonav._version import __version__
from robonav.robot.encoding import Encoder
from robonav.validation import check_real

from .multilayer_perceptron import Array, Network
from .network_stack import network_of

FORMAT = "robonav weights 1"
DTYPES = {"F16", "F32", "F64"}  # safetensors' names of floats that NumPy has too


@dataclass(frozen=True, eq=False)
class Weights:
    """A trained network and the settings of its training.

    Parameters
    ----------
    network : Network
        The network, or a stack of them.
    method : str
        How it was trained: ``"lfd"``, ``"nnql"``, ...
    encoder : Encoder
        Turns what the robot senses into the network's inputs.
    made : mapping
        The other settings of its training (seed, number of demonstrations, ...), in types that JSON can hold.
    temperature : float
        The temperature at which the policy draws its actions, see :class:`NetworkPolicy`.
    version : str
        The version of robonav that trained it.

    Raises
    ------
    ValueError
        If the encoder gives another number of inputs than the network takes, or the temperature is negative.

    Examples
    --------
    >>> from robonav.networks import Weights, random_network
    >>> from robonav.robot import Encoder
    >>> encoder = Encoder(target="number")
    >>> weights = Weights(random_network((encoder.size, 8, 5), seed=3), "lfd", encoder, {"seed": 3})
    >>> weights.method, weights.network.sizes
    ('lfd', (11, 8, 5))
    """

    network: Network
    method: str
    encoder: Encoder
    made: Mapping[str, Any] = field(default_factory=dict)
    temperature: float = 0.0
    version: str = __version__

    def __post_init__(self) -> None:
        object.__setattr__(
            self, "temperature", check_real("temperature", self.temperature, at_least=0)
        )
        given, taken = self.encoder.size, self.network.sizes[0]
        if given != taken:
            raise ValueError(
                f"network must take the {given} inputs its encoder gives, got one of {taken}"
            )


def save_weights(path: str | Path, weights: Weights) -> None:
    """Write a safetensors file: tensors ``weights.1``, ``biases.1``, ... (layers count from 1) and the settings.

    The same weights give the same bytes.

    Parameters
    ----------
    path : path
        Path of the file. An interrupted write leaves no file.
    weights : Weights
        What to write.

    Raises
    ------
    TypeError
        If ``weights.made`` holds a value of a type that JSON cannot hold.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from robonav.networks import Weights, load_weights, random_network, save_weights
    >>> from robonav.robot import Encoder
    >>> encoder = Encoder(target="number")
    >>> weights = Weights(random_network((encoder.size, 8, 5), seed=0), "lfd", encoder)
    >>> with TemporaryDirectory() as folder:
    ...     save_weights(Path(folder) / "lfd.safetensors", weights)
    ...     load_weights(Path(folder) / "lfd.safetensors").method
    'lfd'
    """
    network = weights.network
    tensors = {
        f"weights.{layer}": array
        for layer, array in enumerate(network.weights, start=1)
    }
    tensors |= {
        f"biases.{layer}": array for layer, array in enumerate(network.biases, start=1)
    }
    about = {
        "format": FORMAT,
        "method": weights.method,
        "encoder": asdict(weights.encoder),
        "made": dict(weights.made),
        "temperature": weights.temperature,
        "version": weights.version,
    }
    try:
        note = json.dumps(about, sort_keys=True, allow_nan=False, default=_plain)
    except (TypeError, ValueError) as error:
        raise TypeError(
            f"made must hold only types that JSON can hold: {error}"
        ) from None
    contiguous = {name: np.ascontiguousarray(array) for name, array in tensors.items()}
    with atomic.atomic_write(path) as file:
        file.write(save(contiguous, metadata={"robonav": note}))


def _plain(value: Any) -> Any:
    """Return numbers and arrays of NumPy in types that JSON can hold; raise TypeError for anything else."""
    if isinstance(value, np.generic | np.ndarray):
        return value.tolist()
    raise TypeError(f"{type(value).__name__} is none of them")


def load_weights(path: str | Path) -> Weights:
    """Read a file that :func:`save_weights` wrote.

    Parameters
    ----------
    path : path
        Of the file.

    Returns
    -------
    Weights

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    IsADirectoryError
        If the path is that of a folder.
    ValueError
        If the file is not a safetensors file, was not written by robonav, has another format, or holds no network.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import TemporaryDirectory
    >>> from robonav.networks import Weights, load_weights, random_network, save_weights
    >>> from robonav.robot import Encoder
    >>> weights = Weights(random_network((16, 8, 5), seed=0), "nnql", Encoder((9, 1, 2, 8, 3, 7, 4), True, "number"))
    >>> with TemporaryDirectory() as folder:
    ...     save_weights(Path(folder) / "nnql.safetensors", weights)
    ...     load_weights(Path(folder) / "nnql.safetensors").network.sizes
    (16, 8, 5)
    """
    name = Path(path).name
    if Path(path).is_dir():
        raise IsADirectoryError(f"{name} is a folder, not a safetensors file")
    try:
        with safe_open(str(path), framework="numpy") as file:
            kinds = {file.get_slice(key).get_dtype() for key in file.keys()}  # noqa: SIM118 - not a mapping
            if not kinds <= DTYPES:
                raise ValueError(
                    f"{name} must hold tensors of {', '.join(sorted(DTYPES))}, got {', '.join(sorted(kinds - DTYPES))}"
                )
            note = (file.metadata() or {}).get("robonav")
            tensors = {key: file.get_tensor(key) for key in file.keys()}  # noqa: SIM118 - not a mapping
    except (SafetensorError, TypeError):
        raise ValueError(f"{name} is not a whole safetensors file") from None
    about = _about(name, note)
    try:
        network = _network(tensors)
        encoder = about["encoder"]
        encoder = Encoder(
            tuple(encoder["sensors"]), encoder["walls"], encoder["target"]
        )
        return Weights(
            network,
            about["method"],
            encoder,
            about["made"],
            about["temperature"],
            about["version"],
        )
    except (KeyError, TypeError, ValueError) as error:
        raise ValueError(
            f"{name} does not hold a network and its encoder: {error}"
        ) from None


def _network(tensors: dict[str, Array]) -> Network:
    """Return the network that numbered tensors hold; raise KeyError or ValueError if they hold none."""
    layers = range(1, len(tensors) // 2 + 1)
    names = [f"{kind}.{layer}" for kind in ("weights", "biases") for layer in layers]
    if set(names) != set(tensors):
        raise ValueError(f"its tensors are {', '.join(sorted(tensors))}")
    arrays = [tensors[name] for name in names]
    return network_of(arrays[: len(layers)], arrays[len(layers) :])


def _about(name: str, note: str | None) -> dict[str, Any]:
    """Return the checked settings of the training; raise ValueError if robonav did not write them in this format."""
    if note is None:
        raise ValueError(
            f"{name} was not written by robonav: it does not say what made it"
        )
    try:
        about = json.loads(note)
        written = about["format"]
    except (ValueError, TypeError, KeyError, RecursionError):
        raise ValueError(
            f"{name} was not written by robonav: its note cannot be read"
        ) from None
    if written != FORMAT:
        raise ValueError(f"{name} has the format {written!r}, expected {FORMAT!r}")
    kinds: dict[str, Any] = {
        "method": str,
        "encoder": dict,
        "made": dict,
        "temperature": (int, float),
        "version": str,
    }
    wrong = [key for key, kind in kinds.items() if not isinstance(about.get(key), kind)]
    if wrong:
        raise ValueError(f"{name} does not say its {', '.join(wrong)}")
    return about
