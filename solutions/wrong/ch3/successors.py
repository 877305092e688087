"""Known mistakes in 3.4; a function's docstring is its hint."""

import numpy as np


def _expanded(pose, speed, turn_cost, centres, radii, size, margin, *, signs=1, first=True, whole=True, border=True,
              signed=False, keep=True, wrap=True, line=False, strict=False, thick=True, pays=1.0, edge=True,
              goes=1.0):  # fmt: skip
    rows, start = [], pose[:2]
    for action, degrees in enumerate((0, 30, 60, -30, -60)):
        turn = signs * np.radians(degrees)
        heading = pose[2] + turn
        going = heading if first else pose[2]
        way = speed * np.array([np.cos(going), np.sin(going)])
        end = start + way
        along = (
            np.clip(
                (centres - start) @ way / speed**2, *((-1e9, 1e9) if line else (0, 1))
            )
            if whole
            else np.ones(len(centres))
        )
        gaps = np.hypot(*(centres - start - along[:, None] * way).T) - thick * radii
        room = margin if keep and edge else 0.0
        inside = min(*start, *end) >= room and max(*start, *end) <= size - room
        room = margin if keep else 0.0
        if strict:
            room += 1e-9
        if np.all(gaps >= room) and (inside or not border):
            heading = (heading + np.pi) % (2 * np.pi) - np.pi if wrap else heading
            rows.append(
                [
                    action,
                    *end,
                    heading,
                    goes * speed + pays * turn_cost * (turn if signed else abs(turn)),
                ]
            )
    return np.array(rows).reshape(-1, 5)


def goes_first(*arguments):
    """The robot first turns, then goes in the new direction."""
    return _expanded(*arguments, first=False)


def right_is_left(*arguments):
    """Left is counter-clockwise: a left turn adds to the heading."""
    return _expanded(*arguments, signs=-1)


def only_the_end(*arguments):
    """A step can lead across an obstacle: compute the least distance along the whole step, not at its end."""
    return _expanded(*arguments, whole=False)


def no_borders(*arguments):
    """The step must keep the margin to the borders of the map as well."""
    return _expanded(*arguments, border=False)


def touches_borders(*arguments):
    """The margin applies to the borders, too: it is not sufficient that the step stays in the map."""
    return _expanded(*arguments, edge=False)


def no_margin(*arguments):
    """It is not sufficient that the step touches no obstacle: it must keep the margin."""
    return _expanded(*arguments, keep=False)


def left_pays_right(*arguments):
    """A turn to the right costs as much as one to the left."""
    return _expanded(*arguments, signed=True)


def heading_runs_away(*arguments):
    """Bring the heading back into the interval from -pi to pi."""
    return _expanded(*arguments, wrap=False)


def along_the_line(*arguments):
    """A step ends after one second: measure the distance to the segment, not to the whole line."""
    return _expanded(*arguments, line=True)


def exactly_is_too_near(*arguments):
    """A step that keeps exactly the margin is possible."""
    return _expanded(*arguments, strict=True)


def thin_obstacles(*arguments):
    """Distances count from the edge of an obstacle: subtract its radius."""
    return _expanded(*arguments, thick=False)


def pays_nothing(*arguments):
    """The cost is the length of the step and, in addition, the cost of the turn."""
    return _expanded(*arguments, pays=0.0)


def pays_for_the_turn_alone(*arguments):
    """The cost of an action is the length of its step and the cost of its turn, added up."""
    return _expanded(*arguments, goes=0.0)


def pays_by_degrees(*arguments):
    """The cost of a turn is given for one radian, not for one degree."""
    return _expanded(*arguments, pays=float(np.degrees(1.0)))


def heading_from_zero(*arguments):
    """The heading lies between -pi and pi, not between 0 and 2 pi."""
    rows = _expanded(*arguments)
    rows[:, 3] %= 2 * np.pi
    return rows
