"""VFH+ against a slow one with loops, written from the paper."""

from __future__ import annotations

import math

import numpy as np
import pytest

from robonav.planners import polar_histogram, target_bearing, vector_field_histogram
from robonav.planners.vector_field_histogram import BINS


def slow_histogram(ranges, clearance, half_width):
    """One bin after the other, one sector after the other, in whole degrees of the circle."""
    bins = []
    for b in range(BINS):
        total = 0.0
        for k, d in enumerate(ranges):
            off = abs((5 * b - 40 * k + 180) % 360 - 180)
            gamma = 90.0 if d <= clearance else math.degrees(math.asin(clearance / d))
            if off <= math.degrees(half_width) + gamma + 1e-7:
                total += 1 - (d / 10) ** 2
        bins.append(total)
    return bins


def slow_choice(histogram, target, threshold, wide, keep):
    """Find the openings one by one, list their candidates, and take the cheapest."""
    signed = range(-18, 19)  # bins from 90 degrees to the right to 90 to the left
    free = [b for b in signed if histogram[b % BINS] < threshold]
    openings, here = [], []
    for b in signed:
        if b in free:
            here.append(b)
        elif here:
            openings.append(here)
            here = []
    openings += [here] if here else []
    candidates = []
    half = wide // 2
    for opening in openings:
        if len(opening) > 2 * half:
            candidates += opening[half : len(opening) - half]
        elif len(opening) <= wide:
            middle = (len(opening) - 1) / 2
            candidates += [opening[math.floor(middle)], opening[math.ceil(middle)]]
    if not candidates:
        return math.pi

    def cost(b):
        off = abs((math.radians(5 * b) - target + math.pi) % (2 * math.pi) - math.pi)
        return off + keep * math.radians(abs(5 * b))

    return math.radians(5 * min(candidates, key=lambda b: (round(cost(b), 9), b % BINS)))  # fmt: skip


@pytest.mark.parametrize(("clearance", "half_width"), [(1.0, 0.0), (1.5, 0.1), (2.5, 0.35)])  # fmt: skip
def test_histogram_against_loops(random_sensing, clearance, half_width):
    ranges = random_sensing.ranges[:60]
    found = polar_histogram(ranges, clearance=clearance, half_width=half_width)
    slow = [slow_histogram(row, clearance, half_width) for row in ranges]
    np.testing.assert_allclose(found, slow, atol=1e-12)


@pytest.mark.parametrize("wide", [4, 8, 16])
@pytest.mark.parametrize("keep", [0.0, 0.7])
def test_choice_against_a_search_of_the_openings(random_sensing, wide, keep):
    sensing = random_sensing[:300]
    histogram = polar_histogram(sensing.ranges, clearance=1.5, half_width=0.1)
    target = target_bearing(sensing)
    settings = {"threshold": 0.5, "wide": wide, "keep": keep}
    found = vector_field_histogram(histogram, target, **settings)
    slow = [
        slow_choice(row, bearing, **settings)
        for row, bearing in zip(histogram, target, strict=True)
    ]
    np.testing.assert_allclose(found, slow, atol=1e-9)
    assert (np.abs(found - np.pi) < 1e-9).any()  # somewhere nothing is free


def test_nearer_obstacles_take_more_bins_and_count_more():
    near, far = (
        polar_histogram([[d] + [10.0] * 8], clearance=1.0, half_width=0.0)[0]
        for d in (2.0, 6.0)
    )
    assert (near > 0).sum() == 13  # arcsin(1 / 2) is 30 degrees: 6 bins to either side
    assert near[0] == pytest.approx(1 - 0.04)
    assert far[0] == pytest.approx(1 - 0.36)
    assert (far > 0).sum() < 13


def test_gap_between_two_posts_is_entered_in_its_middle(readings):
    sensing = readings(s2=4.0, s9=4.0)
    histogram = polar_histogram(sensing.ranges, clearance=1.0, half_width=0.0)
    bearing = vector_field_histogram(
        histogram, np.array([0.3]), threshold=0.5, wide=16, keep=0.0
    )
    assert bearing[0] == pytest.approx(0.0)
