#!/usr/bin/env python3
"""Does the guide say what the program does?

    docs/book/check.py --program target/release/peridyne

Runs every `peridyne` command of the pages in a folder of its own, writes and checks every deck, compares what is printed and the
pictures with the pages, looks that named code and tests exist, and builds the site with all links and anchors checked.
Needs Python 3.11 and `pip install -r docs/book/requirements.txt`; NumPy and matplotlib for the blocks of Python, which are passed
over without them.

What a page may say before a block:
    <!-- fails: WORDS -->        the command ends with exit code 2 and prints these words
    <!-- long: WHY -->           run with --long only
    <!-- not run: WHY -->        never run
and after it, where the block made a picture:
    <!-- picture: pictures/NAME.png = out/FOLDER/FILE.png -->
    <!-- plot: pictures/NAME.png = FILE.png -->      by matplotlib, whose bytes differ from version to version: not compared
A block ```toml title="NAME.toml" is a deck, one without a title a part of a deck whose keys must be in the schema. A block ```text
after commands is what they print, in this order; `…` stands for anything. With
    <!-- prints: REGULAR EXPRESSION -->
before it, it has the lines in which this is found. `--renew` writes these blocks and the pictures again: to be looked at, and committed.
"""

import argparse
import filecmp
import importlib.util
import json
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
import tomllib
from pathlib import Path

BOOK = Path(__file__).resolve().parent
ROOT = BOOK.parent.parent
PAGES = BOOK / "src"
TOKEN = re.compile(r"^<!-- *(?P<note>[a-z ]+): *(?P<of>.*?) *-->$|^ *(?P<fence>```+)(?P<lang>[\w-]*)(?P<rest>[^\n]*)\n(?P<body>.*?)^ *(?P=fence) *$",
                   re.S | re.M)
REFERENCE = re.compile(r"`((?:crates|papers|examples|verify|benches|docs|decks)/[\w./-]+?\.\w+|\.ci/\w+)(?::(\w+))?`")
MOST_PICTURES = 4_500_000
# what differs from machine to machine and from run to run
VARIES = [(r"\b[\d.,]+ (n|µ|m)?s\b(?=, without| of stepping|, [\d.]+ ns|, \d+ directed)", "… s"), (r"\bin [\d.,]+ (n|µ|m)?s\b", "in … s"),
          (r"(?<=[:,] )[\d.]+ s$", "… s"),
          (r"[\d.,]+ ns per (bond|point)", r"… ns per \1"), (r"(speed +).*", r"\1…"), (r"about [\d.,]+ [^ ,]+(?=, without)", "about …"),
          (r"(memory +).*", r"\1…"), (r"\b(avx512|avx2|portable)\b", "…"), (r"(threads +)\d+", r"\1…"), (r"(\bwith )\d+ threads", r"\1… threads"),
          (r"[\d.,]+ times as fast \(.*\)", "… times as fast (…)"), (r"[\d.,]+ times as fast", "… times as fast"), (r"([\d.]+|…) steps/s", "… steps/s")]


class Page:
    """A page, its folder, and what went wrong."""

    def __init__(self, path, folder, asked):
        self.path, self.folder, self.asked = path, folder, asked
        self.name = path.relative_to(PAGES).as_posix()
        self.errors, self.ran, self.passed_over = [], [], []
        self.printed, self.decks, self.used, self.parts, self.pictures = "", [], set(), 0, 0
        self.renewed = []

    def wrong(self, what):
        self.errors.append(f"{self.name}: {what}")

    def prepare(self):
        shutil.copytree(ROOT / "decks/good", self.folder / "decks/good")
        shutil.copy(ROOT / "decks/in.impact_disk", self.folder / "decks")
        shutil.copytree(ROOT / "docs/fields", self.folder / "docs/fields")
        shutil.copytree(ROOT / "papers/seleson2009/figure-5-1", self.folder / "papers/seleson2009/figure-5-1")
        # what the page offers for download
        for file in self.path.parent.glob("*.*"):
            if file.suffix in (".msh", ".geo", ".data"):
                shutil.copy(file, self.folder)

    def read(self):
        text = self.path.read_text(encoding="utf-8")
        note = ("", "")
        for token in TOKEN.finditer(text):
            if token["note"]:
                note = (token["note"].strip(), token["of"])
                if note[0] in ("picture", "plot"):
                    self.picture(note[1], note[0] == "picture")
                    note = ("", "")
                continue
            self.block(token, indented(token["body"]), *note)
            note = ("", "")
        for deck in self.decks:
            if deck not in self.used:
                self.command(f"peridyne check {deck}", "", "")
        for path, name in REFERENCE.findall(text):
            self.reference(path, name)
        for (start, end), new in reversed(self.renewed):
            text = text[:start] + new + text[end:]
        if self.renewed:
            self.path.write_text(text, encoding="utf-8")

    def block(self, token, body, note, of):
        lang, rest = token["lang"], token["rest"]
        title = re.search(r'title="([^"]+)"', rest)
        if title:
            (self.folder / title[1]).write_text(body, encoding="utf-8")
            if lang == "toml" and note != "not run":
                self.decks.append(title[1])
            if lang == "python":
                compile(body, title[1], "exec")
        elif lang == "toml":
            self.part(body)
        elif lang == "sh":
            self.printed, self.partly = "", False
            for line in commands(body):
                self.command(line, note, of)
        elif lang == "text" and note != "not run" and self.printed and not self.partly:
            if note == "prints" and self.asked.renew:
                lines = [line.rstrip() for line in self.printed.splitlines() if re.search(of, line)]
                self.renewed.append((token.span("body"), "".join(masked(line) + "\n" for line in lines)))
            else:
                self.compare(body)

    def part(self, body):
        """Keys of a part of a deck are those of the schema."""
        self.parts += 1
        try:
            written = tomllib.loads(body)
        except tomllib.TOMLDecodeError as error:
            return self.wrong(f"no TOML: {error}\n{body}")
        kind = "conservation_law" if written.get("kind") == "conservation_law" else None
        schema = self.asked.schema(kind)
        for key in unknown(written, [schema], schema):
            self.wrong(f"a part of a deck has `{key}`, which the schema does not know:\n{body}")

    def command(self, line, note, of):
        words = shlex.split(line, comments=True)
        known = words and words[0] in ("peridyne", "python3", "head", "cut", "ls", "cat")
        if not known or note == "not run" or (note == "long" and not self.asked.long):
            self.passed_over.append((line, of or "no command of peridyne"))
            return
        if words[0] == "python3":
            missing = self.missing((self.folder / words[1]).read_text())
            if missing:
                self.passed_over.append((line, f"no {missing} here"))
                # what the rest prints is not what the page says
                self.partly = True
                return
        self.used.update(w for w in words if w.endswith(".toml"))
        begin = time.monotonic()
        # a terminal of a hundred columns, and no colours
        environment = {**os.environ, "PATH": f"{self.asked.bin}:{os.environ['PATH']}", "COLUMNS": "100", "NO_COLOR": "1"}
        done = subprocess.run(["bash", "-c", line], cwd=self.folder, env=environment, text=True, stdout=subprocess.PIPE,
                              stderr=subprocess.STDOUT)
        self.ran.append((time.monotonic() - begin, line))
        self.printed += done.stdout
        if self.asked.show:
            print(f"--- {self.name}: {line}\n{done.stdout}", flush=True)
        expected = 2 if note == "fails" else 0
        if done.returncode != expected:
            self.wrong(f"exit code {done.returncode}, not {expected}: {line}\n{done.stdout[-3000:]}")
        elif note == "fails" and of not in squeezed(done.stdout.replace("│", " ")):
            self.wrong(f"`{of}` is not in what is printed: {line}\n{done.stdout[-3000:]}")

    def compare(self, body):
        printed = [squeezed(line) for line in self.printed.splitlines()]
        at = 0
        for line in body.splitlines():
            if not line.strip() or line.strip() == "…":
                continue
            pattern = re.compile(".*".join(re.escape(squeezed(p)) for p in line.strip().split("…")))
            found = next((n for n in range(at, len(printed)) if pattern.fullmatch(printed[n])), None)
            if found is None:
                return self.wrong(f"not printed: {line.strip()}\nbut:\n{self.printed[:6000]}")
            at = found + 1

    def picture(self, of, compared):
        committed, made = (part.strip() for part in of.split("="))
        made, committed = self.folder / made, PAGES / committed
        self.pictures += 1
        if not compared:
            if self.asked.renew and made.exists():
                shutil.copy(made, committed)
        elif not made.exists():
            if not self.passed_over:
                self.wrong(f"{made.name} was not made")
        elif self.asked.renew:
            committed.parent.mkdir(exist_ok=True)
            shutil.copy(made, committed)
        elif not committed.exists() or not filecmp.cmp(made, committed, shallow=False):
            self.wrong(f"{committed.name} is not the picture that the program makes: write it again with --renew")

    def reference(self, path, name):
        file = ROOT / path
        if not file.exists():
            self.wrong(f"no {path}")
        elif name and not re.search(rf"\b{name}\b", file.read_text(encoding="utf-8")):
            self.wrong(f"no {name} in {path}")

    @staticmethod
    def missing(script):
        for module in re.findall(r"^(?:import|from) (\w+)", script, re.M):
            if importlib.util.find_spec(module) is None:
                return module
        return None


def indented(body):
    """Without the indentation of a block inside of a list or a tab."""
    lines = body.splitlines()
    depth = min((len(line) - len(line.lstrip()) for line in lines if line.strip()), default=0)
    return "".join(line[depth:] + "\n" for line in lines)


def commands(body):
    """Lines, those that end in a backslash joined with the next."""
    return [line for line in body.replace("\\\n", " ").splitlines() if line.strip() and not line.lstrip().startswith("#")]


def masked(line):
    for pattern, instead in VARIES:
        line = re.sub(pattern, instead, line)
    return line


def squeezed(line):
    return re.sub(r"\s+", " ", line).strip()


def unknown(value, schemas, root, path=""):
    """Keys that none of the schemas allows."""
    schemas = [s for schema in schemas for s in alternatives(schema, root)]
    if isinstance(value, list):
        items = [s["items"] for s in schemas if isinstance(s.get("items"), dict)]
        return [k for item in value for k in (unknown(item, items, root, path) if items else [])]
    if not isinstance(value, dict):
        return []
    found = []
    for key, inner in value.items():
        below = [s["properties"][key] for s in schemas if key in s.get("properties", {})]
        below += [s["additionalProperties"] for s in schemas if isinstance(s.get("additionalProperties"), dict)]
        if below:
            found += unknown(inner, below, root, f"{path}{key}.")
        elif not any(s.get("additionalProperties") is True for s in schemas):
            found.append(path + key)
    return found


def alternatives(schema, root):
    if not isinstance(schema, dict):
        return []
    if "$ref" in schema:
        there = root
        for part in schema["$ref"].removeprefix("#/").split("/"):
            there = there[part]
        return alternatives(there, root)
    found = [schema]
    for word in ("anyOf", "oneOf", "allOf"):
        for inner in schema.get(word, []):
            found += alternatives(inner, root)
    return found


class Asked:
    def __init__(self):
        parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
        parser.add_argument("--program", type=Path, required=True, help="peridyne")
        parser.add_argument("--renew", action="store_true", help="write pictures and printed lines of the pages again")
        parser.add_argument("--long", action="store_true", help="run what takes long, too")
        parser.add_argument("--only", action="append", default=[], help="pages whose name has this in it")
        parser.add_argument("--show", action="store_true", help="show what commands print")
        parser.add_argument("--site", type=lambda path: Path(path).resolve(), help="keep the built site in this folder")
        given = parser.parse_args()
        self.program = given.program.resolve()
        self.renew, self.long, self.only, self.show, self.site = given.renew, given.long, given.only, given.show, given.site
        self.bin = None
        self.schemas = {}

    def schema(self, kind):
        if kind not in self.schemas:
            words = [str(self.program), "schema", *(["--kind", kind] if kind else [])]
            self.schemas[kind] = json.loads(subprocess.run(words, check=True, capture_output=True, text=True).stdout)
        return self.schemas[kind]


def reference(program):
    """The deck reference, where the program can write it."""
    can = subprocess.run([str(program), "doc", "--help"], capture_output=True, text=True)
    if can.returncode == 0 and "--book" in can.stdout:
        done = subprocess.run([str(program), "doc", "--book", str(PAGES / "reference"), "--decks", str(ROOT / "decks/good")], capture_output=True, text=True)
        return [] if done.returncode == 0 else [f"the deck reference was not written: {done.stderr}"]
    return []


def build(site):
    begin = time.monotonic()
    words = [sys.executable, "-m", "mkdocs", "build", "--strict", "-f", str(BOOK / "mkdocs.yml"), "-d", str(site)]
    environment = {**os.environ, "NO_MKDOCS_2_WARNING": "1"}
    done = subprocess.run(words, env=environment, text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    # `--quiet` would keep warnings from being counted
    print(*(line for line in done.stdout.splitlines() if re.search("WARN|ERROR|Abort|left out", line)), sep="\n")
    seconds = time.monotonic() - begin
    errors = [] if done.returncode == 0 else ["the site was not built"]
    # nothing may be loaded from a network when a page is opened
    for page in site.rglob("*.html"):
        for found in re.findall(r'<(?:script|link|img|iframe)[^>]*(?:src|href)="(?:https?:)?//[^"]*"', page.read_text(encoding="utf-8")):
            if 'rel="canonical"' not in found:
                errors.append(f"{page.name} loads from a network: {found}")
    return seconds, errors


def main():
    asked = Asked()
    errors, pages = [], []
    with tempfile.TemporaryDirectory(prefix="peridyne-book-") as top:
        top = Path(top)
        asked.bin = top / "bin"
        asked.bin.mkdir()
        (asked.bin / "peridyne").symlink_to(asked.program)
        # that of this script, with its packages
        (asked.bin / "python3").write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n')
        (asked.bin / "python3").chmod(0o755)
        for n, path in enumerate(sorted(PAGES.rglob("*.md"))):
            name = path.relative_to(PAGES).as_posix()
            if name.startswith("reference/") or (asked.only and not any(o in name for o in asked.only)):
                continue
            page = Page(path, top / f"page{n:02}", asked)
            page.folder.mkdir()
            page.prepare()
            page.read()
            pages.append(page)
            shutil.rmtree(page.folder)
            seconds = sum(s for s, _ in page.ran)
            print(f"{page.name:34} {len(page.ran):3} commands {seconds:7.1f} s  {len(page.decks):2} decks  {page.parts:2} parts  "
                  f"{page.pictures:2} pictures{'  WRONG' if page.errors else ''}", flush=True)
            errors += page.errors
        if not asked.only:
            errors += reference(asked.program)
            seconds, wrong = build(asked.site or top / "site")
            print(f"{'the site, links and anchors':34} {seconds:20.1f} s")
            errors += wrong
            words = subprocess.run([sys.executable, BOOK / "words.py"], text=True, stdout=subprocess.PIPE)
            if words.returncode != 0:
                errors.append(f"old words (docs/book/words.py):\n{words.stdout}")
            shown = "\n".join(p.read_text(encoding="utf-8") for p in PAGES.rglob("*.md"))
            for picture in sorted((PAGES / "pictures").glob("*")):
                if picture.name not in shown:
                    errors.append(f"no page shows pictures/{picture.name}")
            size = sum(p.stat().st_size for p in (PAGES / "pictures").glob("*"))
            print(f"{'pictures':34} {size / 1e6:20.2f} MB")
            if size > MOST_PICTURES:
                errors.append(f"pictures take {size} bytes, more than {MOST_PICTURES}")
    slow = sorted((ran for page in pages for ran in page.ran), reverse=True)[:8]
    print("\nthe longest:", *(f"  {seconds:6.1f} s  {line}" for seconds, line in slow), sep="\n")
    over = [(page.name, *of) for page in pages for of in page.passed_over]
    print(f"\nnot run: {len(over)}", *(f"  {name}: {line}  ({why})" for name, line, why in over), sep="\n")
    ran = [s for page in pages for s, _ in page.ran]
    print(f"\n{len(ran)} commands in {sum(ran):.0f} s, {len(errors)} wrong")
    for error in errors:
        print(f"\nWRONG {error}")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
