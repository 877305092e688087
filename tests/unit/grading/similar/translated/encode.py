"""Answers to exercise 3.2 that were copied from others, with loops for arrays or arrays for loops."""

import math

import numpy as np


def encode_2(R, b, d, m):
    table = np.array([30, 25, 20, 15, 11, 7, 3]) * m / 30
    levels = (R[:, :, None] < table).sum(axis=2)
    deg = np.degrees(b) % 360
    part = ((deg + 20) // 40).astype(int) + 1
    part = np.where(part == 10, 1, part)
    return np.column_stack([levels, part, np.where(d <= m, 1, 0)])


def encode_4(R, b, d, m):
    w = 2 * math.pi / 9
    out = []
    for row, angle, far in zip(R, b, d):
        line = [0] * 11
        for k in range(9):
            for edge in (3, 7, 11, 15, 20, 25, 30):
                line[k] += int(row[k] < edge * m / 30)
        line[9] = math.floor((angle + w / 2) / w) % 9 + 1
        if far <= m:
            line[10] = 1
        out.append(line)
    return out


def encode_6(R, b, d, m):
    u = m / 30
    answer = []
    for i in range(len(R)):
        line = []
        for x in R[i]:
            level = 0
            for k, value in zip((3, 7, 11, 15, 20, 25, 30), (7, 6, 5, 4, 3, 2, 1)):
                if x < k * u:
                    level = value
                    break
            line.append(level)
        t = b[i] / (2 * math.pi) * 9
        z = math.floor(t + 0.5)
        z = z - 9 * (z // 9) + 1
        answer.append([*line, z, 0 if d[i] > m else 1])
    return answer


def encode_7(R, b, d, m):
    t = m * np.array([0.1, 7 / 30, 11 / 30, 0.5, 2 / 3, 5 / 6, 1.0])
    first = np.count_nonzero(R[:, :, None] < t, axis=2)
    deg = np.degrees(b)
    return np.column_stack([first, np.floor((deg + 20) / 40) % 9 + 1, d <= m]).astype(
        int
    )


def encode_9(R, b, d, m):
    f = m / 30.0
    levels = sum((k * f > R).astype(int) for k in (3, 7, 11, 15, 20, 25, 30))
    place = np.floor(b * 9 / (2 * np.pi) + 0.5).astype(int) % 9
    return np.column_stack([levels, place + 1, (d <= m).astype(int)])


def encode_12(R, b, d, m):
    out = []
    edges = [math.radians(x) for x in (20, 60, 100, 140, 180, 220, 260, 300, 340)]
    for i in range(len(b)):
        line = []
        for x in R[i]:
            level = 7
            for e in (3, 7, 11, 15, 20, 25, 30):
                level -= int(x >= e * m / 30)
            line.append(level)
        a = b[i] % (2 * math.pi)
        k = sum(e <= a for e in edges)
        line.append((0 if k == 9 else k) + 1)
        line.append(int(d[i] <= m))
        out.append(line)
    return out
