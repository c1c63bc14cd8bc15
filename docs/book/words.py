#!/usr/bin/env python3
"""Which of our old words are left in what users read?

    docs/book/words.py [FOLDER OF THE REPOSITORY] [--where]

Counts the words that the glossary (docs/book/src/glossary.md) replaces by the field's: in the pages of the guide and in README, ARCHITECTURE
and CONTRIBUTING, outside of code and links; in messages and other texts of the program (string literals of crates/*/src with a blank in them); and in
the sentences that explain keys of decks. Only words that mean nothing else are looked for. Exits with 1 if any stands beyond
the places of ALLOWED.
"""

import re
import sys
from collections import Counter
from pathlib import Path

# (what is meant, the old word, the field's)
WORDS = [
    ("directed bonds", r"directed bonds?|counted from both ends|bonds from both ends", "bonds"),
    ("let go", r"bonds? (that )?lets? go|lets? (it |them )?go at once|bonds that let go|(when|where) it lets go", "break"),
    ("work of conditions", r"work of (conditions|indenters)", "external work"),
    ("indenter", r"indenters?", "rigid body"),
    ("loose grains", r"loose (grains|points|bodies)|bodies are loose", "unbonded particles"),
    ("bears", r"bears?|bore|borne", "carries, sustains"),
    ("horizons of points", r"horizons of points|own horizons?|horizon for each point", "variable horizon"),
    ("as typed", r"as typed", "LPS with three-dimensional constants"),
    ("contains both", r"form that contains both", "two-parameter state-based solid"),
    ("resist turning", r"resists? (stretch and )?turning", "tangential stiffness"),
    ("memory and tensors", r"(laws?|solids|materials?) (of any kind )?(with|that) (memory|remembers?)", "history-dependent"),
    ("answers, settles", r"answers?|settles?", "force state, point update"),
    ("bond after bond", r"bond after bond|one bond after the other", "sequentially linear analysis"),
    ("loads that fall", r"loads? that falls?|along a path|(factor|part) of the load", "path following, load factor"),
    ("told", r"told|tells?", "prescribed, says"),
    ("equilibrium on", r"from (an|its) equilibrium on|motion from an equilibrium", "preloaded state"),
    ("become shorter", r"(bonds|where they) (that )?(become|became|are) (much )?shorter", "substepping under compression"),
    ("made-up masses", r"made-up masses", "fictitious masses"),
    ("really has", r"really ha(s|ve)", "effective moduli"),
    ("asked", r"asked", "target, prescribed"),
    ("all surface", r"all of it is surface", "thinner than two horizons"),
    ("balance misses", r"(balance|account)s? miss(es)?|energy balance misses|what (the balance|these) miss(es)?", "energy balance error"),
    ("released energy", r"released energy|sets? free|setting free", "energy dissipated by bond breakage"),
    ("torn", r"torn|tears?|tore|tearing", "damaged, breaks"),
    ("understood", r"what (was|is|of a script is) understood|what it understood", "input summary"),
    ("left out", r"(when|if) left out|left out:", "default"),
    ("talk to", r"talks? to|who talks", "interact with"),
    ("mends", r"mends?|mended", "corrects"),
    ("not there", r"what is not there|not there|there, with edges|things that surprise", "not supported, limitations, pitfalls"),
    ("wears", r"wears?|wearing|remaining life", "fatigue damage"),
    ("same bits", r"(same|equal) bits|bits are the same", "bitwise reproducible"),
    ("strangers", r"strangers?'?s? decks?", "untrusted input"),
    ("fans", r"fans?", "many-body potential"),
    ("spreads", r"what spreads|spreads? through", "diffusion"),
    ("kin", r"kin", "related laws, by name"),
    ("shelf", r"shelf|shelved", "registry"),
    ("does not see", r"(family|families) (does|do) not see|it does not see", "zero-energy mode"),
    ("whole bonds", r"whole (bonds?|ones)|bonds? (is|are) whole|unbroken", "intact bonds"),
    ("feels", r"feels?", "is subject to"),
    ("one order", r"(with|of) one order|has(n't| not) settled", "consistent order of convergence"),
    ("let go of", r"(is|are|was|were|and) let go", "released, unloaded"),
    ("knows", r"(deck|law|engine|body|bond|point|solid|step|heat|pressure)s? (does |do )?(not )?knows?|knows? nothing|knows? no", "depends on, supports"),
]
PATTERNS = [(name, re.compile(rf"\b(?:{words})(?!\w)", re.I), field) for name, words, field in WORDS]
# (page, word): where they may stand, and why
ALLOWED = {
    ("glossary.md", "directed bonds"): "explained there",
    ("together.md", None): "written by a test, from the program",
    ("measured.md", "directed bonds"): "figures per stored bond",
    ("output.md", "kin"): "an abbreviation of kinetic in an equation",
    ("CONTRIBUTING.md", "spreads"): "the example of what not to write",
}
# (part of a file's path, word): texts of the program where the word is right, and why
RIGHT = {
    ("", "asked"): "what a user asks for",
    ("", "told"): "names of variables in texts that are put together",
    ("", "not there"): "of files and keys",
    ("engine/src/run/b", "directed bonds"): "counted as they are stored",
    ("lammps/src/command/settings", "directed bonds"): "counted as they are stored",
    ("io/src/convert/family", "directed bonds"): "one end may miss what the other has",
    ("engine/src/run/equilibrium", "bond after bond"): "what it does, beside its name",
    ("engine/src/run/traits/lacks", "bond after bond"): "what it does, beside its name",
    ("engine/src/run/traits/system", "answers, settles"): "the name of a variable",
    ("lammps/src/model/build", "answers, settles"): "of a force on one atom",
    ("lammps/src/command/displace", "knows"): "of bonds of LAMMPS",
    ("transport/", "fans"): "rarefaction fans",
    ("shock", "fans"): "a rarefaction fan",
    ("io/src/read/abaqus", "wears"): "keywords of Abaqus",
    ("mechanics/src/interaction/atoms/many_body", "fans"): "for who programs",
    ("lammps/", "indenter"): "LAMMPS's own word",
    ("io/src/write/history", "indenter"): "columns of version 0.1",
    ("io/src/write/history", "work of conditions"): "columns of version 0.1",
    ("io/src/write/history", "released energy"): "columns of version 0.1",
}
AWAY = re.compile(r"<!--.*?-->|^ *(```+).*?^ *\1 *$|\$\$.*?\$\$|`[^`\n]*`|\]\([^)\s]*\)|\{\{.*?\}\}|<[^>\n]+>|^---\n.*?^---$", re.S | re.M)


def pages(root):
    book = root / "docs/book/src"
    for path in sorted(book.rglob("*.md")):
        name = path.relative_to(book).as_posix()
        if not name.startswith("reference/"):
            yield name, path
    # the first two are included in pages
    for name in ("docs/fields.md", "docs/conservation-laws.md", "README.md", "ARCHITECTURE.md", "CONTRIBUTING.md"):
        yield name, root / name


# titles and comments of decks
SAID = re.compile(r'(?:^title = "(.*)"$|(?:^|[ \t])#(.*)$)', re.M)


def decks(root):
    for path in sorted([*root.glob("decks/good/**/*.toml"), *root.glob("papers/**/*.toml")]):
        text = path.read_text(encoding="utf-8")
        lines = ["".join(part or "" for found in SAID.finditer(line) for part in found.groups()) for line in text.split("\n")]
        yield path.relative_to(root).as_posix(), "\n".join(lines)


LITERAL = re.compile(r'"((?:[^"\\]|\\.)*)"', re.S)
COMMENT = re.compile(r"^[ \t]*//.*$", re.M)


def texts(root):
    """Texts of the program: its literals with a blank in them, and sentences about keys of decks; all else is blank."""
    for path in sorted(root.glob("crates/*/src/**/*.rs")):
        name = path.relative_to(root / "crates").as_posix()
        if "tests" in name or name.endswith("deck/renamed.rs"):
            continue
        whole = path.read_text(encoding="utf-8").split("#[cfg(test)]\nmod tests {")[0]
        keep = LITERAL
        if "/document/" in name or name.endswith("conservation/document.rs"):
            keep = re.compile(r"^ *///(.*)$", re.M)
        else:
            whole = COMMENT.sub("", whole).replace("'\"'", "'.'")
        kept = ["\n" if c == "\n" else " " for c in whole]
        for found in keep.finditer(whole):
            if " " in found[1].strip():
                kept[found.start(1) : found.end(1)] = found[1]
        yield name, "".join(kept)


def main():
    root = Path(sys.argv[1]) if sys.argv[1:] and sys.argv[1] != "--where" else Path(__file__).resolve().parents[2]
    by_word, by_page, left, count = Counter(), Counter(), [], 0
    rows = [(name, path.read_text(encoding="utf-8"), ALLOWED) for name, path in pages(root)]
    rows += [(name, text, RIGHT) for name, text in texts(root)]
    rows += [(name, text, RIGHT) for name, text in decks(root)]
    for name, text, allowed in rows:
        if allowed is ALLOWED:
            # the last table of the glossary has the old names
            text = text.split("\n## Old names\n")[0]
            text = AWAY.sub(lambda m: "\n" * m[0].count("\n"), text)
        count += len(text.split())
        for word, pattern, field in PATTERNS:
            for found in pattern.finditer(text):
                if allowed is ALLOWED and ((name, None) in ALLOWED or (name, word) in ALLOWED):
                    continue
                if allowed is RIGHT and any(w == word and part in name for part, w in RIGHT):
                    continue
                by_word[word] += 1
                by_page[name] += 1
                left.append(f"{name}:{text.count(chr(10), 0, found.start()) + 1}: `{found[0]}`: {field}")
    for counter in (by_word, by_page):
        print(*(f"{n:5}  {key}" for key, n in counter.most_common()), "", sep="\n")
    print(f"{by_word.total()} old words in {count:,} words")
    if "--where" in sys.argv or 0 < len(left) < 90:
        print(*left, sep="\n")
    return 1 if left else 0


if __name__ == "__main__":
    sys.exit(main())
