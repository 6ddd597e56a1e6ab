// Spheres as impostors: every sphere is a square that faces the viewer, whose pixels find the sphere's surface.

const vertexSource = `#version 300 es
layout(location = 0) in vec2 corner;
layout(location = 1) in vec3 centre;
layout(location = 2) in vec4 colour;
layout(location = 3) in float radius;
uniform mat3 turn;
uniform vec3 middle;
uniform vec4 extent; // half width and half height of what is seen, depth, 0
out vec2 place;
out vec3 tint;
out float depth;
out float size;
void main() {
  vec3 at = turn * (centre - middle);
  place = corner;
  size = radius;
  tint = colour.rgb;
  depth = at.z;
  gl_Position = vec4((at.xy + corner * radius) / extent.xy, -at.z / extent.z, 1.0);
}`;

const fragmentSource = `#version 300 es
precision highp float;
in vec2 place;
in vec3 tint;
in float depth;
in float size;
uniform vec4 extent;
out vec4 pixel;
void main() {
  float r2 = dot(place, place);
  if (r2 > 1.0) discard;
  vec3 normal = vec3(place, sqrt(1.0 - r2));
  float z = depth + size * normal.z;
  gl_FragDepth = 0.5 - 0.5 * z / extent.z;
  float light = 0.42 + 0.5 * max(dot(normal, normalize(vec3(-0.35, 0.55, 0.76))), 0.0) + 0.12 * normal.z;
  float rim = smoothstep(1.0, 0.86, r2);
  pixel = vec4(tint * light * mix(0.55, 1.0, rim), 1.0);
}`;

const lineVertexSource = `#version 300 es
layout(location = 0) in vec3 centre;
uniform mat3 turn;
uniform vec3 middle;
uniform vec4 extent;
void main() {
  vec3 at = turn * (centre - middle);
  gl_Position = vec4(at.xy / extent.xy, -at.z / extent.z, 1.0);
}`;
const lineFragmentSource = `#version 300 es
precision highp float;
uniform vec4 ink;
out vec4 pixel;
void main() { pixel = ink; }`;

function programOf(gl, vertex, fragment) {
  const program = gl.createProgram();
  for (const [kind, source] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
    const shader = gl.createShader(kind);
    gl.shaderSource(shader, source);
    gl.compileShader(shader);
    gl.attachShader(program, shader);
  }
  gl.linkProgram(program);
  if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program) ?? "WebGL");
  return program;
}

function multiplied(a, b) {
  const out = new Array(9).fill(0);
  for (let i = 0; i < 3; ++i) for (let j = 0; j < 3; ++j) for (let k = 0; k < 3; ++k) out[3 * i + j] += a[3 * i + k] * b[3 * k + j];
  return out;
}

function aboutX(angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return [1, 0, 0, 0, c, -s, 0, s, c];
}
function aboutZ(angle) {
  const c = Math.cos(angle), s = Math.sin(angle);
  return [c, -s, 0, s, c, 0, 0, 0, 1];
}

/// The bed stays upright: it turns about its own vertical, and nods.
const uprightTurn = (about, nod) => multiplied(aboutX(nod), aboutZ(about));

export class View {
  /// Throws where the browser has no WebGL2.
  constructor(canvas) {
    this.canvas = canvas;
    const gl = canvas.getContext("webgl2", {antialias: true, alpha: false, preserveDrawingBuffer: true});
    if (!gl) throw new Error("this browser has no WebGL2");
    this.gl = gl;
    this.lost = false;
    canvas.addEventListener("webglcontextlost", (event) => { event.preventDefault(); this.lost = true; });
    canvas.addEventListener("webglcontextrestored", () => { this.lost = false; this.prepare(); this.show(this.shown); });
    this.prepare();
    this.reset();
    this.background = [1, 1, 1];
    this.ink = [0.4, 0.4, 0.4];
  }

  prepare() {
    const gl = this.gl;
    this.program = programOf(gl, vertexSource, fragmentSource);
    this.lineProgram = programOf(gl, lineVertexSource, lineFragmentSource);
    this.spheres = gl.createVertexArray();
    gl.bindVertexArray(this.spheres);
    const corners = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, corners);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array([-1, -1, 1, -1, -1, 1, 1, 1]), gl.STATIC_DRAW);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 2, gl.FLOAT, false, 0, 0);
    this.centres = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, this.centres);
    gl.enableVertexAttribArray(1);
    gl.vertexAttribPointer(1, 3, gl.FLOAT, false, 0, 0);
    gl.vertexAttribDivisor(1, 1);
    this.colours = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, this.colours);
    gl.enableVertexAttribArray(2);
    gl.vertexAttribPointer(2, 4, gl.UNSIGNED_BYTE, true, 0, 0);
    gl.vertexAttribDivisor(2, 1);
    this.radii = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, this.radii);
    gl.enableVertexAttribArray(3);
    gl.vertexAttribPointer(3, 1, gl.FLOAT, false, 0, 0);
    gl.vertexAttribDivisor(3, 1);
    this.frame = gl.createVertexArray();
    gl.bindVertexArray(this.frame);
    this.frameBuffer = gl.createBuffer();
    gl.bindBuffer(gl.ARRAY_BUFFER, this.frameBuffer);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
  }

  reset() {
    this.about = 0.5;
    this.nod = -1.25;
    this.zoom = 1;
  }

  turn(about, nod) {
    this.about += about;
    this.nod = Math.min(Math.max(this.nod + nod, -Math.PI), 0);
    this.draw();
  }

  magnify(factor) {
    this.zoom = Math.min(Math.max(this.zoom * factor, 0.3), 12);
    this.draw();
  }

  /// centres: Float32Array [n, 3]; radii: Float32Array [n]; colours: Uint8Array [n, 4]; lines: Float32Array of pairs of points; size: of the box.
  show(shown) {
    if (!shown) return;
    this.shown = shown;
    const gl = this.gl;
    gl.bindBuffer(gl.ARRAY_BUFFER, this.centres);
    gl.bufferData(gl.ARRAY_BUFFER, shown.centres, gl.DYNAMIC_DRAW);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.radii);
    gl.bufferData(gl.ARRAY_BUFFER, shown.radii, gl.DYNAMIC_DRAW);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.colours);
    gl.bufferData(gl.ARRAY_BUFFER, shown.colours, gl.DYNAMIC_DRAW);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.frameBuffer);
    gl.bufferData(gl.ARRAY_BUFFER, shown.lines, gl.DYNAMIC_DRAW);
    this.draw();
  }

  draw() {
    if (!this.shown || this.lost) return;
    const {gl, canvas, shown} = this;
    const ratio = Math.min(devicePixelRatio || 1, 2);
    const width = Math.max(1, Math.round(canvas.clientWidth * ratio)), height = Math.max(1, Math.round(canvas.clientHeight * ratio));
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, {width, height});
    gl.viewport(0, 0, width, height);
    gl.enable(gl.DEPTH_TEST);
    gl.clearColor(...this.background, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    const [sx, sy, sz] = shown.size;
    const largest = shown.radii.reduce((most, radius) => Math.max(most, radius), 0.5);
    const round = Math.hypot(sx, sy, sz) / 2 + largest;
    const turn = uprightTurn(this.about, this.nod);
    // The extent of the turned box sets the scale.
    const halfOf = (row) => (Math.abs(turn[row]) * sx + Math.abs(turn[row + 1]) * sy + Math.abs(turn[row + 2]) * sz) / 2 + largest + 0.1;
    const aspect = width / height;
    const upright = Math.max(halfOf(3), Math.hypot(sx, sy) / 2 / aspect + 0.3, halfOf(0) / aspect) / this.zoom;
    const extent = [upright * aspect, upright, round * 1.05, 0];
    const columns = [0, 3, 6, 1, 4, 7, 2, 5, 8].map((i) => turn[i]);
    for (const program of [this.program, this.lineProgram]) {
      gl.useProgram(program);
      gl.uniformMatrix3fv(gl.getUniformLocation(program, "turn"), false, columns);
      gl.uniform3f(gl.getUniformLocation(program, "middle"), sx / 2, sy / 2, sz / 2);
      gl.uniform4f(gl.getUniformLocation(program, "extent"), ...extent);
    }
    gl.uniform4f(gl.getUniformLocation(this.lineProgram, "ink"), ...this.ink, 1);
    gl.bindVertexArray(this.frame);
    gl.drawArrays(gl.LINES, 0, shown.lines.length / 3);
    gl.useProgram(this.program);
    gl.bindVertexArray(this.spheres);
    gl.drawArraysInstanced(gl.TRIANGLE_STRIP, 0, 4, shown.centres.length / 3);
  }

  /// The picture as a PNG.
  picture() {
    this.draw();
    return new Promise((resolve) => this.canvas.toBlob(resolve, "image/png"));
  }
}
