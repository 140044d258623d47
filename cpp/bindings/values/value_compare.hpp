#pragma once
#include <pybind11/pybind11.h>

#include <array>
#include <bit>
#include <concepts>
#include <cstring>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "members.hpp"

namespace realcam::bindings {

// Python's == and hash() for C++ values. NaNs compare equal, so that a result with rays that did not pass equals its
// copy.

template <class T>
bool equal(const T& a, const T& b);

namespace value_compare_detail {

template <class T>
bool equal_ranges(const T& a, const T& b) {
    if (a.size() != b.size()) return false;
    using Item = typename T::value_type;
    if constexpr (std::has_unique_object_representations_v<Item>)
        return a.size() == 0 || std::memcmp(a.data(), b.data(), a.size() * sizeof(Item)) == 0;
    else
        for (std::size_t i = 0; i < a.size(); ++i)
            if (!equal(a[i], b[i])) return false;
    return true;
}

template <class T>
inline constexpr bool is_range = false;
template <class T>
inline constexpr bool is_range<std::vector<T>> = true;
template <class T, std::size_t n>
inline constexpr bool is_range<std::array<T, n>> = true;

template <class T>
inline constexpr bool is_optional = false;
template <class T>
inline constexpr bool is_optional<std::optional<T>> = true;

template <class T>
inline constexpr bool is_shared = false;
template <class T>
inline constexpr bool is_shared<std::shared_ptr<T>> = true;

inline bool equal_objects(const pybind11::object& a, const pybind11::object& b) {
    if (a.is(b)) return true;
    // For arrays == is elementwise; same_arrays compares shape and values.
    return pybind11::module_::import("realcam.pickling").attr("same_arrays")(a, b).cast<bool>();
}

}  // namespace value_compare_detail

template <class T>
bool equal(const T& a, const T& b) {
    using namespace value_compare_detail;
    if constexpr (std::floating_point<T>)
        return a == b || (a != a && b != b);
    else if constexpr (std::integral<T> || std::is_enum_v<T> || std::same_as<T, std::string>)
        return a == b;
    else if constexpr (std::derived_from<T, pybind11::object>)
        return equal_objects(a, b);
    else if constexpr (std::same_as<T, Glass>)
        return equal(a.parts(), b.parts());
    else if constexpr (is_range<T>)
        return equal_ranges(a, b);
    else if constexpr (is_optional<T>)
        return a.has_value() == b.has_value() && (!a || equal(*a, *b));
    else if constexpr (is_shared<T>)
        return a == b || (a && b && equal(*a, *b));
    else
        return [&]<std::size_t... i>(std::index_sequence<i...>) {
            const auto x = members(a), y = members(b);
            return (equal(std::get<i>(x), std::get<i>(y)) && ...);
        }(std::make_index_sequence<std::tuple_size_v<decltype(members(a))>>());
}

/// Returns a hash that is equal for equal values.
template <class T>
std::size_t hash_of(const T& value) {
    using namespace value_compare_detail;
    const auto mixed = [](std::size_t seed, std::size_t next) {
        return (std::rotl(seed, 5) ^ next) * std::size_t{0x9e3779b97f4a7c15};
    };
    std::size_t hash = 1;
    if constexpr (std::floating_point<T>)
        hash = value != value ? 0 : std::hash<T>()(value);
    else if constexpr (std::integral<T> || std::is_enum_v<T> || std::same_as<T, std::string>)
        hash = std::hash<T>()(value);
    else if constexpr (std::same_as<T, Glass>)
        hash = hash_of(value.parts());
    else if constexpr (is_range<T>)
        for (const auto& item : value) hash = mixed(hash, hash_of(item));
    else if constexpr (is_shared<T> || is_optional<T>)
        hash = value ? hash_of(*value) : 0;
    else
        std::apply([&](const auto&... member) { ((hash = mixed(hash, hash_of(member))), ...); }, members(value));
    return hash;
}

}  // namespace realcam::bindings
