"""5.3 by halving: where along the segment does the distance stop falling?"""

import numpy as np


def projected(mixture, found, expert, scale):
    def away(share):  # the slope of the squared distance
        return float(
            ((found - mixture) / scale)
            @ ((mixture + share * (found - mixture) - expert) / scale)
        )

    if np.array_equal(mixture, found) or away(0.0) >= 0:
        share = 0.0
    elif away(1.0) <= 0:
        share = 1.0
    else:
        low, high = 0.0, 1.0
        for _ in range(60):
            middle = (low + high) / 2
            low, high = (middle, high) if away(middle) < 0 else (low, middle)
        share = low
    return mixture + share * (found - mixture), share
