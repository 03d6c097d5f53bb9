"""Writes foam.npy: a synthetic CT image of a foam, 24 x 24 x 24 voxels of 16 bits, z running slowest."""

import math
import random
import struct

N = 24
random.seed(3)
# Middles and sizes of pores; none at the lower and upper side, which are held.
pores = [([random.random(), random.random(), 0.15 + 0.7 * random.random()], 0.11 + 0.05 * random.random()) for _ in range(9)]


def value(z, y, x):
    material = 1000.0
    for (px, py, pz), size in pores:
        square = (x - px) ** 2 + (y - py) ** 2 + (z - pz) ** 2
        material -= 1400.0 * math.exp(-square / size**2)
    return max(0, round(material + random.gauss(0, 20)))


middles = [(k + 0.5) / N for k in range(N)]
numbers = [value(z, y, x) for z in middles for y in middles for x in middles]
header = f"{{'descr': '<u2', 'fortran_order': False, 'shape': ({N}, {N}, {N}), }}"
header += " " * (117 - len(header)) + "\n"
with open("foam.npy", "wb") as file:
    file.write(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header.encode())
    file.write(struct.pack(f"<{len(numbers)}H", *numbers))
