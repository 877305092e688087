"""Localisation: a robot with a map, noisy ranges or none, and a belief about its pose (sections 2.2.2, 2.5.1).

The same Bayes filter as :class:`~robonav.mdp.POMDP`, for poses on a grid and observations that are real numbers. How a
robot senses is not known here: the ranges that the map predicts come in as an array.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray
from scipy.special import logsumexp, ndtr

from robonav.validation import (
    ArrayArgument,
    check_array,
    check_instance,
    check_integer,
    check_positive,
    check_real,
)

from ._arguments import checked, refuses_impossible
from .policies import SUM_TOLERANCE, as_distributions

Floats = NDArray[np.float64]


@dataclass(frozen=True, eq=False)
class PoseGrid:
    """Places and headings of a robot on a map of square cells.

    Pose number ``(row * columns + column) * headings + h`` is the centre of a cell, heading ``h * 2 pi / headings``.

    Parameters
    ----------
    free : (rows, columns) array of bools
        Where the robot can be; row 0 lies at y = 0, column 0 at x = 0.
    cell : float
        Side of a cell in metres.
    headings : int
        Number of directions; with 12, turns of 30 and 60 degrees lead from one to another.

    Examples
    --------
    >>> from robonav.mdp import PoseGrid
    >>> PoseGrid([[True, True]], headings=4).poses[:2].round(2)
    array([[0.5 , 0.5 , 0.  ],
           [0.5 , 0.5 , 1.57]])
    """

    free: NDArray[np.bool_]
    cell: float = 1.0
    headings: int = 12

    def __post_init__(self) -> None:
        free = check_array(
            "free", self.free, shape=("rows", "columns"), dtype=bool
        ).copy()
        if not free.any():
            raise ValueError("free must have a cell where the robot can be, got none")
        free.flags.writeable = False
        object.__setattr__(self, "free", free)
        object.__setattr__(self, "cell", check_positive("cell", self.cell))
        check_integer("headings", self.headings, at_least=1)

    @property
    def n_states(self) -> int:
        """S, the number of poses, those inside walls included."""
        return self.free.size * self.headings

    @cached_property
    def poses(self) -> Floats:
        """(S, 3) x and y in metres, heading in radians."""
        row, column, heading = (
            part.ravel() for part in np.indices((*self.free.shape, self.headings))
        )
        return np.column_stack(
            [
                (column + 0.5) * self.cell,
                (row + 0.5) * self.cell,
                heading * 2 * np.pi / self.headings,
            ]
        )

    @cached_property
    def possible(self) -> NDArray[np.bool_]:
        """(S,) whether the pose is in a free cell."""
        return np.repeat(self.free.ravel(), self.headings)

    def uniform(self) -> Floats:
        """The belief of a robot that only knows the map.

        Returns
        -------
        (S,) array

        Examples
        --------
        >>> from robonav.mdp import PoseGrid
        >>> PoseGrid([[True, False]], headings=2).uniform()
        array([0.5, 0.5, 0. , 0. ])
        """
        return self.possible / self.possible.sum()

    def around(self, poses: ArrayLike) -> sp.csr_array:
        """Poses as mixtures of grid poses: weights linear in x, y and heading, so that the mean is kept.

        Where one of the eight corners is not free, or off the map, its share goes to the others; a pose with no free
        corner gets an empty row.

        Parameters
        ----------
        poses : (N, 3) array
            x, y and heading of N poses.

        Returns
        -------
        (N, S) sparse array

        Examples
        --------
        >>> from robonav.mdp import PoseGrid
        >>> PoseGrid([[True, True]], headings=1).around([[0.75, 0.5, 0.0]]).toarray()
        array([[0.75, 0.25]])
        """
        given = check_array("poses", poses, shape=("N", 3))
        rows, columns = self.free.shape
        scaled = given / [self.cell, self.cell, 2 * np.pi / self.headings] - [
            0.5,
            0.5,
            0,
        ]
        low = np.floor(np.round(scaled, 9)).astype(int)
        above = np.clip(scaled - low, 0, 1)
        pose, state, weight = [], [], []
        for corner in np.ndindex(2, 2, 2):
            column, row, heading = (low + corner).T
            share = np.where(corner, above, 1 - above).prod(axis=1)
            inside = (
                (row >= 0)
                & (row < rows)
                & (column >= 0)
                & (column < columns)
                & (share > 0)
            )
            inside[inside] = self.free[row[inside], column[inside]]
            number = (row * columns + column) * self.headings + heading % self.headings
            pose.append(np.flatnonzero(inside))
            state.append(number[inside])
            weight.append(share[inside])
        coordinates = np.concatenate(pose), np.concatenate(state)
        mixed = sp.coo_array(
            (np.concatenate(weight), coordinates), (len(given), self.n_states)
        ).tocsr()
        totals = np.asarray(mixed.sum(axis=1))
        return sp.csr_array(sp.diags_array(1 / np.where(totals > 0, totals, 1)) @ mixed)


def pose_transitions(
    grid: PoseGrid, moves: ArrayLike, *, slip: ArrayLike | None = None
) -> tuple[sp.csr_array, ...]:
    """Transitions, A sparse matrices (S, S), of moves on a grid: turn, then go straight.

    A move that would end in a wall does not happen: the robot turns, but stays where it is.

    Parameters
    ----------
    grid : PoseGrid
    moves : (A, 2) array
        Turn in radians, counter-clockwise, and distance in metres (negative: backward).
    slip : (A, A) array, optional
        Probability that one move (row) becomes another (prediction uncertainty, section 2.5.1).

    Returns
    -------
    tuple of A sparse (S, S) matrices

    Examples
    --------
    >>> from robonav.mdp import PoseGrid, pose_transitions
    >>> grid = PoseGrid([[True, True]], headings=1)
    >>> pose_transitions(grid, [(0.0, 1.0)])[0].toarray()
    array([[0., 1.],
           [0., 1.]])
    """
    steps = check_array("moves", moves, shape=("A", 2))
    meant = [_move(grid, turn, distance) for turn, distance in steps]
    if slip is None:
        return tuple(meant)
    mixing = check_array("slip", slip, shape=(len(steps), len(steps)))
    if (mixing < 0).any() or not np.allclose(mixing.sum(axis=1), 1):
        raise ValueError("slip must have rows of probabilities that sum to one")
    return tuple(
        sp.csr_array(sum(share * meant[b] for b, share in enumerate(row) if share > 0))
        for row in mixing
    )


def _move(grid: PoseGrid, turn: float, distance: float) -> sp.csr_array:
    """Transitions (S, S) of one move."""
    turned = grid.poses + [0, 0, turn]
    ahead = distance * np.column_stack(
        [np.cos(turned[:, 2]), np.sin(turned[:, 2]), np.zeros(len(turned))]
    )
    gone, stayed = grid.around(turned + ahead), grid.around(turned)
    blocked = np.asarray(gone.sum(axis=1)) == 0
    # poses inside walls; nobody is there
    nowhere = blocked & (np.asarray(stayed.sum(axis=1)) == 0)
    return sp.csr_array(
        gone
        + sp.diags_array(blocked.astype(float)) @ stayed
        + sp.diags_array(nowhere.astype(float))
    )


@dataclass(frozen=True)
class RangeSensor:
    """Errors of a range sensor, relative to the ranges that the map predicts.

    Parameters
    ----------
    deviation : float
        Standard deviation in metres of a reading around the range predicted at the centre of a cell. Add to the
        sensor's own noise the effect of half a cell and half a heading step: about half a cell.
    reach : float
        Reading in metres of a sensor that detects nothing.
    outliers : float
        Share of readings that are independent of the map: half of them detect nothing, half are uniform. Too small a
        share makes beliefs overconfident: near a corner, half a heading step can change a reading by metres.

    Examples
    --------
    >>> from robonav.mdp import RangeSensor
    >>> sensor = RangeSensor(deviation=0.5)
    >>> bool(sensor.log_likelihood([3.0], [3.1]) > sensor.log_likelihood([3.0], [5.0]))
    True
    """

    deviation: float = 0.7
    reach: float = 10.0
    outliers: float = 0.1

    def __post_init__(self) -> None:
        check_positive("deviation", self.deviation)
        check_positive("reach", self.reach)
        check_real("outliers", self.outliers, at_least=0, at_most=1)

    @checked
    def log_likelihood(
        self, predicted: ArrayArgument, measured: ArrayArgument
    ) -> Floats:
        """Logarithm of the density of readings where other ranges are expected.

        A reading short of ``reach`` has a normal density about the prediction; ``reach`` itself, which stands for all
        that lies beyond, has the whole tail as its probability. The n sensors err independently.

        Parameters
        ----------
        predicted : (..., n) array
            What an exact sensor would read.
        measured : (n,) array
            The readings.

        Returns
        -------
        (...) array

        Examples
        --------
        >>> import numpy as np
        >>> from robonav.mdp import RangeSensor
        >>> densities = np.exp(RangeSensor().log_likelihood([[3.0], [5.0]], [3.1]))
        >>> densities.round(3)
        array([0.513, 0.018])
        """
        error = (measured - predicted) / self.deviation
        beyond = measured >= self.reach
        hit = np.where(
            beyond,
            ndtr(-error),
            np.exp(-(error**2) / 2) / (np.sqrt(2 * np.pi) * self.deviation),
        )
        stray = np.where(beyond, 0.5, 0.5 / self.reach)
        density = (1 - self.outliers) * hit + self.outliers * stray
        with np.errstate(divide="ignore"):  # the logarithm of 0 is minus infinity
            return np.log(density).sum(axis=-1)


@dataclass(frozen=True, eq=False)
class Localiser:
    """The belief of a robot about its pose, kept by Bayes' rule.

    The filter of :class:`~robonav.mdp.POMDP` (its ``update``), for observations that are real numbers.

    Parameters
    ----------
    transitions : tuple of A sparse (S, S) matrices
        Such as :func:`pose_transitions` makes.
    predicted : (S, n) array
        What the n sensors would read at each pose without noise.
    sensor : RangeSensor
        Their errors.

    Raises
    ------
    TypeError, ValueError
        If the transitions are not (S, S) with rows that sum to one, or the rest does not fit them. The methods raise
        it if a belief is not a distribution over S poses, an action does not exist, or there are not n readings.

    Examples
    --------
    >>> from robonav.mdp import Localiser, PoseGrid, pose_transitions
    >>> grid = PoseGrid([[True, True]], headings=1)
    >>> localiser = Localiser(pose_transitions(grid, [(0.0, 1.0)]), [[5.0], [2.0]])
    >>> localiser.correct(grid.uniform(), [2.0]).round(2)
    array([0.01, 0.99])
    """

    transitions: tuple[sp.csr_array, ...]
    predicted: Floats
    sensor: RangeSensor = RangeSensor()

    def __post_init__(self) -> None:
        check_instance("sensor", self.sensor, RangeSensor)
        object.__setattr__(
            self,
            "predicted",
            check_array("predicted", self.predicted, shape=("S", "n")),
        )
        states = len(self.predicted)
        for action, matrix in enumerate(
            check_instance("transitions", self.transitions, tuple)
        ):
            if not sp.issparse(matrix) or matrix.shape != (states, states):
                raise ValueError(
                    f"transitions must be sparse matrices ({states}, {states}), but that of action {action} is not"
                )
            if (
                matrix.data.min(initial=0) < 0
                or (abs(matrix.sum(axis=1) - 1) > SUM_TOLERANCE).any()
            ):
                raise ValueError(
                    f"transitions must hold one distribution a row, but those of action {action} do not"
                )

    @checked
    def predict(self, belief: ArrayArgument, action: int) -> Floats:
        """The belief after a move: all that a robot with no sensing has.

        Parameters
        ----------
        belief : (S,) array
            The belief before it.
        action : int
            The move.

        Returns
        -------
        (S,) array

        Examples
        --------
        >>> from robonav.mdp import Localiser, PoseGrid, pose_transitions
        >>> grid = PoseGrid([[True, True]], headings=1)
        >>> localiser = Localiser(pose_transitions(grid, [(0.0, 1.0)]), [[5.0], [2.0]])
        >>> localiser.predict([0.5, 0.5], action=0)
        array([0., 1.])
        """
        return belief @ self.transitions[action]

    @refuses_impossible(
        "the ranges have probability zero in every pose that the belief holds possible"
    )
    @checked
    def correct(self, belief: ArrayArgument, ranges: ArrayArgument) -> Floats:
        """The belief after readings.

        Parameters
        ----------
        belief : (S,) array
            The belief before them.
        ranges : (n,) array
            One reading for each sensor, in metres.

        Returns
        -------
        (S,) array

        Raises
        ------
        ValueError
            If the readings are impossible in every pose that the belief holds possible. This needs a sensor without
            outliers.

        Examples
        --------
        >>> from robonav.mdp import Localiser, PoseGrid, pose_transitions
        >>> grid = PoseGrid([[True, True]], headings=1)
        >>> localiser = Localiser(pose_transitions(grid, [(0.0, 1.0)]), [[5.0], [2.0]])
        >>> localiser.correct([0.5, 0.5], [2.0]).round(2)
        array([0.01, 0.99])
        """
        possible = np.flatnonzero(belief)
        evidence = self.sensor.log_likelihood(self.predicted[possible], ranges)
        log = np.log(belief[possible]) + evidence
        corrected = np.zeros_like(belief)
        corrected[possible] = np.exp(log - logsumexp(log))
        return corrected / corrected.sum()

    def update(self, belief: ArrayLike, action: int, ranges: ArrayLike) -> Floats:
        """The belief after a move and the readings that follow it.

        Parameters
        ----------
        belief : (S,) array
            The belief before them.
        action : int
            The move.
        ranges : (n,) array
            One reading for each sensor, in metres.

        Returns
        -------
        (S,) array

        Examples
        --------
        >>> from robonav.mdp import Localiser, PoseGrid, pose_transitions
        >>> grid = PoseGrid([[True, True]], headings=1)
        >>> localiser = Localiser(pose_transitions(grid, [(0.0, 1.0)]), [[5.0], [2.0]])
        >>> localiser.update([1.0, 0.0], action=0, ranges=[2.0])
        array([0., 1.])
        """
        return self.correct(self.predict(belief, action), ranges)

    def as_belief(self, belief: ArrayLike) -> Floats:
        """The belief as an array, checked.

        Parameters
        ----------
        belief : (S,) array
            Probabilities of the poses.

        Returns
        -------
        (S,) array

        Examples
        --------
        >>> from robonav.mdp import Localiser, PoseGrid, pose_transitions
        >>> grid = PoseGrid([[True, True]], headings=1)
        >>> localiser = Localiser(pose_transitions(grid, [(0.0, 1.0)]), [[5.0], [2.0]])
        >>> localiser.as_belief([0.25, 0.75])
        array([0.25, 0.75])
        """
        check_array("belief", belief, shape=(len(self.predicted),))
        return as_distributions("belief", belief, len(self.predicted))

    def as_action(self, action: int) -> int:
        """The action as an index, checked.

        Parameters
        ----------
        action : int
            A move's index.

        Returns
        -------
        int

        Examples
        --------
        >>> from robonav.mdp import Localiser, PoseGrid, pose_transitions
        >>> grid = PoseGrid([[True, True]], headings=1)
        >>> localiser = Localiser(pose_transitions(grid, [(0.0, 1.0)]), [[5.0], [2.0]])
        >>> localiser.as_action(0)
        0
        """
        last = len(self.transitions) - 1
        return check_integer("action", action, at_least=0, at_most=last)

    def as_ranges(self, ranges: ArrayLike) -> Floats:
        """The readings as an array, checked.

        Parameters
        ----------
        ranges : (n,) array
            One reading for each sensor, in metres.

        Returns
        -------
        (n,) array

        Examples
        --------
        >>> from robonav.mdp import Localiser, PoseGrid, pose_transitions
        >>> grid = PoseGrid([[True, True]], headings=1)
        >>> localiser = Localiser(pose_transitions(grid, [(0.0, 1.0)]), [[5.0], [2.0]])
        >>> localiser.as_ranges([2])
        array([2.])
        """
        return check_array("ranges", ranges, shape=self.predicted.shape[1:])
