// Opens reports from the disk in a headless Chromium: three widths, light and dark, with WebGL2 and without; turns, cuts, scrubs
// and picks by mouse, keyboard and touch; looks at the pixels; counts what an accessibility checker finds.
import { chromium } from "playwright-core";
import { readFileSync, statSync, writeFileSync } from "node:fs";
import { createRequire } from "node:module";

const folder = process.argv[2];
const learn = process.argv.includes("--learn");
const axe = readFileSync(createRequire(import.meta.url).resolve("axe-core/axe.min.js"), "utf8");
const expected = JSON.parse(readFileSync("expected.json", "utf8"));
const found = {};
const wrong = [];
const must = (holds, what) => {
  if (!holds) wrong.push(what);
};
let violations = 0;
let pages = 0;

const browser = await chromium.launch({
  executablePath: process.env.CHROMIUM,
  headless: true,
  args: ["--no-sandbox", "--disable-quic", "--no-first-run", "--disable-background-networking", "--disable-component-update", "--disable-sync",
    "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--force-color-profile=srgb"],
});

/** Opens a report; what it says on the console, or asks of a network, is wrong. */
async function open(name, { width = 1400, scheme = "light", hash = "", touch = false, script = true } = {}) {
  const context = await browser.newContext({ viewport: { width, height: 900 }, colorScheme: scheme, hasTouch: touch, javaScriptEnabled: script, offline: true });
  const page = await context.newPage();
  page.on("console", m => must(["info", "log", "debug"].includes(m.type()), `${name}: console: ${m.text()}`));
  page.on("pageerror", e => wrong.push(`${name}: ${e.message}`));
  page.on("request", r => must(/^(file|data|blob):/.test(r.url()), `${name}: asks for ${r.url()}`));
  await page.goto(`file://${folder}/${name}/report.html${hash}`);
  if (script) {
    await page.waitForSelector("body[data-ready]", { timeout: 120000 });
    must((await page.getAttribute("body", "data-ready")) === "yes", `${name}: the body is not drawn`);
    await page.waitForTimeout(300);
  }
  return page;
}

/** Share of the canvas that is covered, and the mean colour there. */
const look = page => page.evaluate(() => {
  viewer.now();
  const from = viewer.canvas;
  const c = document.createElement("canvas");
  [c.width, c.height] = [from.width, from.height];
  const context = c.getContext("2d");
  context.drawImage(from, 0, 0);
  const { data } = context.getImageData(0, 0, c.width, c.height);
  let [covered, sum] = [0, [0, 0, 0]];
  for (let k = 0; k < data.length; k += 4) {
    if (data[k + 3] < 128) continue;
    covered++;
    for (let a = 0; a < 3; a++) sum[a] += data[k + a];
  }
  return [covered / (data.length / 4), ...sum.map(s => s / Math.max(1, covered) / 255)];
});
const apart = (a, b) => Math.max(...a.map((x, k) => Math.abs(x - b[k])));
const settle = page => page.waitForTimeout(350);

/** A statistic of pixels against the stored one. */
function compare(name, seen, within) {
  found[name] = seen.map(v => Number(v.toFixed(4)));
  if (learn) return;
  const stored = expected[name];
  must(stored && apart(stored, seen) <= within, `${name}: pixels are ${found[name]}, were ${stored}`);
}

async function accessible(page, name) {
  await page.evaluate(axe);
  const { violations: all } = await page.evaluate(() => axe.run(document, { runOnly: ["wcag2a", "wcag2aa", "wcag21a", "wcag21aa", "wcag22aa", "best-practice"] }));
  violations += all.length;
  pages++;
  for (const v of all) wrong.push(`${name}: ${v.id} (${v.impact}), ${v.help}: ${v.nodes.slice(0, 3).map(n => n.target.join(" ")).join("; ")}`);
}

// ---- every report, in every width, light and dark

const names = ["impact", "kalthoff", "load_displacement", "bar_wave", "cantilever", "alloy", "swirl", "advection"];
for (const name of names) {
  const bytes = statSync(`${folder}/${name}/report.html`).size;
  must(bytes < 5e6, `${name}: ${bytes} bytes`);
  const all = ["impact", "load_displacement"].includes(name);
  for (const width of [360, 800, 1400]) {
    for (const scheme of ["light", "dark"]) {
      // of the others narrow dark ones and wide light ones
      if (!all && (width === 360) !== (scheme === "dark") || (!all && width === 800)) continue;
      const page = await open(name, { width, scheme });
      const wide = await page.evaluate(() => document.documentElement.scrollWidth);
      must(wide <= width, `${name}: ${wide} pixels wide in a window of ${width}`);
      await accessible(page, `${name} ${width} ${scheme}`);
      await page.screenshot({ path: `${name}_${width}_${scheme}.png`, fullPage: true });
      await page.context().close();
    }
  }
}

// ---- the body: pixels with WebGL2, and without

for (const name of ["impact", "kalthoff", "alloy", "swirl", "cantilever"]) {
  const seen = {};
  for (const hash of ["", "#loops"]) {
    const page = await open(name, { hash });
    const kind = await page.evaluate(() => viewer.draw.name);
    must(kind === (hash ? "loops" : "webgl2"), `${name}: drawn by ${kind}`);
    seen[kind] = await look(page);
    must(seen[kind][0] > 0.03, `${name}: the canvas is blank`);
    compare(`${name} ${kind}`, seen[kind], 0.02);
    await page.context().close();
  }
  must(apart(seen.webgl2, seen.loops) < 0.12, `${name}: WebGL2 and loops differ: ${seen.webgl2}, ${seen.loops}`);
}

// ---- what a person does: field, time, cut, turn, come closer

for (const hash of ["", "#loops"]) {
  const page = await open("impact", { hash });
  const at = async what => {
    await settle(page);
    const seen = await look(page);
    compare(`impact ${what} ${hash || "webgl2"}`, seen, 0.03);
    return seen;
  };
  const first = await at("begin");
  must((await page.inputValue("#field")) === "damage", "the first field is not damage");
  await page.selectOption("#field", "velocity");
  const velocity = await at("velocity");
  must(apart(first, velocity) > 0.02, "another field looks the same");
  must((await page.textContent("#barName")).startsWith("Velocity, length ("), "the bar has no name and unit");
  await page.selectOption("#component", { label: "y" });
  must(apart(velocity, await at("velocity y")) > 0.02, "another component looks the same");
  await page.selectOption("#field", "damage");
  await page.focus("#frame");
  await page.keyboard.press("Home");
  await settle(page);
  must((await page.textContent("#when")) === "t = 0\u00a0s", `time ${await page.textContent("#when")}`);
  const begin = await at("first frame");
  must(apart(first, begin) > 0.02, "the first frame looks like the last");
  await page.keyboard.press("ArrowRight");
  await settle(page);
  must((await page.textContent("#whenCount")).startsWith("2 /"), "an arrow key does not step through time");
  await page.keyboard.press("End");
  await settle(page);
  must(apart(first, await at("end")) < 0.001, "the last frame is not what it was");
  await page.selectOption("#cutAxis", "2");
  const cut = await at("cut");
  must(first[0] - cut[0] > 0.02, "a cut takes nothing away");
  await page.check("#cutSide");
  must(apart(cut, await at("other side")) > 0.005, "the other side looks the same");
  await page.focus("#cutAt");
  for (let k = 0; k < 40; k++) await page.keyboard.press("ArrowRight");
  must((await page.textContent("#cutText")).startsWith("z = "), "the place of the cut is not told");
  await page.selectOption("#cutAxis", "-1");
  const whole = await at("whole");
  await page.focus("#view");
  for (let k = 0; k < 4; k++) await page.keyboard.press("ArrowUp");
  const turned = await at("turned");
  must(apart(whole, turned) > 0.02, "arrow keys do not turn");
  await page.keyboard.press("+");
  await page.keyboard.press("+");
  must((await at("closer"))[0] > turned[0], "+ does not come closer");
  await page.keyboard.press("0");
  must(apart(whole, await at("reset")) < 0.001, "0 does not reset");
  const box = await page.locator("#view").boundingBox();
  await page.mouse.move(box.x + box.width / 2, box.y + box.height / 2);
  await page.mouse.down();
  await page.mouse.move(box.x + box.width / 2 + 90, box.y + box.height / 2 - 60, { steps: 4 });
  await page.mouse.up();
  must(apart(whole, await at("dragged")) > 0.01, "dragging does not turn");
  await page.click("#fit");
  await page.mouse.move(box.x + box.width * 0.35, box.y + box.height * 0.45);
  await settle(page);
  must(/damage.*point/s.test(await page.textContent("#tip")), "the pointer reads no value");
  await page.click("#play");
  await page.waitForTimeout(700);
  await page.click("#play");
  must(!(await page.textContent("#whenCount")).startsWith("1 /"), "play does not play");
  // where play stopped depends on the machine
  await page.focus("#frame");
  await page.keyboard.press("End");
  await page.selectOption("#map", "cividis");
  await settle(page);
  must(apart(first, await look(page)) > 0.02, "another map of colours looks the same");
  await page.context().close();
}

// ---- touch

{
  const page = await open("kalthoff", { width: 360, touch: true });
  await page.locator("#view").scrollIntoViewIfNeeded();
  const box = await page.locator("#view").boundingBox();
  await page.touchscreen.tap(box.x + box.width * 0.4, box.y + box.height * 0.5);
  await settle(page);
  must(/point/.test(await page.textContent("#tip")), "a tap reads no value");
  const small = await page.evaluate(() => [...document.querySelectorAll("button, select, input, summary, a[href]")].filter(e => e.offsetParent && !e.closest(".legend, .filetable")).map(e => [e.id || e.textContent, e.getBoundingClientRect()]).filter(([, r]) => r.height < 17 || r.width < 17).map(([n]) => n));
  must(small.length === 0, `too small to touch: ${small}`);
  await page.context().close();
}

// ---- plots

{
  const page = await open("load_displacement");
  const reader = page.locator("#anyPlot .reader");
  await reader.focus();
  await page.keyboard.press("Home");
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
  const said = await reader.getAttribute("aria-valuetext");
  must(/^elongation x 50\u00a0µm, pull x \d+(\.\d+)?\u00a0N$/.test(said), `the plot reads ${said}`);
  await page.selectOption("#plotX", { label: "Part of the load" });
  await page.selectOption("#plotY", { label: "Strain energy (J)" });
  must((await page.getAttribute("#anyPlot svg.plot", "aria-label")).startsWith("Columns: strain energy over part of the load"), "columns are not chosen");
  const key = page.locator("#plots .key").first();
  await key.click();
  must((await key.getAttribute("aria-pressed")) === "false", "a line cannot be hidden");
  const plot = page.locator("#plots svg.plot").first();
  await plot.scrollIntoViewIfNeeded();
  await plot.hover();
  const read = page.waitForFunction(() => document.querySelector("#plots .legend .value").textContent.length > 1, null, { timeout: 10_000 });
  must(await read.then(() => true, () => false), "the pointer reads nothing off");
  const curve = await open("bar_wave");
  const before = await curve.getAttribute("#curve path.line", "d");
  await curve.focus("#frame");
  await curve.keyboard.press("Home");
  await settle(curve);
  must(before !== (await curve.getAttribute("#curve path.line", "d")), "a bar looks the same at all times");
  const modes = await open("cantilever");
  await modes.selectOption("#scene", { label: "Modes of vibration" });
  await settle(modes);
  must(/mode \d+, [\d.,]+\u00a0k?Hz/.test(await modes.textContent("#when")), `modes: ${await modes.textContent("#when")}`);
}

// ---- colours of the page, paper, no scripts

{
  const page = await open("impact", { scheme: "light" });
  const paper = () => page.evaluate(() => getComputedStyle(document.body).backgroundColor);
  const light = await paper();
  await page.check("input[value=dark]", { force: true });
  must(light !== (await paper()), "the switch to dark does nothing");
  await page.emulateMedia({ media: "print" });
  await page.evaluate(() => window.dispatchEvent(new Event("beforeprint")));
  must(await page.isVisible("#printed"), "the body is not printed");
  must(await page.isHidden("#play"), "buttons are printed");
  await page.pdf({ path: "impact.pdf", format: "A4" });
  const plain = await open("impact", { script: false });
  must((await plain.textContent("#understood")).includes("cubic lattice"), "nothing is understood without scripts");
  must((await plain.textContent("#deck")).includes("Impact of a rigid ball"), "no deck without scripts");
}

await browser.close();
if (learn) writeFileSync("expected.json", JSON.stringify(found, null, 1).replace(/\[\s+([^\]]*?)\s+\]/g, (_, inside) => `[${inside.replace(/\s+/g, " ")}]`) + "\n");
const size = n => `${(statSync(`${folder}/${n}/report.html`).size / 1e6).toFixed(2)} MB`;
console.log(`${names.length} reports, ${names.map(n => `${n} ${size(n)}`).join(", ")}`);
console.log(`${pages} pages checked by axe-core, ${violations} violations; ${Object.keys(found).length} pictures compared`);
for (const w of new Set(wrong)) console.log(`WRONG ${w}`);
process.exit(wrong.length ? 1 : 0);
