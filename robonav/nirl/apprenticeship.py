"""Apprenticeship learning via inverse reinforcement learning (Abbeel and Ng 2004): two ways to the expert's features.

Each iteration guesses a reward by which the expert does better than the policies found so far, finds the best policy
for it, and adds that to them. It ends where the expert's feature expectations are close to a mixture of theirs.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Generic, TypeVar

import numpy as np
from numpy.typing import ArrayLike, NDArray
from scipy.optimize import nnls

from robonav.progress import Progress
from robonav.validation import check_array, check_integer, check_real

from .max_margin import maximum_margin

Floats = NDArray[np.float64]
Found = TypeVar("Found")

Solver = Callable[[Floats], tuple[Any, ArrayLike]]
"""``solve(weights) -> (policy, mu)``: the best policy for the reward theta . f, and its feature expectations (K,)."""


@dataclass(frozen=True, eq=False)
class Apprenticeship(Generic[Found]):
    """The policies found, one more than iterations, and how near they came.

    Attributes
    ----------
    policies : n + 1; the first is the one started from.
    expectations : (n + 1, K) their feature expectations.
    weights : (n, K) the reward that each policy after the first is best for.
    distances : (n + 1,) how far the expert is, in feature expectations, from what the first 1, 2, ... policies reach.
    expert : (K,) the expert's feature expectations.
    """

    policies: tuple[Found, ...]
    expectations: Floats
    weights: Floats
    distances: Floats
    expert: Floats

    @property
    def closest(self) -> int:
        """Which single policy comes nearest to the expert's feature expectations."""
        return int(np.linalg.norm(self.expectations - self.expert, axis=1).argmin())

    @property
    def mixture(self) -> Floats:
        """(n + 1,) how often to pick each policy so that the mixture comes nearest to the expert."""
        return nearest_mixture(self.expert, self.expectations)


def project(mean: Floats, found: Floats, expert: Floats) -> Floats:
    """The point nearest to the expert on the line from ``mean`` through ``found``, all (K,) (Abbeel and Ng 2004, 3.1).

    Not beyond ``found`` itself, so that the point stays a mixture of policies. It would never lie beyond if ``found``
    were the best policy for the reward ``expert - mean``; one that was learned need not be.
    """
    along = found - mean
    length2 = along @ along
    share = (
        0.0 if length2 == 0 else float(np.clip(along @ (expert - mean) / length2, 0, 1))
    )
    return mean + share * along


def nearest_mixture(expert: ArrayLike, found: ArrayLike) -> Floats:
    """The shares (n,), at least 0 and with sum 1, of the mixture of mu_j (n, K) nearest to mu_E (K,).

    Non-negative least squares with the sum's equation weighted so heavily that it holds to rounding.
    """
    mu = check_array("expert", expert, shape=("K",))
    rows = check_array("found", found, shape=("n", len(mu)))
    scale = max(abs(rows - mu).max(), np.finfo(float).tiny)
    heavy = 1e5
    stacked = np.vstack([(rows - mu).T / scale, np.full(len(rows), heavy)])
    wanted = np.zeros(len(stacked))
    wanted[-1] = heavy
    shares, _ = nnls(stacked, wanted, maxiter=30 * len(rows) + 100)
    return shares / shares.sum()


def projection_method(
    expert: ArrayLike,
    solve: Solver,
    first: tuple[Any, ArrayLike],
    *,
    tolerance: float = 1e-3,
    iterations: int = 50,
    progress: Progress | None = None,
) -> Apprenticeship:
    """The projection method (Abbeel and Ng 2004, section 3.1): no quadratic program, only orthogonal projections.

    Parameters
    ----------
    expert : feature expectations mu_E, (K,).
    solve : see ``Solver``.
    first : a policy to start from and its feature expectations (K,).
    tolerance : epsilon; ends when the expert is no farther than this from the projection.
    iterations : policies to find at most.
    progress : called as ``progress(done, iterations)``.
    """

    mean: Floats | None = None

    def away_from_projection(mu: Floats, found: list[Floats]) -> tuple[Floats, float]:
        nonlocal mean
        mean = found[0] if mean is None else project(mean, found[-1], mu)
        return mu - mean, float(np.linalg.norm(mu - mean))

    return _learn(
        expert, solve, first, away_from_projection, tolerance, iterations, progress
    )


def max_margin_method(
    expert: ArrayLike,
    solve: Solver,
    first: tuple[Any, ArrayLike],
    *,
    tolerance: float = 1e-3,
    iterations: int = 50,
    progress: Progress | None = None,
) -> Apprenticeship:
    """The max-margin method (Abbeel and Ng 2004, section 3): the reward of :func:`maximum_margin` in each iteration.

    Parameters as in :func:`projection_method`.
    """

    def most_apart(mu: Floats, found: list[Floats]) -> tuple[Floats, float]:
        widest = maximum_margin(mu, np.stack(found))
        return widest.weights, widest.margin

    return _learn(expert, solve, first, most_apart, tolerance, iterations, progress)


def _learn(
    expert: ArrayLike,
    solve: Solver,
    first: tuple[Any, ArrayLike],
    guess: Callable[[Floats, list[Floats]], tuple[Floats, float]],
    tolerance: float,
    iterations: int,
    progress: Progress | None,
) -> Apprenticeship:
    """The loop of both methods; ``guess(expert, found)`` gives the next reward's weights and the distance left."""
    mu = check_array("expert", expert, shape=("K",))
    enough = check_real("tolerance", tolerance, at_least=0)
    most = check_integer("iterations", iterations, at_least=1)
    policies, found = [first[0]], [check_array("first", first[1], shape=mu.shape)]
    weights: list[Floats] = []
    distances: list[float] = []
    while True:
        theta, distance = guess(mu, found)
        distances.append(distance)
        if distance <= enough or len(weights) == most:
            break
        policy, expectations = solve(theta)
        weights.append(theta)
        policies.append(policy)
        found.append(
            check_array("solve: feature expectations", expectations, shape=mu.shape)
        )
        if progress is not None:
            progress(len(weights), most)
    rewards = np.stack(weights) if weights else np.empty((0, len(mu)))
    return Apprenticeship(
        tuple(policies), np.stack(found), rewards, np.array(distances), mu
    )
