"""Small widgets for one idea each, in the flow of a chapter; one JavaScript file each, of the same name."""

from . import (
    chapter2,
    chapter3,
    chapter4,
    chapter5,
    chapter6,
    mdp_trainings,
    nirl_trainings,
    nnql_trainings,
    robot,
    robot_trainings,
)
from .registry import EXPLORABLES, explorable

__all__ = [
    "EXPLORABLES",
    "chapter2",
    "chapter3",
    "chapter4",
    "chapter5",
    "chapter6",
    "explorable",
    "mdp_trainings",
    "nirl_trainings",
    "nnql_trainings",
    "robot",
    "robot_trainings",
]
