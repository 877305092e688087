"""Decorator of the planners: it checks arguments, runs the compiled twin, and warns.

The decorator :func:`planner` turns an algorithm into the function that users call. It

1. adds the argument ``record`` where the twin keeps a record, and checks the arguments;
2. fills in the default of ``start``, which without discount is a proper policy or its values;
3. runs the twin of the algorithm from ``_fast_planners`` or ``_recorded_planners``, which keeps the values of each
   iteration if ``record`` is true. How closely the two results agree is said below;
4. warns if the algorithm did not converge;
5. adds the greedy policy of each row of the history if ``record`` is true.

A twin from ``_fast_planners`` gives the numbers of its algorithm bit for bit on sparse models. On dense ones NumPy adds
the terms of an expected value in another order, so the numbers differ by rounding. Where two actions are equally good,
this can change which of them modified policy iteration evaluates on its way. Its two results may then differ by up to
the tolerance: each keeps the tolerance, but they are not equal within rounding. The twin of policy iteration solves the
linear equations by another method, so its values agree within rounding on every model.

``inspect.unwrap(planner)`` is the algorithm as written, for a discount below 1.
"""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import replace
from functools import wraps
from importlib import import_module
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from robonav.documentation import with_signature

from ._arguments import checked
from .convergence import warn_not_converged
from .evaluation import with_record
from .models import FiniteMDP
from .solutions import Solution, greedy_actions


def planner(
    *,
    start: Callable[[FiniteMDP, ArrayLike | None], Any],
    limit: Callable[[FiniteMDP, float], float],
    twin: str,
    records: bool = True,
) -> Callable[[Callable[..., Solution]], Callable[..., Solution]]:
    """Make a planner of an algorithm.

    Parameters
    ----------
    start : callable
        ``start(mdp, given)`` is what the algorithm starts from where the user gave ``given`` or None.
    limit : callable
        ``limit(mdp, tolerance)`` is the residual at which the algorithm stops, for the warning.
    twin : str
        The module with a function of the same name that runs instead: it is compiled, or it keeps a record.
    records : bool
        Whether the twin takes an argument ``record``, which is then one of the planner's too.
    """

    def decorate(algorithm: Callable[..., Solution]) -> Callable[..., Solution]:
        """Make a planner of this algorithm."""
        signature = inspect.signature(algorithm)
        if records:
            signature = with_record(signature)
        name = algorithm.__name__

        @wraps(algorithm)
        def plan(*args: Any, **kwargs: Any) -> Solution:
            """Fill in the start, run the twin of the algorithm, and warn where it did not converge."""
            call = signature.bind(*args, **kwargs)
            call.apply_defaults()
            mdp, tolerance = call.arguments["mdp"], call.arguments["tolerance"]
            call.arguments["start"] = start(mdp, call.arguments["start"])
            solution = twin_of(name, twin)(*call.args, **call.kwargs)
            if not solution.converged:
                wanted = limit(mdp, tolerance)
                warn_not_converged(name, solution.iterations, solution.residual, wanted)
            return with_policies(mdp, solution, tolerance)

        return checked(with_signature(plan, signature))

    return decorate


def twin_of(name: str, module: str) -> Callable[..., Solution]:
    """The planner of this name in a module of this package, which is loaded only now."""
    twin: Callable[..., Solution] = getattr(
        import_module(f"robonav.mdp.{module}"), name
    )
    return twin


def with_policies(mdp: FiniteMDP, solution: Solution, tolerance: float) -> Solution:
    """The solution with the greedy policy of each row of its history, unless it has them already."""
    if solution.history is None or solution.policies is not None:
        return solution
    before = [greedy_actions(mdp, row, tolerance) for row in solution.history[:-1]]
    return replace(solution, policies=np.stack([*before, solution.policy]))
