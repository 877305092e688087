"""4.1 robot by robot."""

import math


def explore(q, temperature, allowed):
    answer = []
    for row, t, may in zip(q.tolist(), temperature.tolist(), allowed.tolist()):
        best = max(value for value, yes in zip(row, may) if yes)
        if t == 0:
            shares = [float(yes and value == best) for value, yes in zip(row, may)]
        else:
            shares = [
                math.exp((value - best) / t) if yes else 0.0
                for value, yes in zip(row, may)
            ]
        answer.append([share / sum(shares) for share in shares])
    return answer
