#!/usr/bin/env python3
"""No hot loop calls a single vector operation.

A closure or a generic function that the compiler does not inline into a loop is made without the loop's instruction set, and calls
every one of its operations: same numbers, several times slower. This looks for such calls in the library of a release build
(x86-64; needs objdump):

    cargo build --release -p peridyne-mechanics && verify/inlined.py target/release/libperidyne_mechanics.rlib
"""
import re
import subprocess
import sys
from collections import Counter

# what other crates do with their own vectors
FOREIGN = ("<pulp::", "pulp::")

calls = Counter()
place = "?"
listing = subprocess.Popen(
    ["objdump", "-dr", "--no-show-raw-insn", "-C", sys.argv[1]],
    stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, text=True, errors="replace",
)
functions = 0
for line in listing.stdout:
    if line.endswith(">:\n"):
        place = line.split("<", 1)[1][:-3]
        functions += 1
    elif "R_X86_64" in line and (found := re.search(r"core_arch::x86::\w+::(_mm\w+)", line) or re.search(r"(_mm\d+_\w+)", line)):
        if not place.startswith(FOREIGN):
            calls[place, re.sub(r"17h[0-9a-f]{16}.*", "", found[1])] += 1
if listing.wait() != 0 or functions < 1000:
    sys.exit(f"{sys.argv[1]}: {functions} functions; expected the library of a release build")
for (place, operation), count in calls.most_common():
    print(f"{count:5} {operation:24} in {place}")
print(f"{functions} functions, {sum(calls.values())} calls of single operations")
sys.exit(1 if calls else 0)
