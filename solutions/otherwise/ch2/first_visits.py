"""2.6 by searching each episode for each state."""


def first_visits(states, rewards, discount, size):
    values, counts = [], []
    for state in range(size):
        returns = []
        for visited, earned in zip(states, rewards):
            if state in visited:
                first = visited.index(state)
                returns.append(
                    sum(discount**k * r for k, r in enumerate(earned[first:]))
                )
        values.append(sum(returns) / len(returns) if returns else 0)
        counts.append(len(returns))
    return values, counts
