"""What the guide adds to MkDocs: equations as MathML, files of the repository, pages that stand elsewhere."""

import re
from pathlib import Path

from latex2mathml.converter import convert
from mkdocs.structure.files import File

BOOK = Path(__file__).resolve().parent
ROOT = BOOK.parent.parent
# what pages link to and show, under the same paths in the site
SHARED = ["decks/good/*.toml", "decks/good/conservation/*.toml", "decks/in.*", "docs/*.png", "docs/*/*.png"]
CODE = re.compile(r"(^ *(```+|~~~+).*?^ *\2 *$|`[^`\n]+`)", re.S | re.M)
MATH = re.compile(r"\$\$(.+?)\$\$|(?<![\w$\\])\$([^\s$](?:[^$\n]*[^\s$])?)\$(?![\w$])", re.S)
INCLUDE = re.compile(r"^\{\{ *include (\S+) *\}\}$", re.M)

equations: dict[str, str] = {}


def on_config(config):
    # `peridyne doc --book docs/book/src/reference` writes it; without it the other pages stand, and its links are words
    pages = sorted(p.name for p in (BOOK / "src/reference").glob("*.md") if p.name != "index.md")
    for section in config.nav:
        if "Reference" not in section:
            continue
        others = [p for p in section["Reference"] if "Deck reference" not in p]
        if (BOOK / "src/reference/index.md").exists():
            own = [{"All tables": "reference/index.md"}, *(f"reference/{name}" for name in pages)]
            section["Reference"] = [{"Deck reference": own}, *others]
        else:
            print("INFO    -  the deck reference is left out: peridyne doc --book docs/book/src/reference writes it")
            section["Reference"] = others
    return config


def on_files(files, config):
    for pattern in SHARED:
        for path in sorted(ROOT.glob(pattern)):
            name = path.relative_to(ROOT).as_posix()
            files.append(File.generated(config, name, abs_src_path=str(path)))
    return files


def on_page_markdown(markdown, page, config, files):
    markdown = INCLUDE.sub(lambda m: included(m[1], page), markdown)
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


def equation(match):
    tex, display = (match[1], "block") if match[1] else (match[2], "inline")
    key = f"EQ{len(equations):05d}QE"
    equations[key] = (tex.strip(), display)
    # a paragraph of its own
    return f'\n\n<div class="equation">{key}</div>\n\n' if display == "block" else key


def on_page_content(html, page, config, files):
    def made(match):
        tex, display = equations[match[0]]
        return convert(tex, display=display)

    # code and its test, where a page names them
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
