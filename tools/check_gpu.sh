#!/usr/bin/env bash
# Builds realcam on a machine with an NVIDIA GPU, runs all tests on both backends, looks for memory errors and races,
# and benchmarks. Needs no network: what is missing is to be there already (CONTRIBUTING.md, "On a GPU machine").
#   tools/check_gpu.sh FOLDER [build|test|sanitize|bench|mitsuba]...
# Writes FOLDER/gpu.json, FOLDER/gpu.md and a log of each step.
set -uo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
out=${1:?usage: tools/check_gpu.sh FOLDER [STEP]...}
shift
steps=("${@:-build test sanitize bench}")
read -ra steps <<<"${steps[*]}"
python=$(command -v "${PYTHON:-python3}")
mkdir -p "$out"
export PYTHONPATH=$PWD/python${PYTHONPATH:+:$PYTHONPATH}
failed=()

step() {  # step NAME COMMAND...: its output goes to a log, of which the end is shown where it fails
    local name=$1 start=$SECONDS
    shift
    if "$@" >"$out/$name.log" 2>&1; then
        echo "$name: ok, $((SECONDS - start)) s"
        grep -E '^[0-9]+% tests passed|[0-9]+ passed|ERROR SUMMARY' "$out/$name.log"
    else
        echo "$name: FAILED, $((SECONDS - start)) s"
        tail -n 25 "$out/$name.log"
        failed+=("$name")
    fi
}

configure() {
    local settings=(-DREALCAM_PYTHON=ON "-DPython_EXECUTABLE=$python" -DREALCAM_WERROR=OFF)
    cmake --preset cuda "${settings[@]}"
}

bench() {
    "$python" -c 'from realcam.cli import main; main()' bench --json \
        gpu-lens-rays gpu-hits gpu-paths gpu-frames >"$out/gpu.json"
}

# The suite that exercises every kernel, small enough for tools that slow a GPU down a hundred times.
sanitized=(tests/python/test_live_view.py tests/python/test_device_arrays.py tests/parity/test_parity_rays.py
           tests/parity/test_parity_pictures.py::test_any_number_of_pixels_and_samples
           tests/parity/test_parity_pictures.py::test_the_same_picture_twice)

for wanted in "${steps[@]}"; do
    case $wanted in
        build)
            step configure configure
            step build cmake --build build/cuda
            ;;
        test)
            step ctest ctest --preset cuda --parallel "$(nproc)"
            step pytest "$python" -m pytest -q -x --maxfail=20 tests/python tests/parity tests/truth
            ;;
        sanitize)
            for tool in memcheck racecheck initcheck; do
                # A test asks for more memory than there is: the failed call is no finding.
                options=(--tool "$tool" --target-processes all --error-exitcode 9)
                [[ $tool == memcheck ]] && options+=(--report-api-errors no)
                step "$tool" compute-sanitizer "${options[@]}" "$python" -m pytest -q -p no:faulthandler \
                    "${sanitized[@]}"
            done
            ;;
        bench)
            step bench bench
            step table "$python" tools/gpu_table.py "$out"
            ;;
        mitsuba) step mitsuba "$python" benchmarks/against_mitsuba.py "$out/mitsuba.json" ;;
        *)
            echo "unknown step: $wanted" >&2
            exit 2
            ;;
    esac
done
[[ ${#failed[@]} == 0 ]] || { echo "failed: ${failed[*]}"; exit 1; }
