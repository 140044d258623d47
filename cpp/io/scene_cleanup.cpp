#include "scene_cleanup.hpp"

#include "../error.hpp"
#include "scene_checks.hpp"
#include "scene_normals.hpp"
#include "vertex_welding.hpp"

namespace realcam::io {

void warn_count(Scene& scene, const std::string& path, std::size_t n, const std::string& what) {
    if (n > 0) scene.warnings.push_back(path + ": " + std::to_string(n) + " " + what);
}

void clean_geometry(Scene& scene, const std::vector<std::uint32_t>& smooth, const std::string& path) {
    if (scene.triangles.empty()) {
        throw SceneFileError(path + ": holds no triangles" +
                             (scene.positions_m.empty() ? "" : ", only points or lines"));
    }
    // Like drop_degenerate_triangles, but the list of those to be smoothed has to follow.
    std::vector<bool> is_smooth(scene.triangles.size(), false);
    for (const std::uint32_t t : smooth) is_smooth[t] = true;
    std::vector<std::uint32_t> still_smooth;
    std::size_t kept = 0;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        if (is_degenerate(scene, scene.triangles[t])) continue;
        if (is_smooth[t]) still_smooth.push_back(static_cast<std::uint32_t>(kept));
        scene.triangles[kept++] = scene.triangles[t];
    }
    const std::size_t dropped = scene.triangles.size() - kept;
    scene.triangles.resize(kept);
    if (kept == 0) throw SceneFileError(path + ": all of its triangles are without area");
    warn_count(scene, path, dropped, dropped == 1 ? "triangle without area dropped" : "triangles without area dropped");

    if (!still_smooth.empty()) smooth_normals(scene, still_smooth);
    weld_vertices(scene);
}

}  // namespace realcam::io
