#pragma once
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "../../camera/film/develop.hpp"
#include "../settings/setting_names.hpp"

namespace realcam {

/// Conversion of film exposure to 8-bit display values: a tone curve, or a view of an OpenColorIO configuration.
class View {
public:
    View() = default;
    View(const View&) = delete;
    View& operator=(const View&) = delete;
    virtual ~View() = default;

    /// Develops `count` pixels at an ISO number. `exposure_lux_s`: red, green and blue of each pixel in lux seconds,
    /// linear Rec. 709. `codes` receives as many display values. Throws Error.
    virtual void develop(const float* exposure_lux_s, std::size_t count, double iso, std::uint8_t* codes) const = 0;

    /// Metadata entries of files that hold the display values: names and values.
    virtual std::vector<std::pair<std::string, std::string>> entries() const = 0;

    /// True if the display values are encoded for sRGB (IEC 61966-2-1).
    virtual bool is_srgb() const = 0;
};

/// The view of a tone curve: each channel by itself, encoded for sRGB.
class ToneView final : public View {
public:
    explicit ToneView(ToneCurve curve) : curve_(curve) {}

    void develop(const float* exposure_lux_s, std::size_t count, double iso, std::uint8_t* codes) const override {
        for (std::size_t i = 0; i < 3 * count; ++i)
            codes[i] = srgb_code(apply_tone_curve(curve_, sensor_value(static_cast<double>(exposure_lux_s[i]), iso)));
    }
    std::vector<std::pair<std::string, std::string>> entries() const override {
        return {{"realcam:tone", name_of(curve_)}};
    }
    bool is_srgb() const override { return true; }

private:
    ToneCurve curve_;
};

}  // namespace realcam
