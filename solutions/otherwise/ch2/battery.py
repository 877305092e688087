"""2.7 by recursion from the full charge, with a cache."""

from functools import cache


def battery(transitions, rewards, costs, charge):
    actions, states, _ = transitions.shape

    @cache
    def value(left, state):
        best = None
        for a in range(actions):
            if costs[a] <= left:
                following = sum(
                    transitions[a, state, t] * value(left - int(costs[a]), t)
                    for t in range(states)
                )
                q = rewards[state, a] + following
                best = q if best is None else max(best, q)
        return 0.0 if best is None else best

    return [
        [value(left, state) for state in range(states)] for left in range(charge + 1)
    ]
