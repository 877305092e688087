"""5.6 by comparing every step of the expert's with every step of the policy's."""


def accuracies(shown, chosen, number):
    shown, chosen = shown.tolist(), chosen.tolist()
    agreed = sum(a == b for a, b in zip(shown, chosen)) / len(shown)
    strangers = sum(a == b for a in shown for b in chosen) / len(shown) ** 2
    return agreed, 0 if strangers == 1 else 1 - (1 - agreed) / (1 - strangers)
