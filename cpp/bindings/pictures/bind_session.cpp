// The internal class _Session, for realcam.Session.

#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "../bindings.hpp"
#include "../values/arrays.hpp"
#include "film_parts.hpp"
#include "owned_session.hpp"
#include "python_image.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

/// Core part of realcam.Session.
class PythonSession {
public:
    PythonSession(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                  const std::string& device)
        : session_(device, &make_session) {
        device_ = session_.use([](const auto& session) { return session->name(); });
        set(scene, camera, settings);
    }

    void set(const Assembly& scene, const Camera& camera, const RenderSettings& settings) {
        session_.use([&](const auto& session) {
            session->set(scene, camera, settings, heed_signals);
            const py::gil_scoped_acquire acquire;
            scene_ = scene;
            camera_ = camera;
            settings_ = settings;
        });
    }

    /// Returns work(session, progress), called with the current scene, camera and settings set, while this thread holds
    /// the session's lock and not the GIL.
    template <class Work>
    auto with_session(Work&& work) {
        return session_.use([&](const auto& session) {
            session->set(scene_, camera_, settings_, heed_signals);  // prepares the session again after an error
            return work(*session, [](double) { return heed_signals(); });
        });
    }

    void add(int spp) {
        with_session([&](Session& session, const Progress& progress) { session.add(spp, progress); });
    }

    /// Takes samples until a noise goal is reached, that of `settings`, whose other members are ignored.
    Typed<"_Reached", py::dict> add_until(const RenderSettings& settings) {
        const NoiseGoal goal = settings.noise.value_or(NoiseGoal());
        const ReachedNoise reached =
            with_session([&](Session& session, const Progress& progress) { return session.add_until(goal, progress); });
        return py::dict("noise"_a = reached.noise, "is_reached"_a = reached.is_reached,
                        "spp_wanted"_a = reached.samples_required, "shortfall"_a = shortfall_message(reached, goal));
    }

    /// Returns the picture of all samples so far. `plan`, here and below: summary of the plan, or empty.
    PythonImage image(const std::string& plan) {
        auto [image, camera, settings] = session_.use(
            [&](const auto& session) { return std::tuple(session->picture(heed_signals), camera_, settings_); });
        return python_image(std::move(image), camera, settings, plan);
    }

    /// Returns radiance sums of a region's pixels for `count` samples with indices from `first`, apart from this
    /// picture. `counts`: smaller number of samples for each pixel, row by row; std::nullopt: all of them.
    RegionSumArrays sample_region(const RegionNumbers& numbers, std::int64_t first, int count,
                                  const std::optional<InputArray<std::uint32_t>>& counts) {
        const FilmRegion region = region_from(numbers);
        std::vector<std::uint32_t> samples_per_pixel;
        if (counts) samples_per_pixel.assign(counts->data(), counts->data() + counts->size());
        return region_sums_to(with_session([&](Session& session, const Progress& progress) {
                                  return session.sample_region(region, first, count, samples_per_pixel, progress);
                              }),
                              region);
    }

    /// Returns layer sums of a region's pixels, of the first surfaces that these samples hit.
    VoidArray layer_sums_of_region(const RegionNumbers& numbers, std::int64_t first, int count) {
        const FilmRegion region = region_from(numbers);
        return layer_sums_to(with_session([&](Session& session, const Progress& progress) {
                                 return session.layer_sums_of_region(region, first, count, progress);
                             }),
                             region);
    }

    /// Returns the light on the whole film that is traced apart from the samples of pixels.
    SplatList sample_splats(std::int64_t first, int count) {
        return splats_to(with_session(
            [&](Session& session, const Progress& progress) { return session.sample_splats(first, count, progress); }));
    }

    /// Develops a film that was accumulated from parts, wherever they were exposed.
    PythonImage image_of(const FilmArrays& arrays, const StatNumbers& stats, const std::string& plan) {
        AccumulatedFilm film = arrays.film();
        film.stats = stats_from(stats);
        film.stats.device = device_;
        auto [image, camera, settings] = with_session([&](Session& session, const Progress&) {
            return std::tuple(session.picture_of(film, heed_signals), camera_, settings_);
        });
        return python_image(std::move(image), camera, settings, plan);
    }

    const std::string& device() const { return device_; }

    /// Returns the number of samples of each pixel, an array (H, W).
    py::array_t<std::int64_t> samples() {
        SampleCounts samples = session_.use([](const auto& session) { return session->sample_counts(heed_signals); });
        return array_from(std::move(samples.counts), {samples.height, samples.width});
    }

    void cancel() { session_.cancel(OnCancel::keep); }

    const Assembly& scene() const { return scene_; }
    const Camera& camera() const { return camera_; }

private:
    OwnedSession session_;
    std::string device_;
    Assembly scene_;  ///< current scene, camera and settings of the picture
    Camera camera_;
    RenderSettings settings_;
};

}  // namespace

void bind_session(py::module_& m) {
    py::class_<PythonSession>(m, "_Session", "Internal: use realcam.Session. One picture that accumulates samples.")
        .def(py::init<const Assembly&, const Camera&, const RenderSettings&, const std::string&>(), "scene"_a,
             "camera"_a, "settings"_a, "device"_a)
        .def("set", &PythonSession::set, "scene"_a, "camera"_a, "settings"_a,
             "Sets what is photographed. A change of the picture discards the samples.")
        .def("add", &PythonSession::add, "spp"_a, "Takes spp more samples of each pixel.")
        .def("add_until", &PythonSession::add_until, "settings"_a,
             "Takes samples until the noise goal of these settings is reached.")
        .def("image", &PythonSession::image, "plan"_a, "Returns an Image of all samples so far.")
        .def("sample_region", &PythonSession::sample_region, "region"_a, "first"_a, "count"_a, "counts"_a = py::none(),
             R"(Returns pixel sums of a region, for count samples with indices from first. region: (column, row, width,
height). counts: number of the samples that each pixel takes, row by row; None: all.)")
        .def("layer_sums_of_region", &PythonSession::layer_sums_of_region, "region"_a, "first"_a, "count"_a,
             "Returns layer sums of a region, of the first surfaces that these samples hit.")
        .def("sample_splats", &PythonSession::sample_splats, "first"_a, "count"_a,
             "Returns films of the light that is traced apart from the samples of pixels.")
        .def(
            "image_of",
            [](PythonSession& self, const InputArray<PixelSum>& pixels,
               const std::optional<InputArray<LayerSum>>& layers, const SplatList& splats, const StatNumbers& stats,
               const std::string& plan) { return self.image_of({pixels, layers, splats}, stats, plan); },
            "pixels"_a, "layers"_a, "splats"_a, "stats"_a, "plan"_a,
            "Returns an Image of a film that was accumulated from parts.")
        .def("cancel", &PythonSession::cancel, "Ends the running call of another thread, which raises Cancelled.")
        .def_property_readonly("device", &PythonSession::device, "Name of the device, for people.")
        .def_property_readonly("samples", &PythonSession::samples, "(H, W): number of samples of each pixel.")
        .def_property_readonly("scene", &PythonSession::scene, "The current scene.")
        .def_property_readonly("camera", &PythonSession::camera, "The current camera.");
}

}  // namespace realcam::bindings
