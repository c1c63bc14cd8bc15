"""Every deck of Peridigm's test/regression and PeriLab's test/fullscale_tests, converted, run, and compared with its gold file.

Usage: python decks.py PERIDYNE [--peridigm CHECKOUT] [--perilab CHECKOUT] [--only PART] [--table FILE] [--seconds N]

CHECKOUT is a clone of github.com/peridigm/peridigm or github.com/PeriHub/PeriLab.jl, bare or with files. A line of the table is a deck:
what became of it, the largest difference of each field from the gold over all points and common times, as part of the field's largest
value, and entries that were not mapped. It agrees where all fields are within TOLERANCE, or within its own in KNOWN with the reason
for it. Exit code 1 if one that is not in KNOWN, or has a tolerance there, does not agree: what differs must have its reason.

What is compared, and what is not:
- Displacements and velocities of components that are free: those that are prescribed agree by themselves, and Peridigm adds half of a
  kick of the force that holds them to their velocity (Peridigm.cpp, second half of the step of Verlet). Without a free component and
  another field nothing is compared.
- Force densities without the body force: Peridigm's field has none of it.
- A run in time without `Fixed dt` takes the step of the gold: it is an estimate there, and another here.
- PeriLab's first record is empty; that of the start is written after the first evaluation, with prescribed displacements, and is not
  compared where t is a load or what has broken is asked for.
- PeriLab's statics and Newmark write forces that are not 0 where nothing is held and 0 where something is: they are not compared. Its
  Newmark gives the state after a step the time before it.
- PeriLab's Verlet (Verlet_solver.jl, update_velocity_and_position!) adds Δt/2 a once a step: from the second step on its points move
  as if twice as heavy. Its decks in which nothing acts at the start run with twice the density, which makes the same states; of others
  the states at 0 and Δt are compared, which are those of Verlet.
Needs: pip install numpy scipy
"""

import argparse
import collections
import pathlib
import re
import subprocess
import sys
import tempfile
import tomllib

import numpy as np
from scipy.io import netcdf_file
from scipy.spatial import cKDTree

TOLERANCE = 1e-6

# our nodal variables (without their component), and those of both programs
FIELDS = {
    "displacement": ("displ", ["Displacement", "Displacements"]),
    "velocity": ("velocity", ["Velocity"]),
    "force density": ("force_density", ["Force_Density", "Force Densities"]),
    "force": ("force_density", ["Force", "Forces"]),
    "dilatation": ("dilatation", ["Dilatation"]),
    "damage": ("damage", ["Damage"]),
    "deformation gradient": ("displacement_gradient", ["Deformation_Gradient"]),
}


class Exodus:
    """Nodal and element variables of a file, by point."""

    def __init__(self, path):
        self.data = netcdf_file(path, "r", mmap=False)
        v = self.data.variables
        axes = [f"coord{a}" for a in "xyz" if f"coord{a}" in v]
        at = [v[a].data for a in axes] or list(v["coord"].data)
        self.at = np.zeros((len(at[0]), 3))
        for a, column in enumerate(at):
            self.at[:, a] = column
        self.times = np.array(v["time_whole"].data)
        self.nodal = {n: k for k, n in enumerate(self.names("name_nod_var"), 1)}
        self.element = {n: k for k, n in enumerate(self.names("name_elem_var"), 1)}

    def names(self, name):
        return self.names_of(self.data.variables, name)

    @staticmethod
    def names_of(variables, name):
        rows = variables[name].data if name in variables else []
        return [b"".join(row).split(b"\0")[0].decode().strip() for row in rows]

    def scalar(self, name, frame):
        """Values of a variable at all points; elements are points with the numbers of their nodes."""
        if name in self.nodal:
            return self.data.variables[f"vals_nod_var{self.nodal[name]}"].data[frame]
        if name not in self.element:
            return None
        values = np.full(len(self.at), np.nan)
        blocks = [k for k in range(1, 1000) if f"connect{k}" in self.data.variables]
        for block in blocks:
            nodes = self.data.variables[f"connect{block}"].data
            found = self.data.variables.get(f"vals_elem_var{self.element[name]}eb{block}")
            if nodes.shape[1] != 1 or found is None:
                return None
            values[nodes[:, 0] - 1] = found.data[frame]
        return values

    def field(self, names, frame):
        """Columns of the first of these fields that is there: a scalar, or components in any of the spellings."""
        for name in names:
            one = self.scalar(name, frame)
            if one is not None:
                return one[:, None]
            for style in (str.lower, str.upper, lambda a: "_" + a):
                for components in ("xyz", [a + b for a in "xyz" for b in "xyz"]):
                    columns = [self.scalar(name + style(a), frame) for a in components]
                    columns = [c for c in columns if c is not None]
                    if len(columns) >= 2:
                        return np.stack(columns, axis=1)
        return None


Line = collections.namedtuple("Line", "case kind text worst left")


def files(checkout, under, to):
    """The files of a folder of a checkout, without what is not there of it."""
    checkout = pathlib.Path(checkout)
    if (checkout / under).is_dir():
        return checkout / under
    git = ["git", "--git-dir", str(checkout if (checkout / "HEAD").exists() else checkout / ".git")]
    names = subprocess.run([*git, "ls-tree", "-r", "--name-only", "HEAD", under], capture_output=True, text=True, check=True)
    for name in names.stdout.splitlines():
        shown = subprocess.run([*git, "show", f"HEAD:{name}"], capture_output=True)
        if shown.returncode == 0:
            path = to / name
            path.parent.mkdir(parents=True, exist_ok=True)
            path.write_bytes(shown.stdout)
    return to / under


def entries(text, name):
    """Values of an entry of a deck, YAML or XML, without comments."""
    text = re.sub(r"<!--.*?-->", "", text, flags=re.S)
    text = re.sub(r"(?m)^\s*#.*$", "", text)
    pattern = rf'(?:"|^|\s){re.escape(name)}"?\s*(?::\s*|type="\w+"\s+value=)"?([^"\n#/]+)'
    return [v.strip() for v in re.findall(pattern, text, flags=re.M)]


def gold_of(deck, text):
    """The gold file of a deck."""
    for output in entries(text, "Output Filename"):
        stem = pathlib.Path(output.strip()).name
        tried = [deck.parent / f"{stem}_gold.e", deck.parent / "Reference" / f"{stem}.e"]
        for path in tried + [deck.parent / f"{deck.stem}_gold.e"]:
            if path.is_file():
                return path
    return None


def common(gold, times, kept):
    """Pairs of a frame of the gold and our frames about it with the weight of the second; `times` are ours as there."""
    span = max(abs(times[-1]), abs(times[-1] - times[0]), 1e-300)
    pairs = []
    for g, t in enumerate(gold.times):
        # the first record of PeriLab is empty, that of the start follows
        if (g + 1 < len(gold.times) and g == 0 and gold.times[1] == t) or not kept(t):
            continue
        k = int(np.searchsorted(times, t - 1e-9 * span))
        if k < len(times) and abs(times[k] - t) <= 1e-6 * span:
            pairs.append((g, k, k, 0.0))
        elif 0 < k < len(times):
            pairs.append((g, k - 1, k, (t - times[k - 1]) / (times[k] - times[k - 1])))
    return pairs


def step_of(gold):
    """The step of a gold file of PeriLab: after an empty record there is one every k states, the first that of the k-th."""
    times = gold.times[1:]
    if len(times) < 2:
        return None
    return float(times[1] - times[0] - times[0])


class Conditions:
    """What the new deck prescribes: free components of the points of its mesh, and body forces."""

    def __init__(self, new):
        deck = tomllib.loads(new.read_text())
        mesh = new.parent / deck["body"]["file"]
        data = netcdf_file(mesh, "r", mmap=False).variables if mesh.suffix == ".g" else {}
        names = Exodus.names_of(data, "ns_names")
        if not data:
            self.at = None
            return
        self.at = np.stack([data[f"coord{a}"].data for a in "xyz" if f"coord{a}" in data], axis=1)
        self.at = np.pad(self.at, ((0, 0), (0, 3 - self.at.shape[1])))
        self.free = np.ones((len(self.at), 3), bool)
        self.loads = []
        for condition in deck.get("boundary_condition", []):
            members = np.arange(len(self.at))
            if condition.get("set") in names:
                members = data[f"node_ns{names.index(condition['set']) + 1}"].data - 1
            for kind in ("displacement", "velocity"):
                for a in condition.get(kind, {}):
                    self.free[members, "xyz".index(a)] = False
            for a, text in condition.get("body_force", {}).items():
                self.loads.append((members, "xyz".index(a), str(text)))

    def body_force(self, at, t):
        """Force densities that the deck adds, at these points of the mesh."""
        found = np.zeros((len(self.at), 3))
        for members, a, text in self.loads:
            x, y, z = self.at[members].T
            scope = {"x": x, "y": y, "z": z, "t": t, "pi": np.pi, "e": np.e, "__builtins__": {}}
            functions = {n: getattr(np, n) for n in ("sin", "cos", "tan", "exp", "log", "sqrt", "abs", "hypot")}
            found[members, a] += eval(text.replace("^", "**"), scope, functions)
        return found[at]


def points_of(ours, gold):
    """Our point at each of the gold's, or why there is none."""
    distance, nearest = cKDTree(ours.at).query(gold.at)
    size = np.ptp(gold.at, axis=0).max()
    if len(ours.at) != len(gold.at) or distance.max() > 1e-6 * size:
        return f"its points are others: {len(gold.at)} there, {len(ours.at)} here, {distance.max():.1e} apart"
    return nearest


def compare(ours, gold, times, deck, program, last):
    """Largest difference of each field as part of its largest value, or why there is none; up to the step `last`, if that is there."""
    nearest = points_of(ours, gold)
    if isinstance(nearest, str):
        return nearest
    conditions = Conditions(deck)
    statics, peri_lab = "[statics]" in deck.read_text(), program == "perilab"
    matrices = peri_lab and (statics or "newmark" in deck.read_text())
    of = None
    free = np.ones((len(gold.at), 3), bool)
    if conditions.at is not None:
        of = cKDTree(conditions.at).query(gold.at)[1]
        free = conditions.free[of]
    start = times[0]
    kept = lambda t: not (statics and peri_lab and t == start) and (last is None or t <= start + 1.001 * last)
    pairs = common(gold, times, kept)
    if not pairs or (last is not None and not any(gold.times[g] > start for g, *_ in pairs)):
        return "no time of the gold is in the run" if last is None else "no record of the gold is that of the first step"
    volume = np.concatenate([ours.data.variables[k].data[:, 1] for k in attributes(ours)])
    order = np.concatenate([ours.data.variables[k.replace("attrib", "connect")].data[:, 0] for k in attributes(ours)]) - 1
    volumes = np.empty(len(ours.at))
    volumes[order] = volume
    worst, something = {}, False
    for label, (here, there) in FIELDS.items():
        largest, off = 0.0, 0.0
        in_motion = label in ("displacement", "velocity")
        if (statics and label == "velocity") or (in_motion and not free.any()) or (matrices and label.startswith("force")):
            continue
        for g, a, b, weight in pairs:
            if label == "damage" and peri_lab and gold.times[g] == start:
                continue
            wanted = gold.field(there, g)
            found = [ours.field([here], k) for k in (a, b)]
            if wanted is None or any(f is None for f in found):
                break
            found = (found[0] + weight * (found[1] - found[0]))[nearest][:, : wanted.shape[1]]
            t = times[a] + weight * (times[b] - times[a])
            # equilibria begin without loads here
            if label.startswith("force") and not peri_lab and of is not None and not (statics and t == start):
                t = (t - start) / (times[-1] - start) if statics else t
                found = found - conditions.body_force(of, t)[:, : wanted.shape[1]]
            if label == "deformation gradient":
                found = found + np.eye(3).ravel()
            if label == "force":
                found = found * volumes[nearest][:, None]
            asked = ~np.isnan(wanted)
            if in_motion:
                asked &= free[:, : wanted.shape[1]]
            largest = max(largest, np.abs(wanted).max(initial=0.0, where=~np.isnan(wanted)))
            off = max(off, np.abs(found - wanted)[asked].max(initial=0.0))
            # that nothing breaks is a result
            something |= label == "damage" or bool(wanted[asked].any() or found[asked].any())
        else:
            worst[label] = float(off if largest == 0.0 else off / largest)
    if not something:
        return "no field of the gold is in the run with a component that is free and not 0"
    return worst


def attributes(file):
    return sorted((k for k in file.data.variables if re.fullmatch(r"attrib\d+", k)), key=lambda k: int(k[6:]))


def shorter(message):
    """What a program says of a failure, in one line without paths and frames."""
    lines = [l.strip(" ×│╭╰─·▶|") for l in message.splitlines() if "not mapped:" not in l and ": note:" not in l]
    text = re.sub(r"\s+", " ", " ".join(l for l in lines if l)).strip()
    return re.sub(r"/\S*/(\S+)", r"\1", text.removeprefix("Error:").strip())[:160] or "nothing was said"


def twice_as_heavy(new, damping):
    """Doubles densities and dampings of a deck; adds a damping, as part of the velocity in a unit of time, where the deck has none."""
    text = re.sub(r"(?m)^(density|damping) = (\S+)", lambda m: f"{m[1]} = {2.0 * float(m[2])!r}", new.read_text())
    if damping and "\ndamping = " not in text:
        material = tomllib.loads(text)["material"]
        for m in [material] if "law" in material else material.values():
            text += f"\n[[boundary_condition]]\nset = \"{m.get('set', 'all')}\"\ndamping = {m['density'] * damping!r}\n"
    new.write_text(text)


def case(peridyne, deck, name, program, seconds):
    text = deck.read_text(errors="replace")
    with tempfile.TemporaryDirectory() as folder:
        folder = pathlib.Path(folder)
        new = folder / "new.toml"
        done = subprocess.run([peridyne, "convert", str(deck), "-o", str(new)], capture_output=True, text=True)
        said = done.stdout + done.stderr
        left = sorted({l.split("not mapped: ", 1)[1] for l in said.splitlines() if "not mapped: " in l})
        if done.returncode != 0:
            return Line(name, "refused", shorter(done.stderr), {}, left)
        statics = "[statics]" in new.read_text()
        sets = ["output.report=false", "output.picture=false"]
        gold = gold_of(deck, text)
        try:
            gold = gold and Exodus(gold)
        except (TypeError, ValueError) as error:
            return Line(name, "no gold", f"its gold is not read: {error}", {}, left)
        step = None
        if not statics and "newmark" not in new.read_text():
            estimated = program == "perilab" and "time_step = {" in new.read_text()
            step = step_of(gold) if gold and estimated else None
            if step:
                # every state is written: between those of frames nothing is known
                sets += [f"run.time_step={step!r}", "output.every=1"]
            # there a step that is too long is taken as it is
            if step or "time_step = {" not in new.read_text():
                sets.append("run.force_unstable=true")
        if step:
            new.write_text(re.sub(r"(?m)^frames = \d+\n", "", new.read_text()))
        def run(*more):
            """The results, or why there are none."""
            command = [peridyne, "run", str(new), "--out", str(folder / "out")]
            command += [word for s in [*sets, *more] for word in ("--set", s)]
            try:
                done = subprocess.run(command, capture_output=True, text=True, timeout=seconds)
            except subprocess.TimeoutExpired:
                return Line(name, "too long", f"more than {seconds} s", {}, left)
            if done.returncode != 0:
                return Line(name, "does not run", shorter(done.stderr), {}, left)
            return Exodus(next((folder / "out").glob("*.e")))

        moving = program == "perilab" and not statics and "newmark" not in new.read_text() and Conditions(new).free.any()
        last = step_of(gold) if gold and moving else None
        if last is not None and '"force_density"' not in new.read_text():
            # what acts at the start decides
            new.write_text(new.read_text().replace("fields = [", 'fields = ["force_density", '))
        if last is None:
            ours = run()
        else:
            ours = run("run.steps=1" if "\nsteps = " in new.read_text() else f"run.duration={last!r}")
            fields = [] if isinstance(ours, Line) else [ours.field([f], 0) for f in ("force_density", "velocity")]
            if any(f is not None for f in fields) and not any(f is not None and f.any() for f in fields):
                last = None
                damping = float((entries(text, "Numerical Damping") or ["0"])[0])
                twice_as_heavy(new, damping / step if step and damping else 0.0)
                ours = run()
        if isinstance(ours, Line):
            return ours
        if gold is None:
            return Line(name, "no gold", "", {}, left)
        start = float((entries(text, "Initial Time") or ["0"])[0])
        times = ours.times + start
        if program == "perilab" and "newmark" in new.read_text():
            times = times - ours.times[1]
        if statics:
            end = entries(text, "Final Time")
            steps = entries(text, "Time Steps")
            end = float(end[0]) if end else float(steps[0].split()[-1])
            times = start + (end - start) * ours.times
        found = compare(ours, gold, times, new, program, last)
    if isinstance(found, str):
        return Line(name, "not compared", found, {}, left)
    tolerance, why = known(name)
    most = max(found.values())
    if tolerance is None:
        return Line(name, "differs", "", found, left)
    return Line(name, "agrees" if most <= tolerance else "DIFFERS", "", found, left)


def table(lines):
    rows = ["| deck | | largest difference | why, what is not mapped |", "|---|---|---|---|"]
    for l in lines:
        worst = ", ".join(f"{field} {value:.0e}" for field, value in l.worst.items())
        left = collections.Counter(e.split(" / ")[0] for e in l.left)
        rest = ", ".join(f"{k} ({n})" for k, n in left.items())
        why = known(l.case)[1] if l.kind != "refused" else ""
        said = [x for x in (why, l.text.replace("|", "/"), rest and "not mapped: " + rest) if x]
        rows.append(f"| {l.case} | {l.kind} | {worst} | {'; '.join(said)} |")
    counts = collections.Counter(l.kind for l in lines)
    rows.append("")
    rows.append(f"{len(lines)} decks: " + ", ".join(f"{n} {kind}" for kind, n in counts.most_common()))
    return "\n".join(rows)


# names of decks, tolerance (None: it differs), and why; the first that fits
KNOWN = [
    # Peridigm
    ("Body_Force/Body_Force_Implicit", None, "its first acceleration of implicit motion is 0; here a load acts from the start"),
    ("Bar_TwoDisconnectedPieces_QS/", None, "Omit Bonds Between Blocks is not mapped: blocks become bodies of their own"),
    ("Contact_", None, "contact is not mapped: search and stiffness are its own"),
    ("ElementVariableOutput/", None, "its node set has a point 0, which Peridigm itself refuses now; the gold took it as the first"),
    ("Interfaces/", None, "a block is of a material that is not mapped, and holds the others"),
    ("Notched_Plate_Data_Loader/", None, "values of a file of data are not mapped"),
    ("PrecrackedPlateTwoCracks/", None, "bonds meet the edge of a crack: round-off decides there (of 41,640 neighbours 48 are on one side alone)"),
    ("WaveInCube/", None, "its mesh is not in the repository"),
    ("(Multiphysics|Pals)_", None, "no law here"),
    # PeriLab
    ("test_Bond_Based_Elastic/test_bond_based_elastic_2D", 1e-3, "displacements of 1e-13 of a length of 1: round-off of stretches"),
    ("test_Bond_Based_Elastic/test_static_bond_based_elastic_2D", None, "its solver stops at a residual of 1e-8, and the forces are below"),
    ("test_Gmsh/", 1e-5, "its damping takes a part of the velocity once a step, here it is a force"),
    ("test_FEM", None, "finite elements are not mapped"),
    ("test_Penalty_Contact/", None, "contact is not mapped"),
    ("test_DCB/DCBmodel_(PD_solid|unified_bb)", None, "ENERGY"),
    ("test_DCB/DCBmodel_UMAT", None, "no law of the user"),
    ("test_DCB/", None, "CORRESPONDENCE; ENERGY"),
    ("test_Newmark/Newmark_thermal|thermal|temperature|matrix_based_additive|Hetval|heat_transfer", None, "temperatures are not mapped"),
    ("test_Newmark/Newmark_solver_DCBmodel", None, "CORRESPONDENCE; ENERGY"),
    (
        "test_correspondence_elastic_3D/strain_(xx|xy|yy)",
        None,
        "its stress agrees to 1e-14; its forces are not those of its source, which NumPy gives (ours to 1e-14 with P = F(C:E))",
    ),
    ("test_(Correspondence|correspondence)|_correspondence|test_Newmark/|test_linear_static_matrix_based_solver/", None, "CORRESPONDENCE"),
    ("test_aniso_damage/", None, "damage of directions is not mapped; ENERGY"),
    ("test_body_force/", None, "its points of distorted hexahedra are means of the corners, here the centroids"),
    ("test_critical_energy/critical_energy_pressure", None, "bonds break in compression there (Only Tension: false); here in tension alone"),
    ("test_point_wise_material/", None, "moduli of each point (a column of the mesh) are not mapped"),
    ("test_Surface_Correction/", None, "its correction of surfaces is not mapped"),
    ("test_(BCs|dry_run|reload)", None, "Material Models: False: nothing acts there"),
]
REASONS = {
    "CORRESPONDENCE": "its first Piola stress is (C:E)F^-1, here F(C:E), the slope of an energy; its control of zero-energy modes is a tensor, C:K^-1",
    "ENERGY": "Critical Energy is the energy of a bond by the forces of now, here the stretch that the fracture energy says",
}


def known(name):
    """Tolerance of a deck and the reason for it."""
    tolerance, why = next(((t, w) for pattern, t, w in KNOWN if re.search(pattern, name)), (TOLERANCE, ""))
    for short, text in REASONS.items():
        why = why.replace(short, text)
    return tolerance, why


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument("peridyne")
    arguments.add_argument("--peridigm")
    arguments.add_argument("--perilab")
    arguments.add_argument("--only", default="")
    arguments.add_argument("--table")
    arguments.add_argument("--seconds", type=float, default=120)
    a = arguments.parse_args()
    peridyne = str(pathlib.Path(a.peridyne).resolve())
    lines = []
    with tempfile.TemporaryDirectory() as folder:
        for program, checkout, under, kinds in [
            ("peridigm", a.peridigm, "test/regression", (".xml", ".yaml")),
            ("perilab", a.perilab, "test/fullscale_tests", (".yaml",)),
        ]:
            if not checkout:
                continue
            root = files(checkout, under, pathlib.Path(folder) / pathlib.Path(under).name)
            for deck in sorted(p for p in root.rglob("*") if p.suffix in kinds):
                name = str(deck.relative_to(root))
                if a.only in name and not re.search(r"/np\d/", name):
                    lines.append(case(peridyne, deck, name, program, a.seconds))
                    print(*lines[-1][:4], flush=True)
    print(table(lines))
    if a.table:
        pathlib.Path(a.table).write_text(table(lines) + "\n")
    unknown = [l.case for l in lines if l.kind not in ("agrees", "refused", "no gold") and not known(l.case)[1]]
    if unknown or any(l.kind == "DIFFERS" for l in lines):
        sys.exit(f"decks without a reason in KNOWN: {unknown}")


if __name__ == "__main__":
    main()
