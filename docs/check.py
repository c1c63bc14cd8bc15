#!/usr/bin/env python3
"""Are the pages beside the guide true?

    docs/check.py [--program target/release/peridyne] [--site FOLDER]

Links and anchors of every Markdown file of the repository lead somewhere; versions, authors and licences of CITATION.cff, Cargo.toml, pyproject.toml
and CHANGELOG.md are the same; every crate has a page; what the map of folders names is there; with --program nothing that docs/first-issues.md calls absent exists. With --site, links of the
built guide between its pages are checked, too, that searches find what they should, and that each deck is on its page. Addresses on the network are not asked. Needs Python 3.11.
"""

import argparse
import html
import json
import re
import subprocess
import sys
import tomllib
from pathlib import Path
from urllib.parse import unquote

ROOT = Path(__file__).resolve().parent.parent
CODE = re.compile(r"^ *(```+|~~~+).*?^ *\1 *$|`[^`\n]+`", re.S | re.M)
LINK = re.compile(r"!?\[(?:[^\]\[]|\[[^\]]*\])*\]\(([^)\s]+)(?: \"[^\"]*\")?\)")
# What is searched for, and the page that must be among what is found
SEARCHED = {
    "Gc": "reference/material.fracture.html", "boundary condition": "reference/boundary_condition.html", "animation": "howto/look.html", "cite": "index.html",
    "cluster": "howto/clusters.html", "Slurm": "howto/clusters.html", "crack speed": "howto/crack-speed.html", "restart": "howto/restart.html",
}
errors: list[str] = []


def wrong(what):
    errors.append(what)


def pages():
    """Markdown that git knows or would take."""
    words = ["git", "ls-files", "--cached", "--others", "--exclude-standard", "*.md"]
    listed = subprocess.run(words, cwd=ROOT, capture_output=True, text=True, check=True).stdout.split("\n")
    return sorted({ROOT / name for name in listed if name and (ROOT / name).exists()})


def anchors(text):
    """Names that headings and marks of a page have, as GitHub and MkDocs make them."""
    found = set(re.findall(r'\bid="([^"]+)"', text))
    for heading in re.findall(r"^#+ +(.*)$", re.sub(r"^```.*?^```", "", text, flags=re.S | re.M), re.M):
        own = re.search(r"\{ *#([\w-]+) *\}", heading)
        if own:
            found.add(own[1])
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).strip().lower()
        github = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        # MkDocs leaves out what is not ASCII, and joins blanks
        plain = re.sub(r"[^\w\s-]", "", words.encode("ascii", "ignore").decode()).strip()
        found |= {github, re.sub(r"[-\s]+", "-", plain)}
    return found


def links():
    count = 0
    for page in pages():
        text = page.read_text(encoding="utf-8")
        guide = ROOT / "docs/book/src" in page.parents
        for to in LINK.findall(CODE.sub("", text)):
            to = unquote(to)
            if re.match(r"[a-z]+:", to):
                continue
            count += 1
            name, _, anchor = to.partition("#")
            there = (page.parent / name).resolve() if name else page
            # pages that hooks.py makes, or puts others into, are looked at in the built site
            if guide and (not there.exists() or "reference" in there.parts):
                continue
            if not there.exists():
                wrong(f"{page.relative_to(ROOT)}: no {to}")
            elif anchor and not guide and there.suffix == ".md" and anchor not in anchors(there.read_text(encoding="utf-8")):
                wrong(f"{page.relative_to(ROOT)}: no #{anchor} in {name or 'the page'}")
    print(f"{count} links of {len(pages())} Markdown files")


def names_of_the_map():
    """Words in lower case that docs/architecture/folders.md sets as code are files, folders, or names in the code."""
    listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=ROOT, capture_output=True, text=True, check=True)
    paths = [Path(name) for name in listed.stdout.split("\n") if name and (ROOT / name).exists()]
    known = {part for path in paths for name in path.parts for part in [name, Path(name).stem]}
    for path in paths:
        if path.suffix == ".rs":
            known |= set(re.findall(r"\w+", re.sub(r"//.*", "", (ROOT / path).read_text(encoding="utf-8"))))
    page = ROOT / "docs/architecture/folders.md"
    words = {word for code in re.findall(r"`([a-z_/]+)`", page.read_text(encoding="utf-8")) for word in code.split("/") if word}
    for word in sorted(words - known):
        wrong(f"{page.relative_to(ROOT)}: `{word}` is neither a file nor a name in the code")
    print(f"{len(words)} names of the map of folders")


def site(folder):
    files, ids, count = {}, {}, 0
    for page in folder.rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        files[page.resolve()] = text
        ids[page.resolve()] = set(re.findall(r'\b(?:id|name)="?([^"\s>]+)', text))
    for page, text in files.items():
        for to in re.findall(r'<(?:a|img|link|script)\b[^>]*?\b(?:href|src)="([^"]*)"', text):
            to = unquote(html.unescape(to))
            if re.match(r"[a-z]+:|//", to) or not to:
                continue
            count += 1
            name, _, anchor = to.partition("#")
            there = (page.parent / name).resolve() if name else page
            if there.is_dir():
                there = there / "index.html"
            if page.name == "404.html":
                continue
            if not there.exists():
                wrong(f"{page.relative_to(folder.resolve())}: no {to}")
            elif anchor and there in ids and anchor not in ids[there] and not anchor.startswith("__"):
                wrong(f"{page.relative_to(folder.resolve())}: no #{anchor} in {name or 'the page'}")
    print(f"{count} links of {len(files)} pages of the site")


def searches(folder):
    """The index of the search has these words on these pages."""
    index = json.loads((folder / "search/search_index.json").read_text(encoding="utf-8"))["docs"]
    for words, page in SEARCHED.items():
        text = " ".join(f"{d['title']} {d['text']}" for d in index if d["location"].partition("#")[0] == page)
        if not re.search(rf"\b{words.replace(' ', '[ -]')}s?\b", re.sub(r"<[^>]*>", " ", text), re.I):
            wrong(f"a search for `{words}` does not find {page}")
    for deck in sorted((ROOT / "decks/good").rglob("*.toml")):
        if f'href="{deck.relative_to(ROOT).as_posix()}"' not in (folder / "decks.html").read_text(encoding="utf-8"):
            wrong(f"decks.html does not lead to {deck.name}")
    print(f"{len(SEARCHED)} searches")


def versions():
    cargo = tomllib.loads((ROOT / "Cargo.toml").read_text())["workspace"]
    package = cargo["package"]
    citation = (ROOT / "CITATION.cff").read_text()
    cited = re.search(r"^version: (\S+)$", citation, re.M)
    if not cited or cited[1] != package["version"]:
        wrong(f"CITATION.cff has version {cited and cited[1]}, Cargo.toml {package['version']}")
    for author in package["authors"]:
        if f"- name: {author}\n" not in citation:
            wrong(f"{author} is not in CITATION.cff")
        if author not in (ROOT / "crates/python/pyproject.toml").read_text():
            wrong(f"{author} is not in pyproject.toml")
    for licence in package["license"].split(" OR "):
        if f"  - {licence}\n" not in citation:
            wrong(f"CITATION.cff has no licence {licence}")
    log = (ROOT / "CHANGELOG.md").read_text(encoding="utf-8")
    heads = re.findall(r"^## (.*)$", log, re.M)
    if heads[:1] != ["[Unreleased]"]:
        wrong("CHANGELOG.md does not begin with [Unreleased]")
    for head in heads[1:]:
        if not re.fullmatch(r"\[\d+\.\d+\.\d+\] - \d{4}-\d\d-\d\d", head):
            wrong(f"CHANGELOG.md: `## {head}` is no version with a date")
    if not any(head.startswith(f"[{package['version']}]") for head in heads):
        wrong(f"CHANGELOG.md does not know {package['version']}")
    kinds = {"Added", "Changed", "Deprecated", "Removed", "Fixed", "Security", "Library", "Building and tests"}
    for kind in re.findall(r"^### (.*)$", log, re.M):
        if kind not in kinds:
            wrong(f"CHANGELOG.md: `### {kind}` is none of {sorted(kinds)}")
    for member in cargo["members"]:
        folder = ROOT / member
        own = tomllib.loads((folder / "Cargo.toml").read_text())["package"]
        if own.get("authors") != {"workspace": True}:
            wrong(f"{member}/Cargo.toml does not inherit authors")
        if own.get("readme") != "README.md" or not (folder / "README.md").exists():
            wrong(f"{member} has no README.md")
    print(f"version {package['version']}, {len(cargo['members'])} crates")


def first_issues(program):
    text = (ROOT / "docs/first-issues.md").read_text(encoding="utf-8")
    absent = re.findall(r"^\| `(\w+): (\w+)` \|", text, re.M)
    laws = subprocess.run([program, "laws"], capture_output=True, text=True, check=True).stdout
    named = set(re.findall(r"^  (\w+)(?= )", laws, re.M))
    # or the look is blind
    for there in ("pmb", "morse", "absorbing_layer", "stress", "sphere", "diamond", "crack_tip"):
        if there not in named:
            wrong(f"`peridyne laws` does not list {there}: docs/check.py cannot read it any more")
    for kind, name in absent:
        if kind in ("output", "shape"):
            table = {"output": "output", "shape": "rigid_body.shape"}[kind]
            keys = subprocess.run([program, "doc", table], capture_output=True, text=True, check=True).stdout
            there = name in re.findall(r"^  (\w+)", keys, re.M)
        else:
            there = name in named
        if there:
            wrong(f"docs/first-issues.md calls `{name}` absent, and it is there")
    for file in re.findall(r"`((?:crates|docs)/[\w./-]+)`", text):
        if not (ROOT / file).exists():
            wrong(f"docs/first-issues.md: no {file}")
    if not absent:
        wrong("docs/first-issues.md lists nothing")
    print(f"{len(absent)} first issues")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--program", help="peridyne")
    parser.add_argument("--site", type=Path, help="the built guide")
    asked = parser.parse_args()
    links()
    names_of_the_map()
    versions()
    if asked.program:
        first_issues(str(Path(asked.program).resolve()))
    if asked.site:
        site(asked.site.resolve())
        searches(asked.site)
    for error in errors:
        print(f"WRONG {error}")
    return 1 if errors else 0


if __name__ == "__main__":
    sys.exit(main())
