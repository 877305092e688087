"""5.6 by weighing each step with one over how often the expert took its action."""


def accuracies(shown, chosen, number):
    shown, chosen = shown.tolist(), chosen.tolist()
    plain = sum(a == b for a, b in zip(shown, chosen)) / len(shown)
    taken = {a: shown.count(a) for a in shown}
    return plain, sum((a == b) / taken[a] for a, b in zip(shown, chosen)) / len(taken)
