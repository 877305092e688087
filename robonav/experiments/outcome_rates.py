"""How drives end, in per cent: what most experiments count."""

from __future__ import annotations

from robonav.robot import Navigation

ENDS = {"success": "arrived", "collision": "collided", "out of steps": "out of steps"}


def rates(drives: Navigation) -> dict[str, float]:
    """How many of the drives arrive, collide and run out of steps, in per cent."""
    return {
        name: 100 * float((drives.outcome == end).mean()) for name, end in ENDS.items()
    }
