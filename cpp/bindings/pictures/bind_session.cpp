#include <pybind11/numpy.h>
#include <pybind11/stl.h>

#include "../bindings.hpp"
#include "../values/arrays.hpp"
#include "film_parts.hpp"
#include "owned_session.hpp"
#include "picture.hpp"

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

    /// Returns take(session, progress) for the current scene, camera and settings, in one turn of the session.
    template <class Take>
    auto taken(Take&& take) {
        return session_.use([&](const auto& session) {
            session->set(scene_, camera_, settings_, heed_signals);  // prepares the session again after an error
            return take(*session, [](double) { return heed_signals(); });
        });
    }

    void add(int spp) {
        taken([&](Session& session, const Progress& progress) { session.add(spp, progress); });
    }

    /// `wanted`: settings; only their noise goal is used.
    Typed<"_Reached", py::dict> add_until(const RenderSettings& wanted) {
        const NoiseGoal goal = wanted.noise.value_or(NoiseGoal());
        const ReachedNoise reached =
            taken([&](Session& session, const Progress& progress) { return session.add_until(goal, progress); });
        return py::dict("noise"_a = reached.noise, "is_reached"_a = reached.is_reached,
                        "spp_wanted"_a = reached.samples_wanted, "shortfall"_a = shortfall_of(reached, goal));
    }

    PictureFields picture() {
        LayerSet layers;
        Image image = session_.use([&](const auto& session) {
            layers = settings_.layers;
            return session->picture(heed_signals);
        });
        return picture_from(std::move(image), layers);
    }

    RegionSumArrays expose_region(const RegionNumbers& numbers, std::int64_t first, int count,
                                  const std::optional<InputArray<std::uint32_t>>& counts) {
        const FilmRegion region = region_from(numbers);
        std::vector<std::uint32_t> of_pixels;
        if (counts) of_pixels.assign(counts->data(), counts->data() + counts->size());
        return region_sums_to(taken([&](Session& session, const Progress& progress) {
                                  return session.expose_region(region, first, count, of_pixels, progress);
                              }),
                              region);
    }

    VoidArray see_region(const RegionNumbers& numbers, std::int64_t first, int count) {
        const FilmRegion region = region_from(numbers);
        return layer_sums_to(taken([&](Session& session, const Progress& progress) {
                                 return session.see_region(region, first, count, progress);
                             }),
                             region);
    }

    SplatList expose_splats(std::int64_t first, int count) {
        return splats_to(taken(
            [&](Session& session, const Progress& progress) { return session.expose_splats(first, count, progress); }));
    }

    PictureFields picture_of(const FilmArrays& arrays, const StatNumbers& stats) {
        AccumulatedFilm film = arrays.film();
        film.stats = stats_from(stats);
        film.stats.device = device_;
        LayerSet layers;
        Image image = taken([&](Session& session, const Progress&) {
            layers = settings_.layers;
            return session.picture_of(film, heed_signals);
        });
        return picture_from(std::move(image), layers);
    }

    const std::string& device() const { return device_; }

    py::array_t<std::int64_t> samples() {
        SampleCounts samples = session_.use([](const auto& session) { return session->sample_counts(heed_signals); });
        return array_from(std::move(samples.counts), {samples.height, samples.width});
    }

    void cancel() { session_.cancel(Collected::keep); }

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
    py::class_<PythonSession>(m, "_Session")
        .def(py::init<const Assembly&, const Camera&, const RenderSettings&, const std::string&>(), "scene"_a,
             "camera"_a, "settings"_a, "device"_a)
        .def("set", &PythonSession::set, "scene"_a, "camera"_a, "settings"_a)
        .def("add", &PythonSession::add, "spp"_a)
        .def("add_until", &PythonSession::add_until, "wanted"_a)
        .def("picture", &PythonSession::picture)
        .def("expose_region", &PythonSession::expose_region, "region"_a, "first"_a, "count"_a, "counts"_a = py::none())
        .def("see_region", &PythonSession::see_region, "region"_a, "first"_a, "count"_a)
        .def("expose_splats", &PythonSession::expose_splats, "first"_a, "count"_a)
        .def(
            "picture_of",
            [](PythonSession& self, const InputArray<PixelSum>& pixels,
               const std::optional<InputArray<LayerSum>>& layers, const SplatList& splats,
               const StatNumbers& stats) { return self.picture_of({pixels, layers, splats}, stats); },
            "pixels"_a, "layers"_a, "splats"_a, "stats"_a)
        .def("cancel", &PythonSession::cancel)
        .def_property_readonly("device", &PythonSession::device)
        .def_property_readonly("samples", &PythonSession::samples)
        .def_property_readonly("scene", &PythonSession::scene)
        .def_property_readonly("camera", &PythonSession::camera);
}

}  // namespace realcam::bindings
