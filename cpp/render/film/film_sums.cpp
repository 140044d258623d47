#include "film_sums.hpp"

#include <algorithm>

#include "../../camera/film/develop.hpp"

namespace realcam {

namespace {

std::size_t pixels_of(const FilmView& film) {
    return static_cast<std::size_t>(film.pixel_count());
}

/// Calls visit(pixel index, PixelNeighbourhood) for the pixels [first, last) of a film. The sums of each column of a
/// row's neighbourhoods are computed once.
template <class Visit>
void for_neighbourhoods(const FilmView& film, std::size_t first, std::size_t last, Visit&& visit) {
    constexpr int kReach = PixelNeighbourhood::kReach;
    const auto columns = static_cast<std::size_t>(film.width);
    std::vector<PixelNeighbourhood> of_columns;
    while (first < last) {
        const std::size_t row = first / columns, end = std::min(last, (row + 1) * columns);
        const int begin_column = std::max(0, static_cast<int>(first % columns) - kReach),
                  end_column = std::min(film.width, static_cast<int>(end - row * columns) + kReach);
        of_columns.clear();
        for (int x = begin_column; x < end_column; ++x)
            of_columns.push_back(film.column_around(x, static_cast<int>(row)));
        for (; first < end; ++first)
            visit(first, PixelNeighbourhood::around(static_cast<int>(first % columns), film.width,
                                                    [&](int x) -> const PixelNeighbourhood& {
                                                        return of_columns[static_cast<std::size_t>(x - begin_column)];
                                                    }));
    }
}

/// Calls visit(pixel index, channel, splatted irradiance in lux, factor of the control variates) for each channel of
/// each pixel of a film.
template <class Visit>
void for_channels(const FilmView& film, const RayLoop& loop, Visit&& visit) {
    const auto visit_pixel = [&](std::size_t i, const PixelNeighbourhood& around) {
        film.for_channels(static_cast<std::int64_t>(i), around,
                          [&](int channel, double splatted, double factor) { visit(i, channel, splatted, factor); });
    };
    loop.run(0, pixels_of(film), [&](std::size_t first, std::size_t last) {
        if (film.control_variates.any()) return for_neighbourhoods(film, first, last, visit_pixel);
        for (std::size_t i = first; i < last; ++i) visit_pixel(i, {});
    });
}

/// Calls visit(index in the array of exposures, exposure in lux seconds) for each channel of each pixel.
template <class Visit>
void for_exposures(const FilmView& film, double exposure_time_s, const RayLoop& loop, Visit&& visit) {
    for_channels(film, loop, [&](std::size_t i, int channel, double splatted, double factor) {
        visit(3 * i + static_cast<std::size_t>(channel),
              film.pixels[i].exposure(channel, exposure_time_s, splatted, factor));
    });
}

}  // namespace

Image developed(const FilmView& film, double exposure_time_s, const RayLoop& loop) {
    Image image;
    image.width = film.width;
    image.height = film.height;
    const std::size_t pixels = pixels_of(film);
    image.exposure = PictureFloats(3 * pixels);
    image.depth = PictureFloats(pixels);
    for_exposures(film, exposure_time_s, loop,
                  [&](std::size_t index, float exposure) { image.exposure[index] = exposure; });
    for (std::size_t i = 0; i < pixels; ++i) image.depth[i] = film.pixels[i].mean_depth();
    return image;
}

std::vector<std::uint8_t> developed_codes(const FilmView& film, double exposure_time_s, double iso, ToneCurve curve,
                                          const RayLoop& loop) {
    std::vector<std::uint8_t> codes(3 * pixels_of(film));
    const CodeTable code_of(iso, curve);
    for_exposures(film, exposure_time_s, loop,
                  [&](std::size_t index, float exposure) { codes[index] = code_of(exposure); });
    return codes;
}

LayerImage developed_variance(const FilmView& film, double exposure_time_s) {
    LayerImage image{Layer::variance, {}, {}};
    image.values.reserve(3 * pixels_of(film));
    for (std::int64_t i = 0; i < film.pixel_count(); ++i)
        for (int channel = 0; channel < 3; ++channel)
            image.values.push_back(
                film.pixels[i].variance(channel, exposure_time_s, film.splatted.variance(i, channel)));
    return image;
}

LayerImage developed_traced(const FilmView& film, double exposure_time_s) {
    LayerImage image{Layer::traced_light, {}, {}};
    image.values.reserve(3 * pixels_of(film));
    for (std::int64_t i = 0; i < film.pixel_count(); ++i)
        for (int channel = 0; channel < 3; ++channel)
            image.values.push_back(film_exposure(film.splatted.irradiance(i, channel) * exposure_time_s));
    return image;
}

namespace {

/// Develops the layer of one dual-pixel half. `half`: one of kHalfLayers.
LayerImage developed_half(const FilmView& film, Layer half, double exposure_time_s) {
    LayerImage image{half, std::vector<float>(3 * pixels_of(film)), {}};
    for_channels(film, {}, [&](std::size_t i, int channel, double splatted, double factor) {
        const PixelSum& sum = film.pixels[i];
        const float right = sum.right_exposure(channel, exposure_time_s, splatted, factor);
        image.values[3 * i + static_cast<std::size_t>(channel)] =
            half == Layer::dual_pixel_right ? right : sum.exposure(channel, exposure_time_s, splatted, factor) - right;
    });
    return image;
}

}  // namespace

std::vector<LayerImage> developed_auxiliary_layers(const FilmView& film, LayerSet requested, double exposure_time_s) {
    std::vector<LayerImage> images;
    if (requested.has(Layer::variance)) images.push_back(developed_variance(film, exposure_time_s));
    if (requested.has(Layer::traced_light)) images.push_back(developed_traced(film, exposure_time_s));
    for (const Layer half : {Layer::dual_pixel_left, Layer::dual_pixel_right})
        if (requested.has(half)) images.push_back(developed_half(film, half, exposure_time_s));
    return images;
}

std::vector<std::int64_t> samples_of(const FilmSums& film) {
    std::vector<std::int64_t> counts;
    counts.reserve(film.size());
    for (const PixelSum& sum : film) counts.push_back(static_cast<std::int64_t>(sum.samples));
    return counts;
}

SplattedLight view_of(const std::vector<SplatFilm>& films) {
    SplattedLight light;
    for (std::size_t i = 0; i < std::min<std::size_t>(films.size(), kMaxGhostViews); ++i)
        light.films[i] = films[i].view();
    return light;
}

FilmView view_of(const FilmSums& pixels, int width, int height, const RenderSettings& settings,
                 const std::vector<SplatFilm>& splats) {
    return {pixels.data(), width, height, film_control_variates(settings), view_of(splats)};
}

std::vector<float> traced_exposure(const std::vector<SplatFilm>& films, double exposure_time_s) {
    const auto lit = std::find_if(films.begin(), films.end(), [](const SplatFilm& film) { return !film.sums.empty(); });
    if (lit == films.end()) return {};
    return developed_traced({nullptr, lit->width, lit->height, {}, view_of(films)}, exposure_time_s).values;
}

}  // namespace realcam
