"""How much faster are two ranks than one, and how much slower with twice the points, beside what `peridyne plan` foresees?

Ranks are threads of one process with one thread each. Strong: the same block on one and on two. Weak: a block on one, and one twice as long on two. Each time is the
least of some runs. What a message costs is measured between two threads (`peridyne ranks`).

Usage: python verify/ranks/scaling.py --program target/release/peridyne [--cells 40] [--steps 30] [--tries 3]
"""

import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

DECK = """\
body = {{ lattice = "cubic", spacing = "1 mm", region = {{ block = {{ low = [0, 0, 0], high = ["{n} mm", "{n} mm", "{long} mm"] }} }} }}
horizon = {{ m_ratio = 3 }}
[material]
density = "2440 kg/m^3"
law = {{ {law} }}
fracture = {{ energy = "135 J/m^2" }}
[[initial]]
velocity = {{ z = "10 m/s * z / (100 mm)" }}
[run]
steps = {steps}
time_step = "50 ns"
[output]
picture = false
report = false
"""
LAWS = {"pmb": 'pmb = { young = "72 GPa" }', "lps": 'lps = { young = "72 GPa", poisson = 0.22 }'}


def main():
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("--program", type=Path, required=True)
    asked.add_argument("--cells", type=int, default=40)
    asked.add_argument("--steps", type=int, default=30)
    asked.add_argument("--tries", type=int, default=3)
    asked = asked.parse_args()

    def said(*words):
        return json.loads(subprocess.run([asked.program.resolve(), *map(str, words)], capture_output=True, text=True, check=True).stdout)

    [speed] = said("ranks", "--on-threads", 2, "--json")["speeds"]
    network = ["--latency", 1e6 * speed["latency_s"], "--bandwidth", 1e-9 * speed["bytes_per_s"]]
    print(f"a message takes {1e6 * speed['latency_s']:.2f} µs and {1e-9 * speed['bytes_per_s']:.1f} GB/s")
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)

        def deck(law, long):
            path = folder / f"{law}_{long}.toml"
            path.write_text(DECK.format(n=asked.cells, long=long, law=LAWS[law], steps=asked.steps))
            return path

        def measured(path, ranks):
            """Seconds of a step, the least of all tries."""
            times = []
            for n in range(asked.tries):
                out = folder / f"out_{n}"
                subprocess.run([asked.program.resolve(), "run", path, "--out", out, "--threads", "1", "--on-threads", str(ranks)], capture_output=True, check=True)
                record = json.loads((out / "run.json").read_text())
                times.append(record["seconds_stepping"] / record["steps"])
            return min(times)

        def foreseen(path):
            found = said("plan", path, "--nodes", "1,2", "--cores", 1, "--threads", 1, "--steps", asked.steps, "--json", *network)
            return [node["seconds_per_step"] for node in found["nodes"]], found.get('meanwhile', {'part': 0})

        print(f"{'law':>4} {'points':>9} {'ranks':>5} {'step':>10} {'foreseen':>10} {'speedup':>8} {'foreseen':>8}")
        for law in LAWS:
            short, long = asked.cells, 2 * asked.cells
            of_one = {}
            for cells in [short, long]:
                path = deck(law, cells)
                plan, meanwhile = foreseen(path)
                for ranks in [1, 2]:
                    took = measured(path, ranks)
                    of_one.setdefault(cells, (took, plan[0]))
                    gain = [one / now for one, now in zip(of_one[cells], (took, plan[ranks - 1]))]
                    points = asked.cells**2 * cells
                    print(f"{law:>4} {points:>9} {ranks:>5} {1e3 * took:>7.2f} ms {1e3 * plan[ranks - 1]:>7.2f} ms {gain[0]:>8.2f} {gain[1]:>8.2f}")
                    if cells == long and ranks == 2:
                        weak = [one / now for one, now in zip(of_one[short], (took, plan[1]))]
            print(f"{law:>4} twice the points on two ranks: efficiency {100 * weak[0]:.0f} %, foreseen {100 * weak[1]:.0f} %; {100 * meanwhile['part']:.0f} % of the work is done while messages come")
    return 0


if __name__ == "__main__":
    sys.exit(main())
