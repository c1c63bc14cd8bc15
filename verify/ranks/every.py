"""Does every good deck and every script of verify/lammps write the same bytes on 2, 3, 4, 7 and 8 ranks as in one process?

Each run is cut off after a few steps. Ranks are threads of one process.

Usage: python verify/ranks/every.py --program target/release/peridyne [--steps 12] [NAME ...]
NAME: decks (file names without their end) and scripts; all of them where none is given. Some ten minutes on two cores.
"""

import argparse
import hashlib
import json
import subprocess
import sys
import tempfile
from pathlib import Path

RANKS = [2, 3, 4, 7, 8]
ROOT = Path(__file__).resolve().parents[2]


def written(out):
    """Hashes of all files but for what tells of the clock."""
    told = ["run.json", "report.html"]
    # states say how long it took, too
    files = [p for p in sorted(out.rglob("*")) if p.is_file() and p.name not in told and p.suffix not in [".log", ".state"]]
    record = json.loads((out / "run.json").read_text())
    found = {str(p.relative_to(out)): hashlib.sha256(p.read_bytes()).hexdigest() for p in files}
    return {**found, "state_hash": record["state_hash"], "ledger_hash": record["ledger_hash"]}


def main():
    asked = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    asked.add_argument("--program", type=Path, required=True)
    asked.add_argument("--steps", type=int, default=12)
    asked.add_argument("names", nargs="*")
    asked = asked.parse_args()
    program = asked.program.resolve()
    paths = sorted((ROOT / "decks/good").glob("*.toml")) + sorted((ROOT / "verify/lammps/cases").glob("in.*"))
    paths = [p for p in paths if not asked.names or p.stem in asked.names or p.name in asked.names]
    wrong, shared, refused = [], 0, []

    def run(path, *more):
        with tempfile.TemporaryDirectory() as folder:
            out = Path(folder) / "out"
            words = [program, "run", path, "--out", out, "--threads", 1, "--stop-after", asked.steps, *more]
            done = subprocess.run([str(word) for word in words], capture_output=True, text=True, timeout=1800)
            said = " ".join(done.stderr.replace("│", " ").split())
            return written(out) if done.returncode == 0 else said

    for path in paths:
        one = run(path)
        if isinstance(one, str):
            wrong.append(f"{path.name}: {one}")
            continue
        for ranks in RANKS:
            many = run(path, "--on-threads", ranks)
            if isinstance(many, str) and "ranks do not share" in many:
                refused.append(path.name)
                break
            if many != one:
                other = many if isinstance(many, str) else [name for name in {*one, *many} if one.get(name) != many.get(name)]
                wrong.append(f"{path.name} on {ranks} ranks: {other}")
        else:
            shared += 1
    for what in wrong:
        print("WRONG", what)
    print(f"{shared} of {len(paths)} shared on {RANKS} ranks, refused: {refused}, {len(wrong)} wrong")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
