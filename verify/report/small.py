#!/usr/bin/env python3
"""A report in a browser, in a minute: small.py PROGRAM [--out DIR] [--learn]

Runs a plate that breaks, a rigid body that flies and a script of LAMMPS, opens their reports from the disk in a headless Chromium (Debian's, installed
where it is missing and this is root; or the one that CHROMIUM names) without a network, clicks, and compares pixels: those that the page's own loops
draw are the same on every machine; what a graphics driver draws must be there and change. verify/report/run.sh does much more.
Needs playwright (pip); expected.small.json holds the pixels, --learn writes them anew.
"""

import argparse
import json
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
DECKS = HERE.parent.parent / "decks"
STORED = HERE / "expected.small.json"
# how far shares of the canvas and mean colours may be from the stored ones
WITHIN = 0.004
# a loaded machine is slow, not wrong (ms)
PATIENCE = 120_000

LOOK = """() => {
  viewer.now();
  const from = viewer.whole();
  const { data } = from.getContext("2d").getImageData(0, 0, from.width, from.height);
  let covered = 0, hash = 0;
  const sum = [0, 0, 0];
  for (let k = 0; k < data.length; k += 4) {
    for (let c = 0; c < 4; c++) hash = (Math.imul(hash, 31) + data[k + c]) | 0;
    if (data[k + 3] < 128) continue;
    covered++;
    for (let c = 0; c < 3; c++) sum[c] += data[k + c];
  }
  const all = data.length / 4;
  return { hash, seen: [covered / all, ...sum.map(s => s / Math.max(1, covered) / 255)].map(x => Number(x.toFixed(4))) };
}"""

SCRIPT = """units si
dimension 3
boundary s s s
atom_style peri
atom_modify map array
neighbor 0.001 bin
lattice sc 0.0005
region target cylinder y 0.0 0.0 0.004 -0.0015 0.0 units box
create_box 1 target
create_atoms 1 region target
pair_style peri/pmb
pair_coeff * * 1.6863e22 0.0015001 0.0005 0.25
set group all density 2200
set group all volume 1.25e-10
velocity all set 0.0 0.0 0.0 sum no units box
fix F1 all nve
variable y equal "0.00110 - 100*step*dt"
fix F2 all indent 1e17 sphere 0.0 v_y 0.0 0.001 units box
compute C1 all damage/atom
timestep 1.0e-7
thermo 40
dump D1 all custom 40 dump.peri id type x y z c_C1
run 200
"""


def chromium():
    """A browser; installs Debian's."""
    names = [os.environ.get("CHROMIUM"), "chromium", "chromium-browser", "google-chrome"]
    for name in filter(None, names):
        if found := shutil.which(name):
            return found
    if not shutil.which("apt-get"):
        sys.exit("no Chromium: install it, or name it in CHROMIUM")
    for command in (["apt-get", "update"], ["apt-get", "install", "-y", "--no-install-recommends", "chromium"]):
        done = subprocess.run(command, capture_output=True, text=True)
        if done.returncode:
            sys.exit(f"{' '.join(command)}: {done.stderr[-600:]}")
    return shutil.which("chromium")


def run(program, out, deck, *more):
    command = [program, "run", str(deck), "--out", str(out), *more]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        sys.exit(f"{' '.join(command)}\n{done.stdout[-600:]}{done.stderr[-600:]}")


class Check:
    def __init__(self, browser, out):
        self.browser, self.out = browser, out
        self.wrong, self.found = [], {}

    def must(self, holds, what):
        if not holds:
            self.wrong.append(what)

    def open(self, name, hash="#loops", width=1200, **more):
        context = self.browser.new_context(viewport={"width": width, "height": 900}, offline=True, **more)
        page = context.new_page()
        page.set_default_timeout(PATIENCE)
        page.on("console", lambda m: self.must(m.type in ("info", "log", "debug"), f"{name}: console: {m.text}"))
        page.on("pageerror", lambda e: self.wrong.append(f"{name}: {e}"))
        page.on("request", lambda r: self.must(r.url.split(":")[0] in ("file", "data", "blob"), f"{name}: asks for {r.url}"))
        page.goto(f"file://{self.out}/{name}/report.html{hash}")
        page.wait_for_selector("body[data-ready]")
        self.must(page.get_attribute("body", "data-ready") == "yes", f"{name}: the body is not drawn")
        # the picture is as high as the words beside it, and fonts differ
        page.add_style_tag(content=f"#stage {{ flex: none !important; width: {min(760, width - 60)}px !important; height: 480px !important; }}")
        page.wait_for_function("() => viewer.canvas.height === Math.round(480 * viewer.ratio)")
        return page

    def look(self, page, name):
        """Pixels once they have settled: twice the same."""
        last = None
        for _ in range(40):
            page.wait_for_timeout(60)
            now = page.evaluate(LOOK)
            if now == last:
                break
            last = now
        self.found[name] = now["seen"]
        return now

    def changed(self, page, name, before, what):
        now = self.look(page, name)
        self.must(now["hash"] != before["hash"], f"{name}: {what} changes nothing")
        return now


def plate(c):
    page = c.open("kalthoff")
    c.must(page.evaluate("viewer.draw.name") == "loops", "loops do not draw")
    c.must(page.input_value("#field") == "damage", "the first field is not damage")
    c.must("velocity of struck: 22 m/s" in page.text_content("#marksSays").lower(), f"loads: {page.text_content('#marksSays')}")
    first = c.look(page, "plate")
    c.must(page.locator("#marks path.load").count() > 3 and page.locator("#marks path.crack").count() > 1, "loads and cracks are not drawn")
    page.uncheck("#marksOn")
    bare = c.changed(page, "plate without marks", first, "taking marks away")
    page.check("#marksOn")
    page.select_option("#only", "torn")
    torn = c.changed(page, "torn points", first, "the view of cracks")
    c.must(0 < torn["seen"][0] < 0.5 * bare["seen"][0], f"torn points cover {torn['seen'][0]}")
    page.select_option("#only", "all")
    page.focus("#frame")
    page.keyboard.press("Home")
    c.must(page.text_content("#when") == "t = 0\u00a0s" or page.wait_for_timeout(800) or page.text_content("#when") == "t = 0\u00a0s", "Home is not the first frame")
    c.changed(page, "first frame", first, "the first frame")
    page.keyboard.press("End")
    page.select_option("#field", "displacement")
    c.changed(page, "displacement", first, "another field")
    page.select_option("#field", "damage")
    page.focus("#view")
    for _ in range(3):
        page.keyboard.press("ArrowUp")
    page.keyboard.press("+")
    c.changed(page, "turned", first, "turning and coming closer")
    page.keyboard.press("0")
    again = c.look(page, "plate")
    c.must(again["hash"] == first["hash"], "0 does not bring the first view back")
    wide = page.evaluate("document.documentElement.scrollWidth")
    c.must(wide <= 1200, f"{wide} pixels wide in 1200")
    page.context.close()


def ball(c):
    page = c.open("layered")
    first = c.look(page, "ball")
    page.uncheck("#spheres")
    c.changed(page, "without the ball", first, "taking the ball away")
    page.check("#spheres")
    page.select_option("#cutAxis", "2")
    c.changed(page, "cut", first, "a cut")
    places = page.evaluate("scenes[0].balls[0].path.map(p => p[3])")
    c.must(len(set(places)) > 3, f"a free ball does not move: {places}")
    page.context.close()


def script(c):
    page = c.open("script", width=360, color_scheme="dark", has_touch=True)
    c.must(page.input_value("#field") == "damage", f"the first field of a dump is {page.input_value('#field')}")
    c.must(page.text_content("#whenCount").endswith("/ 6"), f"frames of a dump: {page.text_content('#whenCount')}")
    c.must("cubic" in page.text_content("#understood"), "a script is not understood")
    c.must(page.locator("#plots figure").count() + page.locator("#anyPlot svg.plot").count() > 0, "thermo output is not plotted")
    c.look(page, "script")
    wide = page.evaluate("document.documentElement.scrollWidth")
    c.must(wide <= 360, f"{wide} pixels wide in 360")
    page.context.close()


def driver(c):
    """What a graphics driver draws differs from machine to machine: it must be there, and change."""
    page = c.open("kalthoff", hash="")
    first = page.evaluate(LOOK)
    c.must(first["seen"][0] > 0.03, f"{page.evaluate('viewer.draw.name')} leaves the canvas blank")
    page.select_option("#field", "displacement")
    for _ in range(40):
        page.wait_for_timeout(60)
        if page.evaluate(LOOK)["hash"] != first["hash"]:
            break
    else:
        c.wrong.append("another field looks the same")
    page.context.close()


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("program", type=Path)
    arguments.add_argument("--out", type=Path)
    arguments.add_argument("--learn", action="store_true")
    given = arguments.parse_args()
    from playwright.sync_api import sync_playwright

    program = given.program.resolve()
    browser = chromium()
    out = given.out or Path(tempfile.mkdtemp())
    out = out.resolve()
    run(program, out / "kalthoff", DECKS / "good/kalthoff.toml", "--set", "body.spacing=2.5 mm")
    run(program, out / "layered", DECKS / "good/layered_block.toml")
    (out / "in.disk").write_text(SCRIPT)
    run(program, out / "script", out / "in.disk")
    with sync_playwright() as p:
        flags = ["--no-sandbox", "--disable-quic", "--force-color-profile=srgb", "--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
        b = p.chromium.launch(executable_path=browser, headless=True, args=flags, timeout=PATIENCE)
        c = Check(b, out)
        for part in (plate, ball, script, driver):
            part(c)
        b.close()
    if given.learn:
        lines = ",\n".join(f" {json.dumps(k)}: {json.dumps(v)}" for k, v in c.found.items())
        STORED.write_text("{\n" + lines + "\n}\n")
    stored = json.loads(STORED.read_text())
    for name, seen in c.found.items():
        off = max(abs(a - b) for a, b in zip(seen, stored.get(name, [9.0])))
        c.must(off <= WITHIN, f"{name}: pixels are {seen}, were {stored.get(name)}")
    for wrong in dict.fromkeys(c.wrong):
        print(f"WRONG {wrong}")
    print(f"3 reports, {len(c.found)} pictures compared, {'no' if not c.wrong else len(set(c.wrong))} faults")
    sys.exit(bool(c.wrong))


if __name__ == "__main__":
    main()
