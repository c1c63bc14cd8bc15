"""The program: `python -m peridyne run crack.toml`, or `peridyne` where pip puts scripts."""

import sys

from . import _peridyne


def main():
    sys.exit(_peridyne.program(sys.argv[1:]))


if __name__ == "__main__":
    main()
