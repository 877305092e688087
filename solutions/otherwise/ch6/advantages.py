"""6.4 forwards: each error is added to all earlier steps of its episode, as far as it reaches."""


def advantages(
    rewards, values, next_values, seconds, terminated, truncated, discount, decay
):
    steps, robots = rewards.shape
    found = [[0.0] * robots for _ in range(steps)]
    for robot in range(robots):
        begun = 0
        for t in range(steps):
            after = 0.0 if terminated[t, robot] else next_values[t, robot]
            worth = discount ** seconds[t, robot] * after
            error = rewards[t, robot] + worth - values[t, robot]
            reach = 1.0
            for earlier in range(t, begun - 1, -1):
                found[earlier][robot] += reach * error
                if earlier > begun:
                    reach *= decay * discount ** seconds[earlier - 1, robot]
            if terminated[t, robot] or truncated[t, robot]:
                begun = t + 1
    return found
