"""5.1 backward through each trajectory."""


def expectations(trajectories, discount):
    k = trajectories[0].shape[1]
    mean = [0.0] * k
    for features in trajectories:
        total, weight = [0.0] * k, 0.0
        for row in reversed(features.tolist()):
            total = [x + discount * t for x, t in zip(row, total)]
            weight = 1 + discount * weight
        mean = [m + t / weight / len(trajectories) for m, t in zip(mean, total)]
    return mean
