"""Known mistakes in 5.3; a function's docstring is its hint."""

import numpy as np


def _moved(mixture, found, expert, scale, *, clip=True, scaled=True, units=True, share_of_new=True):
    divide = scale if scaled else np.ones_like(scale)
    along, to_expert = (found - mixture) / divide, (expert - mixture) / divide
    length = along @ along
    share = 0.0 if length == 0 else along @ to_expert / length
    share = np.clip(share, 0.0, 1.0) if clip else share
    point = mixture + share * (found - mixture)
    return (point if units else point / scale), (share if share_of_new else 1 - share)


def off_the_segment(mixture, found, expert, scale):
    """A mixture lies between the two: the share stays within 0 and 1."""
    return _moved(mixture, found, expert, scale, clip=False)


def own_units(mixture, found, expert, scale):
    """Divide every feature by its scale before taking distances."""
    return _moved(mixture, found, expert, scale, scaled=False)


def scaled_answer(mixture, found, expert, scale):
    """The new mixture is asked for in the features' own units; the scale is for distances alone."""
    return _moved(mixture, found, expert, scale, units=False)


def share_of_the_old(mixture, found, expert, scale):
    """The share asked for is the new policy's, not what is left of the old mixture."""
    return _moved(mixture, found, expert, scale, share_of_new=False)


def multiplied(mixture, found, expert, scale):
    """Features are divided by their scale, not multiplied."""
    return _moved(mixture, found, expert, 1 / scale)


def nothing_by_nothing(mixture, found, expert, scale):
    """Where the new policy is the mixture itself, nothing divided by nothing is no number: the share is 0."""
    with np.errstate(all="ignore"):
        along, to_expert = (found - mixture) / scale, (expert - mixture) / scale
        share = np.clip(along @ to_expert / (along @ along), 0.0, 1.0)
    return mixture + share * (found - mixture), share
