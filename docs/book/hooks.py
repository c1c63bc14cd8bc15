"""What the guide adds to MkDocs: equations as MathML, files of the repository, pages that stand elsewhere, the page of decks, words to search by."""

import re
import tomllib
from pathlib import Path

from latex2mathml.converter import convert
from mkdocs.structure.files import File

BOOK = Path(__file__).resolve().parent
ROOT = BOOK.parent.parent
# what pages link to and show, under the same paths in the site
SHARED = ["CITATION.cff", "decks/good/*.toml", "decks/good/conservation/*.toml", "decks/in.*", "docs/*.png", "docs/*/*.png"]
CODE = re.compile(r"(^ *(```+|~~~+).*?^ *\2 *$|`[^`\n]+`)", re.S | re.M)
MATH = re.compile(r"\$\$(.+?)\$\$|(?<![\w$\\])\$([^\s$](?:[^$\n]*[^\s$])?)\$(?![\w$])", re.S)
INCLUDE = re.compile(r"^\{\{ *include (\S+) *\}\}$", re.M)

# What others call what a page is about: said at its end, so that the search finds it. A word that a page has anyway need not stand here.
ALSO = {
    "theory/fracture.md": ["critical energy release rate Gc", "toughness", "strain energy release rate"],
    "theory/constants.md": ["Gc", "calibration"],
    "reference/boundary_condition.md": ["boundary condition", "Dirichlet", "Neumann", "body force", "prescribed displacement", "load"],
    "reference/initial.md": ["initial condition"],
    "reference/material.fracture.md": ["Gc", "critical energy release rate", "failure criterion", "bond breakage"],
    "reference/rigid_body.md": ["impactor", "projectile", "rigid body", "punch", "tool"],
    "reference/output.pictures.md": ["animation", "movie", "video", "image", "PNG"],
    "reference/output.md": ["animation", "ParaView", "results"],
    "reference/run.md": ["time integration", "Verlet", "CFL"],
    "reference/statics.md": ["quasi-static", "implicit", "load step", "arc length", "path following"],
    "reference/probe.md": ["crack speed", "crack tip velocity", "reaction force", "J-integral", "stress intensity factor", "CMOD"],
    "howto/look.md": ["animation", "movie", "video", "film", "ParaView", "Point Gaussian"],
    "howto/crack-speed.md": ["crack velocity", "crack tip speed", "branching", "Rayleigh wave speed"],
    "howto/contact.md": ["impactor", "projectile", "rigid body"],
    "howto/restart.md": ["checkpoint", "wall time", "queue", "Slurm"],
    "howto/clusters.md": ["Slurm", "sbatch", "srun", "HPC", "supercomputer", "queue"],
    "howto/studies.md": ["parameter sweep", "Latin hypercube", "sensitivity"],
    "howto/horizon.md": ["m-convergence", "delta-convergence", "mesh size"],
}
# Kinds of decks: a deck is of the first that fits, and stands on their page in the order of FIRST
FIRST = ["Fracture", "Impact, contact, friction", "Statics", "Waves and motion", "Heat, diffusion, thermal stress"]
KINDS = {
    "Conservation laws": lambda deck, of: deck.get("kind") == "conservation_law",
    "Atoms": lambda deck, of: of["atoms"],
    "Heat, diffusion, thermal stress": lambda deck, of: "heat" in deck or "species" in deck,
    "Impact, contact, friction": lambda deck, of: "rigid_body" in deck or isinstance(deck.get("body"), list) or "friction" in str(deck.get("contact")),
    "Fracture": lambda deck, of: "precrack" in deck or "toughness" in deck or "healing" in deck or of["fracture"],
    "Statics": lambda deck, of: "statics" in deck,
    "Waves and motion": lambda deck, of: True,
}
# of molecular dynamics, as `peridyne laws` calls them
ATOMS = {"lennard_jones", "morse", "buckingham", "born_mayer", "eam", "eam_form", "stillinger_weber", "tersoff", "no_potential"}

# Letters of an equation, more or less, that a narrow screen has room for
LONGEST = 36

equations: dict[str, str] = {}


def on_config(config):
    # `peridyne doc --book docs/book/src/reference` writes it; without it the other pages stand, and its links are words
    for section in config.nav:
        if "Reference" not in section:
            continue
        others = [p for p in section["Reference"] if "Deck reference" not in p]
        if (BOOK / "src/reference/index.md").exists():
            section["Reference"] = [{"Deck reference": [{"All tables": "reference/index.md"}, *groups()]}, *others]
        else:
            print("INFO    -  the deck reference is left out: peridyne doc --book docs/book/src/reference writes it")
            section["Reference"] = others
    return config


def groups():
    """The reference in the menu, as its index divides it."""
    found, own = [], []
    for line in (BOOK / "src/reference/index.md").read_text(encoding="utf-8").splitlines():
        if line.startswith("## "):
            own = []
            found.append({line.removeprefix("## "): own})
        elif found and (row := re.match(r"\| \[`?(.*?)`?\]\((\S+\.md)\) \|", line)):
            own.append({short(row[1]): f"reference/{row[2]}"})
    return found


def short(header):
    """`[material.law.lps]` as it stands in the menu: below its group the last word says enough."""
    name = header.strip("[]")
    return name.removeprefix("material.law.") if name != header else header


def on_files(files, config):
    for pattern in SHARED:
        for path in sorted(ROOT.glob(pattern)):
            name = path.relative_to(ROOT).as_posix()
            files.append(File.generated(config, name, abs_src_path=str(path)))
    files.append(File.generated(config, "decks.md", content=decks()))
    return files


def decks():
    """Every good deck with its title, what its first comment says, and its picture where docs/book/decks.py drew one."""
    sections = {kind: [] for kind in [*FIRST, *(kind for kind in KINDS if kind not in FIRST)]}
    for path in [*sorted((ROOT / "decks/good").glob("*.toml")), *sorted((ROOT / "decks/good/conservation").glob("*.toml"))]:
        text = path.read_text(encoding="utf-8")
        deck = tomllib.loads(text)
        laws = set(re.findall(r"\b(\w+)\b(?= *= *\{)|law *= *\"(\w+)\"", str(text)))
        laws = {name for pair in laws for name in pair if name}
        of = {"atoms": bool(laws & ATOMS), "fracture": re.search(r"^[^#]*\b(fracture|critical_stretch)\b", text, re.M) is not None}
        kind = next(kind for kind, fits in KINDS.items() if fits(deck, of))
        sections[kind].append(card(path, text, deck))
    out = ["---\nhide: [toc]\n---\n# Decks\n",
           "All decks of `decks/good`: each is run by the tests on one thread and several, on ranks, and cut off and resumed. Copy one that is near to your problem; "
           "`peridyne check` says what it would do, and the [deck reference](reference/index.md) what its keys mean.\n"]
    out.append(" · ".join(f"[{kind}](#{anchor(kind)})" for kind, of in sections.items() if of) + "\n")
    for kind, of in sections.items():
        if of:
            out += [f"## {kind} {{ #{anchor(kind)} }}\n", '<div class="cards decks" markdown>', *of, "</div>\n"]
    return "\n".join(out)


def anchor(kind):
    return re.sub(r"\W+", "-", kind.lower()).strip("-")


def card(path, text, deck):
    name = path.relative_to(ROOT).as_posix()
    comment = re.match(r"(?:# .*\n)+", text)
    said = " ".join(line.lstrip("# ") for line in comment[0].splitlines()) if comment else ""
    title = deck.get("title") or path.stem.replace("_", " ").capitalize()
    title = title[0].upper() + title[1:]
    picture = BOOK / "src/reference/decks" / f"{path.stem}.png"
    shown = [f'[![{path.stem}](reference/decks/{path.stem}.png){{ loading=lazy }}]({name})\n'] if picture.exists() else []
    # a comment is no Markdown
    said = re.sub(r"([*_<>$\[\]])", r"\\\1", said)
    return "\n".join(["<div markdown>", *shown, f"**{title}**\n", *([said + "\n"] if said else []), f"[`{path.name}`]({name})", "</div>"])


def on_page_markdown(markdown, page, config, files):
    markdown = INCLUDE.sub(lambda m: included(m[1], page), markdown)
    if page.file.src_uri == "index.md":
        markdown += cited()
    if page.file.src_uri in ALSO:
        page.meta.setdefault("search", {})["boost"] = 4
    if page.file.src_uri.startswith("reference/"):
        # tables take the width of the page
        page.meta["hide"] = ["toc"]
    if not (BOOK / "src/reference/index.md").exists():
        markdown = re.sub(r"\[(`[^`]*`|[^\]]*)\]\((?:\.\./)?reference/[^)]*\)", r"\1", markdown)
    parts = CODE.split(markdown)
    # text, (code, fence), text, …: the fence is a group of its own
    out = []
    for n, part in enumerate(parts):
        if n % 3 == 0:
            out.append(MATH.sub(equation, part))
        elif n % 3 == 1:
            out.append(part)
    return "".join(out)


def cited():
    """How to cite the program, from CITATION.cff."""
    text = (ROOT / "CITATION.cff").read_text(encoding="utf-8")
    said = {key: re.search(rf"^(?:  - )?{key}: (.*)$", text, re.M)[1] for key in ("title", "name", "version")}
    return (f"\n\n## Cite { '{ #cite }' }\n\n{said['name']}: *{said['title']}*, version {said['version']}, software ([`CITATION.cff`](CITATION.cff), which reference managers read); "
            "and the papers of the methods that you use, which `peridyne laws` and the theory pages name.\n")


def equation(match):
    tex, display = (match[1], "block") if match[1] else (match[2], "inline")
    keys = []
    # what stands side by side may stand below each other where there is no room
    for part in side_by_side(tex.strip()) if display == "block" else [tex.strip()]:
        terms = []
        for term in broken(part) if display == "block" else [part]:
            terms.append(f"EQ{len(equations):05d}QE")
            equations[terms[-1]] = (term, display)
        keys.append(terms[0] if len(terms) == 1 else f'<span class="terms">{" ".join(terms)}</span>')
    # a paragraph of its own
    return f'\n\n<div class="equation">{" ".join(keys)}</div>\n\n' if display == "block" else keys[0]


def broken(tex):
    """A long equation before its relations, and where a piece is still long before its sums: browsers break none."""

    def long(text):
        # names and letters that are seen, more or less
        return len(re.sub(r"[{}^_\s&]", "", re.sub(r"\\[a-zA-Z]+|\\.", "x", text))) > LONGEST

    def parted(text, signs):
        parts, depth, begin = [], 0, 0
        for token in re.finditer(r"\\[a-zA-Z]+|\\.|[{}()\[\]]|[=+\-]", text):
            if token[0] in ("{", "(", "[", "\\begin", "\\left"):
                depth += 1
            elif token[0] in ("}", ")", "]", "\\end", "\\right"):
                depth -= 1
            elif depth == 0 and token[0] in signs and text[begin : token.start()].strip(" =+-"):
                parts.append(text[begin : token.start()])
                begin = token.start()
        return [*parts, text[begin:]]

    if not long(tex) or "\\\\" in tex:
        return [tex]
    pieces = []
    for piece in parted(tex, "="):
        pieces += parted(piece, "+-") if long(piece) else [piece]
    return [piece for piece in pieces if piece.strip()]


def side_by_side(tex):
    """The parts of an equation between `\\quad` and `\\qquad` that stand in nothing else."""
    parts, depth, begin = [], 0, 0
    for token in re.finditer(r"\\(?:begin|left)\b|\\(?:end|right)\b|\\q?quad\b|\\.|[{}]", tex):
        if token[0] in ("{", "\\begin", "\\left"):
            depth += 1
        elif token[0] in ("}", "\\end", "\\right"):
            depth -= 1
        elif depth == 0 and token[0] in ("\\quad", "\\qquad"):
            parts.append(tex[begin : token.start()])
            begin = token.end()
    return [part.strip() for part in [*parts, tex[begin:]] if part.strip()]


def on_page_content(html, page, config, files):
    def made(match):
        tex, display = equations[match[0]]
        made = convert(tex, display=display)
        # a sign that a term begins with stands between two
        return re.sub(r"(<math[^>]*><mrow><mo)(>(?:=|&#x0003D;|\+|&#x0002B;|-|&#x02212;)</mo>)", r'\1 form="infix"\2', made, count=1)

    # code and its test, where a page names them
    name = page.file.src_uri
    if name in ALSO:
        html += f'<p class="also">Also searched for as: {", ".join(ALSO[name])}.</p>'
    if name.startswith("reference/"):
        html = f'<div class="reference">{html}</div>'
    html = re.sub(r"<p>(<strong>(?:Source|Code|Test)</strong>)", r'<p class="where">\1', html)
    return re.sub(r"EQ\d{5}QE", made, html)


def included(name, page):
    """A page of docs/ as a page of the guide: without its title, its links as seen from here."""
    path = ROOT / name
    text = re.sub(r"\A# .*\n", "", path.read_text(encoding="utf-8"))
    depth = page.file.src_uri.count("/")

    def link(match):
        to = match[2]
        if re.match(r"[a-z]+:|#|/", to):
            return match[0]
        there = (path.parent / to.split("#")[0]).resolve().relative_to(ROOT).as_posix()
        return f"{match[1]}({'../' * depth}{there})"

    return re.sub(r"(!?\[[^\]]*\])\(([^)\s]+)\)", link, text)


def on_post_page(output, page, config):
    """The search of pages that are opened from disk loads a script from a network, but for this."""
    own = "../" * page.file.dest_uri.count("/") + "assets/iframe-worker.js"
    return output.replace("https://unpkg.com/iframe-worker/shim", own)


def on_post_template(output, template_name, config):
    return output.replace("https://unpkg.com/iframe-worker/shim", "assets/iframe-worker.js")
