// A parallel view. In space it turns about the upright axis; a plane is seen from its side.

const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const unit = (a) => { const size = Math.hypot(...a) || 1; return a.map((v) => v / size); };

class Camera {
  constructor(plane) {
    this.plane = plane;
    this.middle = [0, 0, 0];
    this.height = 1;
    this.depth = 1;
    this.look([0, 0, 1]);
  }

  /** Looks from a direction. */
  look(from) {
    const [x, y, z] = unit(from);
    this.around = Math.atan2(y, x);
    this.above = Math.asin(Math.min(Math.max(z, -1), 1));
    this.turn(0, 0);
  }

  /** Turns by angles around the upright axis and above the ground. */
  turn(around, above) {
    if (this.plane === "space") {
      this.around += around;
      this.above = Math.min(Math.max(this.above + above, -Math.PI / 2), Math.PI / 2);
    }
    const [c, s] = [Math.cos(this.around), Math.sin(this.around)];
    this.towards = [Math.cos(this.above) * c, Math.cos(this.above) * s, Math.sin(this.above)];
    this.right = this.plane === "xy" ? [1, 0, 0] : [-s, c, 0];
    if (this.plane === "xy") this.towards = [0, 0, 1];
    this.up = cross(this.towards, this.right);
  }

  /** Moves what is in the middle, by parts of the height of the view. */
  move(right, up) {
    this.middle = this.middle.map((m, k) => m - this.height * (right * this.right[k] + up * this.up[k]));
  }

  zoom(factor) {
    this.height = Math.min(Math.max(this.height / factor, this.whole * 1e-3), this.whole * 20);
  }

  /** The ends of points along the directions of the view. */
  ends(points) {
    return [this.right, this.up, this.towards].map((axis) => {
      const places = points.map((x) => dot(axis, x));
      return [places.reduce((a, b) => Math.min(a, b), Infinity), places.reduce((a, b) => Math.max(a, b), -Infinity)];
    });
  }

  /**
   * Shows points, with room beside them, and others where that makes them smaller by at most a factor each. `aspect` is
   * width over height, `free` the part of the width that nothing covers.
   */
  fit(points, others, aspect, free) {
    const needed = (ends) => Math.max(ends[1][1] - ends[1][0], (ends[0][1] - ends[0][0]) / (aspect * free));
    const own = this.ends(points);
    const joined = (a, b) => a.map(([low, high], k) => [Math.min(low, b[k][0]), Math.max(high, b[k][1])]);
    let ends = own, all = own;
    for (const { points: list, most } of others.filter((o) => o.points.length > 0)) {
      const wider = joined(ends, this.ends(list));
      all = joined(all, wider);
      if (needed(wider) <= most * needed(own)) ends = wider;
    }
    this.height = 1.12 * needed(ends) || 1;
    this.whole = this.height;
    this.depth = 20 * (Math.hypot(...all.map(([a, b]) => b - a)) || 1);
    const middles = ends.map(([a, b]) => (a + b) / 2);
    this.middle = [0, 1, 2].map((i) => middles[0] * this.right[i] + middles[1] * this.up[i] + middles[2] * this.towards[i]);
    this.move((-(1 - free) / 2) * aspect, 0);
  }

  /** The matrix that puts points into the view, column by column. */
  matrix(aspect) {
    const rows = [[this.right, 2 / (this.height * aspect)], [this.up, 2 / this.height], [this.towards, -1 / this.depth]];
    const out = new Float32Array(16);
    rows.forEach(([axis, scale], row) => {
      for (let k = 0; k < 3; k++) out[4 * k + row] = axis[k] * scale;
      out[12 + row] = -dot(axis, this.middle) * scale;
    });
    out[15] = 1;
    return out;
  }
}
