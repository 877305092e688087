"""Neural inverse reinforcement learning (Algorithm 10), and the practice under a reward that all methods share."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from robonav.networks.multilayer_perceptron import Network, random_network, stacked
from robonav.progress import Progress
from robonav.validation import check_array, check_generator, check_integer, check_real

from .boltzmann import boltzmann
from .max_margin import project_to_unit_ball
from .model_selection import accuracy, balanced_accuracy
from .policy_improvement import Improver, ReplaySGD
from .reward_update import SubgradientMaxMargin, balance, contrast
from .tasks import Course
from .transitions import Floats, Steps


class RewardRule(Protocol):
    """Step 5 of Algorithm 10: a reward from the expert's decisions and the policy found last."""

    def __call__(
        self,
        shown: Steps,
        chances: Floats,
        values: Floats,
        before: Floats,
        iteration: int,
    ) -> Floats:
        """Theta (A, k + 1), of any length.

        Parameters
        ----------
        shown : M decisions of the expert.
        chances : pi(a | s_t) of the last policy in the expert's states, (M, A).
        values : its network's outputs there, (M, A).
        before : theta of the iteration before.
        iteration : from 1.
        """


Score = Callable[[NDArray[np.int64], NDArray[np.int64]], float]
"""``score(predicted, shown)``: how well a policy predicts the demonstrations; the best is kept."""


@dataclass(frozen=True, eq=False)
class History:
    """What a learner went through in n iterations; networks and scores begin with the network before the first.

    Attributes
    ----------
    networks : stack (n + 1,).
    weights : theta of every iteration, ||theta|| <= 1, (n, A, k + 1).
    margins : (n,) by how much theta prefers the expert to the policy it is to beat, decision by decision (Fig. 5.7).
    costs : (n,) of the network, Eq. (5.15) (Fig. 5.8).
    arrived, collided : (n,) shares of the iteration's practice drives.
    decisions : (n,) made in them.
    accuracies, balanced : (n + 1,) of the greedy policy's predictions of the demonstrations.
    """

    networks: Network
    weights: Floats
    margins: Floats
    costs: Floats
    arrived: Floats
    collided: Floats
    decisions: NDArray[np.int64]
    accuracies: Floats
    balanced: Floats

    @property
    def changes(self) -> Floats:
        """sum |W_new - W| of each layer from one iteration to the next, (n, 2), Fig. 5.11."""
        return np.stack(
            [
                abs(np.diff(weight, axis=0)).sum(axis=(1, 2))
                for weight in self.networks.weights
            ],
            axis=1,
        )


@dataclass(frozen=True, eq=False)
class Found:
    """The policy kept, ``network``, which of the history's networks it is, and the ``weights`` it was trained for."""

    network: Network
    chosen: int
    weights: Floats
    history: History


def nirl(
    shown: Steps,
    course: Course,
    *,
    iterations: int = 140,
    tolerance: float = 0.0,
    hidden: int = 10,
    eta: float = 25.0,
    reward: RewardRule | None = None,
    improve: Improver | None = None,
    score: Score = balanced_accuracy,
    seed: int | np.random.Generator,
    progress: Progress | None = None,
) -> Found:
    """Neural inverse reinforcement learning, Algorithm 10.

    Parameters
    ----------
    shown : the expert's decisions.
    course : where the learner drives.
    iterations : at most.
    tolerance : epsilon: ends when the margin is no larger than this.
    hidden : units of the network.
    eta : of the Boltzmann policy (5.10) over the network's outputs, which lie between 0 and 1.
    reward : step 5, by default :class:`SubgradientMaxMargin`; :class:`LeastSquaresReward` is the thesis to the letter.
    improve : step 10, by default :class:`ReplaySGD`; :class:`SingleGradientStep` is the thesis to the letter.
    score : by which the policy to keep is chosen: :func:`balanced_accuracy`, or the thesis's :func:`accuracy`.
    seed : a whole number or a generator.
    progress : called as ``progress(done, iterations)``.

    Raises
    ------
    ValueError : if nothing was shown, an action shown does not exist, or an argument is out of bounds.
    """
    rule = reward or SubgradientMaxMargin()
    epsilon = check_real("tolerance", tolerance)
    practice = Practice(shown, course, hidden, eta, improve or ReplaySGD(), seed)
    theta = np.zeros((course.actions, shown.features.shape[1]))
    for iteration in range(1, check_integer("iterations", iterations, at_least=1) + 1):
        practice.drive()
        theta = rule(shown, practice.chances, practice.values, theta, iteration)
        margin = practice.iterate(theta, (iteration - 1) / max(iterations - 1, 1))
        if progress is not None:
            progress(iteration, iterations)
        if margin <= epsilon and epsilon > 0:
            break
    return practice.found(score)


def train_under_reward(
    shown: Steps,
    course: Course,
    weights: Floats,
    *,
    iterations: int = 140,
    hidden: int = 10,
    eta: float = 25.0,
    improve: Improver | None = None,
    score: Score = balanced_accuracy,
    seed: int | np.random.Generator,
    progress: Progress | None = None,
) -> Found:
    """Neural policy iteration under a reward that stays, theta (A, k + 1): Algorithm 10 without its step 5.

    The demonstrations serve to choose among the policies found, and for nothing else. Parameters as in :func:`nirl`.
    """
    practice = Practice(shown, course, hidden, eta, improve or ReplaySGD(), seed)
    theta = check_array(
        "weights", weights, shape=(course.actions, shown.features.shape[1])
    )
    for iteration in range(1, check_integer("iterations", iterations, at_least=1) + 1):
        practice.drive()
        practice.iterate(theta, (iteration - 1) / max(iterations - 1, 1))
        if progress is not None:
            progress(iteration, iterations)
    return practice.found(score)


class Practice:
    """A network that drives, learns and is written down, iteration by iteration: what all methods have in common.

    Attributes
    ----------
    network : the latest.
    values, chances : its outputs and its Boltzmann policy in the expert's states, (M, A) each.
    drives : of every iteration.
    notes : theta, margin and cost of every iteration.
    """

    def __init__(
        self,
        shown: Steps,
        course: Course,
        hidden: int,
        eta: float,
        improve: Improver,
        seed: int | np.random.Generator,
    ) -> None:
        if len(shown) == 0:
            raise ValueError(
                "shown must hold at least one decision of the expert, got none"
            )
        if shown.actions.max() >= course.actions or shown.actions.min() < 0:
            raise ValueError(
                f"shown must hold actions from 0 to {course.actions - 1}, "
                f"got {shown.actions.min()} to {shown.actions.max()}"
            )
        self.shown, self.course, self.improve = shown, course, improve
        self.eta = check_real("eta", eta, at_least=0)
        self.rng = check_generator("seed", seed)
        self.drives: list[Steps] = []
        self.notes: list[tuple[Floats, float, float]] = []
        self._networks: list[Network] = []
        self._scores: list[tuple[float, float]] = []
        self._balance = balance(shown.actions, course.actions)
        units = check_integer("hidden", hidden, at_least=1)
        self._adopt(
            random_network((course.inputs, units, course.actions), seed=self.rng)
        )

    def _adopt(self, network: Network) -> None:
        self.network = network
        self.values = network.forward(self.shown.inputs)
        self.chances = boltzmann(self.values, self.eta)
        predicted = network.decide(self.shown.inputs)
        self._networks.append(network)
        self._scores.append(
            (
                accuracy(predicted, self.shown.actions),
                balanced_accuracy(predicted, self.shown.actions),
            )
        )

    def drive(self) -> Steps:
        """A few drives with the latest policy."""
        network, eta = self.network, self.eta
        self.drives.append(
            self.course.drive(
                lambda inputs: boltzmann(network.forward(inputs), eta), self.rng
            )
        )
        return self.drives[-1]

    def iterate(self, theta: Floats, fraction: float) -> float:
        """Improve the network for the reward theta; the margin by which that reward prefers the expert to it before."""
        weights = project_to_unit_ball(theta)
        margin = float(
            (weights * contrast(self.shown, self.chances, self._balance)).sum()
        )
        improved = self.improve(self.network, self.drives, weights, fraction, self.rng)
        self.notes.append((weights, margin, improved.cost))
        self._adopt(improved.network)
        return margin

    def found(self, score: Score = balanced_accuracy) -> Found:
        """The policy that predicts the demonstrations best, and how it all went."""
        predictions = [network.decide(self.shown.inputs) for network in self._networks]
        chosen = int(
            np.argmax(
                [score(predicted, self.shown.actions) for predicted in predictions]
            )
        )
        thetas, margins, costs = zip(*self.notes, strict=True)
        accuracies, balanced = np.array(self._scores).T
        drives = self.drives[: len(thetas)]
        history = History(
            networks=stacked(self._networks),
            weights=np.stack(thetas),
            margins=np.array(margins),
            costs=np.array(costs),
            arrived=np.array([steps.arrived.mean() for steps in drives]),
            collided=np.array([steps.failed.mean() for steps in drives]),
            decisions=np.array([len(steps) for steps in drives]),
            accuracies=accuracies,
            balanced=balanced,
        )
        return Found(
            self._networks[chosen], chosen, thetas[max(chosen - 1, 0)], history
        )
