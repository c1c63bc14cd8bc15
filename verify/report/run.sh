#!/usr/bin/env bash
# Reports of runs, opened in a browser: verify/report/run.sh PROGRAM [OUT]
# Needs Chromium (Debian: apt-get install chromium) and Node.js; installs what else it needs into OUT.
set -euo pipefail
here=$(cd "$(dirname "$0")" && pwd)
decks=$here/../../decks/good
program=$(realpath "${1:?the program, e.g. target/release/peridyne}")
out=${2:-$(mktemp -d)}
mkdir -p "$out"
out=$(realpath "$out")

browser=${CHROMIUM:-$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)}
if [[ -z $browser ]] && command -v apt-get > /dev/null; then
    apt-get install -y --no-install-recommends chromium > "$out/apt.log" 2>&1 || { tail -3 "$out/apt.log"; exit 1; }
    browser=$(command -v chromium)
fi
if ! command -v npm > /dev/null && command -v apt-get > /dev/null; then
    apt-get install -y --no-install-recommends nodejs npm >> "$out/apt.log" 2>&1 || { tail -3 "$out/apt.log"; exit 1; }
fi
[[ -n $browser ]] || { echo "no Chromium: install it, or name it in CHROMIUM"; exit 1; }
cp "$here/package.json" "$here/package-lock.json" "$here/check.mjs" "$here/expected.json" "$out"
(cd "$out" && npm ci --silent --no-audit --no-fund)

run() { # NAME DECK [--set …]: quietly
    local name=$1 deck=$2
    shift 2
    "$program" run "$decks/$deck" --out "$out/$name" "$@" > "$out/$name.log" 2>&1 || { cat "$out/$name.log"; exit 1; }
}
# 3-D with fracture, of fewer points than the original; 2-D; statics with probes; 1-D; modes; atoms; conservation laws
run impact impact.toml --set body.spacing="1 mm" --set run.steps=1200
run kalthoff kalthoff.toml --set body.spacing="2 mm"
run load_displacement load_displacement.toml
run bar_wave bar_wave.toml --set output.every=8
run cantilever cantilever.toml
run alloy alloy.toml
run swirl conservation/swirl.toml
run advection conservation/advection.toml

cd "$out"
CHROMIUM=$browser node check.mjs "$out" "${@:3}"
