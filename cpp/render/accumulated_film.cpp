#include "accumulated_film.hpp"

#include <algorithm>

namespace realcam {

SplattedLight view_of(const std::vector<SplatFilm>& films) {
    SplattedLight light;
    for (std::size_t i = 0; i < std::min<std::size_t>(films.size(), kMostSplats); ++i) light.films[i] = films[i].view();
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
