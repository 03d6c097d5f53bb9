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
  // Triangles may be seen from either side.
  const add = (to, point, x, y, z) => {
    const own = 3 * owners[point];
    const side = to[own] * x + to[own + 1] * y + to[own + 2] * z < 0 ? -1 : 1;
    to[own] += side * x;
    to[own + 1] += side * y;
    to[own + 2] += side * z;
  };
  for (let k = 0; k < triangles.length; k += 3) {
    const [a, b, c] = [3 * triangles[k], 3 * triangles[k + 1], 3 * triangles[k + 2]];
    const ux = at[b] - at[a], uy = at[b + 1] - at[a + 1], uz = at[b + 2] - at[a + 2];
    const vx = at[c] - at[a], vy = at[c + 1] - at[a + 1], vz = at[c + 2] - at[a + 2];
    for (let i = k; i < k + 3; i++) add(sums, triangles[i], uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx);
  }
  if (joins) {
    // Points of slivers take the normals of their neighbours.
    const wider = sums.slice();
    for (let k = 0; k < triangles.length; k++) {
      for (let i = k - (k % 3), end = i + 3; i < end; i++) {
        const from = 3 * owners[triangles[i]];
        add(wider, triangles[k], sums[from], sums[from + 1], sums[from + 2]);
      }
    }
    sums = wider;
  }
  return sums.map((_, k) => sums[3 * owners[Math.floor(k / 3)] + (k % 3)]);
}
