"""Runs camera shaders without a renderer: C++ has nearly OSL's grammar, and a header brings its types.

What Cycles gives a shader are arrays here: places on the picture, random numbers, the film, the focus.
"""

from __future__ import annotations

import ctypes
import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

COMPILER = shutil.which("c++")

HEADER = """\
#include <cmath>
#include <type_traits>
struct vec {
    float v[3];
    vec() : vec(0, 0, 0) {}
    template <class T> vec(T a) : v{float(a), float(a), float(a)} {}
    vec(float x, float y, float z) : v{x, y, z} {}
    float& operator[](int i) { return v[i]; }
    float operator[](int i) const { return v[i]; }
};
using point = vec; using vector = vec; using color = vec;
inline vec operator+(vec a, vec b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline vec operator-(vec a, vec b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline vec operator*(vec a, vec b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }
inline vec& operator+=(vec& a, vec b) { return a = a + b; }
inline vec& operator-=(vec& a, vec b) { return a = a - b; }
inline float dot(vec a, vec b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline vec normalize(vec a) { return a * vec(1 / std::sqrt(dot(a, a))); }
template <class A, class B> auto min(A a, B b) { std::common_type_t<A, B> x = a, y = b; return x < y ? x : y; }
template <class A, class B> auto max(A a, B b) { std::common_type_t<A, B> x = a, y = b; return x > y ? x : y; }
inline float clamp(float x, float low, float high) { return min(max(x, low), high); }
inline float mix(float a, float b, float t) { return a * (1 - t) + b * t; }
inline float mod(float a, float b) { return a - b * std::floor(a / b); }
inline float radians(float deg) { return deg * float(M_PI / 180); }
using std::abs; using std::acos; using std::asin; using std::atan2; using std::cos; using std::hypot; using std::pow;
using std::sin; using std::sqrt;
struct Input { float raster[2], chance[2], size[2], focal_distance, hash; };
static const Input* input;
inline void getattribute(const char*, vec& size) { size = vec(input->size[0], input->size[1], 0); }
inline void getattribute(const char*, float& distance) { distance = input->focal_distance; }
inline point camera_shader_raster_position() { return {input->raster[0], input->raster[1], 0}; }
inline vector camera_shader_random_sample() { return {input->chance[0], input->chance[1], 0}; }
inline float noise(const char*, float, float) { return input->hash; }
inline vec Dx(vec) { return {1e-3f, 0, 0}; }
inline vec Dy(vec) { return {0, 1e-3f, 0}; }
"""

MAIN = """
extern "C" void run(int count, const Input* inputs, const float* q, float* out) {{
    for (int i = 0; i < count; ++i) {{
        input = inputs + i;
        vec result[7];
        {name}({parameters}, result[0], result[1], result[2], result[3], result[4], result[5], result[6]);
        for (int k = 0; k < 9; ++k) out[9 * i + k] = result[k / 3][k % 3];
    }}
}}
"""


class Rays(NamedTuple):
    position: np.ndarray
    direction: np.ndarray
    throughput: np.ndarray


def program_of(text: str, folder: Path) -> Callable[..., Rays]:
    """A function of raster (N, 2), chance (N, 2), film_mm, and by name the shader's parameters, focal_distance and
    hash."""
    defaults = {name: float(value) for name, value in re.findall(r"(?:float|int) (\w+) = ([-+\d.e]+) \[\[", text)}
    code = re.sub(r" = [-+\d.e]+ \[\[.*?\]\]", "", text)
    code = re.sub(r"output (\w+) (\w+) = 0", r"\1& \2", code)
    code = re.sub(r"output (\w+) (\w+)", r"\1& \2", code)
    name = re.search(r"^shader (\w+)\(", code, re.M)[1]  # type: ignore[index]
    code = code.replace(f"shader {name}", f"void {name}")
    parameters = ", ".join(f"q[{i}]" for i in range(len(defaults)))
    source, library = folder / f"{name}.cpp", folder / f"{name}.so"
    source.write_text(HEADER + code + MAIN.format(name=name, parameters=parameters))
    assert COMPILER
    subprocess.run([COMPILER, "-O1", "-w", "-shared", "-fPIC", source, "-o", library], check=True)
    entry = ctypes.CDLL(str(library)).run

    def run(
        raster: np.ndarray,
        chance: np.ndarray,
        film_mm: tuple[float, float],
        *,
        focal_distance: float = 1e-5,
        hash: float | np.ndarray = 0.5,
        **given: float,
    ) -> Rays:
        assert given.keys() <= defaults.keys()
        inputs = np.zeros((len(raster), 8), np.float32)
        inputs[:, 0:2], inputs[:, 2:4], inputs[:, 4:6] = raster, chance, film_mm
        inputs[:, 6], inputs[:, 7] = focal_distance, hash
        values = np.array([given.get(key, value) for key, value in defaults.items()], np.float32)
        out = np.zeros((len(raster), 9), np.float32)
        address = [array.ctypes.data_as(ctypes.c_void_p) for array in (inputs, values, out)]
        entry(len(raster), *address)
        return Rays(out[:, :3], out[:, 3:6], out[:, 6:])

    return run
