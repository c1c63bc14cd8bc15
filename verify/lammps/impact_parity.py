#!/usr/bin/env python3
"""Run `in.impact` with peridyne and compare with LAMMPS's committed traces, row by row (a minute or two; needs numpy).

    verify/lammps/impact_parity.py            # PMB to 1,000 steps, LPS to 300
    verify/lammps/impact_parity.py lps
"""
import os
import subprocess
import sys
import tempfile

import impact

HERE = os.path.dirname(os.path.abspath(__file__))
MODELS = {"pmb": (1000, 20), "lps": (300, 10)}


def table(path):
    """Heading lines with the histogram and the CRC-32, and rows of numbers."""
    head, rows = [], []
    with open(path) as file:
        for line in file:
            if line.startswith("# final"):
                head.append(line)
            elif line[0].isdigit():
                rows.append([float(x) for x in line.split(",")])
    return head, rows


def compare(model, folder):
    """True if broken and damaged counts, the histogram and the CRC-32 are LAMMPS's."""
    steps, every = MODELS[model]
    script = os.path.join(HERE, "in.impact")
    variables = {"model": model, "steps": steps, "every": every}
    command = ["cargo", "run", "--quiet", "--release", "-p", "peridyne-cli", "--", "run", script, "--out", folder]
    for name, value in variables.items():
        command += ["--var", f"{name}={value}"]
    text = subprocess.run(command, cwd=HERE, check=True, text=True, stdout=subprocess.PIPE).stdout
    ours_path = os.path.join(folder, "trace.csv")
    impact.write(ours_path, folder, text, "(peridyne)", variables)
    ours_head, ours = table(ours_path)
    head, theirs = table(os.path.join(HERE, f"impact_{model}.csv"))
    if [r[0] for r in ours] != [r[0] for r in theirs]:
        raise SystemExit(f"{model}: the rows are not of the same steps")
    same = [a[:3] == b[:3] for a, b in zip(ours, theirs)]
    agree = same.index(False) if False in same else len(same)
    until = int(theirs[agree - 1][0]) if agree else "none"
    print(f"{model}: broken and damaged counts agree through step {until} of {int(theirs[-1][0])}")
    if agree < len(same):
        print(f"  first difference: ours {ours[agree][:3]}, LAMMPS {theirs[agree][:3]}")
    for k, name in ((3, "pe"), (4, "ke")):
        if model == "lps" and name == "pe":
            continue  # LAMMPS's lacks half of the deviatoric part
        largest = max(abs(a[k] - b[k]) / abs(b[k]) for a, b in zip(ours, theirs) if b[k])
        print(f"  largest relative difference of {name}: {largest:.1e}")
    print(f"  histogram and CRC-32 at the end: {'equal' if ours_head == head else 'differ'}")
    print("  " + ours_head[1].rsplit(" ", 1)[1].strip())
    return all(same) and ours_head == head


def main():
    good = True
    for model in sys.argv[1:] or MODELS:
        with tempfile.TemporaryDirectory() as folder:
            good &= compare(model, folder)
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
