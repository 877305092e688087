def improve(q, policy, tolerance):
    return q.argmax(axis=1)
