"""Networks that read a sensor: fully connected, convolutional around a ring, and convolutional over a picture.

All end in the same way. What the sensor's layers make of a reading, and where the target is, goes through one hidden
layer to five logits, one for each action.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import torch
from torch.nn import Conv1d, Conv2d, Linear, ReLU, Sequential, Unflatten

from .sensors import Picture, Ring, Sensor

ACTIONS = 5  # F, L30, L60, R30, R60
TARGET = 3  # sine and cosine of the target's sector, target seen
HIDDEN = 32


class SensorNetwork(torch.nn.Module):
    """Layers that read a sensor, and a hidden layer that reads what they found and where the target is.

    Parameters
    ----------
    layers : torch.nn.Sequential
        Read a batch of readings.
    found : int
        How many numbers these layers make of one reading.
    hidden : int
        Units of the hidden layer.

    Examples
    --------
    >>> import torch
    >>> from robonav.sensing import Ring, fully_connected
    >>> network = fully_connected(Ring(18), seed=0)
    >>> network(torch.zeros(2, 18), torch.zeros(2, 3)).shape
    torch.Size([2, 5])
    """

    def __init__(self, layers: Sequential, found: int, hidden: int) -> None:
        super().__init__()
        self.layers = layers
        self.head = Sequential(
            Linear(found + TARGET, hidden), ReLU(), Linear(hidden, ACTIONS)
        )

    def forward(self, readings: torch.Tensor, target: torch.Tensor) -> torch.Tensor:
        """Return the logits of the actions.

        Parameters
        ----------
        readings : (N, \\*shape) tensor
            What N sensors read.
        target : (N, 3) tensor
            Where the targets are.

        Returns
        -------
        (N, 5) tensor

        Examples
        --------
        >>> import torch
        >>> from robonav.sensing import Picture, picture_network
        >>> network = picture_network(Picture(), seed=0)
        >>> network(torch.zeros(2, 32, 32), torch.zeros(2, 3)).shape
        torch.Size([2, 5])
        """
        found = self.layers(readings).flatten(1)
        return self.head(torch.cat([found, target], dim=1))

    @property
    def size(self) -> int:
        """The number of weights and biases."""
        return sum(part.numel() for part in self.parameters())


def fully_connected(
    sensor: Sensor, *, hidden: int = HIDDEN, seed: int
) -> SensorNetwork:
    """Return a network whose hidden layer reads all numbers of a sensor.

    Parameters
    ----------
    sensor : Ring or Picture
        What it reads.
    hidden : int
        Units of the hidden layer.
    seed : int
        Of the weights.

    Returns
    -------
    SensorNetwork

    Examples
    --------
    >>> from robonav.sensing import Picture, Ring, fully_connected
    >>> fully_connected(Ring(9), seed=0).size, fully_connected(Picture(), seed=0).size
    (581, 33061)
    """
    with seeded(seed):
        numbers = int(torch.tensor(sensor.shape).prod())
        return SensorNetwork(Sequential(torch.nn.Flatten()), numbers, hidden)


def ring_network(
    ring: Ring, *, channels: int = 8, window: int = 5, hidden: int = HIDDEN, seed: int
) -> SensorNetwork:
    """Return a network with two convolutional layers around a ring of sectors.

    Parameters
    ----------
    ring : Ring
        What it reads.
    channels : int
        Windows of each layer.
    window : int
        Width of a window in sectors, odd.
    hidden : int
        Units of the hidden layer.
    seed : int
        Of the weights.

    Returns
    -------
    SensorNetwork

    Examples
    --------
    Turning the ring turns what the convolutional layers find:

    >>> import torch
    >>> from robonav.sensing import Ring, ring_network
    >>> layers, x = ring_network(Ring(36), seed=0).layers, torch.rand(1, 36)
    >>> turned = layers(x.roll(5, dims=1))
    >>> bool(torch.allclose(turned, layers(x).roll(5, dims=2), atol=1e-6))
    True
    """
    with seeded(seed):
        layers = Sequential(
            Unflatten(1, (1, ring.sectors)),
            around(1, channels, window),
            ReLU(),
            around(channels, channels, window),
            ReLU(),
        )
        return SensorNetwork(layers, channels * ring.sectors, hidden)


def around(inputs: int, outputs: int, window: int) -> Conv1d:
    """Return a convolutional layer around a ring, torch's twin of :func:`circular_convolution`."""
    return Conv1d(inputs, outputs, window, padding=window // 2, padding_mode="circular")


def picture_network(
    picture: Picture, *, channels: int = 8, hidden: int = HIDDEN, seed: int
) -> SensorNetwork:
    """Return a network with three convolutional layers, each of which halves the sides of its picture.

    Parameters
    ----------
    picture : Picture
        What it reads.
    channels : int
        Windows of the first layer; the other two have twice as many.
    hidden : int
        Units of the hidden layer.
    seed : int
        Of the weights.

    Returns
    -------
    SensorNetwork

    Examples
    --------
    >>> import torch
    >>> from robonav.sensing import Picture, picture_network
    >>> picture_network(Picture(), seed=0).layers(torch.zeros(1, 32, 32)).shape
    torch.Size([1, 16, 4, 4])
    """
    cells = picture.cells
    with seeded(seed):
        layers = Sequential(
            Unflatten(1, (1, cells)),
            halving(1, channels),
            ReLU(),
            halving(channels, 2 * channels),
            ReLU(),
            halving(2 * channels, 2 * channels),
            ReLU(),
        )
        return SensorNetwork(layers, 2 * channels * (-(-cells // 8)) ** 2, hidden)


def halving(inputs: int, outputs: int) -> Conv2d:
    """Return a convolutional layer that halves the sides, torch's twin of :func:`picture_convolution`."""
    return Conv2d(inputs, outputs, 3, stride=2, padding=1)


@contextmanager
def seeded(seed: int) -> Iterator[None]:
    """Let torch draw from a seed inside of a block; afterwards its generator is as it was before.

    Examples
    --------
    >>> import torch
    >>> from robonav.sensing.networks import seeded
    >>> with seeded(1):
    ...     first = torch.rand(1)
    >>> with seeded(1):
    ...     bool(torch.rand(1) == first)
    True
    """
    with torch.random.fork_rng(devices=[]):
        torch.manual_seed(seed)
        yield
