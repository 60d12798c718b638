#!/usr/bin/env bash
# bench.sh BUILD [WORD ...] -- runs every program whose figures docs/results.md and docs/results/ quote, and writes what they print
# into these pages. With words, only programs whose command contains one of them.
set -euo pipefail
cd "$(dirname "$0")/.."
build=$PWD/$1
shift
cmake --build "$build" --target bench >&2
export AMBIT_PATH="$build/plugins"
exec "$(command -v lua5.4 || command -v lua)" scripts/results.lua "$build" "$@"
