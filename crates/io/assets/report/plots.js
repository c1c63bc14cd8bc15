// Plots of numbers over numbers that can be read off: with the pointer, with the arrow keys of the slider below, and in a table.

const DASHES = ["", "7 3", "2 3", "9 3 2 3", "5 2", "1 2"];
let plotsMade = 0;

/** A plot in `home`. `show({ x, lines, rows, box })` draws: columns have name, unit, values; `box` fixes the bounds of y. */
class Plot {
  constructor(home, label) {
    this.home = home;
    this.label = label;
    this.hidden = new Set();
    this.number = ++plotsMade;
    this.picture = make("svg", { class: "plot", role: "img" });
    this.slider = make("input", { type: "range", min: 0, step: 1, value: 0, "aria-label": `Read values off: ${label}`, class: "reader" });
    this.legend = make("ul", { class: "legend" });
    home.append(this.picture, this.slider, this.legend);
    this.slider.addEventListener("input", () => this.read(this.slider.valueAsNumber));
    const near = e => this.read(this.nearest(e));
    this.picture.addEventListener("pointermove", near);
    this.picture.addEventListener("pointerdown", near);
    new ResizeObserver(() => this.data && this.draw()).observe(home);
  }

  show(data) {
    this.data = data;
    this.finite = data.x.values.map((x, i) => (x === null ? -1 : i)).filter(i => i >= 0);
    this.at = Math.min(this.at ?? data.x.values.length - 1, data.x.values.length - 1);
    if (data.at !== undefined) this.at = data.at;
    // the slider goes along the axis
    this.slider.hidden = data.x.values.length < 2;
    this.slider.max = Math.max(0, data.x.values.length - 1);
    this.draw();
  }

  get lines() {
    return this.data.lines.filter(l => !this.hidden.has(l.name));
  }

  bounds(columns, box) {
    let [low, high] = [Infinity, -Infinity];
    for (const c of columns) {
      for (const v of c.values) if (v !== null && Number.isFinite(v)) [low, high] = [Math.min(low, v), Math.max(high, v)];
    }
    if (box) [low, high] = [Math.min(box[0], low), Math.max(box[1], high)];
    if (low > high) return [0, 1];
    // a constant gets room around it
    if (high - low <= 1e-12 * Math.max(Math.abs(low), Math.abs(high))) {
      const room = Math.abs(high) || 1;
      return [low - 0.5 * room, high + 0.5 * room];
    }
    return [low, high];
  }

  draw() {
    const { x, box } = this.data;
    const width = Math.max(240, this.home.clientWidth);
    const height = Math.round(Math.min(340, Math.max(230, 0.42 * width)));
    const [x0, x1] = this.bounds([x]);
    let [y0, y1] = this.bounds(this.lines, box);
    const room = 0.05 * (y1 - y0);
    [y0, y1] = [y0 === 0 ? 0 : y0 - room, y1 === 0 ? 0 : y1 + room];
    const unit = this.data.lines[0]?.unit ?? "";
    const sx = scaled(Math.max(Math.abs(x0), Math.abs(x1)), x.unit);
    const sy = scaled(Math.max(Math.abs(y0), Math.abs(y1)), unit);
    const yTicks = ticks(y0 / sy.factor, y1 / sy.factor, height / 55);
    const labels = yTicks.map(t => plain(t, 5));
    const left = 14 + 7.2 * Math.max(...labels.map(l => l.length), 2) + 20;
    const [right, top, bottom] = [16, 12, 46];
    const [w, h] = [width - left - right, height - top - bottom];
    this.px = v => left + ((v - x0) / (x1 - x0)) * w;
    this.py = v => top + h - ((v - y0) / (y1 - y0)) * h;
    this.inner = { left, top, w, h };
    this.slider.style.cssText = `width:${w + 13}px;margin-left:${left - 6.5}px`;
    const svg = this.picture;
    svg.replaceChildren();
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    svg.setAttribute("width", width);
    svg.setAttribute("height", height);
    const names = this.lines.map(l => words(l.name)).join(", ");
    svg.setAttribute("aria-label", `${this.label}: ${names} over ${words(x.name)}. The slider below reads values off.`);
    const axis = make("g", { class: "axis", "aria-hidden": "true" });
    yTicks.forEach((t, k) => {
      const y = this.py(t * sy.factor);
      axis.append(
        make("line", { x1: left, x2: left + w, y1: y, y2: y, class: t === 0 ? "zero" : "grid" }),
        make("text", { x: left - 6, y: y + 4, "text-anchor": "end" }, labels[k]),
      );
    });
    for (const t of ticks(x0 / sx.factor, x1 / sx.factor, w / 80)) {
      const at = this.px(t * sx.factor);
      axis.append(
        make("line", { x1: at, x2: at, y1: top + h, y2: top + h + 5, class: "tick" }),
        make("text", { x: at, y: top + h + 19, "text-anchor": "middle" }, plain(t, 5)),
      );
    }
    const name = (n, u) => capital(words(n)) + (u ? ` (${u})` : "");
    const yName = this.lines.length === 1 ? this.lines[0].name : this.data.y ?? "";
    axis.append(
      make("rect", { x: left, y: top, width: w, height: h, class: "frame" }),
      make("text", { x: left + w / 2, y: height - 6, "text-anchor": "middle", class: "name" }, name(x.name, sx.unit)),
      make("text", { transform: `translate(13 ${top + h / 2}) rotate(-90)`, "text-anchor": "middle", class: "name" }, name(yName, sy.unit)),
    );
    svg.append(axis);
    const clip = `clip${this.number}`;
    svg.append(make("clipPath", { id: clip }, make("rect", { x: left, y: top - 2, width: w, height: h + 4 })));
    const body = make("g", { "clip-path": `url(#${clip})`, "aria-hidden": "true" });
    this.data.lines.forEach((line, k) => {
      if (this.hidden.has(line.name)) return;
      let path = "";
      let pen = "M";
      line.values.forEach((v, i) => {
        const u = x.values[i];
        if (v === null || u === null || !Number.isFinite(v)) return (pen = "M");
        path += `${pen}${this.px(u).toFixed(1)} ${this.py(v).toFixed(1)}`;
        pen = "L";
      });
      body.append(make("path", { d: path, class: `line c${k % 6}`, "stroke-dasharray": DASHES[k % 6] }));
      if (line.values.length <= 40) {
        line.values.forEach((v, i) => {
          if (v !== null && x.values[i] !== null) body.append(make("circle", { cx: this.px(x.values[i]), cy: this.py(v), r: 2.6, class: `dot c${k % 6}` }));
        });
      }
    });
    this.marks = make("g", { "aria-hidden": "true" });
    this.time = make("line", { class: "now" });
    svg.append(body, this.time, this.marks);
    this.keys();
    this.now(this.value);
    this.read(this.at);
  }

  /** Marks the place of the 3-D view. */
  now(value) {
    this.value = value;
    if (!this.inner || !this.time) return;
    const shown = value !== undefined && this.data.timed;
    this.time.style.display = shown ? "" : "none";
    if (!shown) return;
    for (const [k, v] of Object.entries({ x1: this.px(value), x2: this.px(value), y1: this.inner.top, y2: this.inner.top + this.inner.h })) this.time.setAttribute(k, v);
  }

  keys() {
    this.cells = [];
    const items = this.data.lines.map((line, k) => {
      const value = make("output", { class: "value" });
      this.cells.push(value);
      const swatch = make("svg", { width: 26, height: 10, "aria-hidden": "true" }, make("path", { d: "M0 5H26", class: `line c${k % 6}`, "stroke-dasharray": DASHES[k % 6] }));
      const shown = !this.hidden.has(line.name);
      const key = make("button", { type: "button", class: "key", "aria-pressed": String(shown), onclick: () => {
        if (shown) this.hidden.add(line.name);
        else this.hidden.delete(line.name);
        this.draw();
        this.legend.querySelectorAll("button")[k]?.focus();
      } }, swatch, capital(words(line.name)));
      return make("li", {}, this.data.lines.length > 1 ? key : make("span", { class: "key" }, swatch, capital(words(line.name))), value);
    });
    this.place = make("output", { class: "value" });
    const x = make("li", { class: "at" }, make("span", {}, capital(words(this.data.x.name))), this.place);
    this.legend.replaceChildren(x, ...items);
  }

  /** The row nearest to a pointer; of curves that turn back the nearest in both directions. */
  nearest(event) {
    const box = this.picture.getBoundingClientRect();
    const scale = this.picture.viewBox.baseVal.width / box.width;
    const [mx, my] = [(event.clientX - box.left) * scale, (event.clientY - box.top) * scale];
    const { x } = this.data;
    let [best, at] = [Infinity, this.at];
    for (const i of this.finite) {
      let d = Math.abs(this.px(x.values[i]) - mx);
      if (!this.data.timed) {
        const off = this.lines.map(l => (l.values[i] === null ? Infinity : Math.abs(this.py(l.values[i]) - my)));
        d = Math.hypot(d, Math.min(...off, 1e6));
      }
      if (d < best) [best, at] = [d, i];
    }
    return at;
  }

  read(at) {
    if (!this.data || !(at >= 0)) return;
    this.at = at;
    this.slider.value = at;
    const { x, lines } = this.data;
    const u = x.values[at];
    const said = [`${words(x.name)} ${quantity(u, x.unit)}`];
    this.place.textContent = quantity(u, x.unit);
    this.marks.replaceChildren();
    if (u === null) return;
    this.marks.append(make("line", { x1: this.px(u), x2: this.px(u), y1: this.inner.top, y2: this.inner.top + this.inner.h, class: "cursor" }));
    lines.forEach((line, k) => {
      const v = line.values[at];
      this.cells[k].textContent = quantity(v, line.unit);
      if (this.hidden.has(line.name)) return;
      said.push(`${words(line.name)} ${quantity(v, line.unit)}`);
      if (v !== null && Number.isFinite(v)) this.marks.append(make("circle", { cx: this.px(u), cy: this.py(v), r: 4.5, class: `mark c${k % 6}` }));
    });
    this.slider.setAttribute("aria-valuetext", said.join(", "));
  }
}
