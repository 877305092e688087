"""Two objects of the package that hold arrays can be compared with ==, which never raises."""

from __future__ import annotations

import dataclasses
import importlib
import inspect
import pkgutil
import typing

import numpy as np
import pandas as pd
import pytest
import torch

import robonav

ARRAYS = (np.ndarray, torch.Tensor, pd.DataFrame, pd.Series)


def classes() -> list[type]:
    """Every dataclass and every NamedTuple of the package."""
    found = {}
    for module in pkgutil.walk_packages(robonav.__path__, "robonav."):
        if module.name.endswith("__main__"):
            continue
        for kind in vars(importlib.import_module(module.name)).values():
            if inspect.isclass(kind) and kind.__module__.startswith("robonav."):
                found[f"{kind.__module__}.{kind.__qualname__}"] = kind
    return [
        kind
        for _, kind in sorted(found.items())
        if dataclasses.is_dataclass(kind) or is_named_tuple(kind)
    ]


def is_named_tuple(kind: type) -> bool:
    return issubclass(kind, tuple) and hasattr(kind, "_fields")


def mentions_arrays(hint: object) -> bool:
    """Whether a type, or a type inside it, is an array."""
    kind = typing.get_origin(hint) or hint
    if inspect.isclass(kind) and issubclass(kind, ARRAYS):
        return True
    return any(mentions_arrays(part) for part in typing.get_args(hint))


def holds_arrays(kind: type) -> bool:
    names = getattr(kind, "_fields", None) or [f.name for f in dataclasses.fields(kind)]
    hints = typing.get_type_hints(kind, localns={"pd": pd})
    return any(mentions_arrays(hints[name]) for name in names)


def compares_fields(kind: type) -> bool:
    """Whether == compares the fields, and so asks an array for its truth."""
    return kind.__eq__ is not object.__eq__


@pytest.mark.parametrize(
    "kind", [kind for kind in classes() if holds_arrays(kind)], ids=lambda kind: kind.__qualname__
)  # fmt: skip
def test_classes_that_hold_arrays_are_compared_by_identity(kind: type) -> None:
    assert not compares_fields(kind), (
        f"{kind.__module__}.{kind.__qualname__} needs eq=False"
    )
