#include "../lens_format.hpp"

#include <algorithm>
#include <vector>

#include "../../files/file_suffix.hpp"
#include "../lens_readers.hpp"
#include "../lens_writers.hpp"

namespace realcam::io {
namespace {

template <Prescription (*reader)(std::string_view, const std::string&, LensGlasses&)>
Prescription read(std::string_view text, const std::string& file, LensGlasses& glasses, const LensReadOptions&) {
    return reader(text, file, glasses);
}

// The format has no glass names.
Prescription read_pbrt_lens(std::string_view text, const std::string& file, LensGlasses&,
                            const LensReadOptions& options) {
    return read_pbrt(text, file, options);
}

constexpr LensFormat kFormats[] = {
    {".zmx", read<read_zemax>, lens_as_zemax},
    {".seq", read<read_code_v>, lens_as_code_v},
    {".len", read<read_oslo>, nullptr},
    {".dat", read_pbrt_lens, nullptr},
    {".json", read<read_optiland>, lens_as_optiland},
    {".roa", read<read_ray_optics>, lens_as_ray_optics},
};

}  // namespace

const LensFormat* foreign_format_of(const std::string& path) {
    const std::string suffix = suffix_of(path);
    const auto found = std::find_if(std::begin(kFormats), std::end(kFormats),
                                    [&](const LensFormat& format) { return format.suffix == suffix; });
    return found == std::end(kFormats) ? nullptr : found;
}

std::string lens_suffixes(bool written) {
    std::vector<std::string_view> suffixes{".toml"};
    for (const LensFormat& format : kFormats)
        if (!written || format.write) suffixes.push_back(format.suffix);
    if (written) suffixes.push_back(".osl");  // written by the Python package
    std::string text(suffixes.front());
    for (std::size_t i = 1; i < suffixes.size(); ++i)
        text.append(i + 1 < suffixes.size() ? ", " : " or ").append(suffixes[i]);
    return text;
}

}  // namespace realcam::io
