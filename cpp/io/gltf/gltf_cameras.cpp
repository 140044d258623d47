#include "gltf_cameras.hpp"

#include <numbers>

#include "../text/printable.hpp"

namespace realcam::io {

void read_gltf_cameras(FileScene& scene, const GltfDocument& document) {
    const Json& cameras = document.root()["cameras"];
    for (std::size_t i = 0; i < cameras.size(); ++i) {
        FileCamera camera;
        camera.name = printable(cameras[i]["name"].text());
        const double field = cameras[i]["perspective"]["yfov"].number(0);
        if (cameras[i]["type"].text() != "orthographic" && field > 0 && field < std::numbers::pi)
            camera.vertical_field_rad = field;
        scene.cameras.push_back(camera);
    }
}

}  // namespace realcam::io
