"""5.3 by halving: where along the segment does the distance stop falling?"""

import numpy as np


def projected(weights, found, expert, scale):
    mixture = (weights[:, None] * found[:-1]).sum(axis=0)
    new = found[-1]

    def away(share):  # the slope of the squared distance
        return float(
            ((new - mixture) / scale)
            @ ((mixture + share * (new - mixture) - expert) / scale)
        )

    if np.allclose(mixture, new, atol=1e-14) or away(0.0) >= 0:
        share = 0.0
    elif away(1.0) <= 0:
        share = 1.0
    else:
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if away(middle) < 0 else (low, middle)
        share = low
    probabilities = [w - share * w for w in weights] + [share]
    rest = (np.array(probabilities) @ found - expert) / scale
    return probabilities, float(np.sqrt((rest**2).sum()))
