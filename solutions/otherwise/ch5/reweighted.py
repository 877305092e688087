"""5.5 sample by sample."""

import math


def reweighted(log_p, log_q, features, most):
    ratios = [p - q for p, q in zip(log_p.tolist(), log_q.tolist())]
    middle = max(ratios) + math.log(
        math.fsum(math.exp(r - max(ratios)) for r in ratios) / len(ratios)
    )
    kept = [min(math.exp(r - middle), most) for r in ratios]
    total = sum(kept)
    estimate = [
        sum(w * x for w, x in zip(kept, column)) / total
        for column in features.T.tolist()
    ]
    return estimate, total**2 / sum(w * w for w in kept)
