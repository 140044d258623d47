#include <pybind11/stl.h>

#include "../io/files/image_metadata.hpp"
#include "../render/session.hpp"
#include "../shot/shot_file.hpp"
#include "bindings.hpp"
#include "picture_readers.hpp"
#include "render_turn.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// What realcam.Shot is made of, by the names of its fields.
py::dict read_shot(const py::object& path, const std::string& device, const py::object& progress) {
    shot::ShotRequest request;
    Camera camera;
    Assembly scene;
    std::vector<std::string> notes;
    const shot::PictureReaders readers = picture_readers();
    const std::string name = path_from(path);
    {
        const Unlocked unlocked;
        request = shot::read_shot_file(name);
        request.lens_options.keep_going = heed_signals;
        request.lens_options.warn = [&](const std::string& note) { notes.push_back(note); };
        camera = shot::camera_of(request);
        request.lens_options = {};  // which must not outlive what they name
        scene = shot::scene_of(request, readers, heed_signals);
    }
    for (const std::string& note : notes)
        if (PyErr_WarnEx(PyExc_UserWarning, note.c_str(), 1) < 0) throw py::error_already_set();
    shot::Shot shot = shot::set_up(request, std::move(camera), std::move(scene));
    if (!request.exposure_time_s) {
        Session& session = session_for(device);
        const Progress report = progress_of(progress);
        const Unlocked unlocked;
        const RenderTurn turn;
        meter(shot, request, session, report);
    }
    return py::dict("scene"_a = shot.scene, "camera"_a = shot.camera, "settings"_a = request.settings,
                    "tone"_a = request.tone == ToneCurve::film ? "film" : "linear");
}

py::dict metadata(const Camera& camera, const RenderSettings& settings, int spp, std::uint32_t seed,
                  const std::string& plan, const std::string& denoiser) {
    py::dict entries;
    io::ImageMetadata metadata = io::metadata_of(camera, settings);
    metadata.spp = spp;
    metadata.seed = seed;
    metadata.plan = plan;
    metadata.denoiser = denoiser;
    for (const auto& [name, value] : metadata.entries()) entries[py::str(name)] = value;
    return entries;
}

}  // namespace

void bind_shot(py::module_& m) {
    m.def("_read_shot", &read_shot, "path"_a, "device"_a, "progress"_a);
    m.def("_metadata", &metadata, "camera"_a, "settings"_a, "spp"_a, "seed"_a, "plan"_a, "denoiser"_a);
}

}  // namespace realcam::bindings
