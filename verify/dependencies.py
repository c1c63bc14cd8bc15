"""Licences and sources of all dependencies against `deny.toml`: what `cargo deny check licenses bans sources` asks, in a second
(and, like it, licences of what tests alone depend on are theirs).

Usage: python verify/dependencies.py
Needs: pip install license-expression. Ends with 1 if a package may not be used.
"""

import json
import subprocess
import sys
import tomllib
from pathlib import Path

from license_expression import AND, OR, get_spdx_licensing

ROOT = Path(__file__).resolve().parent.parent
INDEX = ("registry+https://github.com/rust-lang/crates.io-index", "sparse+https://index.crates.io/")


def allows(licence, allowed):
    """May one use what is under this expression?"""
    if isinstance(licence, (AND, OR)):
        parts = [allows(part, allowed) for part in licence.args]
        return all(parts) if isinstance(licence, AND) else any(parts)
    return str(licence) in allowed


def shipped(metadata):
    """Ids of what programs are made of: all but dependencies of tests alone."""
    nodes = {node["id"]: node for node in metadata["resolve"]["nodes"]}
    found, left = set(), list(metadata["workspace_members"])
    while left:
        one = left.pop()
        if one not in found:
            found.add(one)
            left += [d["pkg"] for d in nodes[one]["deps"] if any(kind["kind"] != "dev" for kind in d["dep_kinds"])]
    return found


def main():
    rules = tomllib.loads((ROOT / "deny.toml").read_text())
    allowed = set(rules["licenses"]["allow"])
    command = ["cargo", "metadata", "--locked", "--format-version", "1"]
    metadata = json.loads(subprocess.run(command, cwd=ROOT, check=True, capture_output=True).stdout)
    packages, ours = metadata["packages"], shipped(metadata)
    spdx, wrong = get_spdx_licensing(), []
    for package in packages:
        name = f"{package['name']} {package['version']}"
        if package["source"] is not None and package["source"] not in INDEX:
            wrong.append(f"{name}: comes from {package['source']}")
        said = package["license"]
        if package["id"] not in ours:
            continue
        if said is None:
            wrong.append(f"{name}: says no licence")
        elif not allows(spdx.parse(said.replace("/", " OR "), validate=True), allowed):
            wrong.append(f"{name}: {said} is not allowed by deny.toml")
        if package["source"] is None:
            stars = [d["name"] for d in package["dependencies"] if d["req"] == "*" and not d.get("path")]
            wrong += [f"{name}: depends on any version of {star}" for star in stars]
    print("\n".join(wrong) or f"{len(ours)} of {len(packages)} packages are shipped, all may be")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
