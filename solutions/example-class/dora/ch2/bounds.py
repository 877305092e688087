def bounds(previous, values, discount):
    change = values - previous
    return values + discount / (1 - discount) * change.min()
