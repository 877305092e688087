"""3.2 reading by reading."""

import math


def encode(ranges, bearing, distance, reach):
    states = []
    for row, angle, far in zip(ranges, bearing, distance):
        state = []
        for r in row:
            degree = 0
            for border in (30, 25, 20, 15, 11, 7, 3):
                if r < border * (reach / 30):
                    degree += 1
            state.append(degree)
        degrees = (math.degrees(angle) + 20) % 360
        states.append([*state, int(degrees // 40) + 1, int(far <= reach)])
    return states
