"""5.2 step by step, with the posterior scaled after each, and actions that are ruled out remembered."""


def intended(states, done, slip, prior, size):
    posterior, possible = [None] * size, [None] * size
    for state, action in zip(states.tolist(), done.tolist()):
        if posterior[state] is None:
            posterior[state] = prior.tolist()
            possible[state] = [p > 0 for p in prior.tolist()]
        column = slip[:, action].tolist()
        possible[state] = [yes and p > 0 for yes, p in zip(possible[state], column)]
        updated = [
            max(old * p, 1e-250) if yes else 0.0
            for old, p, yes in zip(posterior[state], column, possible[state])
        ]
        largest = max(updated)
        posterior[state] = [p / largest for p in updated]
    return [
        -1 if values is None else max(range(len(values)), key=values.__getitem__)
        for values in posterior
    ]
