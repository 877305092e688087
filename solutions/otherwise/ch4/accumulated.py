"""4.4 in plain numbers."""


def accumulated(features, actions, rewards, ended, number, discount, gradient_step):
    rows = features.tolist()
    weights = [[0.0] * len(rows[0]) for _ in range(number)]
    memory = []

    def q(action, phi):
        return sum(w * x for w, x in zip(weights[action], phi))

    for t in range(len(actions)):
        following = max(q(a, rows[t + 1]) for a in range(number))
        if ended and t + 1 == len(actions):
            following = 0.0
        memory.append((rows[t], int(actions[t]), rewards[t] + discount * following))
        for phi, action, target in memory:
            error = target - q(action, phi)
            weights[action] = [
                w + gradient_step * error * x for w, x in zip(weights[action], phi)
            ]
    return weights
