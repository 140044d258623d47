#include "shake_curve.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <string_view>

#include "../error.hpp"
#include "../io/files/readable_file.hpp"
#include "../io/text/help_page.hpp"
#include "../io/text/printable.hpp"
#include "../io/text/text_lines.hpp"

namespace realcam::shot {
namespace {

constexpr std::size_t kMaxRows = 1 << 20;

const std::vector<std::string> kColumns = {"time_s", "x_deg", "y_deg", "z_deg", "x_m", "y_m", "z_m"};

/// Splits a line at commas, and trims the cells.
std::vector<std::string_view> cells_of(std::string_view line) {
    std::vector<std::string_view> cells;
    for (std::size_t begin = 0; begin <= line.size();) {
        const std::size_t end = std::min(line.find(',', begin), line.size());
        cells.push_back(io::trimmed(line.substr(begin, end - begin)));
        begin = end + 1;
    }
    return cells;
}

/// Reads the lines of a shake curve. Empty lines and lines that begin with # are ignored.
class CurveReader {
public:
    explicit CurveReader(const std::string& path) : path_(path) {}

    std::vector<ShakeKey> read() {
        if (const std::string why = io::why_unreadable(path_); !why.empty()) throw InputError(path_ + ": " + why);
        std::ifstream stream(path_, std::ios::binary);
        std::vector<ShakeKey> curve;
        for (std::string line; std::getline(stream, line);) {
            ++line_;
            if (line.ends_with('\r')) line.pop_back();
            const std::string_view content = io::trimmed(line);
            if (content.empty() || content.front() == '#') continue;
            if (columns_.empty()) {
                read_columns(content);
                continue;
            }
            if (curve.size() == kMaxRows) fail("has more than " + std::to_string(kMaxRows) + " rows");
            curve.push_back(row_of(content));
            if (const std::string why =
                    key_time_error(curve.back().time_s, curve.size() > 1 ? &curve[curve.size() - 2].time_s : nullptr);
                !why.empty())
                fail(why);
            try {
                validate(Shake{.curve = {curve.back()}});
            } catch (const InputError&) {
                fail("angles must lie within 90 degrees, and positions within 1e6 m");
            }
        }
        if (curve.empty())
            throw InputError(path_ + ": has no curve; expected a line with names of columns, and rows of numbers");
        return curve;
    }

private:
    [[noreturn]] void fail(const std::string& why) const {
        throw InputError(path_ + ':' + std::to_string(line_) + ": " + why);
    }

    void read_columns(std::string_view line) {
        for (const std::string_view cell : cells_of(line)) {
            const auto found = std::find(kColumns.begin(), kColumns.end(), cell);
            if (found == kColumns.end())
                fail("unknown column " + io::in_quotes(cell) + io::did_you_mean(cell, kColumns) +
                     "; the first line names columns: time_s, x_deg, y_deg, z_deg, x_m, y_m or z_m");
            const auto column = static_cast<std::size_t>(found - kColumns.begin());
            if (std::find(columns_.begin(), columns_.end(), column) != columns_.end())
                fail("the column " + *found + " is named twice");
            columns_.push_back(column);
        }
        if (std::find(columns_.begin(), columns_.end(), 0u) == columns_.end()) fail("the column time_s is missing");
    }

    ShakeKey row_of(std::string_view line) const {
        const std::vector<std::string_view> cells = cells_of(line);
        if (cells.size() != columns_.size())
            fail("has " + std::to_string(cells.size()) + " numbers; the columns are " +
                 std::to_string(columns_.size()));
        std::array<double, 7> values{};
        for (std::size_t i = 0; i < cells.size(); ++i) {
            double& value = values[columns_[i]];
            const char* const end = cells[i].data() + cells[i].size();
            const auto [stop, error] = std::from_chars(cells[i].data(), end, value);
            if (error != std::errc() || stop != end || !std::isfinite(value))
                fail(io::in_quotes(cells[i]) + " is not a finite number");
        }
        return {values[0], {values[1], values[2], values[3]}, {values[4], values[5], values[6]}};
    }

    const std::string& path_;
    std::size_t line_ = 0;
    std::vector<std::size_t> columns_;  ///< indices into kColumns
};

}  // namespace

std::vector<ShakeKey> read_shake_curve(const std::string& path) {
    return CurveReader(path).read();
}

}  // namespace realcam::shot
