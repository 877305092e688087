"""Code that all widgets share: one front-end file made of several, one style, and packed arrays."""

from __future__ import annotations

import base64
import json
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, DTypeLike

from robonav import style
from robonav.networks.multilayer_perceptron import Network

HERE = Path(__file__).parent
PALETTE = {
    name: getattr(style, name)
    for name in dir(style)
    if name.isupper() and isinstance(getattr(style, name), str)
}


def front_end(*names: str) -> str:
    """Return the JavaScript of a widget: the palette, ``shared.js`` and the named files as one module.

    It is one text, because a module that imports another one does not load from disk.
    """
    parts = [(HERE / f"{name}.js").read_text("utf-8") for name in ("shared", *names)]
    return "\n".join([f"export const PALETTE = {json.dumps(PALETTE)};", *parts])


def style_sheet(*names: str) -> str:
    """Return the style sheet of a widget: ``shared.css`` and the named files."""
    return "\n".join(
        (HERE / f"{name}.css").read_text("utf-8") for name in ("shared", *names)
    )


def packed(array: ArrayLike, dtype: DTypeLike = np.float64) -> dict[str, Any]:
    """Pack an array for the page's ``unpack``: shape, type and bytes (little-endian, base 64)."""
    values = np.ascontiguousarray(array, dtype=np.dtype(dtype).newbyteorder("<"))
    data = base64.b64encode(values.tobytes()).decode("ascii")
    return {"shape": list(values.shape), "dtype": np.dtype(dtype).name, "data": data}


def packed_network(network: Network, dtype: DTypeLike = np.float64) -> dict[str, Any]:
    """Pack a network, or a stack of networks, for the page's ``networkAt``."""
    return {
        "sizes": list(network.sizes),
        "weights": [packed(weight, dtype) for weight in network.weights],
        "biases": [packed(bias, dtype) for bias in network.biases],
    }


def menus(
    controls: Mapping[str, Sequence[str]], chosen: Sequence[str]
) -> list[dict[str, Any]]:
    """Return the menus of a lab for its page: the label and options of each, and the number of the chosen option.

    Examples
    --------
    >>> menus({"problem": ["disc", "xor"]}, ["xor"])
    [{'label': 'problem', 'options': ['disc', 'xor'], 'value': 1}]
    """
    return [
        {"label": label, "options": list(options), "value": list(options).index(choice)}
        for (label, options), choice in zip(controls.items(), chosen, strict=True)
    ]


def spread_out(last: int, count: int) -> Sequence[int]:
    """Return about ``count`` of the iterations 0 to ``last``, denser at the start, where the network changes most."""
    steps = np.geomspace(1, last + 1, count) - 1
    return sorted(
        {*range(min(last, 5) + 1), *np.rint(steps).astype(int).tolist(), last}
    )
