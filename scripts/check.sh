#!/usr/bin/env bash
# Formatting and static analysis of the whole tree; prints what is wrong and exits 1. With --format, formatting alone.
set -euo pipefail
cd "$(dirname "$0")/.."
mapfile -t sources < <(git ls-files 'framework/*.[ch]' 'plugins/*.[ch]' 'tests/*.[ch]')
clang-format --dry-run -Werror "${sources[@]}"
echo "format: ${#sources[@]} files"
git ls-files '*.md' '*.lua' '*.c' '*.h' | xargs lua5.4 scripts/wrap.lua --check
echo "lines: at most 120 columns"
reuse --no-multiprocessing lint | tail -n 1 # the licence of each file: .reuse/dep5
[ "${1-}" != --format ] || exit 0
cmake --preset clang -DAMBIT_TESTS=OFF >/dev/null
mapfile -t units < <(git ls-files 'framework/*.c' 'plugins/*.c')
printf '%s\n' "${units[@]}" | xargs -P "$(nproc)" -n 4 clang-tidy -p build/clang --quiet 2>/dev/null
echo "static analysis: ${#units[@]} files"
