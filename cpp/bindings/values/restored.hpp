#pragma once
#include <pybind11/numpy.h>

#include <algorithm>
#include <concepts>
#include <cstring>
#include <type_traits>
#include <vector>

#include "../../cuda/device/shared_device_array.hpp"
#include "../../error.hpp"
#include "value_compare.hpp"

namespace realcam::bindings {

// Validation of unpickled values: a pickle is untrusted input, so its values must satisfy the checks of the
// constructors. Every pickled type must declare its check, or the code does not compile.

/// `static void check(const T&)` throws a realcam::Error if a value is invalid although each of its members is valid.
/// Declared for every struct that is pickled.
template <class T>
struct RestoredCheck;

/// For structs whose members have no joint constraint, or are checked by the enclosing struct.
struct AnyMembers {
    template <class T>
    static void check(const T&) {}
};

template <class T, class... Types>
concept OneOf = (std::same_as<T, Types> || ...);

/// `value`: the last enumerator of an enumeration that starts at 0 and has no gaps.
template <class E>
struct LastEnumerator;

template <auto last>
struct LastIs {
    static constexpr auto value = last;
};

/// True if a type's strings are names or contents of files, which need not be UTF-8.
template <class T>
inline constexpr bool has_names_of_files = false;

/// Throws InputError if a condition on unpickled data does not hold.
inline void require_restored(bool condition) {
    if (!condition) throw InputError("it is damaged");
}

template <class E, class Number>
constexpr bool is_enumerator(Number number) {
    using Plain = std::underlying_type_t<E>;
    return number >= 0 && number <= static_cast<Plain>(LastEnumerator<E>::value);
}

/// Checks a value whose bytes were copied from a pickle. The bytes of a bool or enumerator must be checked before the
/// value is read: any other bit pattern would be undefined behaviour.
template <class T>
void check_copied(const T& value) {
    using namespace value_compare_detail;
    if constexpr (std::same_as<T, bool>) {
        unsigned char byte;
        std::memcpy(&byte, &value, 1);
        require_restored(byte <= 1);
    } else if constexpr (std::is_enum_v<T>) {
        std::underlying_type_t<T> number;
        std::memcpy(&number, &value, sizeof number);
        require_restored(is_enumerator<T>(number));
    } else if constexpr (std::is_arithmetic_v<T>) {
    } else if constexpr (is_range<T>) {
        for (const auto& item : value) check_copied(item);
    } else {
        std::apply([](const auto&... member) { (check_copied(member), ...); }, members(value));
        RestoredCheck<T>::check(value);
    }
}

/// Required type and shape of an array in a pickled result.
struct ExpectedArray {
    char kind;  ///< numpy's kind character: f floats, c complex numbers, i integers
    std::vector<pybind11::ssize_t> shape;
};

/// Throws InputError if the object is not a numpy array or DeviceArray of that kind and shape.
inline void check_restored_array(const pybind11::object& array, const ExpectedArray& expected) {
    namespace py = pybind11;
    require_restored(py::isinstance<py::array>(array) || py::isinstance<SharedDeviceArray>(array));
    const py::object type = array.attr("dtype");
    require_restored(py::dtype::from_args(type).kind() == expected.kind && type.attr("isnative").cast<bool>());
    const py::tuple shape = array.attr("shape");
    require_restored(shape.size() == expected.shape.size());
    for (std::size_t i = 0; i < shape.size(); ++i) require_restored(shape[i].cast<py::ssize_t>() == expected.shape[i]);
}

/// Returns the length of the first dimension. Throws InputError if the object is not an array or has no dimension.
inline pybind11::ssize_t restored_length(const pybind11::object& array) {
    namespace py = pybind11;
    require_restored(py::isinstance<py::array>(array) || py::isinstance<SharedDeviceArray>(array));
    const py::tuple shape = array.attr("shape");
    require_restored(!shape.empty());
    return shape[0].cast<py::ssize_t>();
}

}  // namespace realcam::bindings
