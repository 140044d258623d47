// Accumulated samples of parts of a film as Python arrays, for realcam.FilmPart and realcam.Job.

#include "../../render/film/film_sums.hpp"
#include "../../render/session/adaptive_sampling.hpp"
#include "film_parts.hpp"

namespace realcam::bindings {

using namespace py::literals;

namespace {

constexpr std::pair<const char*, double RenderStats::*> kSeconds[] = {
    {"seconds", &RenderStats::seconds},
    {"lens_seconds", &RenderStats::lens_seconds},
    {"scene_seconds", &RenderStats::scene_seconds},
    {"other_seconds", &RenderStats::other_seconds},
};
constexpr std::pair<const char*, std::uint64_t RenderStats::*> kRays[] = {
    {"sampled_rays", &RenderStats::sampled_rays},
    {"passed_rays", &RenderStats::passed_rays},
    {"scene_rays", &RenderStats::scene_rays},
};

template <class T, class Array>
std::vector<T> values_of(const Array& array) {
    return std::vector<T>(array.data(), array.data() + array.size());
}

SplatFilm splat_film_from(const py::dict& splats) {
    const auto sums = splats["sums"].cast<InputArray<std::int64_t>>();
    if (sums.ndim() != 4 || sums.shape(3) != 3)
        throw InputError("sums of splats must be an array of shape (films, H, W, 3)");
    SplatFilm film;
    const int light = splats["light"].cast<int>();
    if (light < 0 || light >= kMaxGhostViews) throw InputError("the splats have an unknown kind of light");
    film.light = static_cast<GhostLight>(light);
    film.blocks = splats["blocks"].cast<std::vector<unsigned long long>>();
    film.units_per_lux = splats["units_per_lux"].cast<double>();
    film.height = static_cast<int>(sums.shape(1));
    film.width = static_cast<int>(sums.shape(2));
    if (film.blocks.size() != static_cast<std::size_t>(sums.shape(0)))
        throw InputError("blocks must have one number for each film of splats");
    film.sums.resize(static_cast<std::size_t>(sums.size()) / 3);
    for (std::size_t i = 0; i < film.sums.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c) film.sums[i].units[c] = sums.data()[3 * i + c];
    return film;
}

std::vector<SplatFilm> splat_films_from(const py::list& splats) {
    std::vector<SplatFilm> films;
    for (const py::handle& film : splats) films.push_back(splat_film_from(film.cast<py::dict>()));
    return films;
}

/// Returns the exposure of an accumulated film in lux seconds, an array (H, W, 3).
py::array_t<float> developed_exposure(const FilmArrays& arrays, const RenderSettings& settings,
                                      double exposure_time_s) {
    const AccumulatedFilm film = arrays.film();
    const auto height = arrays.pixels.shape(0), width = arrays.pixels.shape(1);
    Image image = [&] {
        const Unlocked unlocked;
        return developed(view_of(film.pixels, static_cast<int>(width), static_cast<int>(height), settings, film.splats),
                         exposure_time_s);
    }();
    return array_from(std::move(image.exposure), {height, width, 3});
}

/// Adaptive sampling of a film whose samples are taken elsewhere, in rounds (see AdaptiveSampling).
class Rounds {
public:
    Rounds(const RenderSettings& settings, double iso, const InputArray<float>& exposure,
           const InputArray<std::int64_t>& samples, const InputArray<float>& traced)
        : height_(samples.shape(0)),
          width_(samples.shape(1)),
          goal_(settings.noise.value_or(NoiseGoal())),
          tiles_(static_cast<int>(width_), static_cast<int>(height_), goal_, iso, floats_of(exposure),
                 values_of<std::int64_t>(samples), floats_of(traced)) {}

    py::array_t<std::uint32_t> next() { return array_from(tiles_.next(kInfinity), {height_, width_}); }

    bool traces_lights() const { return tiles_.traces_lights(); }

    void add(const InputArray<float>& exposure, const InputArray<std::uint32_t>& counts,
             const InputArray<float>& traced) {
        tiles_.add(floats_of(exposure), values_of<std::uint32_t>(counts), floats_of(traced));
    }

    std::string shortfall() const { return shortfall_message(tiles_.reached(), goal_); }
    double left() const { return tiles_.left(); }

private:
    static std::span<const float> floats_of(const InputArray<float>& array) {
        return {array.data(), static_cast<std::size_t>(array.size())};
    }

    py::ssize_t height_, width_;
    NoiseGoal goal_;
    AdaptiveSampling tiles_;
};

}  // namespace

AccumulatedFilm FilmArrays::film() const {
    if (pixels.ndim() != 2) throw InputError("sums of pixels must be an array of shape (H, W)");
    AccumulatedFilm film;
    film.pixels = values_of<PixelSum>(pixels);
    if (layers) film.layers = values_of<LayerSum>(*layers);
    film.splats = splat_films_from(splats);
    return film;
}

RegionSumArrays region_sums_to(RegionSums sums, const FilmRegion& region) {
    StatNumbers stats;
    for (const auto& [name, member] : kSeconds) stats[name] = sums.stats.*member;
    for (const auto& [name, member] : kRays) stats[name] = static_cast<double>(sums.stats.*member);
    return py::dict("pixels"_a = array_from(std::move(sums.pixels), {region.height, region.width}), "stats"_a = stats);
}

RenderStats stats_from(const StatNumbers& numbers) {
    RenderStats stats;
    for (const auto& [name, member] : kSeconds) stats.*member = numbers.at(name);
    for (const auto& [name, member] : kRays) stats.*member = static_cast<std::uint64_t>(numbers.at(name));
    return stats;
}

VoidArray layer_sums_to(std::vector<LayerSum> sums, const FilmRegion& region) {
    return array_from(std::move(sums), {region.height, region.width});
}

SplatList splats_to(std::vector<SplatFilm> films) {
    py::list list;
    for (const SplatFilm& film : films) {
        const auto count = static_cast<py::ssize_t>(film.blocks.size());
        py::array_t<std::int64_t> sums({count, py::ssize_t{film.height}, py::ssize_t{film.width}, py::ssize_t{3}});
        for (std::size_t i = 0; i < film.sums.size(); ++i)
            for (std::size_t c = 0; c < 3; ++c) sums.mutable_data()[3 * i + c] = film.sums[i].units[c];
        list.append(py::dict("light"_a = static_cast<int>(film.light), "sums"_a = sums, "blocks"_a = film.blocks,
                             "units_per_lux"_a = film.units_per_lux));
    }
    return list;
}

void bind_film_parts(py::module_& m) {
    // The dtypes' field names are those of files of film parts: a renamed member would change the file format.
    PYBIND11_NUMPY_DTYPE(PixelSum, irradiance, auxiliary, depth, met, samples, passed);
    PYBIND11_NUMPY_DTYPE(LayerSum, weight, met, normal, albedo, circle_mm);
    m.attr("_PIXEL_SUM") = py::dtype::of<PixelSum>();
    m.attr("_LAYER_SUM") = py::dtype::of<LayerSum>();
    m.attr("_TRACED_LIGHTS") = kMaxGhostViews;
    m.attr("_SAMPLES_PER_SUM") = kSamplesPerSum;
    m.attr("_SHARING_TILE_SIDE") = SampleSharing::kTileSide;
    py::set sampled_layers;
    for (std::size_t i = 0; i < kLayers.size(); ++i)
        if (kSampledLayers.has(static_cast<Layer>(i))) sampled_layers.add(kLayers[i].name);
    m.attr("_SAMPLED_LAYERS") = sampled_layers;
    m.def(
        "_developed_exposure",
        [](const InputArray<PixelSum>& pixels, const SplatList& splats, const RenderSettings& settings,
           double exposure_time_s) {
            return developed_exposure({pixels, std::nullopt, splats}, settings, exposure_time_s);
        },
        "pixels"_a, "splats"_a, "settings"_a, "exposure_time_s"_a,
        "Internal. Returns the exposure (H, W, 3) in lux seconds of accumulated pixel sums and splats.");
    m.def(
        "_traced_exposure",
        [](const SplatList& splats, double exposure_time_s) {
            const std::vector<SplatFilm> films = splat_films_from(splats);
            std::vector<float> exposure = traced_exposure(films, exposure_time_s);
            const py::ssize_t height = exposure.empty() ? 0 : films.front().height,
                              width = films.empty() ? 0 : films.front().width;
            return array_from(std::move(exposure), {height, width, 3});
        },
        "splats"_a, "exposure_time_s"_a,
        "Internal. Returns the exposure (H, W, 3) in lux seconds of the splats alone: light traced from the lights.");
    py::class_<Rounds>(m, "_Rounds", "Internal. Adaptive sampling of a picture whose samples are taken elsewhere.")
        .def(py::init<const RenderSettings&, double, const InputArray<float>&, const InputArray<std::int64_t>&,
                      const InputArray<float>&>(),
             "settings"_a, "iso"_a, "exposure"_a, "samples"_a, "traced"_a,
             R"(settings: only their noise goal is used. exposure: (H, W, 3), of the samples so far, lux seconds;
samples: (H, W), their number in each pixel. traced: part of the exposure traced from the lights; empty if there is
none.)")
        .def_static(
            "first_samples",
            [](const RenderSettings& settings) {
                return AdaptiveSampling::first_samples(settings.noise.value_or(NoiseGoal()));
            },
            "settings"_a, "Returns the number of samples per pixel of the first round.")
        .def("next", &Rounds::next,
             "Returns how many more samples each pixel needs in the next round, (H, W); all 0 when finished.")
        .def_property_readonly("traces_lights", &Rounds::traces_lights,
                               "True if light is to be traced from the lights in the next round.")
        .def("add", &Rounds::add, "exposure"_a, "counts"_a, "traced"_a,
             "Adds the picture after a round. exposure, traced: of all samples; counts: samples of the round, (H, W).")
        .def("left", &Rounds::left, "Returns the approximate number of samples, over all pixels, still required.")
        .def("shortfall", &Rounds::shortfall,
             "Returns a sentence if the noise goal has not been reached, otherwise an empty text.");
}

}  // namespace realcam::bindings
