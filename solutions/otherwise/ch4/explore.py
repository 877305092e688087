"""4.1 robot by robot, with Newton's steps on 1 / T kept between two bounds."""

import math


def explore(q, share, allowed):
    answer = []
    for row, wanted, may in zip(q.tolist(), share.tolist(), allowed.tolist()):
        best = max(value for value, yes in zip(row, may) if yes)
        gaps = [best - value if yes else math.inf for value, yes in zip(row, may)]
        finite = [gap for gap in gaps if 0 < gap < math.inf]
        n_best = gaps.count(0)

        def weights(beta, gaps=gaps):
            return [math.exp(-beta * gap) if gap < math.inf else 0.0 for gap in gaps]

        if wanted >= 1:
            shares = [float(gap == 0) for gap in gaps]
        elif not finite or n_best / sum(may) >= wanted:
            shares = [float(yes) for yes in may]
        else:
            low, high = 0.0, 1.0 / min(finite)
            while n_best / sum(weights(high)) < wanted:
                high *= 2
            for _ in range(100):
                middle = (low + high) / 2
                if n_best / sum(weights(middle)) < wanted:
                    low = middle
                else:
                    high = middle
            shares = weights(high)
        answer.append([value / sum(shares) for value in shares])
    return answer
