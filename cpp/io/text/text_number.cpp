#include "text_number.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>

namespace realcam::io {

std::optional<double> number_in(const std::string& text) {
    char* end = nullptr;
    const double value = std::strtod(text.c_str(), &end);
    const bool is_whole = !text.empty() && end == text.c_str() + text.size();
    if (!is_whole || std::isspace(static_cast<unsigned char>(text[0])) || std::isnan(value)) return std::nullopt;
    return value;
}

std::optional<std::vector<double>> numbers_in(const std::string& text, char separator, std::size_t count) {
    std::vector<double> values;
    for (std::size_t start = 0; start <= text.size();) {
        const std::size_t end = std::min(text.find(separator, start), text.size());
        const std::optional<double> value = number_in(text.substr(start, end - start));
        if (!value || std::isinf(*value)) return std::nullopt;
        values.push_back(*value);
        start = end + 1;
    }
    if (values.size() != count) return std::nullopt;
    return values;
}

}  // namespace realcam::io
