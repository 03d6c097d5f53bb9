// The face of a cut through tetrahedra, with values between those of the corners.

/** Points, values and triangles where a plane (dot(normal, x) = distance) passes through tetrahedra. */
function cutThrough(at, values, tetrahedra, normal, distance) {
  const points = [], found = [], triangles = [];
  const heights = new Float32Array(at.length / 3);
  for (let k = 0; k < heights.length; k++) {
    heights[k] = normal[0] * at[3 * k] + normal[1] * at[3 * k + 1] + normal[2] * at[3 * k + 2] - distance;
  }
  const between = (a, b) => {
    const part = heights[a] / (heights[a] - heights[b]);
    for (let i = 0; i < 3; i++) points.push(at[3 * a + i] + (at[3 * b + i] - at[3 * a + i]) * part);
    found.push(values[a] + (values[b] - values[a]) * part);
    return found.length - 1;
  };
  for (let k = 0; k < tetrahedra.length; k += 4) {
    const corners = [tetrahedra[k], tetrahedra[k + 1], tetrahedra[k + 2], tetrahedra[k + 3]];
    const above = corners.filter((c) => heights[c] > 0), below = corners.filter((c) => heights[c] <= 0);
    if (above.length === 0 || below.length === 0) continue;
    if (above.length === 2) {
      const [a, b] = above, [c, d] = below;
      const [p, q, r, s] = [between(a, c), between(a, d), between(b, d), between(b, c)];
      triangles.push(p, q, r, p, r, s);
    } else {
      const [single, others] = above.length === 1 ? [above[0], below] : [below[0], above];
      triangles.push(...others.map((other) => between(single, other)));
    }
  }
  const normals = new Float32Array(points.length);
  for (let k = 0; k < points.length; k++) normals[k] = normal[k % 3];
  return { at: new Float32Array(points), normals, values: new Float32Array(found), triangles: new Uint32Array(triangles) };
}
