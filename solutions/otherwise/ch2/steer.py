"""2.9 robot by robot: the best of five directions, by their room and by how well they lead to the target."""

TURNS = (0, 30, 60, -30, -60)


def steer(ranges, region, seen):
    answer = []
    for row, sector in zip(ranges.tolist(), region.tolist()):
        bearing = (sector - 1) * 40
        bearing = bearing - 360 if bearing > 180 else bearing
        scores = []
        for turn in TURNS:
            place = round(turn / 40) % 9
            room = min(row[place], row[(place + 1) % 9] + 1, row[(place - 1) % 9] + 1)
            off = abs(bearing - turn)
            scores.append(min(room, 6.0) * 40 - off - 0.1 * abs(turn))
        answer.append(scores.index(max(scores)))
    return answer
