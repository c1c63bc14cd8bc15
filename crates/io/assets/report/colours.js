// Maps of colours that grow evenly lighter, readable by the colour-blind, and colours of things to be told apart.

const MAPS = {
  viridis: "440154 471365 482475 46337f 414487 3b528b 355f8d 2f6c8e 2a788e 25848e 21918c 1f9d89 22a884 2fb47c 44bf70 5ec962 7ad151 9bd93c bddf26 dfe318 fde725",
  cividis: "00224e 00285d 002f6c 12366f 273e6d 35456c 424e6b 4d566c 57606d 61686f 6a7071 737873 7d8077 868a78 919378 9c9d77 a8a673 b4b06f c0ba6a ccc464 fee838",
  inferno: "1b0c41 2a0b57 390963 4a0c6b 5a116e 6a176e 7a1d6d 8a226a 992966 a92e5e b93556 c73e4c d34743 de5238 e8602d f06f20 f68013 fa9207 fba60e f9bc26 fcffa4",
  diverging: "1b3b6f 24508c 2f66a7 427cb9 5a92c6 77a8d1 95bcdb b2cfe3 cddfe9 e0e8ec ebebeb f0e6dc f3dbc2 f3cba2 f0b880 e8a25f db8a43 c9722d b25b1d 984612 7d330b",
};
const NAMES = { viridis: "Viridis", cividis: "Cividis", inferno: "Inferno", diverging: "Blue–orange" };

// of Okabe and Ito, and of Tol
const KINDS = ["#56b4e9", "#e69f00", "#009e73", "#cc79a7", "#f0e442", "#0072b2", "#d55e00", "#999999", "#882255", "#44aa99", "#ddcc77", "#aa4499"];

const hex = text => [0, 2, 4].map(k => parseInt(text.slice(k, k + 2), 16));

/** The part of a map that values from `low` to `high` have: all of it, but of a diverging one 0 is its middle, as far on either side. */
function part(name, low, high) {
  if (name !== "diverging" || !(low < 0 && high > 0)) return [0, 1];
  const most = Math.max(-low, high);
  return [0.5 + (0.5 * low) / most, 0.5 + (0.5 * high) / most];
}

/** 256 colours of a map for values from `low` to `high`, RGBA. */
function table(name, low, high) {
  const colours = MAPS[name].split(" ").map(hex);
  const [from, to] = part(name, low, high);
  const out = new Uint8Array(1024);
  for (let i = 0; i < 256; i++) {
    const at = (from + ((to - from) * i) / 255) * (colours.length - 1);
    const k = Math.min(Math.floor(at), colours.length - 2);
    for (let c = 0; c < 3; c++) out[4 * i + c] = Math.round(colours[k][c] + (at - k) * (colours[k + 1][c] - colours[k][c]));
    out[4 * i + 3] = 255;
  }
  return out;
}

/** 256 colours for whole numbers from `low`, in turn. */
function kinds() {
  const out = new Uint8Array(1024);
  for (let i = 0; i < 256; i++) out.set([...hex(KINDS[i % KINDS.length].slice(1)), 255], 4 * i);
  return out;
}
const kindColour = n => KINDS[((n % KINDS.length) + KINDS.length) % KINDS.length];


function gradient(name, low, high) {
  const colours = table(name, low, high);
  const stops = [...Array(33).keys()].map(k => `rgb(${colours.slice(4 * Math.round((255 * k) / 32)).slice(0, 3).join(" ")})`);
  return `linear-gradient(to right, ${stops.join(", ")})`;
}
