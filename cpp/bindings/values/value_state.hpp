#pragma once
#include <pybind11/numpy.h>

#include <map>
#include <typeindex>

#include "../../io/text/printable.hpp"
#include "arrays.hpp"
#include "restored.hpp"

namespace realcam::bindings {

// Pickle state of a value: its members, from which its constructor makes it, as numbers, bytes, tuples, and numpy
// arrays for large members, which pickle protocol 5 can transfer without a copy.

/// Must be incremented whenever a value written by an older version would be misread.
inline constexpr int kStateFormat = 1;

/// True for types that are pickled as the bytes of an array; they must not contain pointers.
template <class T>
inline constexpr bool is_flat = std::is_trivially_copyable_v<T> && !std::is_pointer_v<T>;

/// Converts one value to its pickle state. An object that several members share is written once.
class StateWriter {
public:
    /// `owner` keeps the value alive, so that large lists need not be copied; with a null object they are copied.
    explicit StateWriter(pybind11::object owner) : owner_(std::move(owner)) {}

    /// Returns the state of a value.
    template <class T>
    pybind11::object write(const T& value) {
        using namespace value_compare_detail;
        if constexpr (std::is_arithmetic_v<T>)
            return pybind11::cast(value);
        else if constexpr (std::is_enum_v<T>)
            return pybind11::cast(static_cast<std::int64_t>(value));
        else if constexpr (std::same_as<T, std::string>)
            return pybind11::bytes(value);  // file names need not be UTF-8
        else if constexpr (std::derived_from<T, pybind11::object>)
            return value;
        else if constexpr (std::same_as<T, Glass>)
            return StateWriter(pybind11::object()).write(value.parts());  // a temporary, so its lists are copied
        else if constexpr (is_shared<T>)
            return write_shared(value);
        else if constexpr (is_optional<T>)
            return value ? write(*value) : pybind11::none();
        else if constexpr (is_range<T>)
            return write_range(value);
        else
            return write_members(members(value));
    }

private:
    /// Writes members in order, so that the reader sees shared objects in the same order.
    template <class... T>
    pybind11::object write_members(const std::tuple<T...>& all) {
        pybind11::tuple items(sizeof...(T));
        std::size_t i = 0;
        std::apply([&](const auto&... member) { ((items[i++] = write(member)), ...); }, all);
        return items;
    }

    template <class T>
    pybind11::object write_range(const T& values) {
        using Item = typename T::value_type;
        if constexpr (is_flat<Item>) {
            const auto* bytes = reinterpret_cast<const std::uint8_t*>(values.data());
            pybind11::array_t<std::uint8_t> array({values.size(), sizeof(Item)}, bytes, owner_);
            array.attr("flags").attr("writeable") = false;
            return array;
        } else {
            pybind11::tuple items(values.size());
            for (std::size_t i = 0; i < values.size(); ++i) items[i] = write(values[i]);
            return items;
        }
    }

    /// Returns None, the state of the value, or the index of a shared value written before.
    template <class T>
    pybind11::object write_shared(const std::shared_ptr<T>& pointer) {
        if (!pointer) return pybind11::none();
        const auto [entry, is_new] = written_.try_emplace(pointer.get(), written_.size());
        if (!is_new) return pybind11::cast(entry->second);
        return write(*pointer);
    }

    pybind11::object owner_;
    std::map<const void*, std::size_t> written_;  ///< index of each shared object, in the order of writing
};

/// Reads the state written by StateWriter. Throws a realcam::Error for any other state, and pybind11's errors if a
/// Python object has another type. The values satisfy the checks of their constructors (restored.hpp).
class StateReader {
public:
    /// Reads a state into `value`.
    template <class T>
    void read(T& value, const pybind11::handle& state) {
        using namespace value_compare_detail;
        if constexpr (std::is_arithmetic_v<T>)
            value = state.cast<T>();
        else if constexpr (std::is_enum_v<T>)
            read_enumerator(value, state);
        else if constexpr (std::same_as<T, std::string>)
            read_text(value, state);
        else if constexpr (std::derived_from<T, pybind11::object>)
            read_object(value, state);
        else if constexpr (std::same_as<T, Glass>)
            value = read_value<Glass>(state);
        else if constexpr (is_shared<T>)
            read_shared(value, state);
        else if constexpr (is_optional<T>)
            state.is_none() ? value.reset() : read(value.emplace(), state);
        else if constexpr (is_range<T>)
            read_range(value, state);
        else
            read_members(value, state, std::make_index_sequence<std::tuple_size_v<decltype(members(value))>>());
    }

    /// Returns the value of a state.
    template <class T>
    T read_value(const pybind11::handle& state) {
        if constexpr (std::same_as<T, Glass>) {
            return glass_from_parts(read_value<Glass::Parts>(state));
        } else {
            T value{};
            read(value, state);
            return value;
        }
    }

private:
    template <class T>
    void read_enumerator(T& value, const pybind11::handle& state) {
        const auto number = state.cast<std::int64_t>();
        require_restored(is_enumerator<T>(number));
        value = static_cast<T>(number);
    }

    /// Arrays must have the exact type; no conversion takes place.
    template <class T>
    void read_object(T& value, const pybind11::handle& state) {
        require_restored(pybind11::isinstance<T>(state));
        value = pybind11::reinterpret_borrow<T>(state);
    }

    void read_text(std::string& value, const pybind11::handle& state) {
        value = state.cast<pybind11::bytes>();
        require_restored(any_bytes_ || io::is_utf8(value));
    }

    template <class T, std::size_t... i>
    void read_members(T& value, const pybind11::handle& state, std::index_sequence<i...>) {
        const auto items = state.cast<pybind11::tuple>();
        require_restored(items.size() == sizeof...(i));
        const auto targets = members(value);
        const bool outer_any_bytes = std::exchange(any_bytes_, any_bytes_ || has_names_of_files<T>);
        (read(std::get<i>(targets), items[i]), ...);
        any_bytes_ = outer_any_bytes;
        check_made(value);
    }

    template <class T>
    void read_range(T& values, const pybind11::handle& state) {
        using Item = typename T::value_type;
        const auto resize = [&](std::size_t size) {
            if constexpr (requires { values.resize(size); })
                values.resize(size);
            else
                require_restored(values.size() == size);
        };
        if constexpr (is_flat<Item>) {
            require_restored(pybind11::isinstance<pybind11::array_t<std::uint8_t>>(state));
            const auto bytes = state.cast<InputArray<std::uint8_t>>();
            require_restored(bytes.ndim() == 2 && bytes.shape(1) == static_cast<pybind11::ssize_t>(sizeof(Item)));
            resize(static_cast<std::size_t>(bytes.shape(0)));
            if (bytes.size() > 0) std::memcpy(values.data(), bytes.data(), static_cast<std::size_t>(bytes.size()));
            for (const Item& item : values) check_copied(item);
        } else {
            const auto items = state.cast<pybind11::tuple>();
            resize(items.size());
            for (std::size_t i = 0; i < items.size(); ++i) read(values[i], items[i]);
        }
    }

    template <class T>
    void read_shared(std::shared_ptr<T>& pointer, const pybind11::handle& state) {
        if (state.is_none()) return pointer.reset();
        if (pybind11::isinstance<pybind11::int_>(state)) {
            const auto index = state.cast<std::size_t>();
            // Rejects references to values of another type and to values that contain this one, which StateWriter never
            // writes.
            require_restored(index < read_.size() && read_[index].value && read_[index].type == typeid(T));
            pointer = std::static_pointer_cast<T>(read_[index].value);
            return;
        }
        const std::size_t index = read_.size();
        read_.push_back({nullptr, typeid(T)});
        auto value = std::make_shared<std::remove_const_t<T>>();
        read(*value, state);
        read_[index].value = value;
        pointer = std::move(value);
    }

    struct Shared {
        std::shared_ptr<const void> value;  ///< null while it is being read
        std::type_index type;
    };
    std::vector<Shared> read_;  ///< shared values, in the order of writing
    bool any_bytes_ = false;  ///< true if strings need not be UTF-8
};

}  // namespace realcam::bindings
