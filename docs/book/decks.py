#!/usr/bin/env python3
"""Pictures of the decks of `decks/good` for the guide's page of decks.

    docs/book/decks.py --program target/release/peridyne

Runs every deck on one thread, as many at once as there are cores, and keeps the picture that it makes without being asked as
`docs/book/src/reference/decks/NAME.png`; git ignores that folder. A deck that takes more than --longest seconds of processor time has no picture, nor has one that
draws none (atoms; models that are only written). Pictures that are newer than deck and program are kept. `hooks.py` makes the page.
"""

import argparse
import os
import re
import resource
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

BOOK = Path(__file__).resolve().parent
ROOT = BOOK.parent.parent
PICTURES = BOOK / "src/reference/decks"


def draw(deck, program, longest):
    """What happened, in a word."""
    picture = PICTURES / f"{deck.stem}.png"
    newer = max(deck.stat().st_mtime, program.stat().st_mtime)
    if picture.exists() and picture.stat().st_mtime > newer:
        return "kept"
    picture.unlink(missing_ok=True)
    with tempfile.TemporaryDirectory(prefix="peridyne-deck-") as out:
        words = [str(program), "run", str(deck), "--threads", "1", "--out", out, "--set", "output.report=false"]
        if deck.parent.name != "conservation":
            words += ["--set", "output.vtu=false"]
        # of the processor, so that other work on the machine does not show
        limit = lambda: resource.setrlimit(resource.RLIMIT_CPU, (longest, longest))
        done = subprocess.run(words, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, preexec_fn=limit)
        if done.returncode in (-signal.SIGXCPU, -signal.SIGKILL):
            return "too long"
        if done.returncode != 0:
            return f"exit code {done.returncode}: {done.stdout[-1000:]}"
        made = [Path(m) for m in re.findall(r"^picture: (.*)$", done.stdout, re.M)]
        # what a conservation law draws, and what a deck asked for
        made += sorted(Path(out).glob("space_time*.png")) + sorted(Path(out).glob("*.png"))
        made = [m for m in made if m.exists() and "film" not in m.name]
        if not made:
            return "none"
        shutil.copy(made[0], picture)
        return "drawn"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", type=Path, required=True, help="peridyne")
    parser.add_argument("--longest", type=int, default=6, help="seconds of the processor that a deck may take (6)")
    asked = parser.parse_args()
    PICTURES.mkdir(parents=True, exist_ok=True)
    decks = sorted((ROOT / "decks/good").glob("*.toml")) + sorted((ROOT / "decks/good/conservation").glob("*.toml"))
    begin = time.monotonic()
    with ThreadPoolExecutor(os.cpu_count() or 1) as workers:
        answers = list(workers.map(lambda deck: draw(deck, asked.program.resolve(), asked.longest), decks))
    for old in PICTURES.glob("*.png"):
        if old.stem not in {deck.stem for deck in decks}:
            old.unlink()
    said = {word: [d.stem for d, a in zip(decks, answers) if a == word] for word in ("drawn", "kept", "none", "too long")}
    print(", ".join(f"{len(of)} {word}" for word, of in said.items()), f"of {len(decks)} decks in {time.monotonic() - begin:.0f} s")
    print(f"too long: {', '.join(said['too long']) or 'no deck'}")
    failed = [f"{deck.name}: {answer}" for deck, answer in zip(decks, answers) if answer.startswith("exit code")]
    print(*failed, sep="\n", end="")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
