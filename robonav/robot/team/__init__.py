"""Chapter 6, several robots: N maps that R robots cross at once, each sensing the others as moving obstacles.

``TeamEnv`` is the same as a PettingZoo environment. It needs the extra ``team``, and loads when it is first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

from ._fast import ROBOT_RADIUS
from .rollout import TeamNavigation, navigate_team, team_selector
from .simulator import TeamSimulator
from .teams import Teams, crossing, draw_teams, random_teams

if TYPE_CHECKING:
    from .environment import TeamEnv, parallel_env

__all__ = [
    "ROBOT_RADIUS",
    "TeamEnv",
    "TeamNavigation",
    "TeamSimulator",
    "Teams",
    "crossing",
    "draw_teams",
    "navigate_team",
    "parallel_env",
    "random_teams",
    "team_selector",
]


def __getattr__(name: str) -> Any:
    if name in ("TeamEnv", "parallel_env"):
        return getattr(importlib.import_module(f"{__name__}.environment"), name)
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
