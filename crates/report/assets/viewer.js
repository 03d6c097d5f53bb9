// The view: bodies at a time, colours of a field, a cut.

/** Stands for values that are no numbers, in the memory of the graphics too. */
const NOTHING = -1e30;

class Viewer extends Controls {
  constructor(scene) {
    super();
    this.scene = scene;
    this.canvas = byId("canvas");
    this.renderer = new Renderer(this.canvas);
    this.arrays = new Arrays(scene.arrays);
    this.camera = new Camera(scene.plane);
    const kept = this.kept();
    this.frame = kept.frame ?? scene.first;
    this.field = kept.field ?? this.firstField();
    this.magnify = kept.magnify ?? scene.magnify;
    this.hidden = new Set(kept.hidden ?? []);
    this.edges = kept.edges ?? false;
    this.cut = { axis: "", place: 0.5 };
    this.cache = new Map();
    this.drawn = [];
    this.colours = this.bodyColours();
    // In space a rigid body would hide the contact with its faces; a ceiling hides all.
    this.seesThrough = scene.plane === "space" && scene.parts.some((p) => p.look === "contact");
    this.camera.look(kept.from ?? scene.from);
    this.setControls();
    this.setPointer();
    this.setKeys();
    new ResizeObserver(() => this.resize()).observe(this.canvas.parentElement);
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.draw());
    this.resize();
    this.ready = this.show(this.frame);
  }

  /** What was chosen before the page was made again. */
  kept() {
    try { return SERVED ? JSON.parse(sessionStorage.getItem("view") || "{}") : {}; } catch { return {}; }
  }

  /** Keeps what is chosen for the next page; the last state stays the last. */
  keep() {
    const { frame, field, magnify, edges } = this;
    const kept = { field, magnify, edges, hidden: [...this.hidden], from: this.camera.towards };
    if (frame < this.scene.times.length - 1) kept.frame = frame;
    sessionStorage.setItem("view", JSON.stringify(kept));
  }

  /** The first field that is worth it and that bodies have, else contacts; none where only colours of bodies tell something. */
  firstField() {
    const { parts, fields } = this.scene;
    const has = (list, k) => list.some((p) => p.states.some((s) => s && k in s.fields));
    const bodies = parts.filter((p) => ["solid", "membrane", "curve"].includes(p.look));
    const worth = fields.map((f, k) => k).filter((k) => fields[k].first);
    return worth.find((k) => has(bodies, k)) ?? worth.find((k) => has(parts, k)) ?? -1;
  }

  isSize(field, state) {
    return this.scene.fields[field]?.name === "displacement" && Boolean(state.moved);
  }

  /** Rigid bodies are grey, the others have colours of their own. */
  bodyColours() {
    const names = [...new Set(this.scene.parts.filter((p) => p.look !== "rigid").map((p) => p.name))];
    const deformable = names.length > 0 && this.scene.parts.some((p) => ["solid", "membrane", "curve"].includes(p.look));
    const rigid = this.scene.parts.filter((p) => p.look === "rigid").map((p) => p.name);
    return (part) => {
      if (part.look === "outline" || part.look === "pair") return FRONT;
      if (part.look === "rigid") return deformable || rigid.length < 2 ? GREY : BODIES[rigid.indexOf(part.name) % BODIES.length];
      return BODIES[names.indexOf(part.name) % BODIES.length];
    };
  }

  isDark() {
    return matchMedia("(prefers-color-scheme: dark)").matches;
  }

  /** Shows a state. */
  show(frame) {
    this.frame = Math.min(Math.max(frame, 0), this.scene.times.length - 1);
    byId("time").value = this.frame;
    const time = shown(this.scene.times[this.frame], 5);
    byId("time-value").textContent = time;
    byId("time").setAttribute("aria-valuetext", `t = ${time}`);
    const wanted = (this.wanted = Symbol());
    this.ready = this.load(this.frame).then((parts) => {
      if (this.wanted !== wanted) return;
      this.drawn.flatMap((p) => p.meshes).forEach((item) => this.renderer.remove(item.mesh));
      this.drawn = parts.map((part) => ({ ...part, meshes: this.meshes(part) }));
      this.bar();
      if (!this.isFitted) this.fit();
      this.isFitted = true;
      this.drawCut();
      const field = this.scene.fields[this.field];
      this.canvas.ariaLabel = `${field ? field.label : "Bodies"} at t = ${time}: ${this.scene.parts.map((p) => p.name).join(", ")}`;
    });
    return this.ready;
  }

  /** Places, values and what joins them, of all parts at a time. */
  async load(frame) {
    const { parts, shapes, fields } = this.scene;
    const found = parts.map(async (part, number) => {
      const state = part.states[frame];
      if (!state) return undefined;
      const own = shapes[state.shape];
      const get = (list) => Promise.all(list.map((k) => this.arrays.get(k)));
      const [at, moved, joins] = await Promise.all([get(state.at), state.moved ? get(state.moved) : undefined,
        get([own.triangles, own.edges, own.lines, own.tetrahedra])]);
      const count = at[0].length;
      let values = new Float32Array(count).fill(NOTHING), isColoured = false;
      if (this.isSize(this.field, state)) {
        values = values.map((_, k) => Math.hypot(moved[0][k], moved[1][k], moved[2][k]));
        isColoured = true;
      } else if (this.field >= 0 && this.field in state.fields) {
        values = (await this.arrays.get(state.fields[this.field])).map((v) => (isNaN(v) ? NOTHING : v));
        isColoured = true;
      }
      const bodies = this.scene.magnified === "displacements" ? this.magnify : 1;
      const heights = this.scene.magnified === "deflections" ? this.magnify : 1;
      const places = new Float32Array(3 * count);
      for (let k = 0; k < count; k++) {
        for (let i = 0; i < 3; i++) {
          places[3 * k + i] = (at[i][k] + (moved ? bodies * moved[i][k] : 0)) * (i === 2 ? heights : 1);
        }
      }
      const [triangles, edges, lines, tetrahedra] = joins;
      return { part, number, at: places, values, isColoured, triangles, edges, lines, tetrahedra, field: fields[this.field] };
    });
    return (await Promise.all(found)).filter(Boolean);
  }

  /** Whether a surface was found on a grid: its slivers have no normals worth seeing. Bodies of scenes have edges. */
  isSampled(part) {
    return part.look === "rigid" && !this.scene.parts.some((p) => p.look === "pair");
  }

  /** What is drawn of a part. */
  meshes({ part, at, values, isColoured, triangles, edges, lines }) {
    const renderer = this.renderer, out = [];
    const colour = this.colours(part);
    const isContact = part.look === "contact";
    const ink = () => (this.isDark() ? [220, 224, 230] : [40, 44, 50]);
    const isLine = part.look === "rigid" && triangles.length === 0;
    if (triangles.length > 0) {
      const mesh = renderer.addSurface(at, normals(at, triangles, this.isSampled(part)), values, triangles);
      // A contact surface lies on its body; where colours show what the body does not have, the body lets it be seen.
      const behind = { rigid: 3, solid: 1, membrane: 1, contact: 0 }[part.look] ?? 1;
      // A contact surface without colours would hide the body.
      if (!isContact || isColoured) out.push({ mesh, kind: "surface", coloured: isColoured, behind, crease: this.isSampled(part) ? -1 : 0.85,
        colour: () => [...colour, this.opacity(part, isColoured)] });
      else renderer.remove(mesh);
      if (edges.length > 0 && part.look !== "rigid" && !isContact) {
        const drawn = renderer.addLines(at, values, edges);
        out.push({ mesh: drawn, kind: "edges", width: 1, nearer: 5e-5, colour: () => [...ink(), 0.35] });
      }
    }
    if (lines.length > 0) {
      const mesh = renderer.addLines(at, values, lines);
      const width = { curve: 5, outline: 3, arrows: 1.8, pair: 4 }[part.look] ?? (isLine ? 2.5 : 4);
      const own = part.look === "arrows" && !isColoured ? ink() : colour;
      const nearer = part.look === "outline" ? 2e-3 : part.look === "curve" ? 3e-4 : 1e-3;
      const clear = part.look === "arrows" && !isColoured ? 0.6 : 1;
      out.push({ mesh, kind: "lines", coloured: isColoured && !isLine, width, nearer, colour: () => [...own, clear] });
    }
    return out;
  }

  opacity(part, isColoured) {
    const fields = this.scene.parts.some((p) => p.look === "contact");
    if (part.name === "ceiling" && part.look === "rigid") return 0.3;
    if (part.look === "rigid") return this.seesThrough ? 0.3 : 1;
    if (part.look === "solid" && this.field >= 0 && !isColoured && fields) return 0.18;
    return 1;
  }

  /** The box of what is fitted, as it is magnified. */
  box() {
    const { low, high, magnified } = this.scene;
    const grown = magnified === "deflections" ? this.magnify : 1;
    return [low, high].map((x) => x.map((v, k) => (k === 2 ? v * grown : v)));
  }

  /** Points of parts, not more than tell where they end. */
  points(parts) {
    const out = [];
    for (const { at } of parts) {
      const step = 3 * Math.max(1, Math.floor(at.length / 9000));
      for (let k = 0; k < at.length; k += step) out.push([at[k], at[k + 1], at[k + 2]]);
    }
    return out;
  }

  /** Fits the bodies that are shown now, and forces, rigid bodies and other times where that makes them hardly smaller. */
  fit() {
    const of = (...looks) => this.drawn.filter((p) => looks.includes(p.part.look));
    const bodies = of("solid", "membrane", "curve");
    const [low, high] = this.box();
    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((c) => [0, 1, 2].map((k) => ((c >> k) & 1 ? high[k] : low[k])));
    const bar = this.field >= 0 && !byId("bar").hidden ? byId("bar").offsetWidth + 24 : 0;
    const free = 1 - bar / (this.canvas.clientWidth || 800);
    const own = this.points(bodies.length > 0 ? bodies : this.drawn);
    // A rope or a path is shown with what it lies on.
    const most = bodies.length > of("solid", "membrane").length ? 2.5 : 1.4;
    const others = [...of("arrows"), ...of("rigid")].map((part) => ({ points: this.points([part]), most }));
    if (this.scene.times.length > 1) others.push({ points: corners, most: 1.4 });
    this.camera.fit(own.length > 1 ? own : corners, others, this.aspect(), free);
  }

  aspect() {
    return this.canvas.width / this.canvas.height || 1;
  }

  resize() {
    const { clientWidth, clientHeight } = this.canvas;
    const ratio = window.devicePixelRatio || 1;
    if (!clientWidth || !clientHeight) return;
    const before = this.aspect();
    this.canvas.width = Math.round(clientWidth * ratio);
    this.canvas.height = Math.round(clientHeight * ratio);
    if (Math.abs(this.aspect() - before) > 0.01) this.fit();
    this.draw();
  }

  /** Which half-space is left, as (normal, distance). */
  cutPlane() {
    const axis = Number(this.cut.axis);
    if (this.cut.axis === "") return [0, 0, 0, 1];
    const [low, high] = this.box();
    const room = 0.002 * (high[axis] - low[axis]);
    const place = low[axis] - room + (high[axis] - low[axis] + 2 * room) * this.cut.place;
    // What is nearer to the eye is cut away.
    const side = this.camera.towards[axis] < 0 ? -1 : 1;
    const plane = [0, 0, 0, side * place];
    plane[axis] = side;
    return plane;
  }

  /** The faces of the cut, and then everything. */
  drawCut() {
    this.faces?.forEach((face) => this.renderer.remove(face.mesh));
    const [x, y, z, distance] = (this.plane = this.cutPlane());
    const solids = this.cut.axis === "" ? [] : this.drawn.filter((p) => p.tetrahedra.length > 0);
    this.faces = solids.map(({ part, number, at, values, tetrahedra, isColoured }) => {
      const face = cutThrough(at, values, tetrahedra, [x, y, z], distance - 1e-6 * Math.abs(distance || 1));
      const mesh = this.renderer.addSurface(face.at, face.normals, face.values, face.triangles);
      return { mesh, number, coloured: isColoured, colour: () => [...this.colours(part), this.opacity(part, isColoured)] };
    });
    this.draw();
  }

  /** Draws at the next frame of the screen. */
  draw() {
    if (this.pending) return;
    this.pending = requestAnimationFrame(() => {
      this.pending = 0;
      this.drawNow();
    });
  }

  drawNow() {
    const items = [...this.drawn.flatMap((p) => p.meshes.map((m) => ({ ...m, number: p.number }))), ...(this.faces ?? [])];
    const list = items.filter((i) => !this.hidden.has(i.number) && (i.kind !== "edges" || this.edges));
    const range = this.scene.fields[this.field]?.range ?? [0, 1];
    this.renderer.draw(list.map((i) => ({ ...i, colour: i.colour() })), {
      camera: this.camera,
      cut: this.plane ?? [0, 0, 0, 1],
      range: range[1] > range[0] ? range : [range[0] - 1, range[0] + 1],
      isFlat: this.scene.plane !== "space",
      ground: this.isDark() ? [27, 30, 35] : [255, 255, 255],
    });
    this.axes();
  }

  /** The directions of the axes, in the corner. */
  axes() {
    const { right, up } = this.camera;
    const names = this.scene.plane === "xz" ? [["x", 0], ["z", 2]] : this.scene.plane === "xy" ? [["x", 0], ["y", 1]] : [["x", 0], ["y", 1], ["z", 2]];
    byId("axes").innerHTML = names.map(([name, k]) => {
      const [x, y] = [30 * right[k], -30 * up[k]];
      const [a, b] = [40 * right[k], -40 * up[k]];
      const seen = Math.hypot(x, y) > 6;
      return seen ? `<line x1="0" y1="0" x2="${x}" y2="${y}"/><text x="${a}" y="${b}">${name}</text>` : "";
    }).join("");
  }

  /** The colour bar with its unit, round values and ends. */
  bar() {
    const field = this.scene.fields[this.field];
    const before = byId("bar").hidden ? 0 : byId("bar").offsetWidth;
    byId("bar").hidden = !field;
    if (field) {
      byId("bar-title").textContent = field.unit ? `${field.label} [${field.unit}]` : field.label;
      const context = byId("bar-colours").getContext("2d");
      for (let k = 0; k < 256; k++) {
        context.fillStyle = `rgb(${viridis(1 - k / 255)})`;
        context.fillRect(0, k, 1, 1);
      }
      const [low, high] = field.range;
      const values = high > low ? roundValues(low, high, 5) : [low];
      byId("bar-ticks").replaceChildren(...values.map((value) => {
        const tick = document.createElement("li");
        tick.style.bottom = `${high > low ? (100 * (value - low)) / (high - low) : 50}%`;
        tick.textContent = shown(value);
        return tick;
      }));
      byId("bar-ends").textContent = `largest ${shown(field.ends[1])}\nsmallest ${shown(field.ends[0])}`;
    }
    if (Math.abs((field ? byId("bar").offsetWidth : 0) - before) > 40) this.isFitted = false;
  }
}
