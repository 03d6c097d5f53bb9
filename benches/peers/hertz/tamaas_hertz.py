"""A rigid sphere on an elastic half space with tamaas."""

import numpy as np
import tamaas as tm

n, size, radius, force = 128, 16.0, 100.0, 182.057
x = np.linspace(-size / 2, size / 2, n, endpoint=False)
x, y = np.meshgrid(x, x, indexing="ij")
model = tm.ModelFactory.createModel(tm.model_type.basic_2d, [size, size], [n, n])
model.E, model.nu = 1000.0, 0.3
solver = tm.PolonskyKeerRey(model, -(x**2 + y**2) / (2 * radius), 1e-10)
solver.solve(force / size**2)
pressure = np.array(model.traction).reshape(n, n)

modulus = model.E / (1 - model.nu**2)
a = (3 * force * radius / (4 * modulus)) ** (1 / 3)
exact = 3 * force / (2 * np.pi * a**2)
area = (pressure > 0).sum() * (size / n) ** 2
print(f"largest pressure {100 * (pressure.max() / exact - 1):+.3f} %, area {100 * (area / (np.pi * a**2) - 1):+.3f} %")
