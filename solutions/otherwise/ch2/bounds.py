"""2.3 by adding up the series, sweep after sweep."""


def bounds(previous, values, discount):
    changes = [new - old for new, old in zip(values.tolist(), previous.tolist())]
    least = sum(min(changes) * discount**k for k in range(1, 2000))
    most = sum(max(changes) * discount**k for k in range(1, 2000))
    return [v + least for v in values.tolist()], [v + most for v in values.tolist()]
