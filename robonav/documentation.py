"""Documentation that several functions share, written once: parameters, result and errors."""

from __future__ import annotations

import inspect
import re
from collections.abc import Callable, Mapping
from typing import ParamSpec, TypeVar

P = ParamSpec("P")
R = TypeVar("R")

SECTIONS = ("Parameters", "Returns", "Raises", "Notes", "Examples")


def documents(
    parameters: Mapping[str, str], *, returns: str = "", raises: str = ""
) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Return a decorator that adds to a docstring what it leaves out.

    Parameters
    ----------
    parameters : mapping of str to str
        What is said of each parameter, by its name: its type and, on indented lines, its meaning. Only parameters of
        the function that its docstring does not explain are added, in the order of the function's signature.
    returns, raises : str
        These sections of a docstring that has none.

    Returns
    -------
    callable
        The decorator.

    Examples
    --------
    >>> @documents({"discount": "float\\n    gamma, in [0, 1)."}, returns="float")
    ... def effective_horizon(discount):
    ...     '''How many steps a discount looks ahead.'''
    ...     return 1 / (1 - discount)
    >>> print(effective_horizon.__doc__)
    How many steps a discount looks ahead.
    <BLANKLINE>
    Parameters
    ----------
    discount : float
        gamma, in [0, 1).
    <BLANKLINE>
    Returns
    -------
    float
    """

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        """Complete the docstring of a function."""
        text, sections = sections_of(inspect.getdoc(function) or "")
        order = list(inspect.signature(function).parameters)
        own = re.split(r"\n(?=\S)", sections.get("Parameters", ""))
        entries = {tuple(entry.split(" : ")[0].split(", ")): entry for entry in own}
        known = {name for names in entries for name in names}
        for name in order:
            if name not in known and name in parameters:
                entries[(name,)] = f"{name} : {parameters[name]}"
        entries.pop(("",), None)
        inside = sorted(entries, key=lambda names: order.index(names[0].lstrip("*")))
        complete = {
            "Parameters": "\n".join(entries[names] for names in inside),
            "Returns": returns,
            "Raises": raises,
        } | {name: body for name, body in sections.items() if name != "Parameters"}
        function.__doc__ = "\n\n".join(
            [text]
            + [
                f"{name}\n{'-' * len(name)}\n{complete[name]}"
                for name in SECTIONS
                if complete.get(name)
            ]
        )
        return function

    return decorate


def add_sections(described: Callable[..., object], sections: str) -> None:
    """Add sections to the docstring of a function or class whose source shows a short one.

    Parameters
    ----------
    described : function or class
        Its docstring is changed.
    sections : str
        In numpydoc's format.

    Examples
    --------
    >>> def double(x):
    ...     '''Twice a number.'''
    ...     return 2 * x
    >>> add_sections(double, "Returns\\n-------\\nfloat")
    >>> print(double.__doc__)
    Twice a number.
    <BLANKLINE>
    Returns
    -------
    float
    """
    described.__doc__ = f"{inspect.getdoc(described)}\n\n{sections.strip()}"


def sections_of(docstring: str) -> tuple[str, dict[str, str]]:
    """Return the text of a docstring in numpydoc's format, and its sections by their titles.

    Examples
    --------
    >>> sections_of("Add one.\\n\\nReturns\\n-------\\nint")
    ('Add one.', {'Returns': 'int'})
    """
    titles = "|".join(SECTIONS)
    text, *rest = re.split(rf"^({titles})\n-+\n", docstring, flags=re.MULTILINE)
    bodies = [body.strip("\n") for body in rest[1::2]]
    return text.strip(), dict(zip(rest[::2], bodies, strict=True))


def with_signature(
    function: Callable[P, R], signature: inspect.Signature
) -> Callable[P, R]:
    """Let a function show another signature than that of its code, in ``help()`` and in editors.

    A decorator that adds or fills in arguments takes them as ``*args`` and ``**kwargs``, which tells a reader nothing.

    Examples
    --------
    >>> import inspect
    >>> def area(*args): return args[0] * args[1]
    >>> def shape(width, height): ...
    >>> print(inspect.signature(with_signature(area, inspect.signature(shape))))
    (width, height)
    """
    function.__signature__ = signature  # type: ignore[attr-defined]
    return function
