"""Does the program find the MPI that started it, do messages between its ranks come as they were sent, and is it said where they cannot?

And does a run that they share write the same bytes on any number of them, and end well where its input is wrong?

Usage: python verify/ranks/check.py --program target/debug/peridyne --mpi FOLDER [--mpi FOLDER]
FOLDER has bin/mpiexec and lib/libmpi_abi.so.1: a virtual environment into which `pip install mpich` or `pip install impi-rt` was done.
"""

import argparse
import hashlib
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

RANKS = [1, 2, 3, 4]
# of messages from each rank to each
LENGTHS = 4
DECKS = Path(__file__).resolve().parents[2] / "decks/good"
DECK = DECKS / "ten_lines.toml"
# what is run of it on any number of ranks, of another one on three: keys, where it is cut off, bonds that break at least
ASKED = {
    "ten_lines": (["body.spacing=1 mm", "run.steps=200", "output.every=60"], 110, 10_000),
    "two_bodies": (["output.every=40"], 70, 10_000),
}


def environment(**more):
    # processes of this machine, through its memory; nothing of another MPI
    return {k: v for k, v in os.environ.items() if not k.startswith(("PMI_", "OMPI_", "SLURM_", "PERIDYNE_MPI"))} | {"HYDRA_LAUNCHER": "fork", "I_MPI_FABRICS": "shm"} | more


def run(command, **more):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, env=environment(**more), timeout=300)
    return done.returncode, done.stdout, done.stderr


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
                first = ["run", DECKS / f"{deck}.toml", *keys, "--out", out]
                cut = ["--stop-after", stop] if parts == 2 else []
                for words in [[*first, *cut], ["resume", out]][:parts]:
                    code, said, err = run([*launcher, program, *words, "--threads", "1", *more])
                    if code:
                        wrong.append(f"{name}: {code}\n{said}{err}")
                        return
                record = json.loads((out / "run.json").read_text())
                files = {str(p.relative_to(out)): hashlib.sha256(p.read_bytes()).hexdigest() for p in sorted(out.rglob("*")) if p.is_file() and p.name not in ["run.json", "report.html"]}
                ends[deck, f"{name}, {parts}"] = (record["state_hash"], record["ledger_hash"], files)
                hold(record["broken_directed_bonds"] > broken, f"{name}: {record['broken_directed_bonds']} broken")
                hold(record["ranks"] == (int(name.split()[-1]) if name != "alone" else 1), f"{name}: {record['ranks']} ranks")

    def hold(true, what):
        if not true:
            wrong.append(what)

    for mpi in asked.mpi:
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
        end(f"{mpi.name} on 3", [mpi / "bin/mpiexec", "-n", 3], deck="two_bodies")
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
