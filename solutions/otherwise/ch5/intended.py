"""5.2 one recorded step after another, each posterior scaled so that its largest part is one."""


def intended(states, done, slip, prior, size):
    posterior = [None] * size
    for state, action in zip(states.tolist(), done.tolist()):
        old = posterior[state] or prior.tolist()
        new = [p * row[action] for p, row in zip(old, slip.tolist())]
        posterior[state] = [p / max(new) for p in new]
    return [-1 if p is None else p.index(max(p)) for p in posterior]
