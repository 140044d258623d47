#!/usr/bin/env bash
# Builds realcam on a machine with an NVIDIA GPU, runs all tests on both backends, looks for memory errors and races,
# and benchmarks. Needs no network: what is missing is to be there already (docs/testing.md, "On a GPU machine").
#   tools/check_gpu.sh FOLDER [build|test|sanitize|foreign|bench|mitsuba]...
# Writes FOLDER/gpu.json, FOLDER/gpu.md and a log of each step.
set -uo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."
out=${1:?usage: tools/check_gpu.sh FOLDER [STEP]...}
shift
steps=("${@:-build test sanitize bench}")
read -ra steps <<<"${steps[*]}"
python=$(command -v "${PYTHON:-python3}")
mkdir -p "$out"
export PYTHONPATH=$PWD/python:$PWD/benchmarks${PYTHONPATH:+:$PYTHONPATH}
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

settings=(-DREALCAM_PYTHON=ON "-DPython_EXECUTABLE=$python" -DREALCAM_WERROR=OFF)
[[ -e /usr/include/OpenImageIO/imageio.h ]] || settings+=(-DREALCAM_OPENIMAGEIO=OFF)
[[ -e /usr/include/png.h && -d /usr/include/CLI ]] || settings+=(-DREALCAM_PICTURES=OFF)

bench() {
    "$python" -m realcam bench --json \
        gpu-lens-rays gpu-hits gpu-paths gpu-frames gpu-objects >"$out/gpu.json"
}

# A build for other chips only: `auto` takes the CPU, and who asks for the GPU is told why there is none.
foreign() {
    local chip=120-real
    [[ $(nvidia-smi --query-gpu=compute_cap --format=csv,noheader | head -n 1) == 12* ]] && chip=75-real
    cmake --preset cuda -B build/foreign "${settings[@]}" -DCMAKE_CUDA_ARCHITECTURES="$chip" -DREALCAM_TESTS=OFF &&
        cmake --build build/foreign --target _core || return
    rm -rf build/foreign/package && mkdir build/foreign/package || return
    cp -r python/realcam build/foreign/package/ && cp --remove-destination build/foreign/python/_core*.so build/foreign/package/realcam/ || return
    PYTHONPATH=build/foreign/package:$PYTHONPATH "$python" - <<'TEXT'
import realcam as rc
from frame_scene import frame_scene

assert "foreign" in rc.__file__
print(*rc.devices(), sep="\n")
camera = rc.Camera(rc.Lens.load("tessar-50mm").focused(4.0), position=(0, 1, 3), look_at=(0, 0.6, -2))
scene = frame_scene(spheres=3, boxes=3)
assert rc.render(scene, camera, spp=1, device="auto").stats.device.startswith("CPU")
for take in (lambda: rc.render(scene, camera, device="cuda"), lambda: rc.LiveView(scene)):
    try:
        take()
    except rc.DeviceError as error:
        assert "no code for the GPU's architecture" in str(error), error
        print(error)
    else:
        raise SystemExit("it ran on a chip that it has no code for")
TEXT
}

# The suite that exercises every kernel, small enough for tools that slow a GPU down a hundred times.
sanitized=(tests/python/render/test_live_view.py tests/python/render/test_session.py tests/python/scene/test_instances.py tests/python/render/test_device_arrays.py
           tests/parity/test_parity_rays.py
           tests/parity/test_parity_pictures.py::test_any_number_of_pixels_and_samples
           tests/parity/test_parity_pictures.py::test_the_same_picture_twice)

for wanted in "${steps[@]}"; do
    case $wanted in
        build)
            step configure cmake --preset cuda "${settings[@]}"
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
                selected=("${sanitized[@]}")
                # These run kernels one after the other, so that a stop cannot overtake the frame of minutes it is for.
                [[ $tool == memcheck ]] || selected+=(-k "not test_cancel")
                step "$tool" compute-sanitizer "${options[@]}" "$python" -m pytest -q -p no:faulthandler -m "not slow" \
                    "${selected[@]}"
            done
            ;;
        foreign) step foreign foreign ;;
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
