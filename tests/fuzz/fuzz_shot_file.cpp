// Fuzz target: a shot file, mutated from one that can be read, becomes a request or an Error whose message is one line.

#include <cstring>
#include <string>

#include "error.hpp"
#include "mutate_text.hpp"
#include "shot/shot_file.hpp"
#include "target.hpp"

namespace realcam::fuzz {
namespace {

/// Every key of the format.
constexpr const char* kSeed = R"(format = 1
scene = "terrace.glb"
scale = 0.01
texture = "wood.png"
environment_cd_m2 = [20.0, 28.0, 46.0]
environment_scale = 1.5
environment_rotation_deg = 30.0
lens = "double-gauss-50mm"
model = "full"
f_number = 2.1
focus_m = "auto"
film_mm = [36.0, 24.0]
resolution = [960, 640]
position_m = [0.0, 0.25, 1.1]
look_at_m = [0.0, 0.12, 0.0]
up = [0, 1, 0]
exposure_time_s = 0.025
iso = 100
tone = "film"
spp = 64
max_bounces = 1
seed = 0

[air]
visibility_m = 200.0
albedo = [0.9, 0.95, 1.0]
anisotropy = 0.8
margin_m = 50.0
)";

}  // namespace

int fuzz_shot_file(const std::uint8_t* data, std::size_t size) {
    Bytes in(data, size);
    std::string text = kSeed;
    for (int i = in.below(5); i >= 0; --i) mutate_text(in, text);
    ++findings().files;
    try {
        const shot::ShotRequest request = shot::parse_shot(text, "fuzz.toml");
        ++findings().files_read;
        if (!(request.scale > 0) || request.scene.empty())
            report("a shot file becomes a request that is none", "%s", start_of(text).c_str());
    } catch (const Error& error) {
        if (std::strchr(error.what(), '\n'))
            report("a message of several lines", "%s: %s", error.what(), start_of(text).c_str());
    } catch (const std::exception& error) {
        report("a shot file raises something else", "%s: %s", error.what(), start_of(text).c_str());
    }
    return 0;
}

}  // namespace realcam::fuzz

REALCAM_FUZZ_TARGET(fuzz_shot_file)
