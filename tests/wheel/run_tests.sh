#!/usr/bin/env bash
# The tests of Python with the wheel in dist, and with the plug-in for GPUs where dist has it: in an environment that has
# them installed, and a copy of the repository without its packages and sources, so that nothing else can be imported.
#   tests/wheel/run_tests.sh PYTHON [PYTEST ARGUMENT...]
set -euo pipefail
cd "$(git -C "$(dirname "$(readlink -f "$0")")" rev-parse --show-toplevel)"
python=$1
shift
tag=$("$python" -c 'import sys; print("cp%d%d" % sys.version_info[:2])')
mapfile -t wheels < <(compgen -G "dist/realcam-*-$tag-$tag-*.whl")
if ((${#wheels[@]} != 1)); then
    echo "realcam: expected one wheel for $tag in dist, found ${#wheels[@]}; ./run wheel makes one" >&2
    exit 2
fi
mapfile -t -O 1 wheels < <(compgen -G "dist/realcam_cuda13-*.whl")
folder=$PWD/build/wheel-test
rm -rf "$folder/tree"
mkdir -p "$folder/tree"
git ls-files -co -z --exclude-standard -- . ':!python' ':!cpp' ':!cmake' ':!cuda13' ':!tests/cpp' \
    ':!tests/architecture' | xargs -0 cp --parents -t "$folder/tree"
[[ -x $folder/venv/bin/python ]] || "$python" -m venv "$folder/venv"
"$folder/venv/bin/python" -m pip install --quiet --disable-pip-version-check "${wheels[0]}[dev]"
# The same version, built anew, counts as installed.
"$folder/venv/bin/python" -m pip install --quiet --disable-pip-version-check --no-deps --force-reinstall "${wheels[@]}"
if ((${#wheels[@]} > 1)); then export REALCAM_CUDA_WHEEL=$PWD/${wheels[1]}; fi
cd "$folder/tree"
source "$folder/venv/bin/activate"
python -c 'import pathlib, realcam, sys; sys.exit(sys.prefix not in realcam.__file__)'
exec python -m pytest "$@" tests
