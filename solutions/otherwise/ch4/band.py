"""4.7 resample by resample, the percentiles by sorting."""


def band(successes, block, draws):
    seeds = successes.tolist()
    blocks = len(seeds[0]) // block
    counts = [
        [sum(row[b * block : (b + 1) * block]) for b in range(blocks)] for row in seeds
    ]

    def means(rows):
        return [sum(row[b] for row in rows) / len(rows) for b in range(blocks)]

    def percentile(values, share):
        place = share * (len(values) - 1)
        below = int(place)
        above = min(below + 1, len(values) - 1)
        return values[below] + (place - below) * (values[above] - values[below])

    resampled = [means([counts[seed] for seed in drawn]) for drawn in draws.tolist()]
    columns = [sorted(row[b] for row in resampled) for b in range(blocks)]
    return means(counts), [
        [percentile(column, share) for column in columns] for share in (0.025, 0.975)
    ]
