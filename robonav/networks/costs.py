"""The two costs of chapter 3, each with its gradient, for an optimiser to minimise."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from ._interface import (
    cross_entropy_cost,
    cross_entropy_gradient,
    squared_error_cost,
    squared_error_gradient,
)
from .multilayer_perceptron import Gradient


@dataclass(frozen=True)
class Objective:
    """A cost to minimise, and its gradient.

    Attributes
    ----------
    cost, gradient : callable
        Functions of (network, x, y, regularisation=), such as :func:`squared_error_cost` and
        :func:`squared_error_gradient`.

    Examples
    --------
    >>> from robonav.networks import CROSS_ENTROPY
    >>> CROSS_ENTROPY.cost.__name__
    'cross_entropy_cost'
    """

    cost: Callable[..., float]
    gradient: Callable[..., Gradient]


SQUARED_ERROR = Objective(squared_error_cost, squared_error_gradient)
CROSS_ENTROPY = Objective(cross_entropy_cost, cross_entropy_gradient)
