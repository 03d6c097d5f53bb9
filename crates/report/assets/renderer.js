// Draws surfaces and lines with WebGL2.

const SURFACE_POINT = `#version 300 es
in vec3 at; in vec3 normal; in float value;
uniform mat4 view; uniform vec3 towards;
out vec3 place; out vec3 smoothed; out float shownValue;
// Normals look to the eye, whichever way triangles are turned.
void main() { place = at; smoothed = dot(normal, towards) < 0.0 ? -normal : normal; shownValue = value; gl_Position = view * vec4(at, 1.0); }`;

// Where faces meet at an angle they are drawn flat, elsewhere smooth. Values that are no numbers have the colour of the body.
const SURFACE_COLOUR = `#version 300 es
precision highp float;
in vec3 place; in vec3 smoothed; in float shownValue;
uniform vec3 towards, light; uniform vec4 cut, colour; uniform vec2 range; uniform bool isFlat; uniform float coloured, crease;
uniform sampler2D palette;
out vec4 result;
void main() {
  if (dot(cut.xyz, place) > cut.w) discard;
  vec3 face = normalize(cross(dFdx(place), dFdy(place)));
  if (dot(face, towards) < 0.0) face = -face;
  vec3 n = normalize(smoothed);
  if (dot(n, towards) < 0.0) n = -n;
  if (crease > -1.0 && !(dot(n, face) > crease)) n = face;
  float shade = isFlat ? 1.0 : 0.52 + 0.48 * max(dot(n, light), 0.0);
  vec3 own = colour.rgb;
  if (coloured > 0.0 && shownValue > -1e29) {
    float t = clamp((shownValue - range.x) / (range.y - range.x), 0.0, 1.0);
    own = texture(palette, vec2(0.002 + 0.996 * t, 0.5)).rgb;
  }
  result = vec4(own * shade, colour.a);
}`;

// A line is a strip of the width that is wanted on the screen, square at its ends.
const LINE_POINT = `#version 300 es
in vec3 from; in vec3 to; in float valueFrom; in float valueTo;
uniform mat4 view; uniform vec2 size; uniform float width, nearer;
out vec3 place; out float shownValue;
void main() {
  float end = float(gl_VertexID & 1), side = float(gl_VertexID >> 1) * 2.0 - 1.0;
  vec4 a = view * vec4(from, 1.0), b = view * vec4(to, 1.0);
  vec2 along = (b.xy - a.xy) * size;
  along = length(along) > 1e-6 ? normalize(along) : vec2(1.0, 0.0);
  vec2 shift = (vec2(-along.y, along.x) * side + along * (2.0 * end - 1.0) * 0.5) * width / size;
  place = mix(from, to, end); shownValue = mix(valueFrom, valueTo, end);
  gl_Position = mix(a, b, end) + vec4(shift, -nearer, 0.0);
}`;

const LINE_COLOUR = `#version 300 es
precision highp float;
in vec3 place; in float shownValue;
uniform vec4 cut, colour; uniform vec2 range; uniform float coloured; uniform sampler2D palette;
out vec4 result;
void main() {
  if (dot(cut.xyz, place) > cut.w) discard;
  vec3 own = colour.rgb;
  if (coloured > 0.0 && shownValue > -1e29)
    own = texture(palette, vec2(0.002 + 0.996 * clamp((shownValue - range.x) / (range.y - range.x), 0.0, 1.0), 0.5)).rgb;
  result = vec4(own, colour.a);
}`;

class Renderer {
  /** Throws where there is no WebGL2. */
  constructor(canvas) {
    const gl = canvas.getContext("webgl2", { antialias: true, alpha: true, premultipliedAlpha: false });
    if (!gl) throw new Error("no WebGL2");
    this.gl = gl;
    this.surface = this.program(SURFACE_POINT, SURFACE_COLOUR, ["at", "normal", "value"]);
    this.line = this.program(LINE_POINT, LINE_COLOUR, ["from", "to", "valueFrom", "valueTo"]);
    const colours = new Uint8Array(256 * 4);
    for (let k = 0; k < 256; k++) colours.set([...viridis(k / 255), 255], 4 * k);
    gl.bindTexture(gl.TEXTURE_2D, gl.createTexture());
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, colours);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, gl.LINEAR);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.enable(gl.DEPTH_TEST);
    gl.blendFunc(gl.SRC_ALPHA, gl.ONE_MINUS_SRC_ALPHA);
  }

  program(point, colour, names) {
    const gl = this.gl;
    const made = gl.createProgram();
    for (const [kind, source] of [[gl.VERTEX_SHADER, point], [gl.FRAGMENT_SHADER, colour]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, source);
      gl.compileShader(shader);
      gl.attachShader(made, shader);
    }
    names.forEach((name, k) => gl.bindAttribLocation(made, k, name));
    gl.linkProgram(made);
    if (!gl.getProgramParameter(made, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(made) || "no program");
    const uniforms = {};
    for (let k = 0; k < gl.getProgramParameter(made, gl.ACTIVE_UNIFORMS); k++) {
      const { name } = gl.getActiveUniform(made, k);
      uniforms[name] = gl.getUniformLocation(made, name);
    }
    return { made, uniforms };
  }

  buffer(data, kind = this.gl.ARRAY_BUFFER) {
    const buffer = this.gl.createBuffer();
    this.gl.bindBuffer(kind, buffer);
    this.gl.bufferData(kind, data, this.gl.STATIC_DRAW);
    return buffer;
  }

  /** A surface: places and normals of its points, a value each, and its triangles. */
  addSurface(at, normals, values, triangles) {
    const gl = this.gl;
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    const buffers = [at, normals, values].map((data, k) => {
      const buffer = this.buffer(data);
      gl.enableVertexAttribArray(k);
      gl.vertexAttribPointer(k, k < 2 ? 3 : 1, gl.FLOAT, false, 0, 0);
      return buffer;
    });
    buffers.push(this.buffer(triangles, gl.ELEMENT_ARRAY_BUFFER));
    gl.bindVertexArray(null);
    return { array, buffers, count: triangles.length };
  }

  /** Lines between pairs of points. */
  addLines(at, values, pairs) {
    const gl = this.gl;
    const data = new Float32Array(4 * pairs.length);
    for (let k = 0; k < pairs.length; k += 2) {
      for (let end = 0; end < 2; end++) {
        const point = pairs[k + end];
        for (let i = 0; i < 3; i++) data[4 * k + 3 * end + i] = at[3 * point + i];
        data[4 * k + 6 + end] = values[point];
      }
    }
    const array = gl.createVertexArray();
    gl.bindVertexArray(array);
    const buffers = [this.buffer(data)];
    [[3, 0], [3, 12], [1, 24], [1, 28]].forEach(([size, offset], k) => {
      gl.enableVertexAttribArray(k);
      gl.vertexAttribPointer(k, size, gl.FLOAT, false, 32, offset);
      gl.vertexAttribDivisor(k, 1);
    });
    gl.bindVertexArray(null);
    return { array, buffers, count: pairs.length / 2, isLines: true };
  }

  remove({ array, buffers }) {
    this.gl.deleteVertexArray(array);
    buffers.forEach((buffer) => this.gl.deleteBuffer(buffer));
  }

  /** Draws a list of { mesh, colour, width, coloured, behind, nearer, crease } with what they have in common. */
  draw(list, { camera, cut, range, isFlat, ground }) {
    const gl = this.gl;
    const [width, height] = [gl.canvas.width, gl.canvas.height];
    gl.viewport(0, 0, width, height);
    gl.clearColor(...ground.map((c) => c / 255), 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const view = camera.matrix(width / height);
    const light = unit(camera.towards.map((t, k) => t + 0.35 * camera.up[k] - 0.25 * camera.right[k]));
    const isClear = (item) => item.colour[3] < 1;
    const order = [...list.filter((i) => !isClear(i)), ...list.filter(isClear)];
    for (const { mesh, colour, width: wide = 1, coloured = false, behind = 0, nearer = 0, crease = 0.85 } of order) {
      const { made, uniforms } = mesh.isLines ? this.line : this.surface;
      gl.useProgram(made);
      gl.uniformMatrix4fv(uniforms.view, false, view);
      gl.uniform4fv(uniforms.cut, cut);
      gl.uniform4fv(uniforms.colour, [...colour.slice(0, 3).map((c) => c / 255), colour[3]]);
      gl.uniform2fv(uniforms.range, range);
      gl.uniform1f(uniforms.coloured, coloured ? 1 : 0);
      const clear = colour[3] < 1;
      gl[clear ? "enable" : "disable"](gl.BLEND);
      gl.depthMask(!clear);
      gl.bindVertexArray(mesh.array);
      if (mesh.isLines) {
        gl.uniform2fv(uniforms.size, [width, height]);
        gl.uniform1f(uniforms.width, wide * (globalThis.devicePixelRatio || 1));
        gl.uniform1f(uniforms.nearer, nearer);
        gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, mesh.count);
      } else {
        gl.uniform3fv(uniforms.towards, camera.towards);
        gl.uniform3fv(uniforms.light, light);
        gl.uniform1f(uniforms.crease, crease);
        gl.uniform1i(uniforms.isFlat, isFlat ? 1 : 0);
        gl.enable(gl.POLYGON_OFFSET_FILL);
        gl.polygonOffset(1 + behind, 1 + behind);
        gl.drawElements(gl.TRIANGLES, mesh.count, gl.UNSIGNED_INT, 0);
      }
    }
    gl.depthMask(true);
    gl.bindVertexArray(null);
  }
}
