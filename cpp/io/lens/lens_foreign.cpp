#include "lens_foreign.hpp"

#include <algorithm>

namespace realcam::io {

void refuse_foreign(const std::vector<ForeignFeature>& features, const std::string& file,
                    const LensReadOptions& options) {
    if (features.empty()) return;
    const auto place = [](const ForeignFeature& f) {
        return std::string(f.surface > 0 ? "surface " + std::to_string(f.surface) : "") +
               (f.line > 0 ? (f.surface > 0 ? " (line " : "(line ") + std::to_string(f.line) + ")" : "");
    };
    constexpr std::size_t kMostNamed = 8;
    if (options.force) {
        if (!options.warn) return;
        for (const ForeignFeature& f : features)
            options.warn(file + ": " + (place(f).empty() ? "" : place(f) + ": ") + "left out: " + f.what);
        return;
    }
    std::string also;
    for (std::size_t i = 1; i < std::min(features.size(), kMostNamed); ++i)
        also += (i == 1 ? "; also " : ", ") + features[i].what +
                (place(features[i]).empty() ? "" : " at " + place(features[i]));
    if (features.size() > kMostNamed) also += ", and " + std::to_string(features.size() - kMostNamed) + " more";
    const ForeignFeature& first = features.front();
    LensReadError error("has " + first.what + also + ", of which realcam has no model", file, first.line,
                        first.surface);
    error.can_be_forced = true;
    throw error;
}

}  // namespace realcam::io
