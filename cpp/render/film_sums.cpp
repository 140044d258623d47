#include "film_sums.hpp"

#include <algorithm>

#include "../camera/code_table.hpp"
#include "wavelength_balance.hpp"

namespace realcam {

namespace {

/// visit(pixel, what lies around it) for some pixels of a film.
template <class Visit>
void for_surroundings(const FilmSums& film, FilmSize size, std::size_t first, std::size_t last, Visit&& visit) {
    const auto columns = static_cast<std::size_t>(size.width);
    std::vector<ExcessSum> of_columns;
    while (first < last) {
        const std::size_t row = first / columns, end = std::min(last, (row + 1) * columns);
        const int begin_column = static_cast<int>(first % columns) - ExcessSum::kReach,
                  end_column = static_cast<int>(end - row * columns) + ExcessSum::kReach;
        of_columns.clear();
        for (int x = begin_column; x < end_column; ++x)
            of_columns.push_back(ExcessSum::of_column(film.data(), size.width, size.height, x, static_cast<int>(row)));
        for (; first < end; ++first)
            visit(first, ExcessSum::around(static_cast<int>(first % columns), [&](int x) -> const ExcessSum& {
                      return of_columns[static_cast<std::size_t>(x - begin_column)];
                  }));
    }
}

/// take(place, exposure) for each channel of the film, at its place among them all.
template <class Take>
void for_exposures(const FilmSums& film, FilmSize size, bool balances, double exposure_time_s,
                   const SplattedLight& splatted, const RayLoop& loop, Take&& take) {
    const auto expose = [&](std::size_t i, int channel, double balance) {
        const double ghosts = splatted.irradiance(static_cast<std::int64_t>(i), channel);
        take(3 * i + static_cast<std::size_t>(channel), film[i].exposure(channel, exposure_time_s, ghosts, balance));
    };
    loop.run(0, film.size(), [&](std::size_t first, std::size_t last) {
        if (balances) {
            for_surroundings(film, size, first, last, [&](std::size_t i, const ExcessSum& around) {
                for (int c = 0; c < 3; ++c) expose(i, c, wavelength_balance(film[i], c, around.mean(c)));
            });
        } else {
            for (std::size_t i = first; i < last; ++i)
                for (int c = 0; c < 3; ++c) expose(i, c, 1);
        }
    });
}

}  // namespace

Image developed(const FilmSums& film, FilmSize size, bool balances, double exposure_time_s,
                const SplattedLight& splatted, const RayLoop& loop) {
    Image image;
    image.width = size.width;
    image.height = size.height;
    image.exposure = PictureFloats(3 * film.size());
    image.depth = PictureFloats(film.size());
    for_exposures(film, size, balances, exposure_time_s, splatted, loop,
                  [&](std::size_t place, float exposure) { image.exposure[place] = exposure; });
    for (std::size_t i = 0; i < film.size(); ++i) image.depth[i] = film[i].mean_depth();
    return image;
}

std::vector<std::uint8_t> developed_codes(const FilmSums& film, FilmSize size, bool balances, double exposure_time_s,
                                          double iso, ToneCurve curve, const SplattedLight& splatted,
                                          const RayLoop& loop) {
    std::vector<std::uint8_t> codes(3 * film.size());
    const CodeTable code_of(iso, curve);
    for_exposures(film, size, balances, exposure_time_s, splatted, loop,
                  [&](std::size_t place, float exposure) { codes[place] = code_of(exposure); });
    return codes;
}

LayerImage developed_variance(const FilmSums& film, double exposure_time_s, const SplattedLight& splatted) {
    LayerImage image{Layer::variance, {}, {}};
    image.values.reserve(3 * film.size());
    for (std::size_t i = 0; i < film.size(); ++i)
        for (int channel = 0; channel < 3; ++channel)
            image.values.push_back(
                film[i].variance(channel, exposure_time_s, splatted.variance(static_cast<std::int64_t>(i), channel)));
    return image;
}

namespace {

LayerImage developed_half(const FilmSums& film, Layer half, double exposure_time_s, const SplattedLight& splatted) {
    LayerImage image{half, {}, {}};
    image.values.reserve(3 * film.size());
    for (std::size_t i = 0; i < film.size(); ++i) {
        for (int channel = 0; channel < 3; ++channel) {
            const double ghosts = splatted.irradiance(static_cast<std::int64_t>(i), channel);
            const float right = film[i].right_exposure(channel, exposure_time_s, ghosts);
            image.values.push_back(
                half == Layer::dual_pixel_right ? right : film[i].exposure(channel, exposure_time_s, ghosts) - right);
        }
    }
    return image;
}

}  // namespace

std::vector<LayerImage> developed_besides(const FilmSums& film, LayerSet wanted, double exposure_time_s,
                                          const SplattedLight& splatted) {
    std::vector<LayerImage> images;
    if (wanted.has(Layer::variance)) images.push_back(developed_variance(film, exposure_time_s, splatted));
    for (const Layer half : {Layer::dual_pixel_left, Layer::dual_pixel_right})
        if (wanted.has(half)) images.push_back(developed_half(film, half, exposure_time_s, splatted));
    return images;
}

std::vector<std::int64_t> samples_of(const FilmSums& film) {
    std::vector<std::int64_t> counts;
    counts.reserve(film.size());
    for (const PixelSum& sum : film) counts.push_back(static_cast<std::int64_t>(sum.samples));
    return counts;
}

}  // namespace realcam
