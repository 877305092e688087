"""The warning of an iterative method that did not converge."""

from __future__ import annotations

import inspect
import warnings
from collections.abc import Callable
from functools import wraps
from typing import Any, ParamSpec, Protocol, TypeVar

from robonav.counting import counted
from robonav.errors import ConvergenceWarning


class Converging(Protocol):
    """The result of an iterative method."""

    @property
    def iterations(self) -> int:
        """Number of iterations."""

    @property
    def residual(self) -> float:
        """Largest change of a value in the last iteration."""

    @property
    def converged(self) -> bool:
        """Whether the change was as small as asked for."""


P = ParamSpec("P")
R = TypeVar("R", bound=Converging)


def warns_not_converged(
    limit: Callable[[Any, float], float],
) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Decorate an iterative method, so that it warns where its result has not converged.

    Parameters
    ----------
    limit : callable
        ``limit(model, tolerance)`` is the residual at which the method stops, for the warning. The model is the first
        argument of the method.

    Returns
    -------
    callable
        The decorator.
    """

    def decorate(method: Callable[P, R]) -> Callable[P, R]:
        """Let this function warn where it did not converge."""
        signature = inspect.signature(method)

        @wraps(method)
        def run(*args: P.args, **kwargs: P.kwargs) -> R:
            """Call the function, and warn where it did not converge."""
            result = method(*args, **kwargs)
            if not result.converged:
                call = signature.bind(*args, **kwargs)
                call.apply_defaults()
                wanted = limit(call.args[0], call.arguments["tolerance"])
                warn_not_converged(
                    method.__name__, result.iterations, result.residual, wanted
                )
            return result

        return run

    return decorate


def warn_not_converged(
    name: str, iterations: int, residual: float, limit: float, *, stacklevel: int = 4
) -> None:
    """Give a ConvergenceWarning at the line that called the method ``name``."""
    warnings.warn(
        f"{name} gave up after {counted(iterations, 'iteration')}: the last one still changed a value "
        f"by {residual:.3g}, where {limit:.3g} was asked for",
        ConvergenceWarning,
        stacklevel=stacklevel,
    )
