#include "scene_cleanup.hpp"

#include "../../error.hpp"
#include "../../scene/scene_checks.hpp"
#include "vertex_welding.hpp"

namespace realcam::io {

void warn_count(Scene& scene, const std::string& path, std::size_t n, const std::string& what) {
    if (n > 0) scene.warnings.push_back(path + ": " + std::to_string(n) + " " + what);
}

void clean_geometry(Scene& scene, Smoothing smoothing, const std::string& path, Checkpoint& checkpoint) {
    if (scene.triangles.empty()) {
        throw SceneFileError(path + ": holds no triangles" +
                             (scene.positions_m.empty() ? "" : ", only points or lines"));
    }
    // Like drop_degenerate_triangles, but keeps the smoothing groups in step.
    std::size_t kept = 0;
    bool any_smooth = false;
    for (std::size_t t = 0; t < scene.triangles.size(); ++t) {
        checkpoint.pass();
        if (is_degenerate(scene, scene.triangles[t])) continue;
        any_smooth |= smoothing.groups[t] != kFlat;
        smoothing.groups[kept] = smoothing.groups[t];
        scene.triangles[kept++] = scene.triangles[t];
    }
    const std::size_t dropped = scene.triangles.size() - kept;
    scene.triangles.resize(kept);
    smoothing.groups.resize(kept);
    if (kept == 0) throw SceneFileError(path + ": all of its triangles are without area");
    warn_count(scene, path, dropped, dropped == 1 ? "triangle without area dropped" : "triangles without area dropped");

    if (any_smooth) smooth_normals(scene, smoothing, checkpoint);
    weld_vertices(scene, checkpoint);
}

}  // namespace realcam::io
