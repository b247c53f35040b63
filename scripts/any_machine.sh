#!/usr/bin/env bash
# Runs the suite under every arithmetic setting that this machine offers, and prints which were
# run with pytest's counts. Arguments go to pytest.
#
#   scripts/any_machine.sh                      the whole suite under each setting
#   scripts/any_machine.sh tests/doctor
#
# PYTHON names the interpreter (default: .venv/bin/python); SETTINGS picks some by name.
set -uo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
cd "$root"
python=${PYTHON:-$root/.venv/bin/python}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
export PYTHONPATH="$root${PYTHONPATH:+:$PYTHONPATH}"

"$python" scripts/arithmetic_settings.py >"$work/settings" || exit 2
bad=0
while IFS=$'\t' read -r name first second third <&3; do
  if [ -n "${SETTINGS:-}" ] && [[ " $SETTINGS " != *" $name "* ]]; then continue; fi
  variables=()
  for one in "$first" "$second" "$third"; do [ -n "$one" ] && variables+=("$one"); done
  printf '\n== %s: %s\n' "$name" "${variables[*]:-as the machine is}"
  # machine code of one setting is not read by another
  cache="$work/numba-$name"
  env "${variables[@]}" NUMBA_CACHE_DIR="$cache" "$python" -m pytest "$@" </dev/null 2>&1 |
    tee "$work/$name.log"
  [ "${PIPESTATUS[0]}" -eq 0 ] || bad=1
done 3<"$work/settings"

printf '\n== settings run\n'
while IFS=$'\t' read -r name rest; do
  [ -f "$work/$name.log" ] || continue
  printf '%-18s %s\n' "$name" "$(grep -E '[0-9]+ (passed|failed|error)' "$work/$name.log" | tail -n 1)"
done <"$work/settings"
exit $bad
