"""Does the program find the MPI that started it, do messages between its ranks come as they were sent, and is it said where they cannot?

And is a block that ranks share torn to the same bits on any number of them?

Usage: python verify/ranks/check.py --program target/debug/peridyne --mpi FOLDER [--mpi FOLDER]
Beside the program lies examples/ranks, which `cargo build --examples` and `cargo test` make.
FOLDER has bin/mpiexec and lib/libmpi_abi.so.1: a virtual environment into which `pip install mpich` or `pip install impi-rt` was done.
"""

import argparse
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

RANKS = [1, 2, 3, 4]
# of messages from each rank to each
LENGTHS = 4
DECK = Path(__file__).resolve().parents[2] / "decks/good/ten_lines.toml"


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
    program, wrong = asked.program.resolve(), []
    block, ends = program.parent / "examples/ranks", {}

    def end(words, name):
        code, out, err = run([*words])
        ends[name] = out.split(",")[0] if code == 0 and out.count("\n") == 1 else f"{code}\n{out}{err}"

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
            end([mpi / "bin/mpiexec", "-n", ranks, block], f"{mpi.name} on {ranks}")
        # a launcher, and no MPI
        code, out, err = run([mpi / "bin/mpiexec", "-n", 2, program, "ranks"], PERIDYNE_MPI="/nowhere/libmpi_abi.so.1")
        hold(code == 2 and out == "" and " ".join(err.replace("│", " ").split()).count("no MPI with the standard ABI") == 1 and "/nowhere/" in err, f"{mpi} without a library: {code}\n{out}{err}")
        # a launcher that this library knows nothing of
        other = environment(OMPI_COMM_WORLD_SIZE="2", OMPI_COMM_WORLD_RANK="0", PERIDYNE_MPI=str(mpi / "lib/libmpi_abi.so.1"))
        code, out, err = run([program, "ranks"], **other)
        hold(code == 2 and out == "" and "the launcher is of another MPI" in " ".join(err.replace("│", " ").split()), f"{mpi} under another launcher: {code}\n{out}{err}")
        # several copies of one run
        with tempfile.TemporaryDirectory() as folder:
            words = ["-n", 4, program, "run", DECK, "--threads", 1, "--out", Path(folder) / "out"]
            code, out, err = run([mpi / "bin/mpiexec", *words])
            hold(code != 0 and "runs are not shared among ranks yet" in " ".join(err.replace("│", " ").split()), f"{mpi}, a run of four copies: {code}\n{out}{err}")
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
        end([block, "--on-threads", ranks], f"{ranks} threads")
    end([block], "alone")
    hold(len(set(ends.values())) == 1, f"a block that is torn: {ends}")
    print(f"a block that is torn, {len(ends)} times: {ends['alone']}")
    for what in wrong:
        print("WRONG", what)
    print(f"ranks: {len(wrong)} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
