"""2.2 state by state."""


def improve(q, policy, tolerance):
    improved = []
    for row, kept in zip(q.tolist(), policy.tolist()):
        best = row.index(max(row))
        improved.append(best if row[best] - row[kept] > tolerance else kept)
    return improved
