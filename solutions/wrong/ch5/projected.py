"""Known mistakes in 5.3; a function's docstring is its hint."""

import numpy as np


def _moved(
    weights,
    found,
    expert,
    scale,
    *,
    clip=True,
    scaled=True,
    shrinks=True,
    mixture=None,
    once=False,
    far=None,
):
    mixture = weights @ found[:-1] if mixture is None else mixture
    divide = scale if scaled else np.ones_like(scale)
    along, to_expert = (found[-1] - mixture) / divide, (expert - mixture) / divide
    by = np.sqrt(scale) if once else np.ones_like(scale)
    length = (along * by) @ (along * by)
    share = 0.0 if length == 0 else (along * by) @ (to_expert * by) / length
    share = float(np.clip(share, 0.0, 1.0)) if clip else float(share)
    new = np.append((1 - share if shrinks else 1.0) * weights, share)
    rest = (expert - mixture - share * (found[-1] - mixture)) / scale
    return new, float(np.linalg.norm(rest)) if far is None else far(rest)


def off_the_segment(weights, found, expert, scale):
    """A probability lies between 0 and 1: the mixture stays on the segment between the two points."""
    return _moved(weights, found, expert, scale, clip=False)


def own_units(weights, found, expert, scale):
    """Divide every feature by its scale before you measure a distance."""
    return _moved(weights, found, expert, scale, scaled=False)


def multiplied(weights, found, expert, scale):
    """Divide the features by their scale; do not multiply them."""
    new, _ = _moved(weights, found, expert, 1 / scale)
    rest = (expert - new @ found) * scale
    return new, float(np.linalg.norm(rest))


def scaled_once(weights, found, expert, scale):
    """A squared distance has the square of the scale: divide both vectors by it before you multiply them."""
    return _moved(weights, found, expert, scale, once=True)


def sum_to_more(weights, found, expert, scale):
    """The probabilities sum to one: the old ones shrink when the new policy gets its share."""
    return _moved(weights, found, expert, scale, shrinks=False)


def share_of_the_old(weights, found, expert, scale):
    """The share along the segment is the new policy's probability, not that of the old mixture."""
    new, left = _moved(weights, found, expert, scale)
    share = new[-1]
    return np.append(share * weights, 1 - share), left


def all_alike(weights, found, expert, scale):
    """The policies are not equally probable: the new one gets its share, and the old ones keep their proportions."""
    new = np.full(len(found), 1 / len(found))
    return new, float(np.linalg.norm((expert - new @ found) / scale))


def from_the_latest_policy(weights, found, expert, scale):
    """The segment begins at the mixture of all policies so far, not at the latest of them."""
    return _moved(weights, found, expert, scale, mixture=found[-2])


def from_the_plain_mean(weights, found, expert, scale):
    """The feature expectations of the mixture are the mean of the policies' weighted with their probabilities."""
    return _moved(weights, found, expert, scale, mixture=found[:-1].mean(axis=0))


def nothing_by_nothing(weights, found, expert, scale):
    """If the new policy equals the mixture, the division is 0 by 0. The new policy then has the probability 0."""
    mixture = weights @ found[:-1]
    with np.errstate(all="ignore"):
        along, to_expert = (found[-1] - mixture) / scale, (expert - mixture) / scale
        share = np.clip(along @ to_expert / (along @ along), 0.0, 1.0)
    left = np.linalg.norm(to_expert - share * along)
    return np.append((1 - share) * weights, share), float(left)


def distance_in_own_units(weights, found, expert, scale):
    """The remaining distance is measured in scaled features, too."""
    return _moved(
        weights, found, expert, scale, far=lambda rest: np.linalg.norm(rest * scale)
    )


def squared_distance(weights, found, expert, scale):
    """Return the distance, not its square."""
    return _moved(weights, found, expert, scale, far=lambda rest: rest @ rest)


def distance_of_the_old(weights, found, expert, scale):
    """Return the distance of the new mixture, not that of the mixture before."""
    new, _ = _moved(weights, found, expert, scale)
    rest = (expert - weights @ found[:-1]) / scale
    return new, float(np.linalg.norm(rest))


def _measured(new, found, expert, scale):
    """These probabilities, with the distance of their mixture from the expert."""
    return new, float(np.linalg.norm((expert - new @ found) / scale))


def sum_to_more_and_measured(weights, found, expert, scale):
    """The probabilities sum to one: the old ones shrink when the new policy gets its share."""
    new, _ = _moved(weights, found, expert, scale, shrinks=False)
    return _measured(new, found, expert, scale)


def share_of_the_old_and_measured(weights, found, expert, scale):
    """The share along the segment is the new policy's probability, not that of the old mixture."""
    new, _ = share_of_the_old(weights, found, expert, scale)
    return _measured(new, found, expert, scale)


def own_units_throughout(weights, found, expert, scale):
    """Divide every feature by its scale before you measure a distance."""
    new, _ = _moved(weights, found, expert, scale, scaled=False)
    return new, float(np.linalg.norm(expert - new @ found))
