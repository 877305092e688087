"""6.2 bin by bin."""


def direction(histogram, blocked, low, high, target, last, weights):
    n, now, costs = len(histogram), [], []
    for b in range(n):
        if histogram[b] >= high:
            now.append(True)
        elif histogram[b] <= low:
            now.append(False)
        else:
            now.append(bool(blocked[b]))
        costs.append(
            sum(
                weight * min((b - to) % n, (to - b) % n)
                for weight, to in zip(weights, (target, 0, last))
            )
        )
    free = [b for b in range(n) if not now[b]]
    return now, costs, min(free, key=lambda b: costs[b]) if free else -1
