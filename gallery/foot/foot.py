"""Writes foot.stl: a rounded block, a superellipsoid of triangles, closed."""

import math
import struct

LENGTH, WIDTH, HEIGHT = 10.0, 6.0, 4.0
LONG, ACROSS = 28, 14


def power(c, e):
    return math.copysign(abs(c) ** e, c)


def point(i, j):
    a, b = 2 * math.pi * i / LONG, math.pi * (j / ACROSS - 0.5)
    return (
        LENGTH * power(math.cos(b), 0.5) * power(math.cos(a), 0.5),
        WIDTH * power(math.cos(b), 0.5) * power(math.sin(a), 0.5),
        HEIGHT + HEIGHT * power(math.sin(b), 0.5),
    )


bottom, top = (0.0, 0.0, 0.0), (0.0, 0.0, 2 * HEIGHT)
triangles = []
for i in range(LONG):
    k = (i + 1) % LONG
    triangles.append((bottom, point(k, 1), point(i, 1)))
    triangles.append((top, point(i, ACROSS - 1), point(k, ACROSS - 1)))
    for j in range(1, ACROSS - 1):
        a, b, c, d = point(i, j), point(k, j), point(k, j + 1), point(i, j + 1)
        triangles += [(a, b, c), (a, c, d)]
with open("foot.stl", "wb") as file:
    file.write(b"A foot".ljust(80) + struct.pack("<I", len(triangles)))
    for t in triangles:
        file.write(struct.pack("<12fH", 0, 0, 0, *t[0], *t[1], *t[2], 0))
