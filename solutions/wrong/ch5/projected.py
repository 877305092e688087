"""Known mistakes in 5.3; a function's docstring is its hint."""

import numpy as np


def _moved(
    mixture,
    found,
    expert,
    scale,
    *,
    clip=True,
    scaled=True,
    units=True,
    share_of_new=True,
):
    divide = scale if scaled else np.ones_like(scale)
    along, to_expert = (found - mixture) / divide, (expert - mixture) / divide
    length = along @ along
    share = 0.0 if length == 0 else along @ to_expert / length
    share = np.clip(share, 0.0, 1.0) if clip else share
    point = mixture + share * (found - mixture)
    return (point if units else point / scale), (share if share_of_new else 1 - share)


def off_the_segment(mixture, found, expert, scale):
    """The mixture lies on the segment between the two points: clip the share to the range from 0 to 1."""
    return _moved(mixture, found, expert, scale, clip=False)


def own_units(mixture, found, expert, scale):
    """Divide every feature by its scale before taking distances."""
    return _moved(mixture, found, expert, scale, scaled=False)


def scaled_answer(mixture, found, expert, scale):
    """Return the new mixture in the features' own units: use the scale for distances only."""
    return _moved(mixture, found, expert, scale, units=False)


def share_of_the_old(mixture, found, expert, scale):
    """Return the share of the new policy, not that of the old mixture."""
    return _moved(mixture, found, expert, scale, share_of_new=False)


def multiplied(mixture, found, expert, scale):
    """Divide the features by their scale; do not multiply them."""
    return _moved(mixture, found, expert, 1 / scale)


def nothing_by_nothing(mixture, found, expert, scale):
    """If the new policy equals the mixture, the division is 0 by 0. Return a share of 0."""
    with np.errstate(all="ignore"):
        along, to_expert = (found - mixture) / scale, (expert - mixture) / scale
        share = np.clip(along @ to_expert / (along @ along), 0.0, 1.0)
    return mixture + share * (found - mixture), share
