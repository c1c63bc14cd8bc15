// Rigid bodies beside the points: balls and triangles, where they are in a frame. A ball without triangles is drawn as one.

/** Triangles of a ball of radius 1, with what they face at their corners. */
function round(bands = 24) {
  const at = (b, s) => {
    const [up, turn] = [(Math.PI * b) / bands, (Math.PI * s) / bands];
    return [Math.sin(up) * Math.cos(turn), Math.sin(up) * Math.sin(turn), Math.cos(up)];
  };
  const all = [];
  for (let b = 0; b < bands; b++) {
    for (let s = 0; s < 2 * bands; s++) {
      const [p, q, r, t] = [at(b, s), at(b + 1, s), at(b + 1, s + 1), at(b, s + 1)];
      all.push(p, q, r, p, r, t);
    }
  }
  return all;
}

/** Corners and faces of a box from `low` to `high`. */
function block(low, high) {
  const corner = [...Array(8).keys()].map(n => low.map((l, a) => ((n >> a) & 1 ? high[a] : l)));
  const sides = [[0, 4, 6, 2], [1, 3, 7, 5], [0, 1, 5, 4], [2, 6, 7, 3], [0, 2, 3, 1], [4, 5, 7, 6]];
  return { corner, face: sides.flatMap(([a, b, c, d]) => [[a, b, c], [a, c, d]]) };
}

class Bodies {
  /** Of notes of the run; `scene` for its dimension and spacing, `low` and `high` are the ends of the points. */
  constructor(notes, scene, low, high) {
    const long = Math.max(...high.map((h, a) => h - low[a]), scene.spacing);
    const middle = low.map((l, a) => 0.5 * (l + high[a]));
    this.reach = 0.3 * long;
    [this.low, this.high] = [low, high];
    this.all = notes.filter(n => n.path.length).map(note => {
      if (note.plane) return this.slab(note, scene, middle, long);
      if (!note.face) return note;
      // a rectangle in a plane is as thick as the points
      const flat = note.corner.every(x => x[2] === 0);
      if (!flat) return note;
      const end = (pick, a) => note.corner.reduce((m, x) => pick(m, x[a]), note.corner[0][a]);
      const thick = 0.6 * scene.spacing;
      return { ...note, ...block([end(Math.min, 0), end(Math.min, 1), -thick], [end(Math.max, 0), end(Math.max, 1), thick]) };
    });
  }

  /** A plane, as wide as what it is beside: a block whose upper side it is. */
  slab(note, scene, middle, long) {
    const { corner, face } = block([-0.62 * long, -0.62 * long, -0.05 * long], [0.62 * long, 0.62 * long, 0]);
    if (scene.dimension < 3) corner.forEach(x => (x[1] = 0.6 * scene.spacing * Math.sign(x[1])));
    const path = note.path.map(p => p.slice());
    const axes = note.path.map((p, k) => {
      const n = note.axes?.[k]?.map(row => dot(row, note.plane)) ?? note.plane;
      // in a plane the second of its own axes is z, in space any across
      const least = [0, 1, 2].reduce((m, a) => (Math.abs(n[a]) < Math.abs(n[m]) ? a : m), 0);
      const q = scene.dimension < 3 ? [0, 0, 1] : normal(cross(n, [0, 1, 2].map(a => Number(a === least))));
      const above = [0, 1, 2].reduce((sum, a) => sum + (middle[a] - p[a + 1]) * n[a], 0);
      for (let a = 0; a < 3; a++) path[k][a + 1] = middle[a] - above * n[a];
      const o = cross(q, n);
      return [0, 1, 2].map(r => [o[r], q[r], n[r]]);
    });
    return { ...note, corner, face, path, axes };
  }

  /** Those that are there at a time: where, and as triangles in space with what they face. */
  at(time) {
    const begun = this.all.filter(n => n.path[0][0] <= time);
    const there = begun.length ? begun : this.all;
    // statics before motion has bodies of its own, and no frame has both
    return there.filter(n => n.path.at(-1)[0] >= time || !this.all.some(o => o.path[0][0] <= time && o.path.at(-1)[0] >= time)).map(n => this.placed(n, time));
  }

  placed(note, time) {
    const { path, radius } = note;
    const k = Math.max(1, path.findIndex(p => p[0] >= time));
    const [a, b] = [path[k - 1], path[k] ?? path.at(-1)];
    const part = b[0] > a[0] ? Math.min(1, Math.max(0, (time - a[0]) / (b[0] - a[0]))) : 0;
    const center = [1, 2, 3].map(c => a[c] + part * (b[c] - a[c]));
    if (!note.face) return { radius, center };
    const axes = note.axes?.[part < 0.5 ? k - 1 : Math.min(k, path.length - 1)] ?? [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
    const corner = note.corner.map(x => axes.map((row, r) => center[r] + dot(row, x)));
    const triangles = note.face.map(f => f.map(n => corner[n]));
    return { center, corner, triangles };
  }

  /** Places that a picture of a frame should show, as far as it reaches. */
  ends(time) {
    const within = x => x.map((c, a) => Math.min(this.high[a] + this.reach, Math.max(this.low[a] - this.reach, c)));
    return this.at(time).flatMap(({ center, radius, corner }) => (corner ?? [-1, 1].map(s => center.map(c => c + s * radius))).map(within));
  }
}

/** Triangles of bodies with what they face at each corner, for a renderer; balls too where `balls` says. */
function triangles(bodies, balls) {
  const out = [];
  for (const { center, radius, triangles: own } of bodies) {
    for (const t of own ?? []) {
      const n = cross(t[1].map((c, a) => c - t[0][a]), t[2].map((c, a) => c - t[0][a]));
      if (Math.hypot(...n) > 0) out.push(...t.map(x => [x, normal(n)]));
    }
    if (!own && balls(radius)) out.push(...round().map(n => [n.map((c, a) => center[a] + radius * c), n]));
  }
  return out;
}
