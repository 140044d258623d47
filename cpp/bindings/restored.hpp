#pragma once
#include <algorithm>
#include <cstring>
#include <type_traits>

#include "../error.hpp"
#include "value_compare.hpp"

namespace realcam::bindings {

// What may be made of a pickle: it is input as any other, so everything that is read of one is held to what the
// constructors hold it to. Each type has to say what that is, or it does not compile.

/// `static void check(const T&)` throws a realcam::Error where a value, of which the members are good, is none.
/// Declared for every struct that is pickled.
template <class T>
struct RestoredCheck;

/// For structs whose members may be anything, or are checked by the struct that holds them.
struct AnyMembers {
    template <class T>
    static void check(const T&) {}
};

/// `value`: of an enumeration that begins at 0 and has no gaps, its last enumerator.
template <class E>
struct LastEnumerator;

template <auto last>
struct LastIs {
    static constexpr auto value = last;
};

/// Whether the names in it are those of files and their content, which need not be UTF-8.
template <class T>
inline constexpr bool has_names_of_files = false;

inline void require_restored(bool good) {
    if (!good) throw InputError("it is damaged");
}

template <class E, class Number>
constexpr bool is_enumerator(Number number) {
    using Plain = std::underlying_type_t<E>;
    return number >= 0 && number <= static_cast<Plain>(LastEnumerator<E>::value);
}

/// Checks an item that was copied as bytes. A truth value or an enumerator among them may not even be looked at before
/// its bytes are known to be those of one.
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

}  // namespace realcam::bindings
