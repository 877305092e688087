"""Write a call of a student's function to a file that ``numpy.load`` reads without pickle.

The file holds each argument by its name, the right answer if there is a single one, the student's answer, and the call
as Python code that reads the arguments from the loaded file ``case``.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np

from robonav.atomic import atomic_write

from .compare import as_numbers
from .evidence import Observation


def write_case(path: Path, observation: Observation, names: Sequence[str]) -> str:
    """Write a call with its answers, and return the call as Python code that reads the file's content as ``case``."""
    arrays: dict[str, Any] = {}
    arguments = observation.case.arguments
    if len(names) != len(arguments):
        names = [f"argument_{n}" for n in range(len(arguments))]
    given = [
        _stored(arrays, name, argument)
        for name, argument in zip(names, arguments, strict=True)
    ]
    call = f"{observation.case.exercise.name}({', '.join(given)})"
    if observation.expected is not None:
        _stored(arrays, "expected", observation.expected)
    _stored(arrays, "got", observation.got)
    arrays["call"] = np.array(call)
    with atomic_write(path) as file:
        np.savez(file, **arrays)
    return call


def _stored(arrays: dict[str, Any], name: str, value: Any) -> str:
    """Add a value to the arrays, and return code that reads it back."""
    match value:
        case bool() | np.bool_():
            arrays[name] = np.array(value)
            return f'bool(case["{name}"])'
        case int() | np.integer():
            arrays[name] = np.array(value)
            return f'int(case["{name}"])'
        case float() | np.floating():
            arrays[name] = np.array(value)
            return f'float(case["{name}"])'
        case np.ndarray():
            arrays[name] = value
            return f'case["{name}"]'
        case list() | tuple():
            numbers = as_numbers(value)
            plain = not any(isinstance(part, np.ndarray) for part in value)
            if numbers is not None and plain and numbers.size:
                arrays[name] = numbers
                back = f'case["{name}"].tolist()'
                return back if isinstance(value, list) else f"tuple({back})"
            parts = [
                _stored(arrays, f"{name}_{n}", part) for n, part in enumerate(value)
            ]
            inside = ", ".join(parts)
            return f"[{inside}]" if isinstance(value, list) else f"({inside},)"
    arrays[name] = np.array(repr(value))
    return f'str(case["{name}"])'
