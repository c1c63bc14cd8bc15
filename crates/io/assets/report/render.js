// Draws points as cubes or balls without perspective, lit, darker in cracks. By WebGL2; where that is missing, by loops over pixels:
// both draw the same picture. Lengths are those of the run; depth grows towards the eye.

const LIGHT = normal([-0.35, 0.55, 0.75]);
const AMBIENT = 0.45;
// how much what lies behind its surroundings is darkened, per spacing, and at most
const HOLLOW = 0.35;
const DARKEST = 0.4;

function normal(v) {
  const l = Math.hypot(...v);
  return v.map(c => c / l);
}
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** Light on a face whose normal is `n` (right, up, to the eye): 1 on what faces the eye. */
const lit = n => AMBIENT + (1 - AMBIENT) * Math.min(1.12, Math.max(0, dot(n, LIGHT)) / LIGHT[2]);

/** Half the width and height of a cube or ball of half edge `half`, seen along the axes `right`, `up`. */
function extent(view) {
  if (view.balls) return [view.half, view.half];
  const reach = axis => view.half * (Math.abs(axis[0]) + Math.abs(axis[1]) + Math.abs(axis[2]));
  return [reach(view.right), reach(view.up)];
}

/** What a ray through (`x`, `y`) from the middle of a cube or ball meets first: depth and light; null if nothing. */
function meets(view, x, y) {
  const h = view.half;
  if (view.balls) {
    const rest = h * h - x * x - y * y;
    if (rest < 0) return null;
    const z = Math.sqrt(rest);
    return [z, lit([x / h, y / h, z / h])];
  }
  let [first, last, face] = [-Infinity, Infinity, 0];
  for (let a = 0; a < 3; a++) {
    const from = x * view.right[a] + y * view.up[a];
    const along = Math.abs(view.eye[a]) < 1e-6 ? -1e-6 : -view.eye[a];
    const [t1, t2] = [(-h - from) / along, (h - from) / along];
    if (Math.min(t1, t2) > first) [first, face] = [Math.min(t1, t2), a];
    last = Math.min(last, Math.max(t1, t2));
  }
  if (first > last) return null;
  const sign = view.eye[face] >= 0 ? 1 : -1;
  return [-first, lit([view.right, view.up, view.eye].map(axis => sign * axis[face]))];
}

/** Is point `i` shown: somewhere, and not cut away? */
function cutAway(view, scene, i) {
  if (!view.cut) return false;
  return (scene.reference[view.cut.axis][i] - view.cut.at) * view.cut.side > 0;
}

class Loops {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
    this.name = "loops";
  }

  points(points) {
    this.scene = points;
  }

  draw(view) {
    const { width: w, height: h } = this.canvas;
    const image = this.context.createImageData(w, h);
    const depth = new Float32Array(w * h).fill(-Infinity);
    const from = new Int32Array(w * h).fill(-1);
    const light = new Float32Array(w * h);
    const { scene } = this;
    const px = view.pixels;
    // all cubes look alike
    const [ex, ey] = extent(view).map(e => Math.max(1, Math.ceil(e * px)));
    const sprite = [];
    for (let y = -ey; y <= ey; y++) {
      for (let x = -ex; x <= ex; x++) {
        const met = meets(view, x / px, -y / px);
        if (met) sprite.push([x, y, ...met]);
      }
    }
    if (sprite.length < 2) sprite.push([0, 0, 0, 1], [1, 0, 0, 1]);
    const n = scene.value.length;
    for (let i = 0; i < n; i++) {
      if (cutAway(view, scene, i)) continue;
      const p = [0, 1, 2].map(a => scene.reference[a][i] + view.stretch * scene.moved[a][i] - view.middle[a]);
      const cx = Math.round(w / 2 + (dot(p, view.right) - view.shift[0]) * px);
      const cy = Math.round(h / 2 - (dot(p, view.up) - view.shift[1]) * px);
      const d = dot(p, view.eye);
      if (!(cx > -ex && cx < w + ex && cy > -ey && cy < h + ey)) continue;
      for (const [dx, dy, dz, shade] of sprite) {
        const [x, y] = [cx + dx, cy + dy];
        if (x < 0 || y < 0 || x >= w || y >= h) continue;
        const at = y * w + x;
        if (d + dz > depth[at]) [depth[at], from[at], light[at]] = [d + dz, i, shade];
      }
    }
    for (const { center, radius, triangles: own } of view.bodies) {
      if (own) {
        this.triangles(own, view, (at, d, shade) => {
          if (d > depth[at]) [depth[at], from[at], light[at]] = [d, n, shade];
        });
        continue;
      }
      const p = center.map((c, a) => c - view.middle[a]);
      const [cx, cy] = [w / 2 + (dot(p, view.right) - view.shift[0]) * px, h / 2 - (dot(p, view.up) - view.shift[1]) * px];
      const ball = { balls: true, half: radius };
      for (let y = Math.max(0, Math.ceil(cy - radius * px)); y < Math.min(h, cy + radius * px); y++) {
        for (let x = Math.max(0, Math.ceil(cx - radius * px)); x < Math.min(w, cx + radius * px); x++) {
          const met = meets(ball, (x - cx) / px, (cy - y) / px);
          const at = y * w + x;
          if (met && dot(p, view.eye) + met[0] > depth[at]) [depth[at], from[at], light[at]] = [dot(p, view.eye) + met[0], n, met[1]];
        }
      }
    }
    const reach = Math.max(1, Math.round(view.spread * px));
    const around = [[1, 0], [0, 1], [0.7, 0.7], [0.7, -0.7]];
    const steps = around.map(([x, y]) => Math.round(x * reach) + w * Math.round(y * reach));
    for (let at = 0; at < w * h; at++) {
      if (from[at] < 0) continue;
      let hollow = 0;
      // of opposite sides the mean: slopes are no hollows
      const off = step => Math.min(4, Math.max(-4, ((depth[at + step] ?? -Infinity) - depth[at]) / view.spread));
      for (const step of steps) hollow += Math.max(0, 0.5 * (off(step) + off(-step)));
      const shade = light[at] * Math.max(DARKEST, 1 - (HOLLOW * hollow) / 4);
      const value = from[at] < n ? scene.value[from[at]] : NaN;
      const k = 4 * Math.round(255 * Math.min(1, Math.max(0, (value - view.low) / (view.high - view.low))));
      for (let c = 0; c < 3; c++) image.data[4 * at + c] = (Number.isNaN(value) ? 128 : view.colours[k + c]) * shade;
      image.data[4 * at + 3] = 255;
    }
    this.context.putImageData(image, 0, 0);
  }
}

/** Each pixel of triangles, its depth and light. */
Loops.prototype.triangles = function (all, view, put) {
  const { width: w, height: h } = this.canvas;
  const px = view.pixels;
  for (const triangle of all) {
    const [a, b, c] = triangle.map(x => {
      const p = x.map((y, k) => y - view.middle[k]);
      return [w / 2 + (dot(p, view.right) - view.shift[0]) * px, h / 2 - (dot(p, view.up) - view.shift[1]) * px, dot(p, view.eye)];
    });
    const area = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
    // what turns left on the screen, whose rows grow downwards, faces away
    if (!(area < 0)) continue;
    const n = normal(cross(triangle[1].map((y, k) => y - triangle[0][k]), triangle[2].map((y, k) => y - triangle[0][k])));
    const shade = lit([view.right, view.up, view.eye].map(axis => dot(n, axis)));
    const [low, high] = [0, 1].map(k => [Math.min(a[k], b[k], c[k]), Math.max(a[k], b[k], c[k])]);
    for (let y = Math.max(0, Math.ceil(low[1])); y <= Math.min(h - 1, high[1]); y++) {
      for (let x = Math.max(0, Math.ceil(low[0])); x <= Math.min(w - 1, high[0]); x++) {
        const v = ((x - a[0]) * (c[1] - a[1]) - (y - a[1]) * (c[0] - a[0])) / area;
        const u = ((b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0])) / area;
        if (v >= 0 && u >= 0 && v + u <= 1) put(y * w + x, a[2] + v * (b[2] - a[2]) + u * (c[2] - a[2]), shade);
      }
    }
  }
};

const CORNERS = `#version 300 es
precision highp float;
layout(location = 0) in vec3 place;
layout(location = 1) in vec3 faces;
uniform vec3 right, up, eye, middle;
uniform vec2 shift, screen;
uniform float pixels, deep;
out vec3 towards;
void main() {
  vec3 p = place - middle;
  vec2 at = (vec2(dot(p, right), dot(p, up)) - shift) * pixels / (0.5 * screen);
  towards = vec3(dot(faces, right), dot(faces, up), dot(faces, eye));
  gl_Position = vec4(at, -dot(p, eye) / deep, 1.0);
}`;

const STEEL = `#version 300 es
precision highp float;
uniform vec3 light;
uniform float ambient;
in vec3 towards;
out vec4 colour;
void main() {
  vec3 n = normalize(towards);
  if (n.z < 0.0) discard;
  colour = vec4(vec3(0.5) * (ambient + (1.0 - ambient) * min(1.12, max(0.0, dot(n, light)) / light.z)), 1.0);
}`;

const POINTS = `#version 300 es
precision highp float;
layout(location = 0) in vec3 reference;
layout(location = 1) in vec3 moved;
layout(location = 2) in float value;
uniform vec3 right, up, eye, middle, cutAxis;
uniform vec2 shift, screen, reach;
uniform float pixels, stretch, deep, cutAt, low, high;
out float part, nearness;
void main() {
  vec3 p = reference + stretch * moved - middle;
  vec2 at = (vec2(dot(p, right), dot(p, up)) - shift) * pixels / (0.5 * screen);
  nearness = dot(p, eye);
  part = (value - low) / (high - low);
  bool shown = p == p && dot(reference, cutAxis) <= cutAt;
  gl_Position = shown ? vec4(at, -nearness / deep, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
  gl_PointSize = max(2.0, 2.0 * max(reach.x, reach.y) * pixels);
}`;

const SURFACE = `#version 300 es
precision highp float;
uniform vec3 right, up, eye, light;
uniform vec2 reach;
uniform float halfEdge, deep, ambient, pixels;
uniform bool balls;
uniform sampler2D colours;
in float part, nearness;
out vec4 colour;
float lit(vec3 n) { return ambient + (1.0 - ambient) * min(1.12, max(0.0, dot(n, light)) / light.z); }
void main() {
  float side = max(max(reach.x, reach.y), 1.0 / pixels);
  vec2 q = side * (2.0 * gl_PointCoord - 1.0) * vec2(1.0, -1.0);
  float z = 0.0, shade = 1.0;
  if (reach.x * pixels >= 1.0) {
    if (balls) {
      float rest = halfEdge * halfEdge - dot(q, q);
      if (rest < 0.0) discard;
      z = sqrt(rest);
      shade = lit(vec3(q, z) / halfEdge);
    } else {
      vec3 from = q.x * right + q.y * up;
      vec3 along = mix(-eye, vec3(-1e-6), lessThan(abs(eye), vec3(1e-6)));
      vec3 a = (-halfEdge - from) / along, b = (halfEdge - from) / along;
      vec3 near = min(a, b), far = max(a, b);
      float first = max(near.x, max(near.y, near.z));
      if (first > min(far.x, min(far.y, far.z))) discard;
      vec3 face = near.x == first ? vec3(1, 0, 0) : near.y == first ? vec3(0, 1, 0) : vec3(0, 0, 1);
      vec3 n = face * mix(vec3(-1), vec3(1), greaterThanEqual(eye, vec3(0)));
      z = -first;
      shade = lit(vec3(dot(n, right), dot(n, up), dot(n, eye)));
    }
  }
  gl_FragDepth = 0.5 - 0.5 * (nearness + z) / deep;
  vec3 c = part == part ? texture(colours, vec2(clamp(part, 0.0, 1.0) * (255.0 / 256.0) + 0.5 / 256.0, 0.5)).rgb : vec3(0.5);
  colour = vec4(c * shade, 1.0);
}`;

const WHOLE = `#version 300 es
void main() { gl_Position = vec4(gl_VertexID == 1 ? 3.0 : -1.0, gl_VertexID == 2 ? 3.0 : -1.0, 0.0, 1.0); }`;

// darkens hollows, and averages the fine picture down
const FINISH = `#version 300 es
precision highp float;
uniform sampler2D picture, depths;
uniform int fine;
uniform float deep, spread, spreadPixels, hollowness, darkest;
out vec4 colour;
ivec2 size;
float depth(ivec2 at) { return (1.0 - 2.0 * texelFetch(depths, clamp(at, ivec2(0), size - 1), 0).r) * deep; }
void main() {
  size = textureSize(picture, 0);
  ivec2 from = ivec2(gl_FragCoord.xy) * fine;
  vec4 sum = vec4(0);
  for (int k = 0; k < fine * fine; k++) {
    ivec2 at = from + ivec2(k % fine, k / fine);
    vec4 c = texelFetch(picture, at, 0);
    if (c.a == 0.0) continue;
    float d = depth(at), hollow = 0.0;
    // of opposite sides the mean: slopes are no hollows
    for (int a = 0; a < 4; a++) {
      float angle = 0.7853981634 * float(a);
      ivec2 beside = ivec2(round(max(1.0, spreadPixels) * vec2(cos(angle), sin(angle))));
      vec2 off = clamp(vec2(depth(at + beside) - d, depth(at - beside) - d) / spread, -4.0, 4.0);
      hollow += max(0.0, 0.5 * (off.x + off.y));
    }
    sum += vec4(c.rgb * max(darkest, 1.0 - hollowness * hollow / 4.0), 1.0);
  }
  colour = sum / float(fine * fine);
}`;

class Graphics {
  constructor(canvas) {
    this.canvas = canvas;
    const gl = canvas.getContext("webgl2", { antialias: false, preserveDrawingBuffer: true, premultipliedAlpha: true });
    if (!gl) throw new Error("no WebGL2");
    this.gl = gl;
    this.name = "webgl2";
    this.largest = gl.getParameter(gl.ALIASED_POINT_SIZE_RANGE)[1];
    this.cubes = this.program(POINTS, SURFACE);
    this.steel = this.program(CORNERS, STEEL);
    this.corners = [0, 1].map(() => gl.createBuffer());
    this.surface = gl.createVertexArray();
    this.finish = this.program(WHOLE, FINISH);
    this.buffers = [0, 1, 2].map(() => gl.createBuffer());
    this.array = gl.createVertexArray();
    this.empty = gl.createVertexArray();
    this.lut = gl.createTexture();
    this.picture = gl.createTexture();
    this.depth = gl.createTexture();
    this.frame = gl.createFramebuffer();
    gl.bindVertexArray(this.array);
    [3, 3, 1].forEach((n, k) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[k]);
      gl.enableVertexAttribArray(k);
      gl.vertexAttribPointer(k, n, gl.FLOAT, false, 0, 0);
    });
  }

  program(vertex, fragment) {
    const { gl } = this;
    const program = gl.createProgram();
    for (const [kind, text] of [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]]) {
      const shader = gl.createShader(kind);
      gl.shaderSource(shader, text);
      gl.compileShader(shader);
      gl.attachShader(program, shader);
      if (!gl.getShaderParameter(shader, gl.COMPILE_STATUS)) throw new Error(gl.getShaderInfoLog(shader) ?? "lost");
    }
    gl.linkProgram(program);
    if (!gl.getProgramParameter(program, gl.LINK_STATUS)) throw new Error(gl.getProgramInfoLog(program) ?? "lost");
    const at = {};
    for (let k = 0; k < gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS); k++) {
      const { name } = gl.getActiveUniform(program, k);
      at[name] = gl.getUniformLocation(program, name);
    }
    return { program, at };
  }

  points({ reference, moved, value }) {
    const { gl } = this;
    this.count = value.length;
    const side = all => {
      const out = new Float32Array(3 * all[0].length);
      all.forEach((c, a) => c.forEach((x, i) => (out[3 * i + a] = x)));
      return out;
    };
    const put = (k, data) => {
      gl.bindBuffer(gl.ARRAY_BUFFER, this.buffers[k]);
      gl.bufferData(gl.ARRAY_BUFFER, data, gl.DYNAMIC_DRAW);
    };
    if (reference !== this.reference) put(0, side((this.reference = reference)));
    if (moved !== this.moved) put(1, side((this.moved = moved)));
    put(2, value);
  }

  targets(w, h) {
    const { gl } = this;
    if (this.size === `${w} ${h}`) return;
    this.size = `${w} ${h}`;
    const texture = (texture, inner, format, type) => {
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.texImage2D(gl.TEXTURE_2D, 0, inner, w, h, 0, format, type, null);
      for (const key of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, key, gl.NEAREST);
    };
    texture(this.picture, gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE);
    texture(this.depth, gl.DEPTH_COMPONENT24, gl.DEPTH_COMPONENT, gl.UNSIGNED_INT);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.frame);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.COLOR_ATTACHMENT0, gl.TEXTURE_2D, this.picture, 0);
    gl.framebufferTexture2D(gl.FRAMEBUFFER, gl.DEPTH_ATTACHMENT, gl.TEXTURE_2D, this.depth, 0);
  }

  draw(view) {
    const { gl } = this;
    const fine = view.fine;
    const [w, h] = [this.canvas.width * fine, this.canvas.height * fine];
    this.targets(w, h);
    gl.bindFramebuffer(gl.FRAMEBUFFER, this.frame);
    gl.viewport(0, 0, w, h);
    gl.clearColor(0, 0, 0, 0);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    gl.enable(gl.DEPTH_TEST);
    gl.disable(gl.BLEND);
    gl.useProgram(this.cubes.program);
    gl.activeTexture(gl.TEXTURE0);
    gl.bindTexture(gl.TEXTURE_2D, this.lut);
    gl.texImage2D(gl.TEXTURE_2D, 0, gl.RGBA8, 256, 1, 0, gl.RGBA, gl.UNSIGNED_BYTE, view.colours);
    for (const key of [gl.TEXTURE_MIN_FILTER, gl.TEXTURE_MAG_FILTER]) gl.texParameteri(gl.TEXTURE_2D, key, gl.NEAREST);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    let { at } = this.cubes;
    for (const name of ["right", "up", "eye", "middle"]) gl.uniform3fv(at[name], view[name]);
    gl.uniform3fv(at.light, LIGHT);
    const axis = [0, 0, 0];
    if (view.cut) axis[view.cut.axis] = view.cut.side;
    gl.uniform3fv(at.cutAxis, axis);
    gl.uniform1f(at.cutAt, view.cut ? view.cut.at * view.cut.side : 1);
    gl.uniform2fv(at.shift, view.shift);
    gl.uniform2f(at.screen, w, h);
    gl.uniform2fv(at.reach, extent(view));
    gl.uniform1f(at.pixels, view.pixels * fine);
    gl.uniform1f(at.stretch, view.stretch);
    gl.uniform1f(at.deep, view.deep);
    gl.uniform1f(at.low, view.low);
    gl.uniform1f(at.high, view.high);
    gl.uniform1f(at.halfEdge, view.half);
    gl.uniform1f(at.ambient, AMBIENT);
    gl.uniform1i(at.balls, view.balls ? 1 : 0);
    gl.uniform1i(at.colours, 0);
    gl.bindVertexArray(this.array);
    gl.drawArrays(gl.POINTS, 0, this.count);
    // indenters: a point each, without a value
    gl.bindVertexArray(this.empty);
    gl.uniform3f(at.cutAxis, 0, 0, 0);
    gl.uniform1f(at.cutAt, 1);
    gl.uniform1i(at.balls, 1);
    // a point may be too small for a ball
    const large = radius => 2 * radius * view.pixels * fine > this.largest;
    for (const { center, radius, triangles: own } of view.bodies) {
      if (own || large(radius)) continue;
      gl.uniform1f(at.halfEdge, radius);
      gl.uniform2f(at.reach, radius, radius);
      gl.vertexAttrib3fv(0, center);
      gl.vertexAttrib3f(1, 0, 0, 0);
      gl.vertexAttrib1f(2, NaN);
      gl.drawArrays(gl.POINTS, 0, 1);
    }

    this.faces(view, triangles(view.bodies, large), [w, h], fine);
    gl.bindFramebuffer(gl.FRAMEBUFFER, null);
    gl.viewport(0, 0, this.canvas.width, this.canvas.height);
    gl.disable(gl.DEPTH_TEST);
    gl.useProgram(this.finish.program);
    ({ at } = this.finish);
    gl.bindTexture(gl.TEXTURE_2D, this.picture);
    gl.activeTexture(gl.TEXTURE1);
    gl.bindTexture(gl.TEXTURE_2D, this.depth);
    gl.uniform1i(at.picture, 0);
    gl.uniform1i(at.depths, 1);
    gl.uniform1i(at.fine, fine);
    gl.uniform1f(at.deep, view.deep);
    gl.uniform1f(at.spread, view.spread);
    gl.uniform1f(at.spreadPixels, view.spread * view.pixels * fine);
    gl.uniform1f(at.hollowness, HOLLOW);
    gl.uniform1f(at.darkest, DARKEST);
    gl.bindVertexArray(this.empty);
    gl.drawArrays(gl.TRIANGLES, 0, 3);
  }
}

/** Corners of triangles with what they face. */
Graphics.prototype.faces = function (view, all, screen, fine) {
  if (!all.length) return;
  const { gl } = this;
  const { program, at } = this.steel;
  gl.useProgram(program);
  gl.bindVertexArray(this.surface);
  this.corners.forEach((buffer, k) => {
    gl.bindBuffer(gl.ARRAY_BUFFER, buffer);
    gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(all.flatMap(c => c[k])), gl.DYNAMIC_DRAW);
    gl.enableVertexAttribArray(k);
    gl.vertexAttribPointer(k, 3, gl.FLOAT, false, 0, 0);
  });
  for (const name of ["right", "up", "eye", "middle"]) gl.uniform3fv(at[name], view[name]);
  gl.uniform3fv(at.light, LIGHT);
  gl.uniform2fv(at.shift, view.shift);
  gl.uniform2fv(at.screen, screen);
  gl.uniform1f(at.pixels, view.pixels * fine);
  gl.uniform1f(at.deep, view.deep);
  gl.uniform1f(at.ambient, AMBIENT);
  gl.drawArrays(gl.TRIANGLES, 0, all.length);
};

/** What draws into a canvas: WebGL2, or loops (also asked for by `#loops` behind the address). */
function renderer(canvas) {
  if (location.hash !== "#loops") {
    try {
      return new Graphics(canvas);
    } catch (error) {
      console.info(`drawn without WebGL2: ${error.message}`);
      // a canvas that was asked for one context gives no other
      const fresh = canvas.cloneNode();
      canvas.replaceWith(fresh);
      canvas = fresh;
    }
  }
  return new Loops(canvas);
}
