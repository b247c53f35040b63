#!/usr/bin/env bash
# Builds the wheel and the sdist, checks what an index would show of them, installs each into a
# clean environment outside the tree, with what it declares and nothing else, and runs four commands
# from there.
#
# PYTHON names the interpreter that builds and makes the environment (default: .venv/bin/python;
# it needs hatchling and twine). CLEAN names the environment's folder, which then stays.
set -euo pipefail

root=$(cd "$(dirname "$0")/.." && pwd)
python=${PYTHON:-$root/.venv/bin/python}
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
unset PYTHONPATH

cd "$root"
"$python" -m hatchling build -d "$work/dist" >"$work/build.log" 2>&1 || { cat "$work/build.log"; exit 1; }
ls "$work/dist"
"$python" -m twine check --strict "$work"/dist/*
cd "$work"
folder=${CLEAN:-$work/clean}
"$python" -m venv "$folder"
clean="$folder/bin"

try() {
  "$clean/python" - "$folder" <<'EOF'
import importlib, pkgutil, sys, kinlab
assert kinlab.__file__.startswith(sys.argv[1]), kinlab.__file__
names = [m.name for m in pkgutil.walk_packages(kinlab.__path__, "kinlab.") if "__main__" not in m.name]
for name in names:
    importlib.import_module(name)
print(f"{len(names)} modules imported from {kinlab.__version__}")
EOF
  "$clean/kinlab" check planar2r | tail -n 1
  "$clean/kinlab" list | grep -c puma560
  "$clean/kinlab" view puma560 --save page.html
  test -s page.html && rm page.html
  "$clean/kinlab" fivebar list | grep -c isotropic
}

for built in "$work"/dist/*.whl "$work"/dist/*.tar.gz; do
  printf -- '-- %s\n' "${built##*/}"
  # the second replaces the package only; what it needs is there from the first
  "$clean/pip" install -q --force-reinstall $([ -x "$clean/kinlab" ] && echo --no-deps) "$built"
  "$clean/pip" check
  try
done
