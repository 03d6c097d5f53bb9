"""The mesh of gallery/hertz with cells of degree 1, and what Hertz' contact is compared with."""

import numpy as np

E, NU, R, SIZE, DOWN = 1000.0, 0.3, 100.0, 20.0, 0.085
#: Force on the whole cylinder and largest pressure: converged, 384 nodes per millimetre.
FORCE, PRESSURE = 52.1321, 13.5754


def graded(small, inner, total, growth=1.2, count=16):
    """Nodes from 0 to total: of equal distance up to `inner`, then growing."""
    sizes = growth ** np.arange(count)
    outer = inner + (total - inner) * np.cumsum(sizes) / sizes.sum()
    return np.concatenate([np.linspace(0, inner, round(inner / small) + 1), outer])


def block(small=0.25):
    """Points, quadrilaterals, and the numbers of the points at the bottom, at the top and on the left."""
    x, t = graded(small, 3.75, SIZE), graded(small, 1.25, SIZE) / SIZE
    X, T = np.meshgrid(x, t)
    bottom = R - np.sqrt(R**2 - X**2)
    points = np.column_stack([X.ravel(), (bottom + (SIZE - bottom) * T).ravel()])
    n = np.arange(X.size).reshape(X.shape)
    cells = np.column_stack([n[:-1, :-1].ravel(), n[:-1, 1:].ravel(), n[1:, 1:].ravel(), n[1:, :-1].ravel()])
    return points, cells, n[0], n[-1], n[:, 0]


def tell(name, force, pressure):
    """Differences from the converged computation, in per cent."""
    print(f"{name}: force {100 * (force / FORCE - 1):+.3f} %, largest pressure {100 * (pressure / PRESSURE - 1):+.3f} %")
