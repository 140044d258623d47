// Live rendering: the class LiveFrame, and _LiveView for realcam.LiveView.

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
#include "python_image.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

using FramePointer = std::shared_ptr<const LiveFrame>;

/// Core part of realcam.LiveView.
class PythonLiveView {
public:
    PythonLiveView(const Assembly& scene, const std::string& device) : session_(device, &make_live_session) {
        session_.use([&](const auto& session) { view_.emplace(session, scene); });
    }

    /// Starts to render a frame and returns meanwhile. Throws InputError.
    FramePointer shoot(const Camera& camera, const RenderSettings& settings, const std::string& tone) {
        const ToneCurve curve = tone_curve_from(tone);
        if (settings.noise) throw InputError("spp of a live frame must be a whole number, not \"auto\"");
        return session_.use([&](const auto&) {
            return view_->shoot(camera, settings, curve, heed_signals, std::make_shared<WorkInProgress>());
        });
    }

    /// Renders the last frame's camera and settings with layers.
    PythonImage image(const Camera& camera, const RenderSettings& settings) {
        Image image = session_.use([&](const auto&) { return view_->picture(camera, settings, heed_signals); });
        return python_image(std::move(image), camera, settings);
    }

    /// Returns the exposure (H, W, 3) in lux seconds and the depth (H, W) in m of the samples so far: DeviceArrays if
    /// the session runs on a GPU.
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
    void cancel() { session_.cancel(OnCancel::drop); }

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
                                                      "A frame of a LiveView, which the device may still be rendering.")
        .def_property_readonly(
            "codes", [](const std::shared_ptr<LiveFrame>& frame) { return codes_of(frame); },
            R"((H, W, 3) uint8, read-only: the 8-bit sRGB values of the frame. Waits until it is complete. Raises
DeviceError; Cancelled if cancel() was called; KeyboardInterrupt on Ctrl-C.)")
        .def_property_readonly(
            "ready", [](const LiveFrame& frame) { return frame.wait_for(std::chrono::microseconds(0)); },
            "True if the frame is complete, so that codes returns without waiting.")
        .def_property_readonly("samples", &LiveFrame::samples,
                               "Number of samples per pixel that were accumulated up to this frame.");
    py::class_<PythonLiveView>(m, "_LiveView", "Internal: use realcam.LiveView.")
        .def(py::init<const Assembly&, const std::string&>(), "scene"_a, "device"_a)
        .def(
            "shoot",
            [](PythonLiveView& live, const Camera& camera, const RenderSettings& settings, const std::string& tone) {
                return std::const_pointer_cast<LiveFrame>(live.shoot(camera, settings, tone));
            },
            "camera"_a, "settings"_a, "tone"_a, "Starts to render a frame and returns it meanwhile.")
        .def("show", &PythonLiveView::show, "scene"_a, "Sets the scene of the frames that follow.")
        .def("picture", &PythonLiveView::picture,
             "Returns exposure (H, W, 3) in lux seconds and depth (H, W) in m of the accumulated samples.")
        .def("image", &PythonLiveView::image, "camera"_a, "settings"_a,
             "Returns an Image of the last frame's camera and settings, with layers.")
        .def("cancel", &PythonLiveView::cancel, "Cancels frames in progress, which then raise Cancelled.");
}

}  // namespace realcam::bindings
