#include "film_sums.hpp"

#include "../camera/code_table.hpp"
#include "wavelength_balance.hpp"

namespace realcam {

namespace {

/// take(place, exposure) for each channel of the film, at its place among them all.
template <class Take>
void for_exposures(const FilmSums& film, FilmSize size, bool balances, double exposure_time_s,
                   const SplattedLight& splatted, const RayLoop& loop, Take&& take) {
    const auto expose = [&](std::size_t i, int channel, double balance) {
        const double ghosts = splatted.irradiance(static_cast<std::int64_t>(i), channel);
        take(3 * i + static_cast<std::size_t>(channel), film[i].exposure(channel, exposure_time_s, ghosts, balance));
    };
    loop.run(0, film.size(), [&](std::size_t first, std::size_t last) {
        for (std::size_t i = first; i < last; ++i) {
            if (!balances) {
                for (int c = 0; c < 3; ++c) expose(i, c, 1);
                continue;
            }
            const auto columns = static_cast<std::size_t>(size.width);
            const MeanExcess mean(film.data(), size.width, size.height, static_cast<int>(i % columns),
                                  static_cast<int>(i / columns));
            for (int c = 0; c < 3; ++c) expose(i, c, wavelength_balance(film[i], c, mean.of[c]));
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
