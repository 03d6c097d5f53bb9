// Normals of surfaces.

/** Normals of points: means over the triangles, where wanted of all points that are hardly apart. */
function normals(at, triangles, joins) {
  const owners = new Uint32Array(at.length / 3).map((_, k) => k);
  if (joins) {
    const size = at.reduce((m, v) => Math.max(m, Math.abs(v)), 0) / 500 || 1;
    const first = new Map();
    for (let k = 0; k < owners.length; k++) {
      const key = [0, 1, 2].reduce((key, i) => key * 2048 + Math.round(at[3 * k + i] / size) + 1024, 0);
      if (!first.has(key)) first.set(key, k);
      owners[k] = first.get(key);
    }
  }
  let sums = new Float32Array(at.length);
  const add = (to, point, n) => {
    const own = 3 * owners[point];
    // Triangles may be seen from either side.
    const side = to[own] * n[0] + to[own + 1] * n[1] + to[own + 2] * n[2] < 0 ? -1 : 1;
    for (let i = 0; i < 3; i++) to[own + i] += side * n[i];
  };
  const p = (k, i) => at[3 * triangles[k] + i];
  for (let k = 0; k < triangles.length; k += 3) {
    const [u, v] = [1, 2].map((c) => [0, 1, 2].map((i) => p(k + c, i) - p(k, i)));
    for (let c = 0; c < 3; c++) add(sums, triangles[k + c], cross(u, v));
  }
  if (joins) {
    // Points of slivers take the normals of their neighbours.
    const wider = sums.slice();
    const normal = (point) => [0, 1, 2].map((i) => sums[3 * owners[point] + i]);
    for (let k = 0; k < triangles.length; k++) {
      for (const other of [k - (k % 3), k - (k % 3) + 1, k - (k % 3) + 2]) add(wider, triangles[k], normal(triangles[other]));
    }
    sums = wider;
  }
  return sums.map((_, k) => sums[3 * owners[Math.floor(k / 3)] + (k % 3)]);
}
