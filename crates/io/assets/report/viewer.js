// The body: field, time, cut, deformation, view. One viewer shows one scene; 1-D scenes are curves over the reference position.

const AXES = ["x", "y", "z"];
const MARKS = { crack: "#30353d", support: "#2e549e", load: "#00704f" };
const id = name => document.getElementById(name);

class Viewer {
  constructor() {
    this.draw = renderer(id("view"));
    this.canvas = this.draw.canvas;
    this.onframe = [];
    this.ratio = 1;
    this.playing = null;
    this.cut = { axis: -1, part: 50, other: false };
    this.listen();
    new ResizeObserver(() => this.fit()).observe(id("stage"));
  }

  async open(scene) {
    this.scene = scene;
    this.flat = scene.dimension < 3;
    this.line = scene.dimension === 1;
    id("stage").classList.toggle("curve", this.line);
    for (const part of document.querySelectorAll(".solid")) part.hidden = this.line;
    await this.bounds();
    this.bodies = new Bodies(scene.balls, scene, this.low, this.high);
    this.frame = scene.frames.length - 1;
    this.fields();
    const last = scene.frames.length - 1;
    id("frame").max = last;
    id("timeline").hidden = last === 0;
    this.stretches();
    this.home();
    id("spheresBox").hidden = this.line || !scene.balls.length;
    await this.marked();
    this.torn = scene.shown.find(f => f.name === "damage");
    id("onlyBox").hidden = this.line || !this.torn;
    if (!this.torn) id("only").value = "all";
    id("balls").value = scene.atoms ? "balls" : "cubes";
    if (this.line) {
      this.curve ??= new Plot(id("curve"), "Profile");
    }
    this.drag(this.flat ? "move" : "turn");
    await this.show();
  }

  /** Marks of the scene, each with the point that carries it, and what they are in words. */
  async marked() {
    const { marks } = this.scene;
    const { cracks = [], supports = [], loads = [] } = this.line ? {} : marks ?? {};
    const at = await this.scene.places();
    const nearest = p => {
      let [best, found] = [Infinity, 0];
      for (let i = 0; i < this.scene.points; i++) {
        let square = 0;
        for (let a = 0; a < 3; a++) square += (at[a][i] - p[a]) ** 2;
        if (square < best) [best, found] = [square, i];
      }
      return found;
    };
    const carried = m => ({ ...m, point: nearest(m.at) });
    this.done = { cracks, supports: supports.map(carried), loads: loads.map(carried) };
    const parts = [["loads", loads], ["supports", supports], ["cracks", cracks]].filter(([, all]) => all.length).map(([name]) => name);
    id("marksBox").hidden = !parts.length;
    id("marksName").textContent = capital(parts.join(", "));
    const said = [...new Set([...loads, ...supports].map(m => capital(m.says)))];
    id("marksSays").replaceChildren(...said.map(s => make("li", {}, s)));
  }

  /** Corners of the reference, sizes, default edge. */
  async bounds() {
    const at = await this.scene.places();
    this.low = at.map(c => c.reduce((a, b) => Math.min(a, b), Infinity));
    this.high = at.map(c => c.reduce((a, b) => Math.max(a, b), -Infinity));
    const half = 0.5 * this.scene.spacing;
    this.middle = this.low.map((l, a) => 0.5 * (l + this.high[a]));
    this.extents = this.low.map((l, a) => this.high[a] - l + 2 * half * (a < this.scene.dimension));
    this.size = Math.max(...this.extents);
    // most of what the last frame shows is in the picture, too; what flies away is not
    const last = await this.scene.displacement(this.scene.frames.length - 1);
    const every = Math.ceil(this.scene.points / 4000);
    this.reach = at.map((c, a) => {
      const some = [];
      for (let i = 0; i < c.length; i += every) if (Number.isFinite(last[a][i])) some.push([c[i], last[a][i]]);
      return some;
    });
  }

  // ---- what is shown

  fields() {
    const { scene } = this;
    const field = id("field");
    field.replaceChildren(...scene.shown.map(f => make("option", { value: f.name }, capital(words(f.name)))));
    field.value = scene.first;
    this.components();
  }

  get field() {
    return this.scene.shown.find(f => f.name === id("field").value) ?? this.scene.shown[0];
  }

  components() {
    this.fresh = true;
    const { field, scene } = this;
    const last = scene.frames.length - 1;
    const used = field.components.map((name, c) => ({ name, c, range: scene.range(field, c, 0, last) })).filter(o => o.range[0] !== o.range[1]);
    const many = field.components.length > 1;
    const whole = field.kind === "vector" ? "length" : "size";
    const options = [many ? make("option", { value: -1 }, whole) : null, ...used.map(o => make("option", { value: o.c }, o.name))];
    const select = id("component");
    select.replaceChildren(...options.filter(o => o));
    // along a line the component says more
    if (many && this.line && used.length) select.value = used[0].c;
    id("componentBox").hidden = !many || used.length === 0;
    this.colours();
  }

  get component() {
    return this.field.components.length > 1 ? Number(id("component").value) : 0;
  }

  /** Picks the map that fits: kinds, two-sided, or one-sided. */
  colours() {
    const [low, high] = this.scene.range(this.field, this.component, 0, this.scene.frames.length - 1);
    const signed = low < 0 && high > 0 && Math.min(-low, high) > 0.1 * Math.max(-low, high);
    id("map").value = signed ? "diverging" : "viridis";
    id("mapBox").hidden = this.line || this.field.kind === "integer";
  }

  /** Bounds that leave a hundredth of the points of this frame out at each end. */
  get most() {
    const { value } = this.shown;
    if (this.mostOf !== value) {
      const every = Math.ceil(value.length / 20000);
      const some = value.filter((v, i) => i % every === 0 && Number.isFinite(v)).sort();
      this.mostOf = value;
      this.mostIs = [some[Math.floor(0.01 * some.length)] ?? 0, some[Math.ceil(0.99 * some.length) - 1] ?? 0];
    }
    return this.mostIs;
  }

  get range() {
    const [from, to] = id("range").value === "frame" && this.field.kind !== "integer" ? [this.frame, this.frame] : [0, this.scene.frames.length - 1];
    let [low, high] = this.scene.range(this.field, this.component, from, to);
    if (id("range").value === "most" && this.field.kind !== "integer") [low, high] = this.most;
    return low < high ? [low, high] : [low, low + (Math.abs(low) || 1)];
  }

  /** The deformation is shown larger where nobody would see it. */
  stretches() {
    const { scene } = this;
    const moved = { name: "displacement" };
    const last = scene.frames.length - 1;
    const [, most] = scene.range(moved, -1, 0, last);
    this.auto = most > 0 && !scene.atoms && most < 0.02 * this.size ? round125((0.06 * this.size) / most) : 1;
    const loud = scene.kind === "modes" || scene.statics;
    id("stretch").value = loud ? this.auto : 1;
    id("auto").hidden = this.auto === 1;
    id("auto").textContent = `×${plain(this.auto)}`;
    id("stretchBox").hidden = this.line || most === 0;
  }

  get stretch() {
    const value = id("stretch").valueAsNumber;
    return Number.isFinite(value) ? value : 1;
  }

  async show() {
    const turn = (this.turns = (this.turns ?? 0) + 1);
    const { scene, frame, field, component } = this;
    const torn = id("only").value === "torn" && this.torn;
    const [reference, all, value, damage] = await Promise.all([scene.places(), scene.displacement(frame), scene.values(field, component, frame), torn ? scene.values(torn, 0, frame) : null]);
    // somebody was faster
    if (turn !== this.turns) return;
    // what has no place is not drawn
    const least = id("onlyAt").valueAsNumber / 100;
    const moved = torn ? all.map(c => c.map((x, i) => (damage[i] >= least ? x : NaN))) : all;
    this.shown = { reference, moved, all, value };
    if (this.fresh) {
      this.fresh = false;
      // a few points that fly away must not leave one colour to all others
      const [low, high] = scene.range(field, component, 0, scene.frames.length - 1);
      const long = this.most[1] - this.most[0] < 0.35 * (high - low) && this.most[1] > this.most[0];
      id("range").value = long && !this.line ? "most" : "all";
    }
    const f = scene.frames[frame];
    const [name, text] = scene.axis === "time" || scene.axis === "t" ? ["t", quantity(f.value, scene.unit)] : [scene.axis, quantity(f.value, scene.unit)];
    const label = scene.kind === "modes" ? `mode ${f.step}, ${text}` : scene.statics ? `increment ${f.step}` : `${name} = ${text}`;
    id("frame").value = frame;
    id("frame").setAttribute("aria-valuetext", `${label}, frame ${frame + 1} of ${scene.frames.length}`);
    id("when").textContent = label;
    id("whenCount").textContent = `${frame + 1} / ${scene.frames.length}`;
    this.bar();
    if (this.line) this.profile();
    else {
      // kinds take turns in colours
      const drawn = field.kind === "integer" ? value.map(v => this.range[0] + ((v - this.range[0]) % 252)) : value;
      this.draw.points({ reference, moved, value: drawn });
      this.paint();
    }
    for (const told of this.onframe) told(scene, frame);
    document.body.dataset.shown = `${scene.kind} ${frame} ${field.name} ${component}`;
  }

  profile() {
    const { reference, value } = this.shown;
    const order = [...reference[0].keys()].sort((a, b) => reference[0][a] - reference[0][b]);
    const { field } = this;
    const part = field.components.length > 1 && this.component >= 0 ? ` ${field.components[this.component]}` : "";
    const take = c => order.map(i => (Number.isFinite(c[i]) ? c[i] : null));
    this.curve.show({
      x: { name: "x", unit: this.scene.length, values: take(reference[0]) },
      lines: [{ name: field.name + part, unit: field.unit, values: take(value) }],
      box: id("range").value !== "all" ? undefined : this.scene.range(field, this.component, 0, this.scene.frames.length - 1),
      timed: true,
      plain: true,
    });
  }

  bar() {
    const { field } = this;
    const [low, high] = this.range;
    const part = field.components.length > 1 ? `, ${this.component < 0 ? (field.kind === "vector" ? "length" : "size") : field.components[this.component]}` : "";
    const s = scaled(Math.max(Math.abs(low), Math.abs(high)), field.unit);
    id("barName").textContent = capital(words(field.name)) + part + (s.unit ? ` (${s.unit})` : "");
    id("fieldSays").textContent = field.says ?? "";
    const kinds = field.kind === "integer";
    id("bar").hidden = kinds || this.line;
    id("kinds").hidden = !kinds || this.line;
    id("barBox").hidden = this.line;
    if (kinds) {
      const most = 10;
      const all = [];
      for (let k = low; k <= high && all.length < most; k++) all.push(k);
      const name = k => field.names?.[k] ?? plain(k);
      const items = all.map(k => make("li", {}, make("span", { class: "swatch", style: `background:${kindColour(k - low)}` }), name(k)));
      if (high - low + 1 > most) items.push(make("li", {}, `… ${plain(high)}`));
      id("kinds").replaceChildren(...items);
      return;
    }
    id("colours").style.background = gradient(id("map").value, low, high);
    const at = v => (100 * (v - low)) / (high - low);
    const marks = ticks(low / s.factor, high / s.factor, 5);
    const first = marks.length < 2 ? [low / s.factor, high / s.factor] : marks;
    id("barTicks").replaceChildren(...first.map(t => make("span", { style: `left:${at(t * s.factor)}%` }, plain(t))));
  }

  // ---- camera

  home(which) {
    const { extents: e } = this;
    // thin axis up, unless all are alike; the long one to the right
    const thin = this.flat ? 2 : e.reduce((best, x, a) => (x * 1.5 < e[best] ? a : best), 2);
    this.axis = thin;
    const straight = { x: [[0, 1, 0], [0, 0, 1]], y: [[1, 0, 0], [0, 0, 1]], z: [[1, 0, 0], [0, 1, 0]] };
    if (this.flat && which === undefined) which = "z";
    if (which) {
      const [right, up] = straight[which];
      [this.right, this.up] = [right.slice(), up.slice()];
      if (which === "y") this.right = [1, 0, 0];
    } else {
      const up = [0, 0, 0];
      up[thin] = 1;
      const others = [0, 1, 2].filter(a => a !== thin);
      const long = others.reduce((best, a) => (e[a] > 1.02 * e[best] ? a : best), others[0]);
      const right = [0, 0, 0];
      right[long] = 1;
      [this.right, this.up] = [right, up];
      this.turn(-0.45, 0);
      this.turn(0, 0.6);
    }
    this.shift = [0, 0];
    this.zoom = 1;
    this.frameAll();
    this.paint();
  }

  /** The box that the picture shows: the body, and most of its points where they end. */
  frameAll() {
    const half = 0.5 * this.scene.spacing;
    const box = this.reach.map((some, a) => {
      const end = some.map(([x, u]) => x + this.stretch * u).sort((p, q) => p - q);
      const at = part => end[Math.round(part * (end.length - 1))] ?? this.low[a];
      return [Math.min(this.low[a], at(0.02)), Math.max(this.high[a], at(0.98))];
    });
    // rigid bodies in the first frame and the last
    const { frames } = this.scene;
    for (const { value } of [frames[0], frames.at(-1)]) {
      for (const x of this.bodies.ends(value)) box.forEach((b, a) => ([b[0], b[1]] = [Math.min(b[0], x[a]), Math.max(b[1], x[a])]));
    }
    this.middle = box.map(([l, h]) => 0.5 * (l + h));
    this.shownBox = box.map(([l, h], a) => h - l + 2 * half * (a < this.scene.dimension));
  }

  get eye() {
    return cross(this.right, this.up);
  }

  /** Turns by angles about the upright axis of the body, and about the horizontal one of the screen. */
  turn(about, over) {
    const rotate = (v, k, angle) => {
      const [c, s] = [Math.cos(angle), Math.sin(angle)];
      const kv = cross(k, v);
      const kk = dot(k, v) * (1 - c);
      return v.map((x, a) => x * c + kv[a] * s + k[a] * kk);
    };
    const upright = [0, 0, 0];
    upright[this.axis] = 1;
    const sign = dot(this.up, upright) < 0 ? -1 : 1;
    if (about) {
      this.right = rotate(this.right, upright, -sign * about);
      this.up = rotate(this.up, upright, -sign * about);
    }
    if (over) this.up = rotate(this.up, this.right, -over);
    this.right = normal(this.right);
    this.up = normal(cross(cross(this.right, this.up), this.right));
  }

  fit() {
    const box = id("stage").getBoundingClientRect();
    if (!box.width) return;
    const ratio = Math.min(2, window.devicePixelRatio || 1);
    this.canvas.width = Math.max(1, Math.round(box.width * ratio));
    this.canvas.height = Math.max(1, Math.round(box.height * ratio));
    this.ratio = ratio;
    this.paint();
  }

  /** Pixels of the canvas for a unit of length. */
  get pixels() {
    const { width: w, height: h } = this.canvas;
    const reach = axis => [0, 1, 2].reduce((sum, a) => sum + Math.abs(axis[a]) * this.shownBox[a], 0);
    return 0.9 * this.zoom * Math.min(w / reach(this.right), h / reach(this.up));
  }

  paint() {
    if (!this.scene || this.line) return;
    if (this.waiting) return;
    this.waiting = requestAnimationFrame(() => {
      this.waiting = null;
      this.now();
    });
  }

  now() {
    if (!this.shown || this.line) return;
    const { scene } = this;
    const [low, high] = this.range;
    const integer = this.field.kind === "integer";
    const axis = this.cut.axis;
    const most = 1.2 * Math.hypot(...this.extents, ...this.shownBox) + this.stretch * scene.range({ name: "displacement" }, -1, 0, scene.frames.length - 1)[1];
    this.view = {
      right: this.right, up: this.up, eye: this.eye, middle: this.middle, shift: this.shift, pixels: this.pixels,
      stretch: this.stretch, half: 0.5 * scene.spacing * (scene.atoms ? 0.95 : 1.04), balls: id("balls").value === "balls",
      low, high: integer ? low + 255 : high, colours: integer ? kinds() : table(id("map").value, low, high),
      deep: most, spread: 1.6 * scene.spacing, fine: this.ratio > 1.4 ? 1 : 2,
      cut: axis < 0 ? null : {
        axis,
        at: this.low[axis] - 0.5 * scene.spacing + (this.cut.part / 100) * this.extents[axis],
        side: this.cut.other ? -1 : 1,
      },
    };
    this.view.bodies = id("spheres").checked ? this.bodies.at(scene.frames[this.frame].value) : [];
    const far = ({ center, radius, corner }) => Math.max(...(corner ?? [center]).map(x => Math.hypot(...x.map((c, a) => c - this.middle[a])))) + (radius || 0);
    this.view.deep = Math.max(most, ...this.view.bodies.map(far));
    this.draw.draw(this.view);
    this.marks();
  }

  /** Scale bar, axes, note of the deformation. */
  marks() {
    const px = this.view.pixels / this.ratio;
    const width = this.canvas.width / this.ratio;
    const length = round125((0.28 * Math.min(width, 700)) / px);
    id("scaleBar").style.width = `${length * px}px`;
    id("scaleText").textContent = quantity(length, this.scene.length) || plain(length);
    const lines = [0, 1, 2].slice(0, this.flat ? 2 : 3).map(a => [this.right[a] * 24, -this.up[a] * 24, a]);
    id("triad").replaceChildren(...lines.flatMap(([x, y, a]) => [
      make("line", { x1: 0, y1: 0, x2: x, y2: y }),
      Math.hypot(x, y) > 6 ? make("text", { x: 1.4 * x, y: 1.4 * y + 4, "text-anchor": "middle" }, AXES[a]) : null,
    ]).filter(n => n));
    this.draws();
    const note = this.stretch === 1 || id("stretchBox").hidden ? "" : `displacements ×${plain(this.stretch)}`;
    id("note").textContent = note;
  }

  /** Lines of loads, supports and cracks on the canvas (pixels of the page). */
  draws() {
    const { view, shown } = this;
    const [w, h, px] = [this.canvas.width / this.ratio, this.canvas.height / this.ratio, view.pixels / this.ratio];
    const place = (at, point) => {
      const p = at.map((x, a) => x + (point === undefined ? 0 : view.stretch * (shown.all[a][point] || 0)) - view.middle[a]);
      return [w / 2 + dot(p, view.right) * px - (view.shift[0] * view.pixels) / this.ratio, h / 2 - dot(p, view.up) * px + (view.shift[1] * view.pixels) / this.ratio];
    };
    const path = (points, close = "") => `M${points.map(p => p.map(x => x.toFixed(1)).join(" ")).join("L")}${close}`;
    const lines = [];
    const { cracks, supports, loads } = id("marksOn").checked ? this.done : { cracks: [], supports: [], loads: [] };
    for (const crack of cracks) lines.push([path(crack.map(c => place(c))), "crack"]);
    for (const { at, point } of supports) {
      const [x, y] = place(at, point);
      lines.push([path([[x, y], [x - 6, y + 10], [x + 6, y + 10]], "Z"), "support"]);
    }
    for (const { at, point, toward } of loads) {
      const [x, y] = place(at, point);
      const d = [dot(toward, view.right), -dot(toward, view.up)];
      const part = Math.hypot(...d);
      // towards the eye, or away from it
      if (part < 0.25) {
        lines.push([`M${x - 5} ${y}a5 5 0 1 0 10 0a5 5 0 1 0 -10 0`, "load"]);
        continue;
      }
      const [ux, uy] = d.map(c => c / part);
      const tip = [x + 30 * d[0], y + 30 * d[1]];
      const barb = side => [tip[0] - 8 * ux + side * 4.5 * uy, tip[1] - 8 * uy - side * 4.5 * ux];
      lines.push([path([[x, y], tip]) + path([barb(1), tip, barb(-1)]), "load"]);
    }
    this.lines = lines;
    const svg = id("marks");
    svg.setAttribute("viewBox", `0 0 ${w} ${h}`);
    svg.replaceChildren(...lines.flatMap(([d, kind]) => [make("path", { d, class: "halo" }), make("path", { d, class: kind })]));
  }

  /** The picture with its marks. */
  whole(paper) {
    const { width: w, height: h } = this.canvas;
    const out = make("canvas", { width: w, height: h });
    const c = out.getContext("2d");
    if (paper) {
      c.fillStyle = paper;
      c.fillRect(0, 0, w, h);
    }
    c.drawImage(this.canvas, 0, 0);
    c.scale(this.ratio, this.ratio);
    c.lineJoin = c.lineCap = "round";
    for (const [d, kind] of this.lines ?? []) {
      const shape = new Path2D(d);
      [c.lineWidth, c.strokeStyle] = [4.5, "#fff"];
      c.stroke(shape);
      [c.lineWidth, c.strokeStyle] = [2, MARKS[kind]];
      c.stroke(shape);
    }
    return out;
  }

  // ---- pointing

  /** The point under a place of the canvas (pixels of the page). */
  pick(x, y) {
    const { view, shown } = this;
    const [mx, my] = [((x * this.ratio - this.canvas.width / 2) / view.pixels) + view.shift[0], -((y * this.ratio - this.canvas.height / 2) / view.pixels) + view.shift[1]];
    const reach = Math.max(view.half * 1.2, 2 / view.pixels);
    let [best, found] = [-Infinity, -1];
    for (let i = 0; i < shown.value.length; i++) {
      const p = [0, 1, 2].map(a => shown.reference[a][i] + view.stretch * shown.moved[a][i] - view.middle[a]);
      if (Math.abs(dot(p, view.right) - mx) > reach || Math.abs(dot(p, view.up) - my) > reach) continue;
      if (cutAway(view, shown, i)) continue;
      const d = dot(p, view.eye);
      if (d > best) [best, found] = [d, i];
    }
    return found;
  }

  say(event) {
    if (!this.view) return;
    const box = this.canvas.getBoundingClientRect();
    const i = this.pick(event.clientX - box.left, event.clientY - box.top);
    const tip = id("tip");
    tip.hidden = i < 0;
    if (i < 0) return;
    const { reference, moved, value } = this.shown;
    const place = AXES.slice(0, this.flat ? 2 : 3).map((_, a) => quantity(reference[a][i] + moved[a][i], this.scene.length, 4));
    const shown = this.field.kind === "integer" ? this.field.names?.[value[i]] ?? plain(value[i]) : quantity(value[i], this.field.unit, 3);
    const parts = [make("b", {}, shown), ` ${words(this.field.name)}`, make("br"), `point ${count(i * this.scene.stride + 1)} at (${place.join(", ")})`];
    tip.replaceChildren(...parts);
    const [left, top] = [event.clientX - box.left, event.clientY - box.top];
    tip.style.left = `${Math.min(left + 14, Math.max(0, box.width - 210))}px`;
    tip.style.top = `${Math.max(0, top - 54)}px`;
  }

  drag(what) {
    this.moves = what === "move";
    id("turn").setAttribute("aria-pressed", String(!this.moves));
    id("move").setAttribute("aria-pressed", String(this.moves));
  }

  zoomBy(factor, x = 0, y = 0) {
    const before = this.pixels;
    const most = 60 * Math.max(1, this.size / (this.scene.spacing * 60));
    this.zoom = Math.min(most, Math.max(0.2, this.zoom * factor));
    const after = this.pixels;
    // what is under the pointer stays there
    this.shift = [this.shift[0] + x / before - x / after, this.shift[1] - y / before + y / after];
    this.paint();
  }

  listen() {
    const stage = id("stage");
    const held = new Map();
    let gap = 0;
    const canvas = this.canvas;
    canvas.addEventListener("pointerdown", e => {
      canvas.setPointerCapture(e.pointerId);
      held.set(e.pointerId, [e.clientX, e.clientY]);
      canvas.focus({ preventScroll: true });
      id("tip").hidden = true;
      this.still = [e.clientX, e.clientY];
    });
    canvas.addEventListener("pointermove", e => {
      const last = held.get(e.pointerId);
      if (!last) {
        if (e.pointerType === "mouse" && !this.hovering) {
          this.hovering = setTimeout(() => {
            this.hovering = null;
            if (!held.size) this.say(e);
          }, 60);
        }
        return;
      }
      const [dx, dy] = [e.clientX - last[0], e.clientY - last[1]];
      held.set(e.pointerId, [e.clientX, e.clientY]);
      if (held.size === 2) {
        const [a, b] = [...held.values()];
        const now = Math.hypot(a[0] - b[0], a[1] - b[1]);
        if (gap) this.zoomBy(now / gap);
        gap = now;
        this.pan(dx / 2, dy / 2);
      } else if (this.moves !== (e.shiftKey || e.buttons === 2 || e.buttons === 4)) this.pan(dx, dy);
      else {
        this.turn(dx * 0.008, dy * 0.008);
        this.paint();
      }
    });
    const up = e => {
      if (held.delete(e.pointerId) && this.still && Math.hypot(e.clientX - this.still[0], e.clientY - this.still[1]) < 5 && e.type === "pointerup") this.say(e);
      gap = 0;
    };
    canvas.addEventListener("pointerup", up);
    canvas.addEventListener("pointercancel", up);
    canvas.addEventListener("pointerleave", () => setTimeout(() => (id("tip").hidden = true), 80));
    canvas.addEventListener("contextmenu", e => e.preventDefault());
    canvas.addEventListener("wheel", e => {
      // a page that scrolls by goes on scrolling
      if (document.activeElement !== canvas && !e.ctrlKey) return;
      e.preventDefault();
      const box = canvas.getBoundingClientRect();
      const at = [e.clientX - box.left - box.width / 2, e.clientY - box.top - box.height / 2].map(v => v * this.ratio);
      this.zoomBy(Math.exp(-e.deltaY * (e.deltaMode ? 0.05 : 0.0015)), ...at);
    }, { passive: false });
    canvas.addEventListener("keydown", e => this.key(e));
    stage.addEventListener("dblclick", () => this.home());

    id("field").addEventListener("change", () => { this.components(); this.show(); });
    id("component").addEventListener("change", () => { this.fresh = true; this.colours(); this.show(); });
    for (const name of ["map", "range"]) id(name).addEventListener("change", () => { this.bar(); this.line ? this.profile() : this.paint(); });
    id("frame").addEventListener("input", () => { this.stop(); this.go(id("frame").valueAsNumber); });
    id("play").addEventListener("click", () => (this.playing ? this.stop() : this.play()));
    for (const name of ["balls", "spheres", "marksOn"]) id(name).addEventListener("change", () => this.paint());
    id("stretch").addEventListener("input", () => this.paint());
    id("auto").addEventListener("click", () => { id("stretch").value = this.auto; this.frameAll(); this.paint(); });
    id("true").addEventListener("click", () => { id("stretch").value = 1; this.frameAll(); this.paint(); });
    id("only").addEventListener("change", () => this.only());
    id("onlyAt").addEventListener("input", () => this.only());
    id("cutAxis").addEventListener("change", () => {
      this.cut.axis = Number(id("cutAxis").value);
      id("cutBox").hidden = this.cut.axis < 0;
      this.cutAt();
    });
    id("cutAt").addEventListener("input", () => this.cutAt());
    id("cutSide").addEventListener("change", () => this.cutAt());
    id("turn").addEventListener("click", () => this.drag("turn"));
    id("move").addEventListener("click", () => this.drag("move"));
    id("fit").addEventListener("click", () => this.home());
    for (const axis of AXES) id(`see${axis}`).addEventListener("click", () => this.home(axis));
    id("in").addEventListener("click", () => this.zoomBy(1.25));
    id("out").addEventListener("click", () => this.zoomBy(0.8));
    id("save").addEventListener("click", () => this.save());
  }

  only() {
    id("onlyAtBox").hidden = id("only").value === "all";
    const text = `damage of ${plain(id("onlyAt").valueAsNumber / 100)} or more`;
    id("onlyText").textContent = text;
    id("onlyAt").setAttribute("aria-valuetext", text);
    this.show();
  }

  cutAt() {
    this.cut.part = id("cutAt").valueAsNumber;
    this.cut.other = id("cutSide").checked;
    if (this.cut.axis >= 0) {
      const a = this.cut.axis;
      const at = this.low[a] - 0.5 * this.scene.spacing + (this.cut.part / 100) * this.extents[a];
      const text = `${AXES[a]} = ${quantity(at, this.scene.length, 3)}`;
      id("cutText").textContent = text;
      id("cutAt").setAttribute("aria-valuetext", text);
    }
    this.paint();
  }

  pan(dx, dy) {
    const px = this.pixels / this.ratio;
    this.shift = [this.shift[0] - dx / px, this.shift[1] + dy / px];
    this.paint();
  }

  key(e) {
    const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[e.key];
    if (step) {
      if (this.moves !== e.shiftKey) this.pan(30 * step[0], 30 * step[1]);
      else this.turn(0.12 * step[0], 0.12 * step[1]);
    } else if (e.key === "+" || e.key === "=") this.zoomBy(1.25);
    else if (e.key === "-") this.zoomBy(0.8);
    else if (e.key === "0") this.home();
    else if (AXES.includes(e.key)) this.home(e.key);
    else if (e.key === "," || e.key === "PageDown") this.go(this.frame - 1);
    else if (e.key === "." || e.key === "PageUp") this.go(this.frame + 1);
    else if (e.key === " ") id("play").click();
    else return;
    e.preventDefault();
    this.paint();
  }

  // ---- time

  async go(frame) {
    const last = this.scene.frames.length - 1;
    this.frame = Math.min(last, Math.max(0, frame));
    await this.show();
  }

  play() {
    const last = this.scene.frames.length - 1;
    if (this.frame === last) this.frame = -1;
    this.playing = true;
    id("play").setAttribute("aria-pressed", "true");
    id("playText").textContent = "Pause";
    const wait = Math.max(60, Math.min(350, 6000 / (last + 1)));
    const next = async () => {
      if (!this.playing) return;
      if (this.frame >= last) return this.stop();
      await this.go(this.frame + 1);
      setTimeout(next, wait);
    };
    next();
  }

  stop() {
    this.playing = null;
    id("play").setAttribute("aria-pressed", "false");
    id("playText").textContent = "Play";
  }

  /** The picture as a file. */
  save() {
    this.now();
    const out = this.whole(getComputedStyle(id("stage")).backgroundColor);
    out.toBlob(blob => {
      const link = make("a", { href: URL.createObjectURL(blob), download: `${words(this.field.name)} ${id("when").textContent}.png` });
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    });
  }
}
