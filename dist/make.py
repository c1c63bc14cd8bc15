"""What users install: an archive with the program, a container of one layer, the wheel, and their checksums.

    python3 dist/make.py --out FOLDER                    builds all three (Linux, x86-64), then tries them
    python3 dist/make.py --out FOLDER --program P --static P --wheel W
                                                         packs and tries what is built already
    python3 dist/make.py --check FOLDER                  tries what is in a folder

Building needs Rust, and from PyPI `cargo-zigbuild`, `ziglang` and `maturin`. The program of the archive, and that of the wheel, need symbols of glibc 2.17
(2012) at most, so that they run on the Linux of clusters. That of the container is linked statically, since nothing else is in there; it finds no MPI.
Archives have no times and no owners: the same programs give the same bytes.
"""

import argparse
import gzip
import hashlib
import io
import json
import os
import platform
import re
import shutil
import subprocess
import sys
import tarfile
import tempfile
import zipfile
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
TARGET = "x86_64-unknown-linux-gnu"
GLIBC = (2, 17)
# what the wheel may ask for as well, beside libc: manylinux2014 (PEP 599)
SYSTEM = re.compile(r"^(lib(c|m|dl|pthread|rt|gcc_s|util)\.so|ld-linux)")


def say(text):
    print(text, flush=True)


def run(*command, **more):
    return subprocess.run([str(c) for c in command], check=True, **more)


def answer(*command, **more):
    return run(*command, stdout=subprocess.PIPE, text=True, **more).stdout


def version():
    text = (ROOT / "Cargo.toml").read_text()
    return re.search(r'^version = "(.+)"$', text, re.M)[1]


def build(room):
    """The program for glibc 2.17, the static one, and the wheel."""
    environment = {**os.environ, "CARGO_TARGET_DIR": str(room)}
    cargo = ["--release", "--locked", "-p", "peridyne-cli", "--manifest-path", ROOT / "Cargo.toml"]
    say("building the program for glibc 2.17")
    run("cargo", "zigbuild", *cargo, "--target", f"{TARGET}.{GLIBC[0]}.{GLIBC[1]}", env=environment)
    program = room / "peridyne-2.17"
    shutil.copy2(room / TARGET / "release" / "peridyne", program)
    say("building the static program")
    static = {**environment, "RUSTFLAGS": "-C target-feature=+crt-static", "CARGO_TARGET_DIR": str(room / "static")}
    run("cargo", "build", *cargo, "--target", TARGET, env=static)
    say("building the wheel")
    wheels = room / "wheels"
    shutil.rmtree(wheels, ignore_errors=True)
    run("maturin", "build", "--locked", "--zig", "--compatibility", "manylinux2014", "--out", wheels,
        "--manifest-path", ROOT / "crates" / "python" / "Cargo.toml", env=environment)
    [wheel] = wheels.glob("*.whl")
    return program, room / "static" / TARGET / "release" / "peridyne", wheel


def add(archive, name, content, mode=0o644):
    """A file without a time and without an owner."""
    info = tarfile.TarInfo(name)
    info.size, info.mode = len(content), mode
    archive.addfile(info, io.BytesIO(content))


def tar(files):
    room = io.BytesIO()
    with tarfile.open(fileobj=room, mode="w", format=tarfile.PAX_FORMAT) as archive:
        for name, content, mode in files:
            add(archive, name, content, mode)
    return room.getvalue()


def archive(out, program):
    """The program with its licences, manual pages and completions."""
    folder = f"peridyne-{version()}"
    shells = {"bash": "bash-completion/completions/peridyne", "zsh": "zsh/site-functions/_peridyne",
              "fish": "fish/vendor_completions.d/peridyne.fish"}
    files = [(f"{folder}/bin/peridyne", program.read_bytes(), 0o755)]
    for name in ["README.md", "CHANGELOG.md", "LICENSE-APACHE", "LICENSE-MIT"]:
        files.append((f"{folder}/{name}", (ROOT / name).read_bytes(), 0o644))
    with tempfile.TemporaryDirectory() as pages:
        answer(program, "man", "--out", pages)
        for page in sorted(Path(pages).iterdir()):
            files.append((f"{folder}/share/man/man1/{page.name}", page.read_bytes(), 0o644))
    for shell, place in shells.items():
        files.append((f"{folder}/share/{place}", answer(program, "completions", shell).encode(), 0o644))
    path = out / f"{folder}-{TARGET}.tar.gz"
    path.write_bytes(gzip.compress(tar(files), mtime=0))
    return path


def container(out, program):
    """An image of one layer, as `docker load`, `podman load` and Apptainer (`docker-archive:FILE`) read it, and as OCI layout."""
    name = f"peridyne:{version()}"
    licences = [(f"licenses/{n}", (ROOT / n).read_bytes(), 0o644) for n in ["LICENSE-APACHE", "LICENSE-MIT"]]
    layer = tar([("usr/bin/peridyne", program.read_bytes(), 0o755), *licences])
    packed = gzip.compress(layer, mtime=0)

    def digest(content):
        return hashlib.sha256(content).hexdigest()

    def text(value):
        return json.dumps(value, sort_keys=True).encode()

    labels = {"org.opencontainers.image.title": "peridyne", "org.opencontainers.image.version": version(),
              "org.opencontainers.image.licenses": "MIT OR Apache-2.0"}
    config = text({
        "architecture": "amd64", "os": "linux",
        "config": {"Entrypoint": ["/usr/bin/peridyne"], "Env": ["PATH=/usr/bin"], "WorkingDir": "/work", "Labels": labels},
        "rootfs": {"type": "layers", "diff_ids": [f"sha256:{digest(layer)}"]},
    })

    def described(kind, content, **more):
        return {"mediaType": f"application/vnd.oci.image.{kind}", "digest": f"sha256:{digest(content)}", "size": len(content), **more}

    manifest = text({"schemaVersion": 2, "mediaType": "application/vnd.oci.image.manifest.v1+json",
                     "config": described("config.v1+json", config), "layers": [described("layer.v1.tar+gzip", packed)]})
    note = {"org.opencontainers.image.ref.name": version(), "io.containerd.image.name": f"docker.io/library/{name}"}
    index = text({"schemaVersion": 2, "manifests": [described("manifest.v1+json", manifest, annotations=note)]})
    blobs = [(f"blobs/sha256/{digest(c)}", c, 0o644) for c in (config, packed, manifest)]
    old = text([{"Config": blobs[0][0], "RepoTags": [name], "Layers": [blobs[1][0]]}])
    files = [*blobs, ("index.json", index, 0o644), ("manifest.json", old, 0o644),
             ("oci-layout", text({"imageLayoutVersion": "1.0.0"}), 0o644)]
    path = out / f"peridyne-{version()}-container.tar"
    path.write_bytes(tar(files))
    return path


def checksums(out, files):
    lines = [f"{hashlib.sha256(f.read_bytes()).hexdigest()}  {f.name}\n" for f in sorted(files)]
    (out / "SHA256SUMS").write_text("".join(lines))


# ---- trying them


def symbols(path):
    """Libraries that a program needs, and the newest version of glibc's symbols."""
    text = answer("readelf", "--wide", "--dynamic", "--version-info", path)
    needed = re.findall(r"\(NEEDED\).*\[(.+)\]", text)
    versions = [tuple(map(int, v.split("."))) for v in re.findall(r"GLIBC_([0-9.]+)", text)]
    return needed, max(versions, default=(0,))


DECK = """title = "a bar"
horizon = { m_ratio = 2 }
body = { lattice = "chain", spacing = "1 mm", region = { block = { low = [0], high = ["50 mm"] } } }
material = { density = "1000 kg/m^3", law = { pmb = { young = "1 GPa" } } }
initial = [{ set = "all", velocity = { x = "1 m/s * x / 50 mm" } }]
run = { steps = 20 }
"""


def tries(room, *command):
    """A run by this program is whole, and a mistake is said with code 2."""
    (room / "bar.toml").write_text(DECK)
    run(*command, "run", "bar.toml", cwd=room, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    record = json.loads((room / "out" / "bar" / "run.json").read_text())
    assert record["status"] == "done" and record["steps"] == 20, record
    (room / "bad.toml").write_text(DECK.replace("steps", "stpes"))
    bad = subprocess.run([*map(str, command), "run", "bad.toml"], cwd=room, capture_output=True, text=True)
    assert bad.returncode == 2 and "steps" in bad.stderr, (bad.returncode, bad.stderr)
    return record["state_hash"]


def unpacked(path, room):
    with tarfile.open(path) as archive:
        archive.extractall(room, filter="data")


def check_archive(path, room, released):
    unpacked(path, room)
    [folder] = room.glob("peridyne-*")
    program = folder / "bin" / "peridyne"
    needed, newest = symbols(program)
    strangers = [n for n in needed if not SYSTEM.match(n)]
    assert not strangers, f"{path.name}: needs {strangers}"
    assert not released or newest <= GLIBC, f"{path.name}: needs glibc {newest}"
    # of a clone with its commit
    said = answer(program, "--version").strip()
    assert re.fullmatch(re.escape(f"peridyne {version()}") + r"( \([0-9a-f]{7,}, \d{4}-\d\d-\d\d\))?", said), said
    pages = {page.name for page in (folder / "share" / "man" / "man1").iterdir()}
    verbs = set(re.findall(r"^  ([a-z]+)  +\S", answer(program, "--help"), re.M)) - {"help"}
    assert pages == {"peridyne.1", *(f"peridyne-{verb}.1" for verb in verbs)}, "manual pages"
    assert len([f for f in (folder / "share").rglob("*peridyne*") if f.suffix != ".1"]) == 3, "completions"
    return tries(room, program), f"libraries {', '.join(needed)}; glibc {'.'.join(map(str, newest))}"


def check_container(path, room, released):
    unpacked(path, room / "image")
    image = room / "image"
    index = json.loads((image / "index.json").read_text())

    def blob(of):
        content = (image / "blobs" / of["digest"].replace(":", "/")).read_bytes()
        assert f"sha256:{hashlib.sha256(content).hexdigest()}" == of["digest"] and len(content) == of["size"], of
        return content

    manifest = json.loads(blob(index["manifests"][0]))
    config = json.loads(blob(manifest["config"]))
    [layer] = manifest["layers"]
    content = gzip.decompress(blob(layer))
    assert config["rootfs"]["diff_ids"] == [f"sha256:{hashlib.sha256(content).hexdigest()}"], "another layer"
    root = room / "root"
    with tarfile.open(fileobj=io.BytesIO(content)) as archive:
        archive.extractall(root, filter="data")
    program = root / "usr" / "bin" / "peridyne"
    needed, _ = symbols(program)
    # a debug build that is packed for a trial is not static
    assert not released or not needed, f"{path.name}: needs {needed}"
    work = root / "work"
    work.mkdir()
    # nothing else of this machine can be seen there
    inside = ["unshare", "--map-root-user", "--root", root, "--wd", "/work", "/usr/bin/peridyne"]
    alone = not needed and subprocess.run([*map(str, inside), "--version"], capture_output=True).returncode == 0
    found = tries(work, *(inside if alone else [program]))
    return found, "alone in its root" if alone else "beside the rest of this machine"


def check_wheel(path, room, released):
    name = re.fullmatch(r"peridyne-(.+?)-cp310-abi3-(.+)\.whl", path.name)
    assert name and name[1] == version(), path.name
    assert not released or "manylinux2014" in name[2], path.name
    with zipfile.ZipFile(path) as wheel:
        wheel.extractall(room / "wheel")
    [module] = (room / "wheel").rglob("_peridyne*.so")
    needed, newest = symbols(module)
    strangers = [n for n in needed if not SYSTEM.match(n)]
    assert not strangers, f"{path.name}: needs {strangers}"
    assert not released or newest <= GLIBC, f"{path.name}: needs glibc {newest}"
    run(sys.executable, "-m", "venv", room / "venv")
    run(room / "venv" / "bin" / "pip", "install", "--quiet", path)
    return tries(room, room / "venv" / "bin" / "peridyne"), f"{path.stat().st_size / 1e6:.1f} MB"


def check(out, released):
    """Every file is what its checksum says, and runs in an empty folder; all find the same bits."""
    lines = (out / "SHA256SUMS").read_text().splitlines()
    names = [line.split("  ") for line in lines]
    assert len(names) == 3, lines
    hashes = set()
    for digest, name in names:
        path = out / name
        assert hashlib.sha256(path.read_bytes()).hexdigest() == digest, f"{name}: another checksum"
        of = {".gz": check_archive, ".tar": check_container, ".whl": check_wheel}[path.suffix]
        with tempfile.TemporaryDirectory() as room:
            found, about = of(path, Path(room), released)
        hashes.add(found)
        say(f"{name}: {path.stat().st_size / 1e6:.1f} MB, runs ({about})")
    assert len(hashes) == 1, f"other bits: {hashes}"
    say(f"the same bits: {hashes.pop()}")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--out", type=Path)
    parser.add_argument("--program", type=Path)
    parser.add_argument("--static", type=Path)
    parser.add_argument("--wheel", type=Path)
    parser.add_argument("--room", type=Path, default=ROOT / "target" / "dist", help="where it builds")
    parser.add_argument("--check", type=Path)
    given = parser.parse_args()
    if given.check:
        return check(given.check, True)
    if not given.out:
        parser.error("--out FOLDER: where the files go")
    built = [given.program, given.static, given.wheel]
    if any(built) and not all(built):
        parser.error("--program, --static and --wheel are given together")
    if not all(built) and (platform.system(), platform.machine()) != ("Linux", "x86_64"):
        parser.error("builds on Linux on x86-64")
    given.out.mkdir(parents=True, exist_ok=True)
    program, static, wheel = built if all(built) else build(given.room)
    copy = given.out / wheel.name
    shutil.copyfile(wheel, copy)
    checksums(given.out, [archive(given.out, program), container(given.out, static), copy])
    check(given.out, not all(built))


if __name__ == "__main__":
    main()
