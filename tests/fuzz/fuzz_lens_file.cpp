// Fuzz target: a lens file, realcam's or another program's, mutated from one that can be read, becomes a lens that
// validate() accepts or a LensFileError whose message is one line; nothing else.

#include <cmath>
#include <cstring>
#include <string>
#include <vector>

#include "bytes.hpp"
#include "io/lens/lens_file.hpp"
#include "io/lens/lens_text.hpp"
#include "mutate_text.hpp"
#include "optics/prescription/lens_checks.hpp"
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

constexpr const char* kZoom = R"(
[[zoom]]
name = "a"
thickness_mm = { 4 = 30.0 }
stop_semi_diameter_mm = 6.0
[[zoom]]
name = "b"
thickness_mm = { 4 = 28.0 }
film_distance_mm = 61.0
stop_semi_diameter_mm = 5.0
)";

/// Tilts, forms and apertures, a film that is tilted and curved.
constexpr const char* kFree = R"(format = 1
name = "free"
film_mm = [12.0, 8.0]
film_distance_mm = 40.0
film_radius_of_curvature_mm = -90.0
film_tilt_deg = [3.0, -1.0, 0.0]
film_decentre_mm = [0.0, 1.0, 0.2]
[[surface]]
type = "stop"
thickness_mm = 2.0
clear_semi_diameter_mm = 5.0
[[surface]]
form = "toroid"
radius_of_curvature_mm = 50.0
radius_of_curvature_x_mm = 80.0
conic = -0.2
aspheric_coefficients = {4 = 1e-6}
thickness_mm = 4.0
material = [1.6, 40.0]
clear_semi_diameter_mm = 15.0
tilt_deg = [2.0, -3.0, 10.0]
decentre_mm = [0.2, -0.3, 0.1]
returns = true
aperture = {ellipse_mm = [9.0, 7.0], offset_mm = [0.5, 0.0]}
[[surface]]
form = "biconic"
radius_of_curvature_mm = -80.0
radius_of_curvature_x_mm = -60.0
conic_x = 0.3
thickness_mm = 2.0
material = [1.7, 30.0]
clear_semi_diameter_mm = 15.0
aperture = {rectangle_mm = [9.0, 7.0]}
obscurations = [{spider_arms = 3, width_mm = 0.5}, {circle_mm = 1.0, offset_mm = [1.0, 2.0]}]
[[surface]]
radius_of_curvature_mm = 300.0
thickness_mm = 3.0
material = 1.5
clear_semi_diameter_mm = 12.0
xy_terms = [[1, 1, 1e-4], [0, 3, 1e-6]]
zernike = {order = "noll", radius_mm = 12.0, coefficients_mm = [0.0, 0.01, 0.02, 0.03]}
tilt_deg = [5.0, 0.0, 0.0]
[[surface]]
radius_of_curvature_mm = -300.0
thickness_mm = 20.0
clear_semi_diameter_mm = 12.0
radial_terms = {2 = 1e-4, 3 = 1e-5}
[[surface]]
type = "mirror"
radius_of_curvature_mm = -200.0
thickness_mm = 0.0
clear_semi_diameter_mm = 20.0
tilt_deg = [45.0, 0.0, 0.0]
forbes = {kind = "con", radius_mm = 22.0, coefficients_mm = [0.05, -0.02]}
[[surface]]
thickness_mm = -5.0
material = 1.5
clear_semi_diameter_mm = 20.0
tilt_deg = [45.0, 0.0, 0.0]
aperture = {polygon_mm = [[9.0, -6.0], [0.0, 9.0], [-9.0, -6.0]]}
[[surface]]
clear_semi_diameter_mm = 20.0
)";

/// One lens in the formats that are only read.
constexpr const char* kPbrt = R"(# probe
29.475 3.76 1.67 25.2
84.83 0.12 1 25.2
0 4.5 0 17.1
-14.495 1.18 1.603 17
-39.73 36.0 1 20
)";
constexpr const char* kOptiland = R"({"name": "probe", "aperture": {"type": "EPD", "value": 8},
"fields": {"fields": [{"x": 0, "y": 0, "vx": 0, "vy": 0}, {"x": 0, "y": 10, "vx": 0, "vy": 0.1}],
  "field_definition": {"field_type": "AngleField"}},
"wavelengths": {"wavelengths": [{"value": 0.55, "is_primary": true, "unit": "um"}]},
"surface_group": {"surfaces": [
{"type": "ObjectSurface", "geometry": {"type": "Plane", "cs": {"z": -Infinity}, "radius": Infinity}},
{"thickness": 4, "geometry": {"type": "EvenAsphere", "cs": {"z": 0.0}, "radius": 40, "conic": 0.1,
  "coefficients": [1e-4, 1e-7]}, "material_post": {"type": "Material", "name": "N-BK7", "filename": "/d/schott/N-BK7.yml"},
  "is_stop": true, "interaction_model": {"type": "RefractiveReflectiveModel", "is_reflective": false}},
{"thickness": 80, "geometry": {"type": "StandardGeometry", "cs": {"z": 4.0}, "radius": -60, "conic": 0},
  "material_post": {"type": "IdealMaterial", "index": 1.0}, "aperture": {"type": "RadialAperture", "r_max": 9, "r_min": 0}},
{"thickness": 0, "geometry": {"type": "Plane", "cs": {"z": 84.0}, "radius": Infinity}}]}})";
constexpr const char* kRayOptics = R"({"optical_model": {"attributes": {
"system_spec": {"attributes": {"title": "probe", "_dimensions": "mm"}},
"profile_dict": {"1": {"__instance_type__": ["m", "Spherical"], "attributes": {"cv": 0.0}},
  "2": {"__instance_type__": ["m", "EvenPolynomial"], "attributes": {"cv": 0.03, "cc": 0.2, "coefs": [0.0, 1e-6]}}},
"seq_model": {"attributes": {"stop_surface": 2, "ifcs": [
{"__instance_type__": ["m", "Surface"], "attributes": {"interact_mode": "dummy", "profile_id": "1"}},
{"__instance_type__": ["m", "Surface"], "attributes": {"interact_mode": "transmit", "profile_id": "2", "max_aperture": 9}},
{"__instance_type__": ["m", "Surface"], "attributes": {"interact_mode": "transmit", "profile_id": "1",
  "clear_apertures": [{"__instance_type__": ["m", "Circular"], "attributes": {"radius": 8}}]}},
{"__instance_type__": ["m", "Surface"], "attributes": {"interact_mode": "dummy", "profile_id": "1"}}],
"gaps": [{"attributes": {"thi": 1e10}}, {"attributes": {"thi": 5, "medium": {"__instance_type__":
  ["opticalglass.schott", "SchottGlass"], "attributes": {"gname": "N-BK7"}}}},
  {"attributes": {"thi": 60, "medium": {"__instance_type__": ["m", "Air"], "attributes": {}}}}]}},
"optical_spec": {"attributes": {"spectral_region": {"attributes": {"wavelengths": [587.6], "reference_wvl": 0}},
  "pupil": {"attributes": {"_key": ["aperture", "image", "f/#"], "value": 8}},
  "field_of_view": {"attributes": {"key": ["field", "object", "angle"], "value": 5, "is_relative": true, "fields": [
    {"attributes": {"x": 0, "y": 1}}]}}}}}}})";

constexpr const char* kOslo = R"(// OSLO 7.0
LEN NEW "probe" 100 4
EBR 5
ANG 10
UNI 1.0
AIR
TH 1e20
NXT
GLA BK7
RD 51.68
TH 3
CC -0.3
AD 1e-6
AST
AP CHK 6
NXT
AIR
RD -80; TH 2; AP 6
NXT
PK GLA 1
PK CVM 2 0.001
PK TH -2
NXT
PY 0
WV 0.58756 0.48613 0.65627
END 4
CFG NEW
)";

/// Returns a lens file of any format. `name`: receives a file name with the format's extension.
std::string seed(Bytes& in, std::string& name) {
    const std::span<const io::BundledFile> files = io::bundled_lens_files();
    const std::string bundled(files[static_cast<std::size_t>(in.byte()) % files.size()].name);
    if (in.chance(80)) {
        constexpr const char* kNames[] = {"fuzz.toml", "fuzz.zmx", "fuzz.seq", "fuzz.json", "fuzz.roa"};
        name = kNames[in.below(5)];
        return io::lens_text_for(io::parse_lens(kFree, "seed.toml"), name).text;
    }
    switch (in.below(9)) {
        case 0: return name = "fuzz.dat", kPbrt;
        case 1: return name = "fuzz.json", kOptiland;
        case 2: return name = "fuzz.roa", kRayOptics;
        case 3:
        case 4: name = "fuzz.zmx"; break;
        case 5:
        case 6: name = "fuzz.seq"; break;
        case 7: return name = "fuzz.len", kOslo;
        default: return name = "fuzz.toml", std::string(kEveryKey) + kZoom;
    }
    if (in.chance(64)) return io::lens_text_for(io::parse_lens(std::string(kEveryKey) + kZoom, "seed.toml"), name).text;
    return io::lens_text_for(io::read_lens(bundled), name).text;
}

}  // namespace

int fuzz_lens_file(const std::uint8_t* data, std::size_t size) {
    Bytes in(data, size);
    std::string text, name = "fuzz.toml";
    const std::span<const io::BundledFile> files = io::bundled_lens_files();
    const auto choice = static_cast<std::size_t>(in.byte());
    if (choice == 255) {
        text.assign(reinterpret_cast<const char*>(data) + (size > 0), size - (size > 0));
    } else if (choice >= 128) {
        text = seed(in, name);
        for (int i = in.below(5); i >= 0; --i) mutate_text(in, text);
    } else {
        text = choice % 2 ? std::string(kEveryKey) : std::string(files[choice / 2 % files.size()].text);
        for (int i = in.below(5); i >= 0; --i) mutate_text(in, text);
    }
    ++findings().files;
    try {
        io::LensReadOptions options;
        options.force = choice % 3 == 0;
        const LensSystem lens = io::parse_lens_file(text, name, options);
        ++findings().files_read;
        validate(lens);
        const double film = lens.is_rotational() ? lens.film_distance : std::fabs(lens.film_distance);
        const bool sound = film > 0 && std::isfinite(film) && lens.wavelength_nm >= 100 &&
                           lens.stop_semi_diameter > 0 && lens.focusing.nearest_mm >= 0;
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
