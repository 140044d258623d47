#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <vector>

#include "../cuda/cuda_session.hpp"
#include "../devices/devices.hpp"
#include "../render/live_view.hpp"
#include "arrays.hpp"
#include "bindings.hpp"
#include "picture.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

using FramePointer = std::shared_ptr<const LiveFrame>;

class PythonLiveView {
public:
    PythonLiveView(const Assembly& scene, const std::string& device, std::int64_t seed, int max_bounces)
        : seed_(seed_from(seed)), max_bounces_(max_bounces) {
        const Unlocked unlocked;
        view_ = std::make_unique<LiveView>(make_live_session(device), scene);
        const std::lock_guard lock(mutex());
        all().insert(view_.get());
    }
    ~PythonLiveView() {
        if (has_lost_threads()) {
            static_cast<void>(view_.release());
            return;
        }
        const std::lock_guard lock(mutex());
        all().erase(view_.get());
    }
    PythonLiveView(const PythonLiveView&) = delete;
    PythonLiveView& operator=(const PythonLiveView&) = delete;

    FramePointer shoot(const Camera& camera, int spp, const std::string& tone, const std::vector<std::string>& effects,
                       const std::string& illuminant, const std::string& transport, float clamp_cd_m2) {
        const ToneCurve curve = tone_curve_from(tone);
        const RenderSettings settings =
            settings_from(spp, seed_, max_bounces_, transport, clamp_cd_m2, 0, {}, effects, illuminant);
        const Unlocked unlocked;
        return view_->shoot(camera, settings, curve, heed_signals, std::make_shared<WorkUnderWay>());
    }

    py::tuple image() const {
        const Image image = [&] {
            const Unlocked unlocked;
            return view_->collected().picture(heed_signals);
        }();
        return picture_from(image, {});
    }

    py::tuple picture() const {
        Session& session = view_->collected();
        if (auto* const on_gpu = dynamic_cast<DevicePictures*>(&session)) {
            const DevicePicture picture = [&] {
                const Unlocked unlocked;
                return on_gpu->device_picture(heed_signals);
            }();
            return py::make_tuple(picture.exposure, picture.depth);
        }
        const Image image = [&] {
            const Unlocked unlocked;
            return session.picture(heed_signals);
        }();
        return py::make_tuple(copy_of(image.exposure, {image.height, image.width, 3}),
                              copy_of(image.depth, {image.height, image.width}));
    }

    void show(const Assembly& scene) { view_->show(scene); }
    void cancel() { view_->cancel(); }

    static void cancel_all() {
        const std::lock_guard lock(mutex());
        for (LiveView* const view : all()) {
            try {
                view->cancel();
            } catch (const DeviceError&) {
                // A GPU that is lost has nothing to be stopped.
            }
        }
    }

private:
    static std::mutex& mutex() {
        static auto* const one = new std::mutex;
        return *one;
    }
    static std::set<LiveView*>& all() {
        static auto* const set = new std::set<LiveView*>;
        return *set;
    }

    std::uint32_t seed_;
    int max_bounces_;
    std::unique_ptr<LiveView> view_;
};

/// Without a copy: the array keeps the frame alive, which keeps the memory from being used again.
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
    stop_too_at_exit(&PythonLiveView::cancel_all);
    py::class_<LiveFrame, std::shared_ptr<LiveFrame>>(m, "LiveFrame",
                                                      "A picture of a LiveView, on its way from the device.")
        .def_property_readonly(
            "codes", [](const std::shared_ptr<LiveFrame>& frame) { return codes_of(frame); },
            "(H, W, 3) uint8, sRGB, read-only; waits for the picture. Raises DeviceError; Cancelled after cancel();\n"
            "KeyboardInterrupt on Ctrl-C.")
        .def_property_readonly(
            "ready", [](const LiveFrame& frame) { return frame.wait_for(std::chrono::microseconds(0)); },
            "Whether codes would return at once.")
        .def_property_readonly("samples", &LiveFrame::samples, "Per pixel, collected up to this frame.");
    py::class_<PythonLiveView>(
        m, "LiveView",
        "A scene before a camera that changes with every frame, on one device: \"auto\" (a GPU if there is one), "
        "\"cpu\",\n\"cuda\" or \"cuda:1\".\n\n"
        "Only what changed is prepared again; samples are collected for as long as scene, lens, film and pose of the\n"
        "camera stay the same. Frames are taken one behind the other without waiting: up to three are under way on a\n"
        "GPU, one on the CPU. Not for two threads at once, but for cancel(). Raises InputError, DeviceError where the\n"
        "device is not there.")
        .def(py::init<const Assembly&, const std::string&, std::int64_t, int>(), "scene"_a, py::kw_only(),
             "device"_a = "auto", "seed"_a = 0, "max_bounces"_a = 1)
        .def(
            "shoot",
            [](PythonLiveView& live, const Camera& camera, int spp, const std::string& tone,
               const std::vector<std::string>& effects, const std::string& illuminant, const std::string& transport,
               float clamp_cd_m2) {
                return std::const_pointer_cast<LiveFrame>(
                    live.shoot(camera, spp, tone, effects, illuminant, transport, clamp_cd_m2));
            },
            "camera"_a, py::kw_only(), "spp"_a = 1, "tone"_a = "film", "effects"_a = std::vector<std::string>(),
            "illuminant"_a = "", "transport"_a = "paths", "clamp_cd_m2"_a = 0.0f,
            "Starts to take spp more samples of each pixel, developed with the camera's exposure time and ISO and a\n"
            "tone curve (see Image.developed). effects: names of rc.effects(), but not \"auto\", as planning takes\n"
            "longer than a frame (rc.plan says what it would choose); illuminant: as text, of dispersion and\n"
            "diffraction; transport and clamp_cd_m2: as rc.render has them. Returns a LiveFrame at once, or when the\n"
            "oldest of those under way is there.\n"
            "Raises KeyboardInterrupt on Ctrl-C.")
        .def("show", &PythonLiveView::show, "scene"_a, py::call_guard<Unlocked>(),
             "Another scene for the frames to come. Made for every frame: of one that comes from the last by moved(),\n"
             "only the places are copied. Raises InputError.")
        .def(
            "picture", &PythonLiveView::picture,
            "All that was collected up to the last frame, as two arrays of float32: exposure (H, W, 3) in lux seconds\n"
            "and depth (H, W) in metres, as Image has them. DeviceArrays in the memory of the GPU; of a view on the\n"
            "CPU numpy arrays. Waits for the frames under way. Raises InputError before the first frame, Cancelled\n"
            "where another thread stops them meanwhile, and KeyboardInterrupt on Ctrl-C.")
        .def("_image", &PythonLiveView::image)
        .def("cancel", &PythonLiveView::cancel, py::call_guard<Unlocked>(),
             "Gives up all frames under way within some milliseconds, from any thread: their codes raise Cancelled, "
             "and\n"
             "the next frame begins a new picture.");
}

}  // namespace realcam::bindings
