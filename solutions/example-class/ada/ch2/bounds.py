def bounds(previous, values, discount):
    change = values - previous
    factor = discount / (1 - discount)
    return values + factor * change.min(), values + factor * change.max()
