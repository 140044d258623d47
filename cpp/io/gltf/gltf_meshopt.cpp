#include "gltf_compression.hpp"

#if REALCAM_HAS_MESHOPT
#include <meshoptimizer.h>
#endif

#include "../files/regular_file.hpp"
#include "../text/printable.hpp"

namespace realcam::io {

std::string missing_library(std::string_view extension) {
    if (!REALCAM_HAS_DRACO && extension == kDraco) return "libdraco";
    if (!REALCAM_HAS_MESHOPT && (extension == kMeshopt[0] || extension == kMeshopt[1])) return "meshoptimizer";
    return "";
}

std::string compression_error(const std::string& extension) {
    return "in the glTF extension " + extension + ", which needs " + missing_library(extension) +
           ", without which this realcam was built; export it without compression";
}

#if REALCAM_HAS_MESHOPT
namespace {

/// Layout and codec of a compressed bufferView.
struct MeshoptView {
    std::size_t count, stride;  ///< number of elements, and their size in bytes
    std::string mode, filter;
};

/// Returns why the layout is invalid for its codec, by the extension's specification; empty if it is valid.
std::string layout_error(const MeshoptView& view) {
    const auto expected = [](const std::string& name, const std::string& value, const std::string& values) {
        return "its " + name + " is " + in_quotes(value.substr(0, 60)) + "; expected " + values;
    };
    const std::string stride = std::to_string(view.stride);
    const bool is_vertices = view.mode == "ATTRIBUTES";
    if (!is_vertices && view.mode != "TRIANGLES" && view.mode != "INDICES")
        return expected("mode", view.mode, "ATTRIBUTES, TRIANGLES or INDICES");
    if (is_vertices && (view.stride == 0 || view.stride > 256 || view.stride % 4 != 0))
        return expected("byteStride", stride, "a multiple of 4 up to 256");
    if (!is_vertices && view.stride != 2 && view.stride != 4) return expected("byteStride", stride, "2 or 4");
    if (view.mode == "TRIANGLES" && view.count % 3 != 0)
        return expected("count", std::to_string(view.count), "a multiple of 3");
    if (view.filter.empty() || view.filter == "NONE") return "";
    const bool is_known = view.filter == "OCTAHEDRAL" || view.filter == "QUATERNION" || view.filter == "EXPONENTIAL";
    if (!is_known || !is_vertices) return expected("filter", view.filter, "OCTAHEDRAL, QUATERNION or EXPONENTIAL");
    if (view.filter == "OCTAHEDRAL" && view.stride != 4 && view.stride != 8)
        return expected("byteStride", stride, "4 or 8 with the filter OCTAHEDRAL");
    if (view.filter == "QUATERNION" && view.stride != 8)
        return expected("byteStride", stride, "8 with the filter QUATERNION");
    return "";
}

/// Decodes into `to`, which holds count * stride bytes. Returns false if the bytes are not valid.
bool decode(const MeshoptView& view, std::string_view encoded, char* to) {
    const auto* bytes = reinterpret_cast<const unsigned char*>(encoded.data());
    const int error =
        view.mode == "ATTRIBUTES"  ? meshopt_decodeVertexBuffer(to, view.count, view.stride, bytes, encoded.size())
        : view.mode == "TRIANGLES" ? meshopt_decodeIndexBuffer(to, view.count, view.stride, bytes, encoded.size())
                                   : meshopt_decodeIndexSequence(to, view.count, view.stride, bytes, encoded.size());
    if (error != 0) return false;
    if (view.filter == "OCTAHEDRAL") meshopt_decodeFilterOct(to, view.count, view.stride);
    if (view.filter == "QUATERNION") meshopt_decodeFilterQuat(to, view.count, view.stride);
    if (view.filter == "EXPONENTIAL") meshopt_decodeFilterExp(to, view.count, view.stride);
    return true;
}

}  // namespace

std::string decode_meshopt(const GltfDocument& document, const Json& extension, std::string_view encoded,
                           const std::string& where) {
    const MeshoptView view{extension["count"].index(0), extension["byteStride"].index(0), extension["mode"].text(),
                           extension["filter"].text()};
    if (const std::string why = layout_error(view); !why.empty()) document.fail(where + ": " + why);
    // The codec of vertices has at least 4 bytes for 256 values of a byte of the elements; those of indices have more.
    constexpr std::size_t kMaxRatio = 64;
    if (view.count / kMaxRatio > encoded.size() / view.stride + 1)
        document.fail(where + ": promises " + std::to_string(view.count) + " elements of " +
                      std::to_string(view.stride) + " bytes, for which " + std::to_string(encoded.size()) +
                      " compressed bytes are too few");
    const std::size_t bytes = view.count * view.stride;
    if (const std::string why = too_much_memory(bytes); !why.empty()) document.fail(where + ": needs " + why);
    std::string decoded(bytes, '\0');
    if (!decode(view, encoded, decoded.data()))
        document.fail(where + ": its compressed bytes are not valid for " + std::to_string(view.count) +
                      " elements of " + std::to_string(view.stride) + " bytes, or of a newer version of the codec");
    return decoded;
}

#else

std::string decode_meshopt(const GltfDocument& document, const Json&, std::string_view, const std::string& where) {
    document.fail(where + ": its numbers are " + compression_error(kMeshopt[0]));
}

#endif

}  // namespace realcam::io
