"""5.4 as a linear program: the simplex method on a tableau, by Bland's rule."""

import numpy as np


def margin(expert, found):
    payoff = (expert - found).T  # the row player chooses features
    size = max(abs(payoff).max(), 1e-300)
    game = payoff / size + 2.0  # all positive, so the value is
    k, n = game.shape
    # The column player's program: most sum(y) with game @ y <= 1, y >= 0; the row player's answer is in its prices.
    tableau = np.zeros((k + 1, n + k + 1))
    tableau[:k, :n], tableau[:k, n : n + k], tableau[:k, -1] = game, np.eye(k), 1.0
    tableau[k, :n] = -1.0
    basis = list(range(n, n + k))
    while (tableau[k, :-1] < -1e-12).any():
        enter = int(np.argmax(tableau[k, :-1] < -1e-12))
        ratios = [
            (tableau[i, -1] / tableau[i, enter], basis[i], i)
            for i in range(k)
            if tableau[i, enter] > 1e-12
        ]
        leave = min(ratios)[2]
        tableau[leave] /= tableau[leave, enter]
        for i in range(k + 1):
            if i != leave:
                tableau[i] -= tableau[i, enter] * tableau[leave]
        basis[leave] = enter
    prices = tableau[k, n : n + k]
    return prices / prices.sum()
