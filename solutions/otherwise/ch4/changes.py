"""4.6 weight by weight."""


def changes(weights):
    rows = []
    for before, after in zip(weights[:-1].tolist(), weights[1:].tolist()):
        moved = [b - a for a, b in zip(before, after)]
        sizes = [abs(m) for m in moved]
        rows.append([sum(moved), sum(sizes), max(sizes)])
    return rows
