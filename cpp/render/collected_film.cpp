#include "collected_film.hpp"

#include <algorithm>

namespace realcam {

SplattedLight view_of(const std::vector<SplatFilm>& films) {
    SplattedLight light;
    for (std::size_t i = 0; i < std::min<std::size_t>(films.size(), kMostSplats); ++i) light.films[i] = films[i].view();
    return light;
}

}  // namespace realcam
