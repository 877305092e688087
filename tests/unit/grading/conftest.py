"""What tests of exercises and of their variants share."""

import functools

import numpy as np
import pytest

from robonav.grading import frames
from robonav.grading.cases import PUBLIC, generator, parts_of
from robonav.grading.check import InProcessCalls
from robonav.grading.evidence import Evidence
from robonav.grading.grade import Unaccepted
from robonav.grading.session import Answer


@pytest.fixture(scope="session")
def passes():
    """Whether a function passes all parts of an exercise; it ends at the first one that it does not pass."""

    def passed(course, known, exercise, function, seed=PUBLIC):
        calls, evidence = InProcessCalls(function), Evidence(known)
        for test, _ in parts_of(course, exercise):
            answer = Answer(calls, evidence, exercise, test.__name__)
            try:
                with np.errstate(all="ignore"):
                    test(answer, generator(seed, test.__name__))
            except Unaccepted:
                return False
        return True

    return passed


@pytest.fixture(scope="session")
def remembered():
    """Make functions that answer from memory what they were asked before, because many tests ask the same.

    An answer that came with changed arguments is not kept: such a function has to change them every time.
    """

    @functools.cache
    def with_memory(function):
        known = {}

        @functools.wraps(function)
        def answer(*arguments):
            key = frames.encode(list(arguments))
            if key not in known:
                value = function(*arguments)
                if frames.encode(list(arguments)) != key:
                    return value
                known[key] = value
            return known[key]

        return answer

    return with_memory
