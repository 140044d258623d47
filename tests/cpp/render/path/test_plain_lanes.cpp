// Paths in plain scenes, for which there is vector code: each lane of a block takes the path of a block of one.

#include <memory>

#include "../followed_paths.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

/// `phong`: on the wall.
Scene room(bool phong) {
    Scene scene = lamp_room();
    if (phong) {
        scene.materials[1].specular = {0.3f, 0.3f, 0.3f};
        scene.materials[1].shininess = 40;
    }
    return scene;
}

}  // namespace

TEST_CASE("in plain scenes each lane of a block takes the path of a block of one") {
    for (const AddedLight& light : kAddedLights)
        for (const bool phong : {false, true})
            for (const bool as_instance : {false, true})
                for (const PathSettings& settings : kFollowedSettings) {
                    CAPTURE(std::string(light.name));
                    CAPTURE(phong);
                    CAPTURE(as_instance);
                    CAPTURE(settings.max_bounces);
                    Scene scene = room(phong);
                    light.add(scene);
                    Assembly assembly(scene);
                    if (as_instance) {
                        Affine<double> up;
                        up.origin = {0, 0.7, 0};
                        assembly.instances.push_back({std::make_shared<const Scene>(room(phong)), up, "above"});
                    }
                    // The two forms differ by some roundings at each of six surfaces.
                    check_lanes<SceneKind::plain>(assembly, settings, 2e-5f);
                }
}
