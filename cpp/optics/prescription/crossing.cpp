#include "crossing.hpp"

#include <algorithm>

namespace realcam {

std::vector<Crossing> crossings_of(const LensSystem& lens) {
    std::vector<Crossing> crossings;
    for (int i = 0; i < static_cast<int>(lens.surfaces.size()); ++i) crossings.push_back({i, true, false});
    return crossings;
}

std::vector<Crossing> crossings_of(const LensSystem& lens, GhostPair pair) {
    std::vector<Crossing> crossings;
    for (int i = 0; i < pair.first; ++i) crossings.push_back({i, true, false});
    crossings.push_back({pair.first, true, !is_film(lens, pair.first)});
    for (int i = pair.first - 1; i > pair.second; --i) crossings.push_back({i, false, false});
    crossings.push_back({pair.second, false, true});
    for (int i = pair.second + 1; i < static_cast<int>(lens.surfaces.size()); ++i)
        crossings.push_back({i, true, false});
    return crossings;
}

std::vector<Crossing> reversed(std::vector<Crossing> crossings) {
    std::reverse(crossings.begin(), crossings.end());
    for (Crossing& crossing : crossings)
        if (!crossing.is_reflected) crossing.in_order = !crossing.in_order;
    return crossings;
}

std::vector<GhostPair> ghost_pairs(const LensSystem& lens, int first_begin, int first_end) {
    std::vector<GhostPair> pairs;
    const auto refracts = [&](int i) {
        return lens.surfaces[static_cast<std::size_t>(i)].type == SurfaceType::refracting;
    };
    for (int first = first_begin; first < first_end; ++first)
        for (int second = 0; second < first; ++second)
            if ((is_film(lens, first) || refracts(first)) && refracts(second)) pairs.push_back({first, second});
    return pairs;
}

std::vector<GhostPair> film_ghost_pairs(const LensSystem& lens) {
    const int film = static_cast<int>(lens.surfaces.size());
    return ghost_pairs(lens, film, film + 1);
}

}  // namespace realcam
