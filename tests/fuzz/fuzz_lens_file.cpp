// Fuzz target: a lens file, mutated from one that can be read, becomes a lens that validate() accepts or a
// LensFileError whose message is one line; nothing else.

#include <cstring>
#include <string>
#include <vector>

#include "../../cpp/io/bundled_lenses.hpp"
#include "../../cpp/io/lens_file.hpp"
#include "../../cpp/optics/lens_checks.hpp"
#include "bytes.hpp"
#include "mutate_text.hpp"
#include "target.hpp"

namespace realcam::fuzz {
namespace {

/// Every key and every kind of glass of the format.
constexpr const char* kEveryKey = R"(format = 1
name = "probe"
title = "every key"
source = "none"
wavelength_nm = 550.0
film_mm = [36.0, 24.0]
film_distance_mm = 60.0
[iris]
blades = 7
rounding = 0.3
rotation_deg = 12.5
[focus]
nearest_m = 0.5
group = [2, 3]
[glass.a]
n_d = 1.6
V_d = 40.0
[glass.b]
sellmeier = {B = [1.04, 0.23, 1.01], C = [0.006, 0.02, 103.56]}
[glass.c]
cauchy = [1.5, 0.004]
[glass.d]
table = [[400.0, 1.53], [550.0, 1.52], [700.0, 1.51], [380.0, 1.54], [780.0, 1.505]]
[[surface]]
type = "aperture"
thickness_mm = 1.0
clear_semi_diameter_mm = 20.0
inner_semi_diameter_mm = 3.0
[[surface]]
radius_of_curvature_mm = 50.0
thickness_mm = 4.0
material = "a"
clear_semi_diameter_mm = 15.0
conic = -0.5
aspheric_coefficients = {4 = 1e-6, 6 = -1e-9, 18 = 1e-24}
[[surface]]
radius_of_curvature_mm = -80.0
thickness_mm = 2.0
material = [1.7, 30.0]
clear_semi_diameter_mm = 15.0
[[surface]]
type = "stop"
thickness_mm = 30.0
clear_semi_diameter_mm = 6.0
[[surface]]
type = "mirror"
radius_of_curvature_mm = -300.0
thickness_mm = -20.0
clear_semi_diameter_mm = 20.0
[[surface]]
type = "mirror"
thickness_mm = 25.0
clear_semi_diameter_mm = 10.0
[[surface]]
thickness_mm = 2.0
material = "d"
clear_semi_diameter_mm = 15.0
[[surface]]
material = "N-BK7"
clear_semi_diameter_mm = 15.0
)";

}  // namespace

int fuzz_lens_file(const std::uint8_t* data, std::size_t size) {
    Bytes in(data, size);
    std::string text;
    const std::span<const io::BundledFile> files = io::bundled_lens_files();
    const auto choice = static_cast<std::size_t>(in.byte());
    if (choice == 255) {
        text.assign(reinterpret_cast<const char*>(data) + (size > 0), size - (size > 0));
    } else {
        text = choice % 2 ? std::string(kEveryKey) : std::string(files[choice / 2 % files.size()].text);
        for (int i = in.below(5); i >= 0; --i) mutate_text(in, text);
    }
    ++findings().files;
    try {
        const LensSystem lens = io::parse_lens(text, "fuzz.toml");
        ++findings().files_read;
        validate(lens);
        const bool sound = lens.film_distance > 0 && std::isfinite(lens.film_distance) && !lens.name.empty() &&
                           lens.wavelength_nm >= 100 && lens.stop_semi_diameter > 0 && lens.focusing.nearest_mm >= 0;
        if (!sound) report("a lens file becomes a lens that is none", "%s", start_of(text).c_str());
    } catch (const LensFileError& error) {
        if (std::strchr(error.what(), '\n'))
            report("a message of several lines", "%s: %s", error.what(), start_of(text).c_str());
    } catch (const std::exception& error) {
        report("a lens file raises something else", "%s: %s", error.what(), start_of(text).c_str());
    }
    return 0;
}

}  // namespace realcam::fuzz

REALCAM_FUZZ_TARGET(fuzz_lens_file)
