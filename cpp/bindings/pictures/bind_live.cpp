#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <memory>
#include <optional>
#include <string>

#include "../../cuda/session/cuda_session.hpp"
#include "../../render/session/live_view.hpp"
#include "../bindings.hpp"
#include "../values/arrays.hpp"
#include "owned_session.hpp"
#include "picture.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

using FramePointer = std::shared_ptr<const LiveFrame>;

class PythonLiveView {
public:
    PythonLiveView(const Assembly& scene, const std::string& device) : session_(device, &make_live_session) {
        session_.use([&](const auto& session) { view_.emplace(session, scene); });
    }

    FramePointer shoot(const Camera& camera, const RenderSettings& settings, const std::string& tone) {
        const ToneCurve curve = tone_curve_from(tone);
        if (settings.noise) throw InputError("spp of a frame must be a whole number");
        return session_.use([&](const auto&) {
            return view_->shoot(camera, settings, curve, heed_signals, std::make_shared<WorkInProgress>());
        });
    }

    /// Renders the last frame's camera and settings with layers.
    PictureFields image(const Camera& camera, const RenderSettings& settings) {
        Image image = session_.use([&](const auto&) { return view_->picture(camera, settings, heed_signals); });
        return picture_from(std::move(image), settings.layers);
    }

    Typed<"tuple[DeviceArray | NDArray[float32], DeviceArray | NDArray[float32]]", py::tuple> picture() {
        std::optional<DevicePicture> on_gpu;
        std::optional<Image> image;
        session_.use([&](const auto&) {
            Session& session = view_->collected();
            if (auto* const gpu = dynamic_cast<DevicePictures*>(&session))
                on_gpu = gpu->device_picture(heed_signals);
            else
                image = session.picture(heed_signals);
        });
        if (!image) return py::make_tuple(on_gpu->exposure, on_gpu->depth);
        return py::make_tuple(array_from(std::move(image->exposure), {image->height, image->width, 3}),
                              array_from(std::move(image->depth), {image->height, image->width}));
    }

    void show(const Assembly& scene) {
        session_.use([&](const auto&) { view_->show(scene); });
    }
    void cancel() { session_.cancel(Collected::drop); }

private:
    OwnedSession session_;
    std::optional<LiveView> view_;
};

/// Returns the frame's 8-bit values without a copy: the array keeps the frame alive, and with it its memory out of the
/// pool.
py::array_t<std::uint8_t> codes_of(const FramePointer& frame) {
    const std::uint8_t* codes = nullptr;
    {
        const Unlocked unlocked;
        wait(*frame, heed_signals);
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
                                                      "A picture of a LiveView, on its way from the device.")
        .def_property_readonly(
            "codes", [](const std::shared_ptr<LiveFrame>& frame) { return codes_of(frame); },
            R"((H, W, 3) uint8, sRGB, read-only; waits for the picture. Raises DeviceError; Cancelled after cancel();
KeyboardInterrupt on Ctrl-C.)")
        .def_property_readonly(
            "ready", [](const LiveFrame& frame) { return frame.wait_for(std::chrono::microseconds(0)); },
            "Whether codes would return at once.")
        .def_property_readonly("samples", &LiveFrame::samples, "Per pixel, collected up to this frame.");
    py::class_<PythonLiveView>(m, "_LiveView")
        .def(py::init<const Assembly&, const std::string&>(), "scene"_a, "device"_a)
        .def(
            "shoot",
            [](PythonLiveView& live, const Camera& camera, const RenderSettings& settings, const std::string& tone) {
                return std::const_pointer_cast<LiveFrame>(live.shoot(camera, settings, tone));
            },
            "camera"_a, "settings"_a, "tone"_a)
        .def("show", &PythonLiveView::show, "scene"_a)
        .def("picture", &PythonLiveView::picture)
        .def("image", &PythonLiveView::image, "camera"_a, "settings"_a)
        .def("cancel", &PythonLiveView::cancel);
}

}  // namespace realcam::bindings
