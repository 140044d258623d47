#include "devices/cuda_plugin.hpp"

#include <doctest/doctest.h>

#include "bare_scene.hpp"
#include "cuda/cuda_backend.hpp"
#include "refusal.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

const std::string kFolder = REALCAM_TEST_PLUGINS;

}  // namespace

TEST_CASE("exceptions of the plug-in arrive as what they are") {
    const CudaBackend& backend = load_cuda_plugin(kFolder + "/cuda_plugin.so");
    CHECK(backend.cuda_device(0).name == "GPU of the tests");
    CHECK_THROWS_WITH_AS(backend.cuda_device(1), "an input", InputError);
    CHECK_THROWS_WITH_AS(backend.cuda_device(2), "a device", DeviceError);
    CHECK_THROWS_WITH_AS(backend.cuda_device(3), "a GPU", UnsupportedGpu);
    CHECK_THROWS_WITH_AS(backend.cuda_device(3), "a GPU", Error);
    CHECK_THROWS_AS(backend.cuda_device(4), Cancelled);
}

TEST_CASE("the plug-in has its hierarchies from the program") {
    const CudaBackend& backend = load_cuda_plugin(kFolder + "/cuda_plugin.so");
    // The test's plug-in counts their nodes there. A triangle has one.
    CHECK(backend.hit_rates(0, Assembly(bare_scene()), Camera{}, {}).camera_rays == 1);
}

TEST_CASE("a plug-in of another version is refused with both versions") {
    const std::string message =
        message_of<DeviceError>([] { load_cuda_plugin(kFolder + "/cuda_plugin_of_another_version.so"); });
    CHECK(contains(message, "9.8.7 (build of the tests)"));
    CHECK(contains(message, std::string("this is realcam ") + cuda_backend_stamp()));
    CHECK(contains(message, "pip install"));
}

TEST_CASE("what is no plug-in is refused") {
    for (const std::string& path : {kFolder + "/nothing.so", kFolder + "/cuda_plugin.so/x", std::string("libm.so.6")})
        CHECK(message_of<DeviceError>([&] {
                  load_cuda_plugin(path);
              }).starts_with("the CUDA plug-in cannot be loaded: "));
}
