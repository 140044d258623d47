#pragma once
#include <pybind11/numpy.h>

#include <array>
#include <cstddef>
#include <memory>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "../../math/color.hpp"
#include "../../math/vec3.hpp"

namespace realcam::bindings {

// Conversions between numpy arrays and tuples and the vectors and colours of the core.

/// Point or vector (x, y, z), and linear RGB colour, as passed from Python.
using Triple = std::array<double, 3>;
using Colour = std::array<float, 3>;

inline Vec3d vector_of(const Triple& v) {
    return {v[0], v[1], v[2]};
}

inline std::tuple<double, double, double> triple(Vec3d v) {
    return {v.x, v.y, v.z};
}

inline Color rgb(const Colour& c) {
    return {c[0], c[1], c[2]};
}

/// Input array in C order; converted (copied) if its dtype differs.
template <class T>
using InputArray = pybind11::array_t<T, pybind11::array::c_style | pybind11::array::forcecast>;

/// Returns an array that owns `values` (in C order) and uses their memory. `values` is a std::vector or similar, taken
/// by value: the caller chooses between move and copy.
template <class Numbers>
auto array_from(Numbers values, std::vector<pybind11::ssize_t> shape) {
    auto owned = std::make_unique<Numbers>(std::move(values));
    auto* const data = owned->data();
    const pybind11::capsule owner(owned.get(), [](void* numbers) { delete static_cast<Numbers*>(numbers); });
    owned.release();
    return pybind11::array_t<std::remove_pointer_t<decltype(data)>>(std::move(shape), data, owner);
}

/// Returns an array of shape (n,) with elements f(i).
template <class T = double, class F>
pybind11::array_t<T> array_of(std::size_t n, F&& f) {
    pybind11::array_t<T> array(static_cast<pybind11::ssize_t>(n));
    T* to = array.mutable_data();
    for (std::size_t i = 0; i < n; ++i) to[i] = f(i);
    return array;
}

/// Returns an array of shape (n, m) with elements f(i, k).
template <class F>
pybind11::array_t<double> table_of(std::size_t n, std::size_t m, F&& f) {
    pybind11::array_t<double> array({static_cast<pybind11::ssize_t>(n), static_cast<pybind11::ssize_t>(m)});
    double* to = array.mutable_data();
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < m; ++k) to[i * m + k] = f(i, k);
    return array;
}

}  // namespace realcam::bindings
