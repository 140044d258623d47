// Fuzz targets: a scene file, mutated from one that can be read, becomes a scene that validate() accepts or a
// SceneFileError whose message is one short line; nothing else. One target for each format.

#include <algorithm>
#include <cstring>
#include <iterator>
#include <string>
#include <vector>

#include "compressed_meshes.hpp"
#include "error.hpp"
#include "fuzz_folder.hpp"
#include "io/scene_file.hpp"
#include "io/text/printable.hpp"
#include "mutate_bytes.hpp"
#include "mutate_text.hpp"
#include "scene/scene_checks.hpp"
#include "scene_seeds.hpp"
#include "target.hpp"

namespace realcam::fuzz {
namespace {

/// Beyond this a message is no message. The longest holds two paths and what it quotes.
constexpr std::size_t kLongestMessage = 1000;

void check_text(const char* kind, const std::string& text, const std::string& content) {
    if (text.size() > kLongestMessage || text.find('\n') != std::string::npos || io::printable(text) != text)
        report(kind, "%s: %s", text.substr(0, 300).c_str(), start_of(content).c_str());
}

/// Every other picture cannot be read, and of the others every other one has floats.
std::optional<io::DecodedImage> read_picture(const std::string& path, std::span<const std::uint8_t> bytes) {
    const std::size_t kind = (path.size() + bytes.size()) % 4;
    if (kind % 2) return std::nullopt;
    if (kind == 0) return io::DecodedImage{2, 1, std::vector<std::uint8_t>{1, 2, 3, 4, 5, 6, 7, 8}};
    return io::DecodedImage{1, 1, std::vector<float>{0, 0.5f, 65504, 1}, true};
}

/// Shapes that change over time are valid scenes at other times, or out of reach.
void check_shapes(const Assembly& scene, const std::string& content) {
    for (const double time_s : {-1e9, 0.3, 1e9}) {
        try {
            SceneChecks().check(frozen_at(scene, time_s));
        } catch (const InputError& error) {
            check_text("a message of several lines, or very long", error.what(), content);
        }
    }
}

/// `content`: what was mutated, for the report.
void read(const std::string& path, const std::string& content, const io::SceneFileOptions& options) {
    ++findings().files;
    try {
        const Assembly scene = io::read_scene(path, options, read_picture);
        ++findings().files_read;
        if (scene.deforms()) check_shapes(scene, content);
        for (const std::string& warning : scene.static_geometry->warnings)
            check_text("a warning of several lines, or very long", warning, content);
    } catch (const SceneFileError& error) {
        check_text("a message of several lines, or very long", error.what(), content);
    } catch (const std::exception& error) {
        report("a scene file raises something else", "%s: %s", error.what(), start_of(content).c_str());
    }
}

/// A text after some mutations; now and then also of its bytes.
std::string mutated_text(Bytes& in, std::string text) {
    for (int i = in.below(5); i >= 0; --i) in.chance(200) ? mutate_text(in, text) : mutate_bytes(in, text);
    return text;
}

std::string mutated_bytes(Bytes& in, std::string bytes) {
    for (int i = in.below(8); i >= 0; --i) mutate_bytes(in, bytes);
    return bytes;
}

/// Binary PLY: the text of the header, or the bytes behind it.
std::string mutated_ply(Bytes& in) {
    const int kind = in.below(4);
    if (kind == 0) return mutated_text(in, ply_ascii_seed());
    const std::string seed = ply_binary_seed(kind == 1);
    if (in.chance(128)) return mutated_bytes(in, seed);
    const std::size_t end = seed.find("end_header\n") + std::strlen("end_header\n");
    return mutated_text(in, seed.substr(0, end)) + seed.substr(end);
}

io::SceneFileOptions some_options(Bytes& in) {
    io::SceneFileOptions options;
    if (in.chance(40)) options.scale = in.decades(-6, 6);
    return options;
}

}  // namespace

int fuzz_obj(const std::uint8_t* data, std::size_t size) {
    Bytes in(data, size);
    FuzzFolder::get().write("seed.mtl", mtl_seed());
    const std::string content = mutated_text(in, obj_seed());
    read(FuzzFolder::get().write("seed.obj", content), content, some_options(in));
    return 0;
}

int fuzz_mtl(const std::uint8_t* data, std::size_t size) {
    Bytes in(data, size);
    const std::string content = mutated_text(in, mtl_seed());
    FuzzFolder::get().write("seed.mtl", content);
    FuzzFolder::get().write("seed.png", "a picture");
    read(FuzzFolder::get().write("fixed.obj", obj_seed()), content, {});
    return 0;
}

int fuzz_gltf(const std::uint8_t* data, std::size_t size) {
    Bytes in(data, size);
    const std::string content = mutated_text(in, gltf_seed());
    io::SceneFileOptions options = some_options(in);
    if (in.chance(40)) options.objects = {"car"};
    if (in.chance(40)) options.scene_name = in.chance(128) ? "main" : "1";
    FuzzFolder::get().write("seed.png", "a picture");
    read(FuzzFolder::get().write("seed.gltf", content), content, options);
    return 0;
}

int fuzz_glb(const std::uint8_t* data, std::size_t size) {
    Bytes in(data, size);
    std::string json = gltf_seed(""), binary = gltf_buffer(), content;
    if (in.chance(128)) {
        if (in.chance(170)) json = mutated_text(in, json);
        content = glb_of(json, in.chance(128) ? binary : mutated_bytes(in, binary));
    } else {
        content = mutated_bytes(in, glb_of(json, binary));
    }
    read(FuzzFolder::get().write("seed.glb", content), content, some_options(in));
    return 0;
}

/// Meshes of Draco and of meshoptimizer: mostly the compressed bytes, and now and then the JSON that promises their
/// size.
int fuzz_compressed(const std::uint8_t* data, std::size_t size) {
    Bytes in(data, size);
    const GridMesh grid(1 + in.below(6));
    std::string json, binary;
    if (const bool is_draco = in.chance(160); is_draco && REALCAM_HAS_DRACO) {
#if REALCAM_HAS_DRACO
        binary = draco_bytes(grid, {in.chance(170), in.below(16), 2 + in.below(12), in.below(12), in.below(11)});
        json = draco_json(grid, binary.size());
#endif
    } else if (REALCAM_HAS_MESHOPT) {
#if REALCAM_HAS_MESHOPT
        const MeshoptWriter writer = meshopt_grid(grid, in.chance(128));
        binary = writer.bytes;
        json = meshopt_json(grid, writer);
#endif
    } else {
        json = gltf_seed("");
        binary = gltf_buffer();
    }
    if (in.chance(50)) json = mutated_text(in, json);
    if (in.chance(230)) {
        const std::size_t length = binary.size();
        binary = mutated_bytes(in, binary);
        // A buffer of another length than the JSON says would be refused before it is decoded.
        binary.resize(std::max(length, binary.size()));
    }
    read(FuzzFolder::get().write("seed.glb", glb_of(json, binary)), json, some_options(in));
    return 0;
}

int fuzz_ply(const std::uint8_t* data, std::size_t size) {
    Bytes in(data, size);
    const std::string content = mutated_ply(in);
    read(FuzzFolder::get().write("seed.ply", content), content, some_options(in));
    return 0;
}

/// libFuzzer's one target: the format by the first byte.
int fuzz_scene_file(const std::uint8_t* data, std::size_t size) {
    constexpr Target formats[] = {fuzz_obj, fuzz_mtl, fuzz_gltf, fuzz_glb, fuzz_compressed, fuzz_ply};
    return size == 0 ? 0 : formats[data[0] % std::size(formats)](data + 1, size - 1);
}

}  // namespace realcam::fuzz

REALCAM_FUZZ_TARGET(fuzz_scene_file)
