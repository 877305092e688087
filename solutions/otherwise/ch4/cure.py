"""4.8 step by step: while a round earns something, lower the reward that most such rounds share."""

ROUNDS = [
    [(0, 0)],
    [(1, 1)],
    [(2, 2)],
    [(0, 1), (1, 0)],
    [(0, 2), (2, 0)],
    [(1, 2), (2, 1)],
    [(0, 1), (1, 2), (2, 0)],
    [(0, 2), (2, 1), (1, 0)],
]


def cure(rewards):
    table = {(p, q): rewards[p, q] for p in range(3) for q in range(3)}
    while True:
        gains = [sum(table[step] for step in steps) for steps in ROUNDS]
        bad = [n for n, gain in enumerate(gains) if gain > 1e-9]
        if not bad:
            break
        shared = {
            step: sum(step in ROUNDS[n] for n in bad) + 0.01 * table[step]
            for n in bad
            for step in ROUNDS[n]
        }
        step = max(shared, key=shared.get)
        table[step] -= max(gains[n] for n in bad if step in ROUNDS[n])
    return [[table.get((p, q), rewards[p, q]) for q in range(5)] for p in range(3)]
