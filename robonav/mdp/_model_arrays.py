"""The arrays of a finite MDP, checked and copied when it is made."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike, NDArray

from robonav.validation import check_array

from . import policies


def checked_rewards(rewards: ArrayLike, shape: tuple[int, int]) -> NDArray[np.float64]:
    """Check that the rewards (S, A) are finite. The error says what to do with actions that are not allowed."""
    given = np.asarray(rewards)
    if given.dtype.kind == "f" and np.isneginf(given).any():
        raise ValueError(
            "rewards must hold finite numbers only, got minus infinity: every action must be allowed in every state. "
            "Give a forbidden action the transitions and the reward of an allowed one in that state"
        )
    return check_array("rewards", rewards, shape=shape)


def checked_transitions(
    transitions: Any,
) -> NDArray[np.float64] | tuple[sp.csr_array, ...]:
    """A read-only copy: an array (A, S, S), or a tuple of A sparse arrays (S, S)."""
    checked: NDArray[np.float64] | tuple[sp.csr_array, ...]
    if sp.issparse(transitions):
        raise TypeError(
            "transitions must be a sequence of A sparse matrices (S, S), got one sparse matrix"
        )
    if isinstance(transitions, np.ndarray) and transitions.dtype.kind == "O":
        transitions = list(transitions)  # of matrices, as pymdptoolbox has them
    if isinstance(transitions, Sequence) and any(
        sp.issparse(matrix) for matrix in transitions
    ):
        checked = tuple(
            _checked_sparse(action, matrix, transitions)
            for action, matrix in enumerate(transitions)
        )
        parts = [
            part
            for matrix in checked
            for part in (matrix.data, matrix.indices, matrix.indptr)
        ]
    else:
        checked = check_array("transitions", transitions, shape=("A", "S", "S")).copy()
        if (dtype := np.asarray(transitions).dtype) != checked.dtype:
            checked, _ = policies.normalised(checked, dtype)
        if checked.shape[1] != checked.shape[2]:
            raise ValueError(
                f"transitions must have shape (A, S, S), got {checked.shape}"
            )
        parts = [checked]
    if len(checked) == 0 or checked[0].shape[0] == 0:
        raise ValueError("transitions must hold at least one action and one state")
    for part in parts:
        part.flags.writeable = False
    for action, matrix in enumerate(checked):
        _check_rows(action, matrix)
    return checked


def _checked_sparse(
    action: int, matrix: Any, transitions: Sequence[Any]
) -> sp.csr_array:
    """A canonical copy of one action's sparse matrix."""
    if not sp.issparse(matrix):
        raise TypeError(
            f"transitions must be all sparse or all dense, got {type(matrix).__name__} at action {action}"
        )
    states = transitions[0].shape[0]
    if matrix.shape != (states, states):
        raise ValueError(
            f"transitions must hold matrices ({states}, {states}), got {matrix.shape} at action {action}"
        )
    copy = sp.csr_array(matrix, dtype=float, copy=True)
    copy.sum_duplicates()
    copy.eliminate_zeros()
    check_array("transitions", copy.data)
    if matrix.dtype != copy.dtype:
        copy = scaled_rows(copy, matrix.dtype)
    return with_small_indices(copy)


def scaled_rows(matrix: sp.csr_array, dtype: np.dtype) -> sp.csr_array:
    """The matrix whose rows, rounded to a narrower type, are divided by their sums; unchanged if one is too far off."""
    totals = np.asarray(matrix.sum(axis=1))
    tolerance = policies.sum_tolerance(
        dtype, int(np.diff(matrix.indptr).max(initial=1))
    )
    if (abs(totals - 1) > tolerance).any():
        return matrix
    return sp.csr_array(sp.diags_array(1 / totals) @ matrix)


def with_small_indices(matrix: sp.csr_array) -> sp.csr_array:
    """The matrix with 32-bit indices where they suffice: products with a vector are then faster."""
    if matrix.nnz < 2**31 and max(matrix.shape) < 2**31:
        matrix.indices = matrix.indices.astype(np.int32, copy=False)
        matrix.indptr = matrix.indptr.astype(np.int32, copy=False)
    return matrix


def _check_rows(action: int, matrix: NDArray[np.float64] | sp.csr_array) -> None:
    """ValueError unless every row is a distribution."""
    probabilities = matrix if isinstance(matrix, np.ndarray) else matrix.data
    if probabilities.min(initial=0) < 0:
        raise ValueError(
            f"transitions must not hold negative probabilities, got one at action {action}"
        )
    totals = np.asarray(matrix.sum(axis=1))
    state = int(abs(totals - 1).argmax())
    if abs(totals[state] - 1) > policies.SUM_TOLERANCE:
        raise ValueError(
            "transitions must sum to 1 over the states reached, "
            f"got {totals[state]:.10g} at action {action}, state {state}"
        )
