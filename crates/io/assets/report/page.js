// Puts the page together.

const { run } = meta;
const reveal = name => (id(name).hidden = false);

// ---- light and dark

for (const choice of document.querySelectorAll("input[name=theme]")) {
  choice.addEventListener("change", () => {
    if (choice.value === "auto") delete document.documentElement.dataset.theme;
    else document.documentElement.dataset.theme = choice.value;
  });
}

// ---- head

function head() {
  const bad = run.status.startsWith("stopped");
  const status = run.ended_by ? `ended by ${run.ended_by}` : run.status;
  id("status").replaceChildren(make("span", { class: `badge ${bad ? "bad" : run.status === "done" ? "good" : "some"}` }, capital(status)), meta.subtitle ?? "");
  const facts = meta.facts.map(([name, value, unit, more]) => {
    const text = typeof value === "number" ? (unit === "#" ? many(value) : quantity(value, unit)) : value;
    return make("div", {}, make("dt", {}, name), make("dd", {}, text, more ? make("span", { class: "quiet" }, more) : null));
  });
  id("facts").append(...facts);
  const warnings = run.warnings ?? [];
  if (warnings.length) {
    reveal("warnings");
    id("warningList").append(...warnings.map(w => make("li", {}, w)));
    if (warnings.length > 1) id("warningsTitle").textContent = `${warnings.length} warnings`;
  }
}

// ---- body

let viewer = null;

async function body() {
  if (!scenes.length) return;
  reveal("body");
  if (!canUnpack) {
    id("body").querySelector(".viewer").replaceWith(make("p", { class: "note" }, "This browser is too old to unpack the points (it lacks DecompressionStream)."));
    return;
  }
  id("map").append(...Object.entries(NAMES).map(([value, name]) => make("option", { value }, name)));
  viewer = new Viewer();
  if (scenes.length > 1) {
    reveal("sceneBox");
    id("scene").append(...scenes.map((s, k) => make("option", { value: k }, s.label)));
    id("scene").addEventListener("change", () => { viewer.stop(); viewer.open(scenes[id("scene").value]); });
  }
  id("bodyTitle").textContent = scenes[0].title;
  viewer.onframe.push((scene, frame) => {
    const { field } = viewer;
    id("view").setAttribute("aria-label", `${scenes[0].title}: ${count(scene.points)} points coloured by ${words(field.name)}, ${id("when").textContent}`);
    if (scene.kind === "run" && scene.axis === "time") for (const plot of timed) plot.now(scene.frames[frame].value);
  });
  await viewer.open(scenes[0]);
}

// ---- history

const timed = [];

function column(name) {
  return meta.history.columns.find(c => c.name === name);
}

function history() {
  if (!meta.history || meta.history.columns[0].values.length < 2) return;
  reveal("history");
  const { columns } = meta.history;
  const time = column(meta.history.over);
  const isTime = c => c === time;
  const energies = columns.filter(c => meta.history.energies.includes(c.name) && c.values.some(v => v));
  const figure = (title, lines, y) => {
    const home = make("div");
    const card = make("figure", { class: "card" }, make("figcaption", {}, capital(title)), home);
    id("plots").append(card);
    const plot = new Plot(home, title);
    plot.show({ x: time, lines, y, timed: true });
    timed.push(plot);
  };
  if (energies.length) figure("Energies", energies, "energy");
  const extra = meta.history.plots ?? [];
  for (const { title, names, y } of extra) {
    const lines = names.map(column).filter(c => c && c.values.some(v => v));
    if (lines.length) figure(title, lines, y);
  }
  const [xs, ys, zs] = [id("plotX"), id("plotY"), id("plotZ")];
  const label = c => capital(words(c.name)) + (c.unit ? ` (${unitText(c.unit)})` : "");
  const options = () => columns.map((c, k) => make("option", { value: k }, label(c)));
  xs.append(...options());
  ys.append(...options());
  const plot = new Plot(id("anyPlot"), "Columns");
  const draw = () => {
    const [x, y] = [columns[xs.value], columns[ys.value]];
    const same = columns.map((c, k) => [c, k]).filter(([c]) => c.unit === y.unit && c !== y && c !== x);
    const kept = zs.value;
    zs.replaceChildren(make("option", { value: "" }, "nothing"), ...same.map(([c, k]) => make("option", { value: k }, label(c))));
    zs.value = same.some(([, k]) => String(k) === kept) ? kept : "";
    const z = zs.value === "" ? null : columns[zs.value];
    plot.show({ x, lines: z ? [y, z] : [y], y: z ? "" : undefined, timed: isTime(x) });
    const shown = [x, y, z].filter(c => c);
    const most = 400;
    const every = Math.ceil(x.values.length / most);
    const rows = x.values.map((_, i) => i).filter(i => i % every === 0);
    id("table").replaceChildren(
      make("caption", {}, every > 1 ? `every ${every}th row; all are in history.csv` : "all rows"),
      make("thead", {}, make("tr", {}, ...shown.map(c => make("th", { scope: "col" }, label(c))))),
      make("tbody", {}, ...rows.map(i => make("tr", {}, ...shown.map(c => make("td", {}, plain(c.values[i])))))),
    );
  };
  const pick = (x, y, z = "") => {
    [xs.value, ys.value] = [columns.indexOf(x), columns.indexOf(y)];
    draw();
    if (z) {
      zs.value = columns.indexOf(z);
      draw();
    }
  };
  for (const s of [xs, ys, zs]) s.addEventListener("change", draw);
  const named = (meta.history.presets ?? []).map(p => [p.title, column(p.x), column(p.y)]).filter(([, x, y]) => x && y);
  id("presets").append(...named.map(([title, x, y]) => make("button", { type: "button", onclick: () => pick(x, y) }, capital(title))));
  const residual = column("energy balance error");
  const [first] = named;
  if (first) pick(first[1], first[2]);
  else pick(time, residual ?? columns.find(c => c !== time && c.name !== "step") ?? columns.at(-1));
  if (isTime(columns[xs.value])) timed.push(plot);
}

// ---- energy

function energy() {
  const e = run.energy;
  if (!e) return;
  const names = [
    ["initial", "at the start", 1], ["work_boundary_conditions", "work of loads and supports", 1], ["work_rigid_bodies", "work of rigid bodies", 1], ["created_by_breakage", "created by bond breakage", 1],
    ["kinetic", "kinetic", -1], ["strain", "strain, or potential", -1], ["contact", "contact", -1], ["dissipated_by_breakage", "dissipated by bond breakage", -1], ["dissipated", "dissipated", -1], ["numerical", "taken by the method", -1],
  ].filter(([key]) => e[key]);
  if (!names.length) return;
  reveal("energy");
  const unit = meta.units?.energy ?? "";
  const most = Math.max(...names.map(([key]) => Math.abs(e[key])));
  const s = scaled(most, unit);
  const number = v => plain(v / s.factor);
  const row = ([key, name]) => make("tr", {}, make("th", { scope: "row" }, capital(name)), make("td", {}, number(e[key])),
    make("td", { class: "share" }, make("span", { class: `amount${e[key] < 0 ? " minus" : ""}`, style: `width:${(100 * Math.abs(e[key])) / most}%` })));
  const part = (title, sign) => {
    const rows = names.filter(n => n[2] === sign);
    return make("tbody", {}, make("tr", { class: "part" }, make("th", { colspan: 3, scope: "rowgroup" }, title)), ...rows.map(row));
  };
  id("energies").append(
    make("caption", { class: "hidden" }, "Energies at the end of the run"),
    make("thead", {}, make("tr", {}, make("th", { scope: "col" }, "Energy"), make("th", { scope: "col" }, s.unit || "amount"), make("th", { scope: "col", class: "share" }, "Share of the largest"))),
    part("What came in", 1), part("Where it is", -1),
  );
  const total = names.filter(n => n[2] === 1).reduce((sum, [key]) => sum + Math.abs(e[key]), 0) || most;
  id("energySays").textContent = `Error of the balance: ${quantity(e.balance_error, unit)}, ${plain((100 * Math.abs(e.balance_error)) / total, 2)} % of what came in.`;
}

// ---- texts

function copier(text, what) {
  const said = make("span", { role: "status", class: "quiet" });
  const button = make("button", { type: "button", onclick: async () => {
    try {
      await navigator.clipboard.writeText(text);
      said.textContent = " copied";
    } catch {
      said.textContent = " this browser does not let a file copy: select the text";
    }
  } }, `Copy ${what}`);
  return make("p", { class: "copy" }, button, said);
}

function texts() {
  if (meta.deck) id("deck").querySelector(".card").append(copier(meta.deck, "the deck"));
  const again = id("againText");
  if (meta.command) again.append(make("div", { role: "region", "aria-label": "Command", tabindex: 0 }, make("pre", {}, make("code", {}, meta.command))), copier(meta.command, "the command"));
  if (run.deck_hash) again.append(make("p", { class: "quiet hash" }, `The deck is ${run.deck}, ${run.deck_hash.replace(":", " ")}. The same deck and version give the same numbers to the last bit, on any number of threads.`));
  id("cite").textContent = meta.cite;
  if (meta.sources?.length) id("sources").append(make("p", {}, "What this run rests on:"), make("ul", {}, ...meta.sources.map(s => make("li", {}, s))));
  const bytes = n => (n >= 1e6 ? `${plain(n / 1e6, 3)} MB` : n >= 1e3 ? `${plain(n / 1e3, 3)} kB` : `${n} B`);
  if (meta.files.length) {
    const table = id("fileTable");
    table.append(
      make("thead", {}, make("tr", {}, make("th", { scope: "col" }, "File"), make("th", { scope: "col" }, "Size"), make("th", { scope: "col" }, "What it is"))),
      make("tbody", {}, ...meta.files.map(f => make("tr", {}, make("td", {}, f.link ? make("a", { href: encodeURI(f.name) }, f.name) : f.name), make("td", {}, bytes(f.bytes)), make("td", {}, f.says)))),
    );
  }
  id("leftOut").append(...meta.notes.map(n => make("li", {}, n)));
  id("foot").textContent = `Made by peridyne ${run.version}. This file needs no network: it can be sent and archived as it is.`;
}

function contents() {
  const parts = [...document.querySelectorAll("main section:not([hidden])")].filter(s => s.id !== "warnings");
  const short = { understood: "Input summary", again: "Run again, cite", files: "Files", energy: "Energy", history: "History", deck: "Deck", body: "Body", pictures: "Pictures" };
  id("contents").append(...parts.map(s => make("li", {}, make("a", { href: `#${s.id}` }, short[s.id]))));
}

function pictures() {
  if (!meta.pictures.length) return;
  reveal("pictures");
  id("pictureList").append(...meta.pictures.map(p => make("figure", { class: "card" }, make("img", { src: `data:image/png;base64,${document.getElementById("b" + p.at).textContent}`, alt: p.says, loading: "lazy" }), make("figcaption", {}, p.name))));
}

// ---- paper

function printed(on) {
  if (!viewer || viewer.line || !viewer.shown) return;
  const image = id("printed");
  if (on) {
    viewer.now();
    image.src = viewer.whole().toDataURL();
    image.alt = viewer.canvas.getAttribute("aria-label");
  }
  image.hidden = !on;
}
window.addEventListener("beforeprint", () => printed(true));
window.addEventListener("afterprint", () => printed(false));

head();
history();
energy();
pictures();
texts();
const ready = body();
contents();
ready.then(() => (document.body.dataset.ready = "yes"), error => {
  document.body.dataset.ready = "failed";
  id("body").append(make("p", { class: "note" }, `The body could not be drawn: ${error.message}`));
  console.error(error);
});
