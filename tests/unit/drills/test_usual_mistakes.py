"""Usual mistakes, made with the numbers of a text, are never judged right and get a hint in every question."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from numbers_in_texts import numbers, question_of

Mistakes = Callable[[str], list[Any]]
FEW, SEEDS = 100, 1000


def of_two_targets(text: str) -> list[Any]:
    """The other network's value in one or both targets, the other action, and one target for both methods."""
    reward, *values, discount = numbers(text)
    own, other = np.reshape(values, (2, 3))
    plain, double, by_own, by_other = (
        reward + discount * value
        for value in (
            other.max(),
            other[own.argmax()],
            own.max(),
            own[other.argmax()],
        )
    )
    given = [(by_own, by_own), (by_own, double), (plain, by_other), (plain, plain), (double, plain)]  # fmt: skip
    return [[[dqn], [double_dqn]] for dqn, double_dqn in given]


def of_targets_of_nfq(text: str) -> list[Any]:
    """A value after the arrival, no discount, and no clipping."""
    *pairs, discount = numbers(text)
    rewards, values = np.reshape(pairs, (3, 2)).T
    goes_on = np.array([1, 1, 0])
    return [
        [np.clip(rewards + discount * values, 0, 1).tolist()],
        [np.clip(rewards + goes_on * values, 0, 1).tolist()],
        [(rewards + goes_on * discount * values).tolist()],
    ]


def of_cost_of_outputs(text: str) -> list[Any]:
    """One of the two terms alone, the two exchanged, their mean, and the wrong sign."""
    t1, t2, o1, o2 = numbers(text)
    first = -t1 * math.log(o1) - t2 * math.log(o2)
    second = -(1 - t1) * math.log(1 - o1) - (1 - t2) * math.log(1 - o2)
    exchanged = sum(
        -t * math.log(1 - o) - (1 - t) * math.log(o) for t, o in ((t1, o1), (t2, o2))
    )
    return [first, exchanged, (first + second) / 2, -(first + second)]


MISTAKES: dict[str, Mistakes] = {
    "two-targets": of_two_targets,
    "targets-of-nfq": of_targets_of_nfq,
    "cost-of-outputs": of_cost_of_outputs,
}


def check(name: str, seeds: range) -> None:
    for seed in seeds:
        question = question_of(name, seed)
        for answer in MISTAKES[name](question.text):
            verdict = question.judge(answer)
            assert not verdict.right, (seed, answer)
            assert verdict.hint, (seed, answer)


@pytest.mark.parametrize("name", MISTAKES)
def test_no_usual_mistake_is_right(name: str) -> None:
    check(name, range(FEW))


@pytest.mark.exhaustive
@pytest.mark.parametrize("name", MISTAKES)
def test_no_usual_mistake_is_right_in_a_thousand_questions(name: str) -> None:
    check(name, range(FEW, SEEDS))


@pytest.mark.parametrize("name", ["left-open", "one-round-in-order"])
def test_texts_differ_from_question_to_question(name: str) -> None:
    texts = {question_of(name, seed).text for seed in range(FEW)}
    assert len(texts) >= 15
