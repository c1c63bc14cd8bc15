"""Does the program find the MPI that started it, do messages between its ranks come as they were sent, and is it said where they cannot?

And does a run that they share write the same bytes on any number of them, cut off and gone on with on another number, or after one of them was killed, and
end well where its input is wrong?

Usage: python verify/ranks/check.py --program target/debug/peridyne --mpi FOLDER [--mpi FOLDER]
FOLDER has bin/mpiexec and lib/libmpi_abi.so.1: a virtual environment into which `pip install mpich` or `pip install impi-rt` was done.
"""

import argparse
import hashlib
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from pathlib import Path

RANKS = [1, 2, 3, 4]
# of messages from each rank to each
LENGTHS = 4
DECKS = Path(__file__).resolve().parents[2] / "decks/good"
DECK = DECKS / "ten_lines.toml"
SCRIPTS = DECKS.parents[1] / "verify/lammps/cases"
# what is run of it on any number of ranks, of another one on three: keys, where it is cut off, bonds that break at least
ASKED = {
    "ten_lines": (["body.spacing=1 mm", "run.steps=200", "output.every=60"], 110, 5_000),
    "two_bodies": (["output.every=40"], 70, 5_000),
    "fast_and_hot": ([], 50, 500),
    "snap_back": ([], 5, 5),
    "dragged_disk": (["statics.increments=6"], 3, 0),
    "implicit_crack": (["run.duration=\"12 us\""], 5, 1),
    "lennard_jones_liquid": ([], 120, 0),
    "silicon_torn": (["run.steps=600"], 350, 5),
    "braking_block": ([], 90, 0),
    "glued_solids": ([], 20, 5),
    "in.indent_pmb": ([], 30, 5),
}
# a run that is killed: as the first one, with a state every fifth of a second
KILLED = ["--set", "body.spacing=1 mm", "--set", "run.steps=400", "--set", "output.every=150", "--set", 'output.checkpoint={ every = "0.2 s", keep = 2 }']


def environment(**more):
    # processes of this machine, through its memory; nothing of another MPI
    return {k: v for k, v in os.environ.items() if not k.startswith(("PMI_", "OMPI_", "SLURM_", "PERIDYNE_MPI"))} | {"HYDRA_LAUNCHER": "fork", "I_MPI_FABRICS": "shm"} | more


def run(command, **more):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, env=environment(**more), timeout=300)
    return done.returncode, done.stdout, done.stderr


def of_run(process, program, out):
    """Is it a rank of the run with these results?"""
    try:
        words = (process / "cmdline").read_bytes().split(b"\0")
    except OSError:
        return False
    return words[0] == str(program).encode() and str(out).encode() in words


def main():
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("--program", type=Path, required=True)
    asked.add_argument("--mpi", type=Path, action="append", default=[])
    asked = asked.parse_args()
    program, wrong, ends = asked.program.resolve(), [], {}

    def end(name, launcher, *more, deck="ten_lines"):
        """A run to its end, and one that is cut off and goes on: all that they write but for the clock."""
        keys, stop, broken = ASKED[deck]
        keys = [word for key in keys for word in ["--set", key]]
        with tempfile.TemporaryDirectory() as folder:
            for parts in [1, 2]:
                out = Path(folder) / f"{parts}"
                path = SCRIPTS / deck if deck.startswith("in.") else DECKS / f"{deck}.toml"
                first = ["run", path, *keys, "--out", out]
                cut = ["--stop-after", stop] if parts == 2 else []
                for part, words in enumerate([[*first, *cut], ["resume", out]][:parts]):
                    # what was cut off goes on in one process
                    on = [] if part else launcher
                    code, said, err = run([*on, program, *words, "--threads", "1", *([] if part else more)])
                    if code:
                        wrong.append(f"{name}: {code}\n{said}{err}")
                        return
                record = json.loads((out / "run.json").read_text())
                ends[deck, f"{name}, {parts}"] = written(out)
                hold(record["broken_bonds"] >= broken, f"{name}: {record['broken_bonds']} broken")
                ranks = 1 if name == "alone" or parts == 2 else int(name.split()[-1])
                hold(record["ranks"] == ranks, f"{name}: {record['ranks']} ranks")

    def hold(true, what):
        if not true:
            wrong.append(what)

    def written(out):
        record = json.loads((out / "run.json").read_text())
        files = {str(p.relative_to(out)): hashlib.sha256(p.read_bytes()).hexdigest() for p in sorted(out.rglob("*")) if p.is_file() and p.name not in ["run.json", "report.html"] and p.suffix != ".log"}
        return record["state_hash"], record["ledger_hash"], files

    def killed(mpi, whole):
        """One of three ranks is killed while they run: the others end, and other numbers of ranks go on from the last state."""
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "out"
            words = [mpi / "bin/mpiexec", "-n", 3, program, "run", DECK, *KILLED, "--threads", 1, "--out", out]
            launcher = subprocess.Popen([str(word) for word in words], env=environment(), stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
            until = time.monotonic() + 120
            while not list(out.glob("checkpoint/*.state")) and launcher.poll() is None and time.monotonic() < until:
                time.sleep(0.01)
            ranks = [int(p.name) for p in Path("/proc").iterdir() if p.name.isdigit() and of_run(p, program, out)]
            hold(len(ranks) == 3 and launcher.poll() is None, f"{mpi}: {len(ranks)} ranks run, and the launcher: {launcher.poll()}")
            if ranks:
                os.kill(max(ranks), signal.SIGKILL)
            try:
                code = launcher.wait(60)
            except subprocess.TimeoutExpired:
                launcher.kill()
                code = 0
            hold(code != 0, f"{mpi}: a rank was killed, and the others go on")
            for ranks in [2, 4]:
                again = Path(folder) / f"on {ranks}"
                shutil.copytree(out, again)
                code, said, err = run([mpi / "bin/mpiexec", "-n", ranks, program, "resume", again, "--threads", 1])
                hold(code == 0 and written(again) == whole, f"{mpi}, one of 3 killed, on {ranks}: {code}\n{said}{err}")
            print(f"mpiexec of {mpi.name}: one of 3 ranks was killed, 2 and 4 went on")

    with tempfile.TemporaryDirectory() as folder:
        code, said, err = run([program, "run", DECK, *KILLED, "--out", Path(folder) / "out"])
        whole = written(Path(folder) / "out") if code == 0 else hold(False, f"alone: {said}{err}")
    for mpi in asked.mpi:
        killed(mpi, whole)
        for ranks in RANKS:
            code, out, err = run([mpi / "bin/mpiexec", "-n", ranks, program, "ranks", "--json"])
            try:
                found = json.loads(out)
            except json.JSONDecodeError:
                found = None
            good = code == 0 and found is not None and found["ranks"] == len(found["hosts"]) == ranks and found["messages"] == LENGTHS * ranks**2
            # the library of this launcher, and no other
            good = good and (ranks == 1 or str(mpi.resolve() / "lib") in found["carrier"])
            hold(good, f"{mpi} on {ranks} ranks: {code}\n{out}{err}")
            if good and ranks > 1:
                _, latency, speed = (found["speeds"][0][key] for key in ("between", "latency_s", "bytes_per_s"))
                print(f"{ranks} ranks by {found['carrier'].split(' (')[0]}: {latency * 1e6:.2f} µs, {speed * 1e-9:.2f} GB/s")
            end(f"{mpi.name} on {ranks}", [mpi / "bin/mpiexec", "-n", ranks])
        for deck in list(ASKED)[1:]:
            end(f"{mpi.name} on 3", [mpi / "bin/mpiexec", "-n", 3], deck=deck)
        # a launcher, and no MPI
        code, out, err = run([mpi / "bin/mpiexec", "-n", 2, program, "ranks"], PERIDYNE_MPI="/nowhere/libmpi_abi.so.1")
        hold(code == 2 and out == "" and " ".join(err.replace("│", " ").split()).count("no MPI with the standard ABI") == 1 and "/nowhere/" in err, f"{mpi} without a library: {code}\n{out}{err}")
        # a launcher that this library knows nothing of
        other = environment(OMPI_COMM_WORLD_SIZE="2", OMPI_COMM_WORLD_RANK="0", PERIDYNE_MPI=str(mpi / "lib/libmpi_abi.so.1"))
        code, out, err = run([program, "ranks"], **other)
        hold(code == 2 and out == "" and "the launcher is of another MPI" in " ".join(err.replace("│", " ").split()), f"{mpi} under another launcher: {code}\n{out}{err}")
        with tempfile.TemporaryDirectory() as folder:
            # a mistake, which one rank tells
            words = ["-n", 3, program, "run", DECK, "--set", "horizn=3", "--threads", 1, "--out", Path(folder) / "out"]
            code, out, err = run([mpi / "bin/mpiexec", *words])
            hold(code == 2 and err.count("horizn") >= 1 and err.count("did you mean") == 1, f"{mpi}, a mistyped deck: {code}\n{out}{err}")
            # several copies of one run
            words = ["-n", 2, program, "run", DECK, "--set", "run.steps=2", "--threads", 1, "--out", Path(folder) / "out"]
            code, out, err = run([mpi / "bin/mpiexec", *words], PERIDYNE_MPI="off")
            hold(code != 0 and "each runs alone" in " ".join(err.replace("│", " ").split()), f"{mpi}, two copies of a run: {code}\n{out}{err}")
    # each launcher with the library of each other one: it works, or says why it cannot
    for launcher in asked.mpi:
        for other in asked.mpi:
            if launcher != other:
                library = other.resolve() / "lib/libmpi_abi.so.1"
                code, out, err = run([launcher / "bin/mpiexec", "-n", 2, program, "ranks", "--json"], PERIDYNE_MPI=str(library))
                worked = code == 0 and json.loads(out)["ranks"] == 2
                hold(worked or "the launcher is of another MPI" in " ".join(err.replace("│", " ").split()), f"{launcher} with {library}: {code}\n{out}{err}")
                print(f"mpiexec of {launcher.name}, library of {other.name}: {'works' if worked else 'is refused'}")
    # alone
    code, out, err = run([program, "ranks", "--json"])
    hold(code == 0 and json.loads(out)["ranks"] == 1, f"alone: {code}\n{out}{err}")
    for ranks in RANKS + [7]:
        code, out, err = run([program, "ranks", "--on-threads", ranks, "--json"])
        found = json.loads(out) if code == 0 else {}
        hold(found.get("ranks") == ranks and found["messages"] == LENGTHS * ranks**2, f"{ranks} threads: {code}\n{out}{err}")
        end(f"threads {ranks}", [], "--on-threads", ranks)
    for deck in ASKED:
        end("alone", [], deck=deck)
        one = ends[deck, "alone, 1"]
        of_deck = {name: found for (of, name), found in ends.items() if of == deck}
        for name, found in of_deck.items():
            hold(found == one, f"{deck}, {name} is not what one process writes: {found}\n{one}")
        print(f"{deck}, {len(of_deck)} times: {one[0]} {one[1]} and {len(one[2])} files")
    for what in wrong:
        print("WRONG", what)
    print(f"ranks: {len(wrong)} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
