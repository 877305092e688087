"""Convolutions, as arithmetic to read: one around a ring of sectors, one over a picture.

A convolutional layer looks at every place of its input through the same small window of weights. So it needs few
weights, and what it has learned at one place it knows at all others. Networks of this package use torch's layers, which
compute the same numbers faster; tests hold the two equal.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from robonav.validation import check_array

Floats = NDArray[np.float64]


def circular_convolution(x: Floats, weights: Floats, biases: Floats) -> Floats:
    """Convolve a ring of sectors: ``y[o, i] = b[o] + sum over c, j of w[o, c, j] x[c, (i + j - r) mod n]``.

    Parameters
    ----------
    x : (C, n) array
        C numbers for each of n sectors.
    weights : (O, C, 2 r + 1) array
        O windows, each r sectors wide to either side.
    biases : (O,) array
        One for each window.

    Returns
    -------
    (O, n) array
        Where the last sector ends, the first one begins: the indices are counted modulo n.

    Examples
    --------
    A window that looks at a sector's two neighbours. Sector 0 has the neighbours 1 and 4:

    >>> import numpy as np
    >>> from robonav.sensing import circular_convolution
    >>> x = np.array([[1.0, 2.0, 3.0, 4.0, 5.0]])
    >>> circular_convolution(x, np.array([[[1.0, 0.0, 1.0]]]), np.zeros(1))
    array([[7., 4., 6., 8., 5.]])
    """
    reach = weights.shape[2] // 2
    y = np.zeros((len(weights), x.shape[1]))
    for j in range(weights.shape[2]):
        shifted = np.roll(x, reach - j, axis=1)  # x[:, (i + j - r) mod n]
        y += weights[:, :, j] @ shifted
    return y + biases[:, None]


def picture_convolution(
    x: Floats, weights: Floats, biases: Floats, stride: int = 1
) -> Floats:
    """Convolve a picture: ``y[o, i, k] = b[o] + sum of w[o, c, j, l] x[c, s i + j - r, s k + l - r]``.

    Parameters
    ----------
    x : (C, H, W) array
        C numbers for each cell. Beyond the edges all are 0.
    weights : (O, C, 2 r + 1, 2 r + 1) array
        O windows, each r cells wide to all sides.
    biases : (O,) array
        One for each window.
    stride : int
        s: the window is put on every s-th row and column, so the result has fewer of them.

    Returns
    -------
    (O, ceil(H / s), ceil(W / s)) array

    Examples
    --------
    A window that compares a cell with the one above finds the upper edge of a block:

    >>> import numpy as np
    >>> from robonav.sensing import picture_convolution
    >>> x = np.zeros((1, 4, 4))
    >>> x[0, 1:3, 1:3] = 1
    >>> edge = np.array([[[[0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]]]])
    >>> picture_convolution(x, edge, np.zeros(1))[0].astype(int)
    array([[ 0,  0,  0,  0],
           [ 0,  1,  1,  0],
           [ 0,  0,  0,  0],
           [ 0, -1, -1,  0]])
    """
    width, reach = weights.shape[2], weights.shape[2] // 2
    rows, columns = (-(-side // stride) for side in x.shape[1:])
    padded = np.pad(x, [(0, 0), (reach, reach), (reach, reach)])
    y = np.zeros((len(weights), rows, columns))
    for j in range(width):
        for k in range(width):
            seen = padded[:, j : j + x.shape[1] : stride, k : k + x.shape[2] : stride]
            y += np.einsum("oc,chw->ohw", weights[:, :, j, k], seen)
    return y + biases[:, None, None]


def weights_of_layers(
    inputs: tuple[int, ...], outputs: int, channels: int, window: int
) -> dict[str, int]:
    """Count the weights and biases of two layers that read the same input: one fully connected, one convolutional.

    Parameters
    ----------
    inputs : tuple of int
        Sides of the input: (n,) for a ring, (H, W) for a picture.
    outputs : int
        Units of the fully connected layer.
    channels : int
        Windows of the convolutional layer, whose input has one channel.
    window : int
        Width of a window.

    Returns
    -------
    dict
        ``fully connected`` and ``convolutional``.

    Examples
    --------
    >>> from robonav.sensing import weights_of_layers
    >>> weights_of_layers((32, 32), outputs=32, channels=8, window=3)
    {'fully connected': 32800, 'convolutional': 80}
    """
    sides = check_array("inputs", np.array(inputs), shape=("sides",))
    return {
        "fully connected": outputs * (int(sides.prod()) + 1),
        "convolutional": channels * (window ** len(inputs) + 1),
    }
