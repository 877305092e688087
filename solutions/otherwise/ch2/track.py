"""2.4 by following every state to every state."""


def track(belief, transitions, observations, actions, readings):
    belief = belief.tolist()
    states = range(len(belief))
    for action, reading in zip(actions, readings):
        moved = [
            sum(belief[s] * transitions[action, s, t] for s in states) for t in states
        ]
        likely = [
            1.0 if reading == -1 else observations[action, t, reading] for t in states
        ]
        evidence = sum(m * z for m, z in zip(moved, likely))
        belief = (
            [m * z / evidence for m, z in zip(moved, likely)] if evidence else moved
        )
    return belief
