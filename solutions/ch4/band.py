"""A learning curve from one seed proves little. Compute the curve of the thesis's
Figure 4.6 from many seeds, with its band. Count each seed's successes in every block of
a given number of episodes. Then compute the mean over the seeds, and a 95 % interval of
this mean by the bootstrap. You are given which seeds to draw for each resample. Draw
*seeds*, not episodes, because the episodes of one seed depend on each other. The
interval ends at the 2.5th and the 97.5th percentile of the resamples' means, as
`numpy.percentile` computes them.
"""

import numpy as np
from numpy.typing import NDArray


def band(
    successes: NDArray[np.bool_],
    block: int,
    draws: NDArray[np.int64],
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Mean number of successes in each block, and its interval.

    Parameters
    ----------
    successes : (S, E), whether each episode of each seed succeeded.
    block : episodes to a block; what does not fill the last one is left out.
    draws : (R, S), for each resample the seeds that were drawn, 0 to S - 1.

    Returns
    -------
    (B,) means, and (2, B) lower and upper ends.
    """
    ### BEGIN SOLUTION
    blocks = successes.shape[1] // block
    counts = (
        successes[:, : blocks * block]
        .reshape(len(successes), blocks, block)
        .sum(axis=2)
    )
    resampled = counts[draws].mean(axis=1)
    return counts.mean(axis=0), np.percentile(resampled, [2.5, 97.5], axis=0)
    ### END SOLUTION
