"""2.1 from the definition, in plain loops."""


def backup(transitions, rewards, discount, values, terminal):
    actions, states, _ = transitions.shape
    q = [[0.0] * actions for _ in range(states)]
    for s in range(states):
        for a in range(actions):
            for t in range(states):
                if not terminal[s]:
                    value = 0.0 if terminal[t] else values[t]
                    q[s][a] += transitions[a, s, t] * (
                        rewards[a, s, t] + discount * value
                    )
    return q
