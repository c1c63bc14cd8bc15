// What the report carries: numbers of the run, and packed blocks of points that are unpacked when they are looked at.

const meta = JSON.parse(document.getElementById("meta").textContent);
const canUnpack = typeof DecompressionStream === "function";

async function unpack(number) {
  const text = document.getElementById("b" + number).textContent;
  const packed = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Codes of one component: differences from point to point, or from those before, folded so that small ones of either sign are small. */
function codes(bytes, start, points, wide, before, out) {
  const mask = wide ? 0xffff : 0xff;
  let code = 0;
  for (let i = 0; i < points; i++) {
    const z = wide ? bytes[start + i] | (bytes[start + points + i] << 8) : bytes[start + i];
    if (before) code = before[i];
    code = (code + ((z >>> 1) ^ -(z & 1))) & mask;
    out[i] = code;
  }
}

/** Codes of frame `k` of a field, component after component; of a frame that follows from the one before added to its codes. */
function codesOf(blocks, k, points) {
  const block = blocks[k];
  block.codes ??= (async () => {
    const before = block.after ? await codesOf(blocks, k - 1, points) : null;
    const bytes = await unpack(block.at);
    const wide = block.bits > 8;
    return block.low.map((_, c) => {
      const out = new Uint16Array(points);
      codes(bytes, c * points * (wide ? 2 : 1), points, wide, before?.[c], out);
      return out;
    });
  })();
  return block.codes;
}

/** Numbers of frame `k`, component after component: `low + code (high - low) / (2^bits - 2)`; the last code is no number. */
async function numbers(blocks, k, points) {
  const block = blocks[k];
  const none = 2 ** block.bits - 1;
  const all = await codesOf(blocks, k, points);
  return all.map((of, c) => {
    const low = block.low[c];
    const quantum = (block.high[c] - low) / (none - 1);
    return Float32Array.from(of, code => (code === none ? NaN : low + code * quantum));
  });
}

/** Points with their frames. */
class Scene {
  constructor(made) {
    Object.assign(this, made);
    this.kept = new Map();
  }

  keep(key, make) {
    if (!this.kept.has(key)) {
      // all of a large body at once is too much for a telephone
      if (this.kept.size > 4e7 / (12 * this.points)) this.kept.delete(this.kept.keys().next().value);
      this.kept.set(key, make());
    }
    return this.kept.get(key);
  }

  /** Reference positions. */
  async places() {
    this.at ??= await numbers([this.reference], 0, this.points);
    return this.at;
  }

  /** Displacements of a frame; not a number where a point is far outside. */
  displacement(frame) {
    return this.keep(`moved ${frame}`, () => numbers(this.moved, frame, this.points));
  }

  /** What can be looked at: fields, and displacements. */
  get shown() {
    return this.fields;
  }

  /** Numbers of a component of a field in a frame; component −1: the length of a vector, the size of a tensor. */
  async values(field, component, frame) {
    const all = field.name === "displacement"
      ? await this.displacement(frame)
      : await this.keep(`${field.name} ${frame}`, () => numbers(field.blocks, frame, this.points));
    return component >= 0 ? all[component] : size(all, field.kind);
  }

  /** Bounds of a component over the frames `from` to `to`. */
  range(field, component, from, to) {
    let [low, high] = [Infinity, -Infinity];
    const blocks = field.name === "displacement" ? this.moved : field.blocks;
    for (let f = from; f <= to; f++) {
      const b = blocks[f];
      if (component >= 0) [low, high] = [Math.min(low, b.seen[component][0]), Math.max(high, b.seen[component][1])];
      else [low, high] = [0, Math.max(high, b.size)];
    }
    return low <= high ? [low, high] : [0, 0];
  }
}

function size(all, kind) {
  // off the diagonal each number of a symmetric tensor stands for two
  const weights = kind === "symmetric" ? [1, 1, 1, 2, 2, 2] : all.map(() => 1);
  return all[0].map((_, i) => Math.sqrt(all.reduce((sum, c, k) => sum + weights[k] * c[i] * c[i], 0)));
}

const scenes = meta.scenes.map(s => new Scene(s));
