"""Chapter 6, several robots: N maps that R robots cross at once, each sensing the others as moving obstacles.

``TeamEnv`` is the same as a PettingZoo environment, and needs the extra ``team``.
"""

from ._fast import ROBOT_RADIUS
from .rollout import TeamNavigation, navigate_team, team_selector
from .simulator import TeamSimulator
from .teams import Teams, crossing, draw_teams, random_teams

__all__ = [
    "ROBOT_RADIUS",
    "TeamNavigation",
    "TeamSimulator",
    "Teams",
    "crossing",
    "draw_teams",
    "navigate_team",
    "random_teams",
    "team_selector",
]
