"""2.5 step by step, with the exploring policy's probabilities written out."""


def targets(q, rewards, next_states, next_actions, terminated, discount, epsilon):
    rows = [[], [], []]
    for reward, state, action, last in zip(
        rewards, next_states, next_actions, terminated
    ):
        values = q[state].tolist()
        best = [a for a, w in enumerate(values) if w == max(values)]
        policy = [
            epsilon / len(values) + (1 - epsilon) / len(best) * (a in best)
            for a in range(len(values))
        ]
        following = (
            max(values),
            values[action],
            sum(p * w for p, w in zip(policy, values)),
        )
        for row, value in zip(rows, following):
            row.append(reward + (0 if last else discount * value))
    return rows
