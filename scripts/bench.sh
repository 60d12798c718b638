#!/usr/bin/env bash
# bench.sh BUILD -- every program whose figures docs/results.md quotes, in one run.
set -euo pipefail
cd "$(dirname "$0")/.."
build=$1
cmake --build "$build" --target bench >&2
export AMBIT_PATH="$PWD/$build/plugins"
for program in "$build"/bench/*; do
  [ -x "$program" ] && [ -f "$program" ] || continue
  printf '\n## %s\n\n' "$(basename "$program")"
  "$program"
done
missed=0
for table in figures solvers; do
  printf '\n## %s\n\n' "$table"
  "$build/ambit" run --quiet "scripts/bench/$table.lua" || missed=1
done
for scene in "andrews 0.03" "n_four_bar 2" "n_four_bar 10" bricard stewart ur5; do
  printf '\n## scripts/%s\n\n' "$scene"
  read -r name words <<<"$scene"
  "$build/ambit" run --quiet "scripts/$name.lua" $words
done
exit "$missed"
