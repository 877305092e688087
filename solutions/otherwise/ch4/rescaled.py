"""4.3 with the whole step written on the network's scale."""


def rescaled(
    outputs, actions, rewards, next_outputs, ended, bounds, discount, learning_rate
):
    low, high = bounds
    width = (high - low) / (1 - discount)
    zero = -low / (high - low)  # where a Q-value of 0 lies on the network's scale
    targets = outputs.tolist()
    for row, action, reward, after, last in zip(
        targets, actions, rewards, next_outputs, ended
    ):
        following = zero if last else max(after)
        moved = row[action] + learning_rate * (
            zero + reward / width + discount * (following - zero) - row[action]
        )
        row[action] = min(max(moved, 0.0), 1.0)
    return targets
