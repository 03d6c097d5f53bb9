// What is beside the picture: time, colours, magnification, cut, bodies; pointer and keys.

const byId = (id) => document.getElementById(id);

class Controls {
  setControls() {
    const { times, fields, parts, magnified, plane } = this.scene;
    const time = byId("time");
    time.max = times.length - 1;
    time.value = this.frame;
    byId("time-control").hidden = times.length < 2;
    time.addEventListener("input", () => this.show(Number(time.value)));
    byId("play").addEventListener("click", () => this.play());
    const field = byId("field");
    const options = [["-1", "bodies"], ...fields.map((f, k) => [String(k), f.label])];
    field.append(...options.map(([value, text]) => new Option(text, value)));
    field.value = String(this.field);
    field.addEventListener("change", () => { this.field = Number(field.value); this.show(this.frame); });
    this.setMagnify(magnified);
    this.setCut(plane);
    const edges = byId("edges");
    edges.checked = this.edges;
    edges.addEventListener("change", () => { this.edges = edges.checked; this.draw(); });
    byId("looks").hidden = plane !== "space";
    const looks = { x: [1, 0, 0], y: [0, -1, 0], z: [0, 0, 1] };
    for (const button of byId("looks").querySelectorAll("button")) {
      if (plane !== "space" && button.dataset.look !== "home") button.hidden = true;
      button.addEventListener("click", () => {
        this.camera.look(looks[button.dataset.look] ?? this.scene.from);
        if (button.dataset.look === "z") { this.camera.around = -Math.PI / 2; this.camera.turn(0, 0); }
        this.fit();
        this.draw();
      });
    }
    const words = { rigid: "rigid", contact: "contact surface", outline: "edge of the contact", arrows: "contact forces", pair: "" };
    parts.forEach((part, number) => {
      const box = Object.assign(document.createElement("input"), { type: "checkbox", checked: !this.hidden.has(number) });
      box.addEventListener("change", () => {
        this.hidden[box.checked ? "delete" : "add"](number);
        this.draw();
      });
      const swatch = Object.assign(document.createElement("span"), { className: "swatch" });
      swatch.style.background = `rgb(${this.colours(part)})`;
      const label = document.createElement("label");
      const kind = Object.assign(document.createElement("small"), { textContent: words[part.look] ?? "" });
      label.append(box, swatch, document.createTextNode(part.look === "outline" && part.name === "contact" ? "" : part.name), kind);
      byId("parts").append(label);
    });
  }

  setMagnify(magnified) {
    byId("magnify-control").hidden = magnified === "nothing";
    byId("magnify-label").textContent = magnified === "deflections" ? "Heights" : "Motion";
    const factors = [...new Set([1, 2, 5, 10, 20, 50, 100, 1000, this.magnify])].sort((a, b) => a - b);
    const shownFactors = factors.filter((f) => f <= 20 * this.scene.magnify || f <= 10);
    byId("magnify").append(...shownFactors.map((f) => new Option(f === 1 ? "to scale" : `× ${f}`, f)));
    byId("magnify").value = String(this.magnify);
    byId("magnify").addEventListener("change", () => {
      this.magnify = Number(byId("magnify").value);
      this.isFitted = false;
      this.show(this.frame);
    });
  }

  setCut(plane) {
    const cut = byId("cut"), place = byId("cut-place");
    if (plane === "xy") cut.options[3].remove();
    if (plane === "xz") byId("cut-control").hidden = true;
    const change = () => {
      this.cut = { axis: cut.value, place: place.value / 1000 };
      place.disabled = cut.value === "";
      this.drawCut();
    };
    cut.addEventListener("change", change);
    place.addEventListener("input", change);
  }

  setPointer() {
    const pointers = new Map();
    const canvas = this.canvas;
    canvas.addEventListener("pointerdown", (e) => { canvas.setPointerCapture(e.pointerId); pointers.set(e.pointerId, e); });
    const end = (e) => pointers.delete(e.pointerId);
    canvas.addEventListener("pointerup", end);
    canvas.addEventListener("pointercancel", end);
    canvas.addEventListener("contextmenu", (e) => e.preventDefault());
    canvas.addEventListener("pointermove", (e) => {
      const before = pointers.get(e.pointerId);
      if (!before) return;
      const [x, y] = [(e.clientX - before.clientX) / canvas.clientHeight, (e.clientY - before.clientY) / canvas.clientHeight];
      if (pointers.size === 2) {
        const other = [...pointers.values()].find((p) => p.pointerId !== e.pointerId);
        const apart = (p) => Math.hypot(p.clientX - other.clientX, p.clientY - other.clientY) || 1;
        this.camera.zoom(apart(e) / apart(before));
        this.camera.move(x / 2, -y / 2);
      } else if (e.shiftKey || e.buttons !== 1 || this.scene.plane !== "space") this.camera.move(x, -y);
      else this.camera.turn(-3 * x, 3 * y);
      pointers.set(e.pointerId, e);
      this.draw();
    });
    canvas.addEventListener("wheel", (e) => {
      // Only where the picture was chosen: else the page moves.
      if (document.activeElement !== canvas && !e.ctrlKey) return;
      e.preventDefault();
      this.camera.zoom(Math.exp(-0.0015 * e.deltaY));
      this.draw();
    }, { passive: false });
    canvas.addEventListener("pointerdown", () => canvas.focus());
  }

  setKeys() {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] };
    this.canvas.addEventListener("keydown", (e) => {
      const [x, y] = step[e.key] ?? [0, 0];
      if (e.ctrlKey || e.metaKey || e.altKey) return;
      if (step[e.key] && (e.shiftKey || this.scene.plane !== "space")) this.camera.move(0.06 * x, 0.06 * y);
      else if (step[e.key]) this.camera.turn(0.12 * x, 0.12 * y);
      else if (e.key === "+" || e.key === "=") this.camera.zoom(1.2);
      else if (e.key === "-") this.camera.zoom(1 / 1.2);
      else if (e.key === "Home") { this.camera.look(this.scene.from); this.fit(); }
      else if (e.key === "," || e.key === ".") return this.show(this.frame + (e.key === "." ? 1 : -1));
      else return;
      e.preventDefault();
      this.draw();
    });
  }

  play() {
    const button = byId("play");
    const stop = () => { clearInterval(this.timer); this.timer = undefined; button.textContent = "▶"; button.ariaLabel = "Play"; };
    if (this.timer) return stop();
    button.textContent = "❚❚";
    button.ariaLabel = "Pause";
    const count = this.scene.times.length;
    const step = async () => { await this.ready; this.show((this.frame + 1) % count); };
    this.timer = setInterval(step, Math.min(500, Math.max(60, 5000 / count)));
  }
}
