#include "key_words.hpp"

#include <charconv>
#include <cmath>
#include <sstream>

#include "../io/text/number_words.hpp"
#include "../io/text/printable.hpp"
#include "shot_keys.hpp"

namespace realcam::shot {
namespace {

toml::array array_of(const std::vector<double>& values) {
    toml::array array;
    for (const double value : values) array.push_back(value);
    return array;
}

/// Passes the value of a word to `take`, unless the word is itself the value. Returns false if the word is invalid.
template <class Take>
bool take_word(Syntax syntax, const std::string& word, const Take& take) {
    const auto take_numbers = [&](char separator, std::size_t count) {
        const auto values = io::numbers_in(word, separator, count);
        if (values) take(array_of(*values));
        return values.has_value();
    };
    const auto take_number = [&](bool may_be_infinite) {
        const auto value = io::number_in(word);
        const auto fraction = value ? std::nullopt : io::numbers_in(word, '/', 2);
        if (fraction && (*fraction)[1] != 0) return take((*fraction)[0] / (*fraction)[1]), true;
        if (!value || (std::isinf(*value) && !may_be_infinite)) return false;
        return take(*value), true;
    };
    const auto take_whole = [&] {
        std::int64_t value = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
        if (error != std::errc() || end != word.data() + word.size()) return false;
        return take(value), true;
    };
    switch (syntax) {
        case Syntax::text: return true;
        case Syntax::number: return take_number(false);
        case Syntax::number_or_auto: return word == "auto" || take_number(false);
        case Syntax::distance_or_auto: return word == "auto" || take_number(true);
        case Syntax::whole: return take_whole();
        case Syntax::whole_or_auto: return word == "auto" || take_whole();
        case Syntax::number_or_file: return take_number(true) || true;
        case Syntax::three_numbers: return take_numbers(',', 3);
        case Syntax::two_numbers: return take_numbers(',', 2);
        case Syntax::size: return take_numbers('x', 2);
        case Syntax::names: {
            toml::array names;
            std::istringstream list(word);
            for (std::string name; std::getline(list >> std::ws, name, ',');) names.push_back(name);
            take(names);
            return true;
        }
    }
    return false;
}

}  // namespace

void read_words(toml::table& table, const ShotTable& shot) {
    for (const ShotKey& key : shot_keys()) {
        const toml::node* const node = table.get(key.name);
        if (!node || !node->is_string()) continue;
        const std::string word = *node->value<std::string>();
        const auto take = [&](const auto& value) { table.insert_or_assign(key.name, value); };
        if (!take_word(key.syntax, word, take))
            shot.fail(shot.shown(key.name) + " must be " + key.wanted + "; it is " + io::in_quotes(word), node);
    }
}

}  // namespace realcam::shot
