"""The answers of the robot's drills, worked out another way from the numbers in their texts."""

from __future__ import annotations

import cmath
import math
import re

import numpy as np
import pytest
from numbers_in_texts import drawn, numbers

TURNS = {"F": 0, "L30": 30, "L60": 60, "R30": -30, "R60": -60, "B": 0}


def test_one_step_in_the_complex_plane() -> None:
    for question in drawn("one-step"):
        x, y, heading, speed = numbers(question.text)[:4]
        action = re.search(r"action (\w+)\?", question.text)[1]
        angle = math.radians(heading + TURNS[action])
        distance = -speed if action == "B" else speed
        end = complex(x, y) + cmath.rect(distance, angle)
        assert question.asked.answer[0] == pytest.approx([end.real, end.imag])


def test_sensor_reading_by_many_rays() -> None:
    for question in drawn("sensor-reading"):
        x, y, radius, cx, cy = numbers(question.text)
        angles = np.linspace(0, 2 * math.pi, 200_001)
        surface = np.hypot(
            cx + radius * np.cos(angles) - x, cy + radius * np.sin(angles) - y
        )
        assert question.asked.answer == pytest.approx(surface.min(), abs=1e-4)


def test_sector_by_rounding_the_bearing() -> None:
    for question in drawn("sector-of-point"):
        heading, direction = numbers(question.text)[:2]
        sector = round((direction - heading) / 40) % 9 + 1
        assert question.asked.right == str(sector)


def test_who_acts() -> None:
    for question in drawn("what-the-reflex-does"):
        speed, *ranges = numbers(question.text.partition(" They reach")[0])
        ahead = [ranges[k - 1] for k in (8, 9, 1, 2, 3)]
        if min(ranges) >= 10:
            expected = "turns the robot towards the target"
        elif max(ahead) < speed + 1:
            expected = "step back"
        else:
            expected = "policy chooses"
        assert expected in question.asked.right
