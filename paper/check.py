#!/usr/bin/env python3
"""Does what paper.md claims exist, and are its numbers those of the repository?

    paper/check.py [--program target/release/peridyne]

Every file, test, package and command in `…` must be there; with --program each verb and law too, and the commands in comments are run:
    <!-- run: COMMAND => REGULAR EXPRESSION -->      ends with 0 and prints this
    <!-- same state: COMMAND | COMMAND … -->         end in the same hash of the state
and without it:
    <!-- numbers from FILE: A; B=C -->               the paragraph says A (B), the file says A (C); every other number of a paragraph in
                                                     *Verification* and *Performance* is an error
    <!-- count: FOLDER PATTERN "TEXT" N -->          TEXT stands N times in the files of FOLDER, and the paper says N
Citations are those of paper.bib, all of them. Needs Python 3.11.
"""

import argparse
import re
import shlex
import subprocess
import sys
import tempfile
import tomllib
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent
NUMBER = re.compile(r"(?<![\w.])\d[\d,]*(?:\.\d+)?(?:e-?\d+)?(?![\w])")
# of names: processors, formats
NOT_NUMBERS = re.compile(r"AVX-?\d+|@\w+")
errors: list[str] = []


def wrong(what):
    errors.append(what)


def packages():
    found = {}
    for member in tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]["members"]:
        found[tomllib.loads((ROOT / member / "Cargo.toml").read_text())["package"]["name"]] = ROOT / member
    return found


def cargo(line):
    words = shlex.split(line)
    package = words[words.index("-p") + 1] if "-p" in words else None
    folder = packages().get(package)
    if words[1] != "test" or folder is None:
        return wrong(f"no package for `{line}`")
    for n, word in enumerate(words):
        if word == "--test":
            name = words[n + 1]
            tests = folder / "tests"
            if not ((tests / f"{name}.rs").exists() or (tests / name / "main.rs").exists()):
                wrong(f"{package} has no test {name}: `{line}`")


def reference(code):
    path, _, name = code.partition(":")
    file = ROOT / path
    if not file.exists():
        wrong(f"no {path}")
    elif name and not re.search(rf"\bfn {name}\b", file.read_text(encoding="utf-8")):
        wrong(f"no {name} in {path}")


def verb(program, line):
    """`peridyne VERB` is one; what `doc` is asked for and what `reproduce` computes exist."""
    words = shlex.split(line)[1:]
    if not program or not words:
        return
    if subprocess.run([program, words[0], "--help"], capture_output=True).returncode != 0:
        wrong(f"no verb: `{line}`")
    elif words[0] == "doc" and subprocess.run([program, *words], capture_output=True).returncode != 0:
        wrong(f"`{line}` finds nothing")
    elif words[0] == "reproduce" and len(words) > 1:
        listed = subprocess.run([program, "reproduce", "--list"], capture_output=True, text=True).stdout
        if not re.search(rf"^{re.escape(words[1])}\b", listed, re.M):
            wrong(f"`{line}`: not in reproduce --list")


def numbers(section, paragraph):
    said = re.sub(r"<!--.*?-->", "", paragraph, flags=re.S)
    prose = NOT_NUMBERS.sub("", re.sub(r"`[^`]*`", "", said))
    claimed = set()
    for file, listed in re.findall(r"<!-- numbers from (\S+): (.*?) -->", paragraph, re.S):
        text = (ROOT / file).read_text(encoding="utf-8")
        for item in listed.split("; "):
            there, _, here = item.strip().partition("=")
            here = here or there
            if not re.search(rf"(?<![\w.,]){re.escape(there)}(?![\w])", text):
                wrong(f"{there} is not in {file}")
            if not re.search(rf"(?<![\w.,]){re.escape(here)}(?![\w])", prose):
                wrong(f"the paper does not say {here}, which {file} has")
            claimed |= set(NUMBER.findall(here))
    if section in ("Verification", "Performance"):
        for number in NUMBER.findall(prose):
            if number not in claimed:
                wrong(f"{section}: {number} comes from nowhere")


def counts(paragraph):
    for folder, pattern, text, n in re.findall(r'<!-- count: (\S+) (\S+) "(.*?)" (\d+) -->', paragraph):
        found = sum(f.read_text(encoding="utf-8").count(text) for f in (ROOT / folder).glob(pattern))
        if found != int(n):
            wrong(f"{text} stands {found} times in {folder}/{pattern}, not {n}")
        if n not in re.sub(r"<!--.*?-->", "", paragraph, flags=re.S):
            wrong(f"the paper does not say {n}")


def executed(program, text):
    done = 0
    with tempfile.TemporaryDirectory(prefix="peridyne-paper-") as folder:

        def printed(line):
            words = shlex.split(line)
            words = [program, *(str(ROOT / w) if w.startswith("decks/") else w for w in words[1:])]
            ran = subprocess.run(words, cwd=folder, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
            if ran.returncode != 0:
                wrong(f"exit code {ran.returncode}: {line}\n{ran.stdout[-2000:]}")
            return ran.stdout

        for line, pattern in re.findall(r"<!-- run: (.*?) => (.*?) -->", text):
            if not re.search(pattern, printed(line)):
                wrong(f"{line} does not print {pattern}")
            done += 1
        for lines in re.findall(r"<!-- same state: (.*?) -->", text):
            hashes = [re.findall(r"^state +(\w{16})\b", printed(line), re.M) for line in lines.split(" | ")]
            if not hashes[0] or any(h != hashes[0] for h in hashes):
                wrong(f"states differ: {hashes} of {lines}")
            done += len(hashes)
    return done


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", help="peridyne")
    asked = parser.parse_args()
    program = str(Path(asked.program).resolve()) if asked.program else None
    text = (HERE / "paper.md").read_text(encoding="utf-8")
    head, body = re.match(r"---\n(.*?)\n---\n(.*)", text, re.S).groups()
    for key in ("title", "tags", "authors", "affiliations", "date", "bibliography"):
        if not re.search(rf"^{key}:", head, re.M):
            wrong(f"the head has no {key}")
    cited = set(re.findall(r"@([a-z]\w+)", body))
    known = set(re.findall(r"^@\w+\{(\w+),", (HERE / "paper.bib").read_text(encoding="utf-8"), re.M))
    for key in sorted(cited ^ known):
        wrong(f"{key} is {'cited, and not in paper.bib' if key in cited else 'in paper.bib, and not cited'}")
    sections = re.split(r"^# (.*)$", body, flags=re.M)[1:]
    names = sections[::2]
    for name in ("Summary", "Statement of need", "State of the field", "Design", "Verification", "Performance", "Acknowledgements"):
        if name not in names:
            wrong(f"no section {name}")
    seen = 0
    for section, of in zip(names, sections[1::2]):
        for paragraph in of.split("\n\n"):
            numbers(section, paragraph)
            counts(paragraph)
            for code in re.findall(r"`([^`\n]+)`", re.sub(r"<!--.*?-->", "", paragraph, flags=re.S)):
                seen += 1
                if code.startswith("cargo "):
                    cargo(code)
                elif code.startswith("peridyne "):
                    verb(program, code)
                elif re.match(r"(crates|papers|examples|verify|benches|docs|decks)/|[A-Z]+\.md$", code):
                    reference(code)
                else:
                    seen -= 1
    ran = executed(program, body) if program else 0
    words = len(re.sub(r"<!--.*?-->", "", body, flags=re.S).split())
    print(f"paper.md: {words} words, {len(cited)} references, {seen} commands, tests and files, {ran} commands run")
    for error in errors:
        print(f"WRONG {error}")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
