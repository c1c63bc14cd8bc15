"""Run the small cases and write, or check, their reference data."""
import glob
import os
import re
import shutil
import tempfile

import data
from make_golden import HERE, lammps, version

CASES = os.path.join(HERE, "cases")

# Ways to run the same case that differ in round-off only: name, change of the script's text, arguments of LAMMPS.
VARIANTS = [
    ("skin x 0.5", lambda t: skin(t, 0.5), []),
    ("skin x 1.7", lambda t: skin(t, 1.7), []),
    ("newton off", lambda t: "newton off\n" + t, []),
    ("sorted", lambda t: re.sub(r"(map array)\n", r"\1 sort 1 " + sort_bin(t) + "\n", t), []),
    ("omp 2", lambda t: t, ["-sf", "omp", "-pk", "omp", "2"]),
    ("dt(1+1e-12)", lambda t: re.sub(r"(?m)^(timestep\s+\S+)e-7", lambda m: m[1] + "00000000001e-7", t), []),
]


def skin(text, factor):
    return re.sub(r"(?m)^(neighbor\s+)(\S+)", lambda m: m[1] + repr(float(m[2]) * factor), text)


def sort_bin(text):
    """A bin of 1.3 lattice constants for sorting, 1 step apart: particles change their order in memory."""
    return repr(1.3 * lattice_constant(text))


def lattice_constant(text):
    """The number of a script's last `lattice` line, or of the variable named there."""
    word = re.findall(r"(?m)^lattice\s+\S+\s+(\S+)", text)[-1]
    if "$" in word:
        word = re.search(r"(?m)^variable\s+" + word.strip("${}") + r"\s+equal\s+(\S+)", text)[1]
    return float(word)


def spacing(name):
    with open(os.path.join(CASES, "in." + name)) as file:
        return lattice_constant(file.read())


def names():
    return sorted(os.path.basename(f)[3:] for f in glob.glob(os.path.join(CASES, "in.*")))


def dump_frames(path):
    """`{step: (columns, {id: row})}` of a text dump, numbers as text."""
    frames = {}
    with open(path) as file:
        lines = file.read().split("\n")
    at = 0
    while lines[at]:
        step, count = int(lines[at + 1]), int(lines[at + 3])
        columns = lines[at + 8].split()[2:]
        rows = [line.split() for line in lines[at + 9 : at + 9 + count]]
        frames[step] = (columns, {int(r[columns.index("id")]): r for r in rows})
        at += 9 + count
    return frames


def thermo(text):
    """Column names and rows of the last thermo table that LAMMPS printed."""
    head, body = re.findall(r"(?m)^ +(Step .*)\n((?: +\d.*\n)+)", text)[-1]
    return head.split(), [line.split() for line in body.splitlines()]


def execute(name, path, change=lambda text: text, extra=()):
    """Run a case; answer its frames, its thermo table and LAMMPS's version."""
    with tempfile.TemporaryDirectory() as folder:
        for file in glob.glob(os.path.join(CASES, name + ".*")):
            if file.endswith((".data", ".start")):
                shutil.copy(file, folder)
        script = os.path.join(folder, "in." + name)
        with open(os.path.join(CASES, "in." + name)) as file:
            text = file.read()
        changed = change(text)
        with open(script, "w") as file:
            file.write(changed)
        printed = lammps(path, script, folder, extra=extra)
        return dump_frames(os.path.join(folder, name + ".dump")), thermo(printed), version(printed)


def short(number):
    """The shortest decimal text of a double that reads back as the same double."""
    value = repr(float(number))
    return value[:-2] if value.endswith(".0") else value


def golden(frames):
    """`[(step, columns, {id: [x, y, z, damage, (dilatation)]})]` of the last two frames."""
    keep = ["x", "y", "z", "c_dmg", "c_dil"]
    answer = []
    for step in sorted(frames)[-2:]:
        columns, rows = frames[step]
        at = [columns.index(k) for k in keep if k in columns]
        answer.append((step, {i: [short(r[k]) for k in at] for i, r in sorted(rows.items())}))
    return answer


def write(name, path):
    frames, (head, rows), release = execute(name, path)
    first = f"# LAMMPS {release}: lmp -in in.{name}\n"
    steps = golden(frames)
    fields = len(next(iter(steps[0][1].values())))
    with open(os.path.join(CASES, name + ".golden"), "w") as file:
        file.write(first + "# id x y z damage" + (" dilatation" if fields > 4 else "") + "\n")
        for step, values in steps:
            file.write(f"step {step}\n")
            for i, row in values.items():
                file.write(f"{i} " + " ".join(row) + "\n")
    with open(os.path.join(CASES, name + ".thermo"), "w") as file:
        file.write(first + "# " + " ".join(h.lower().replace("poteng", "pe").replace("kineng", "ke") for h in head) + "\n")
        for row in rows:
            file.write(" ".join([row[0]] + [short(v) for v in row[1:]]) + "\n")
    describe(name, frames, steps)


def describe(name, frames, steps):
    """Print what happened: the largest displacement between the two frames and the broken part."""
    h = spacing(name)
    first = frames[min(frames)]
    at = [first[0].index(k) for k in "xyz"]
    start = {i: [float(r[k]) for k in at] for i, r in first[1].items()}
    text = f"{name:22} {len(start):5} particles"
    for step, values in steps:
        move = max(max(abs(float(v) - s) for v, s in zip(row, start[i])) for i, row in values.items()) / h
        damage = [float(row[3]) for row in values.values()]
        text += (f" | step {step}: moved {move:8.2e} lc, damage mean {sum(damage) / len(damage):.4f}"
                 f" max {max(damage):.3f} particles {sum(d > 0 for d in damage):4}")
        row = values[1]
        if len(row) > 4:
            text += f" dilatation {max(abs(float(r[4])) for r in values.values()):.1e}"
    print(text, flush=True)


def committed(name):
    steps = []
    with open(os.path.join(CASES, name + ".golden")) as file:
        for line in file:
            word = line.split()
            if word[0] == "step":
                steps.append((int(word[1]), {}))
            elif word[0] != "#":
                steps[-1][1][int(word[0])] = word[1:]
    return steps


def check(name, path):
    """Print how much LAMMPS's own variants differ from the committed data; answer the worst position (lc)."""
    h = spacing(name)
    reference = committed(name)
    worst = 0.0
    text = f"{name:22}"
    for label, change, extra in VARIANTS:
        if label == "omp 2" and "_lps" in name:
            continue  # peri/lps/omp computes no bond forces at all
        if label.startswith("skin") and name.startswith("lost_"):
            continue  # which atoms are lost depends on it
        frames, _, _ = execute(name, path, change, extra)
        other = golden(frames)
        place = damage = 0.0
        for (_, want), (_, have) in zip(reference, other):
            for i, row in want.items():
                place = max(place, max(abs(float(a) - float(b)) for a, b in zip(row[:3], have[i][:3])) / h)
                damage = max(damage, abs(float(row[3]) - float(have[i][3])))
        text += f" | {label}: {place:.0e} " + ("same" if damage == 0 else f"DAMAGE {damage:.0e}")
        worst = max(worst, place)
    print(text, flush=True)
    return worst


def run(wanted, path, check_only=False, data_only=False):
    unknown = set(wanted) - set(names())
    if unknown:
        raise SystemExit("no such case: " + ", ".join(sorted(unknown)) + "; there are " + ", ".join(names()))
    if not check_only:
        data.write(CASES)
    if data_only:
        return
    worst = 0.0
    for name in wanted or names():
        if check_only:
            worst = max(worst, check(name, path))
        else:
            write(name, path)
    if check_only:
        print(f"largest difference of a position: {worst:.1e} lattice constants")
