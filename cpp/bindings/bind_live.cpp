#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "../cuda/live_view.hpp"
#include "../devices/devices.hpp"
#include "../embree/embree_backend.hpp"
#include "bindings.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

using FramePointer = std::shared_ptr<const LiveFrame>;

struct PythonLiveView {
    std::unique_ptr<LiveView> view;
    std::uint32_t seed;
    int max_bounces;
};

std::unique_ptr<PythonLiveView> make_live_view(const Assembly& scene, const std::string& device, std::int64_t seed,
                                               int max_bounces) {
    if (seed < 0 || seed > 0xffffffff) throw InputError("the seed must lie between 0 and 4294967295");
    const std::optional<int> gpu = gpu_for_rays(device);
    if (!gpu) throw DeviceError("a live view needs a GPU; device=\"cuda\" is wanted, and rc.render for the CPU");
    const Unlocked unlocked;
    return std::make_unique<PythonLiveView>(std::make_unique<LiveView>(*gpu, scene, fast_pupil_tracer()),
                                            static_cast<std::uint32_t>(seed), max_bounces);
}

FramePointer shoot(PythonLiveView& live, const Camera& camera, int spp, const std::string& tone) {
    const ToneCurve curve = tone_curve_from(tone);
    const Unlocked unlocked;
    return live.view->shoot(camera, {spp, live.seed, live.max_bounces, 0}, curve);
}

/// Without a copy: the array keeps the frame alive, which keeps the memory from being used again.
py::array_t<std::uint8_t> codes_of(const FramePointer& frame) {
    const std::uint8_t* codes = nullptr;
    {
        const Unlocked unlocked;
        codes = frame->codes();
    }
    const py::capsule owner(new FramePointer(frame), [](void* p) { delete static_cast<FramePointer*>(p); });
    py::array_t<std::uint8_t> array({frame->height(), frame->width(), 3}, codes, owner);
    array.attr("flags").attr("writeable") = false;
    return array;
}

}  // namespace

void bind_live(py::module_& m) {
    py::class_<LiveFrame, std::shared_ptr<LiveFrame>>(m, "LiveFrame",
                                                      "A picture of a LiveView, on its way from the GPU.")
        .def_property_readonly(
            "codes", [](const std::shared_ptr<LiveFrame>& frame) { return codes_of(frame); },
            "(H, W, 3) uint8, sRGB, read-only; waits for the picture. Raises DeviceError; Cancelled after cancel().")
        .def_property_readonly("ready", &LiveFrame::ready, "Whether codes would return at once.")
        .def_property_readonly("samples", &LiveFrame::samples, "Per pixel, collected up to this frame.");
    py::class_<PythonLiveView>(
        m, "LiveView",
        "A scene before a camera that changes with every frame, on one GPU.\n\n"
        "Only what changed is copied there; samples are collected for as long as lens, film and pose of the camera\n"
        "stay the same. Frames are taken one behind the other without waiting: up to three are under way.\n"
        "Not for two threads at once, but for cancel(). Raises InputError, DeviceError where there is no GPU.")
        .def(py::init(&make_live_view), "scene"_a, py::kw_only(), "device"_a = "cuda", "seed"_a = 0,
             "max_bounces"_a = 1)
        .def(
            "shoot",
            [](PythonLiveView& live, const Camera& camera, int spp, const std::string& tone) {
                return std::const_pointer_cast<LiveFrame>(shoot(live, camera, spp, tone));
            },
            "camera"_a, py::kw_only(), "spp"_a = 1, "tone"_a = "film",
            "Starts to take spp more samples of each pixel, developed with the camera's exposure time and ISO and a\n"
            "tone curve (see Image.developed). Returns a LiveFrame at once, or when the oldest of three is there.")
        .def(
            "show", [](PythonLiveView& live, const Assembly& scene) { live.view->show(scene); }, "scene"_a,
            "Another scene for the frames to come. Made for every frame: of one that comes from the last by moved(),\n"
            "only the places are copied. Raises InputError.")
        .def(
            "picture",
            [](const PythonLiveView& live) {
                const DevicePicture picture = [&] {
                    const Unlocked unlocked;
                    return live.view->picture();
                }();
                return py::make_tuple(picture.exposure, picture.depth);
            },
            "All that was collected up to the last frame, as two DeviceArrays of float32 on the GPU: exposure (H, W, "
            "3)\n"
            "in lux seconds and depth (H, W) in metres, as Image has them. Waits for the frames under way.\n"
            "Raises InputError before the first frame, and Cancelled where another thread stops them meanwhile.")
        .def(
            "cancel", [](PythonLiveView& live) { live.view->cancel(); }, py::call_guard<Unlocked>(),
            "Gives up all frames under way within some milliseconds, from any thread: their codes raise Cancelled, "
            "and\n"
            "the next frame begins a new picture.");
}

}  // namespace realcam::bindings
