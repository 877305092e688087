"""robonav: robot learning for autonomous navigation, the package of the book.

Each chapter has its subpackage: ``mdp`` (chapter 2), ``robot`` (section 2.5), ``lfd`` (3, imitation learning),
``nnql`` (4, reinforcement learning), ``nirl`` (5, inverse reinforcement learning), ``planners`` (6, which learn
nothing), ``deep`` (6, deep reinforcement learning), ``memory`` (6, policies that remember), ``sensing`` (6, richer
sensors) and ``body`` (6, a body in MuJoCo). Chapters 3 to 6 use ``networks``. Importing this package only registers the
Gymnasium environments. Subpackages load when they are first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

import gymnasium

from ._version import __version__ as __version__

_SUBPACKAGES = (
    "benchmark",
    "body",
    "deep",
    "experiments",
    "grading",
    "lfd",
    "mdp",
    "memory",
    "networks",
    "nirl",
    "nnql",
    "planners",
    "plots",
    "robot",
    "sensing",
    "widgets",
)

if TYPE_CHECKING:
    from robonav import (  # noqa: F401
        body,
        deep,
        experiments,
        grading,
        lfd,
        mdp,
        memory,
        nirl,
        nnql,
        planners,
        plots,
        robot,
        sensing,
        widgets,
    )


def __getattr__(name: str) -> Any:
    if name in _SUBPACKAGES:
        return importlib.import_module(f"{__name__}.{name}")
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted([*globals(), *_SUBPACKAGES])


gymnasium.register(
    "robonav/Navigation-v0",
    entry_point="robonav.robot.environments:NavigationEnv",
    vector_entry_point="robonav.robot.vector_environment:NavigationVectorEnv",
    max_episode_steps=500,
)
