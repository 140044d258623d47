#pragma once
#include <cmath>
#include <filesystem>
#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "../error.hpp"
#include "../io/text/toml_table.hpp"
#include "../math/vec3.hpp"

namespace realcam::shot {

/// Values that replace those of a shot file (ShotChanges), by their keys.
struct Changes {
    toml::table values;
    std::function<std::string(std::string_view)> name;  ///< returns a key's name for messages; empty: the key in quotes
};

/// A table of a shot file. Errors are InputErrors that name file and line; paths are relative to the file's folder. For
/// changed keys, errors name the key alone, and paths are relative to the current folder.
class ShotTable : public io::TomlTable {
public:
    /// `changes`: for the keys of this table, or null. `table` and `changes` must outlive this object.
    ShotTable(const toml::table& table, const std::string& path, const Changes* changes = nullptr)
        : TomlTable(table, path, 0, fail_at), folder_(std::filesystem::path(path).parent_path()), changes_(changes) {
        if (changes && changes->name)
            name_ = [changes](std::string_view key) {
                return changes->values.contains(key) ? changes->name(key) : '"' + std::string(key) + '"';
            };
    }

    /// Throws InputError. A node without a line (0) belongs to a change, and then the file is not named.
    [[noreturn]] static void fail_at(const std::string& message, const std::string& file, int line, int) {
        throw InputError((line > 0 ? file + ':' + std::to_string(line) + ": " : "") + message);
    }

    /// True if the key's value is from the changes, not from the file.
    bool is_changed(std::string_view key) const { return changes_ && changes_->values.contains(key); }

    /// Position of the table, or of a key of it: "shot.toml:12".
    std::string location(const char* key = nullptr) const {
        const toml::node* node = key ? find(key) : nullptr;
        return file() + ":" +
               std::to_string((node ? *node : static_cast<const toml::node&>(raw())).source().begin.line);
    }

    /// The tables [[key]], in their order; empty if the key is absent.
    std::vector<ShotTable> tables(const char* key) const {
        std::vector<ShotTable> all;
        const toml::node* node = find(key);
        if (!node) return all;
        if (!node->is_array_of_tables()) fail("expected tables [[" + std::string(key) + "]]", node);
        for (const toml::node& item : *node->as_array()) all.push_back(ShotTable(*item.as_table(), file()));
        return all;
    }

    /// The tables [key.NAME] with their names.
    std::vector<std::pair<std::string, ShotTable>> named_tables(const char* key) const {
        std::vector<std::pair<std::string, ShotTable>> all;
        const toml::node* node = find(key);
        if (!node) return all;
        if (!node->is_table()) fail("expected tables [" + std::string(key) + ".NAME]", node);
        for (const auto& [name, item] : *node->as_table()) {
            if (!item.is_table()) fail("expected tables [" + std::string(key) + ".NAME]", &item);
            all.emplace_back(std::string(name.str()), ShotTable(*item.as_table(), file()));
        }
        return all;
    }

    /// Three numbers; std::nullopt if the key is absent.
    std::optional<Vec3d> point(const char* key) const {
        const auto v = numbers(key, 3);
        if (v.empty()) return std::nullopt;
        return Vec3d{v[0], v[1], v[2]};
    }
    /// Three numbers; an error if the key is absent.
    Vec3d required_point(const char* key) const {
        const std::optional<Vec3d> v = point(key);
        if (!v) fail(shown(key) + " is missing: three numbers");
        return *v;
    }

    /// A number; an error if the key is absent.
    double required_number(const char* key) const {
        const std::optional<double> v = number(key);
        if (!v) fail(shown(key) + " is missing: a number");
        return *v;
    }

    /// One number for all three components, or three numbers; std::nullopt if the key is absent.
    std::optional<Vec3d> number_or_three(const char* key) const {
        const toml::node* node = find(key);
        if (!node) return std::nullopt;
        if (node->is_array()) return point(key);
        const double v = *number(key);
        return Vec3d{v, v, v};
    }

    /// A number, which may be infinite; std::nullopt for the text "auto" or if the key is absent. `wanted`: noun phrase
    /// for the expected values.
    std::optional<double> number_or_auto(const char* key, const std::string& wanted) const {
        const toml::node* node = find(key);
        if (!node || node->value<std::string>() == "auto") return std::nullopt;
        const double number = node->is_number() ? node->value_or(0.0) : std::nan("");
        if (std::isnan(number)) fail(shown(key) + " must be " + wanted, node);
        return number;
    }

    /// Converts the number of a key to an integer type; an error if it is negative, not whole, or too large.
    template <class Value = int>
    Value whole(const char* key, double number) const {
        constexpr Value kMax = std::numeric_limits<Value>::max();
        // The largest std::int64_t is no double: the conversion rounds it up, and the sum remains the same number.
        if (number != std::floor(number) || !(number >= 0) || !(number < static_cast<double>(kMax) + 1))
            fail(shown(key) + " must be a whole number from 0 to " + std::to_string(kMax), find(key));
        return static_cast<Value>(number);
    }

    /// Path relative to the folder of the shot file; empty if the key is absent.
    std::string path(const char* key) const {
        std::string text = name(key);
        if (text.empty()) {
            if (find(key)) fail(shown(key) + " is empty", find(key));
            return text;
        }
        return is_changed(key) ? text : (folder_ / text).string();
    }

    /// A text without null characters, at which the system would truncate a file name; empty if the key is absent.
    std::string name(const char* key) const {
        const std::string value = text(key);
        if (value.find('\0') != std::string::npos) fail(shown(key) + " holds a null character", find(key));
        return value;
    }

    /// Value of the name under a key, from `find_name`; std::nullopt if the key is absent. An unknown name is an error,
    /// for which `wanted` lists the known names.
    template <class Named>
    auto named(const char* key, Named&& find_name, const std::string& wanted) const -> decltype(find_name("")) {
        const std::string value = text(key);
        if (!find(key)) return std::nullopt;
        const auto found = find_name(value);
        if (!found) fail(shown(key) + " must be " + wanted + "; it is " + io::in_quotes(value), find(key));
        return found;
    }

    /// Runs `check`; its InputErrors are thrown again with the line of the key or, if `key` is null, of the table.
    template <class Check>
    void checked(const char* key, Check&& check) const {
        try {
            check();
        } catch (const InputError& error) {
            fail(error.what(), key ? find(key) : nullptr);
        }
    }

private:
    std::filesystem::path folder_;  ///< folder of the shot file
    const Changes* changes_;
};

}  // namespace realcam::shot
