#include "film_pupil.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "../../math/hypotenuse.hpp"
#include "../lens/parabasal.hpp"
#include "../pupil/bundle_quadrature.hpp"
#include "../pupil/film_surface.hpp"

namespace realcam {

namespace {

/// All light of one film point, by its optical direction cosines in the film's tangent plane: in them it is even.
class FilmPointLight {
public:
    using Entry = Vec2<double>;

    bool mirrored = false;
    Entry middle, reach;

    FilmPointLight(const LensSystem& lens, double wavelength_nm, Vec2<double> at, const ParabasalRays& rays)
        : path_(lens, LightDirection::to_scene, wavelength_nm, film_path_ends(lens, LightDirection::to_scene)),
          film_{lens.film_distance, 1 / lens.film_radius_of_curvature},
          at_(at) {
        const double radius = std::min(lens.stop_semi_diameter, lens.stop().clear_semi_diameter);
        const Matrix2 by_stop = rays.stop_by_film_direction.inverse();
        const Vec3d x = film_.direction(at, {1, 0, 0}), y = film_.direction(at, {0, 1, 0});
        const Vec3d chief = -path_.entry_index * rays.chief.film_direction;
        middle = {dot(chief, x), dot(chief, y)};
        reach = {radius * hypotenuse(by_stop.first.x, by_stop.first.y),
                 radius * hypotenuse(by_stop.second.x, by_stop.second.y)};
    }

    template <int N>
    void pass(const Entry (&entries)[N], bool (&passed)[N]) const {
        LensRays<double, N> rays;
        const double n = path_.entry_index;
        const Vec3d from = film_.place(at_);
        for (int i = 0; i < N; ++i) {
            const auto [l, m] = entries[i];
            const double rest = n * n - l * l - m * m;
            rays.origin.set(i, from);
            rays.direction.set(i, film_.direction(at_, {l, m, -sqrt_or_zero(rest)}));
            rays.status[i] = rest > 0 ? 0 : static_cast<int>(RayStatus::missed);
        }
        trace_lens(path_.view(), rays);
        for (int i = 0; i < N; ++i) passed[i] = rays.status[i] == 0;
    }

private:
    LensPath<double> path_;
    FilmSurface<double> film_;
    Vec2<double> at_;
};

/// Pieces between the edges of neighbouring spokes. Where the light ends between two spokes, along the lit one.
std::vector<std::array<Vec2<double>, 2>> outline_of(const FilmPointLight& light, const std::vector<LitSpoke>& spokes) {
    std::vector<std::array<Vec2<double>, 2>> pieces;
    const auto towards_film = [&](const LitSpoke& spoke, double r) {
        const Vec2<double> entry = spoke.at(light, r);
        return Vec2<double>{-entry.x, -entry.y};
    };
    for (std::size_t s = 0; s < spokes.size(); ++s) {
        const LitSpoke &here = spokes[s], &next = spokes[(s + 1) % spokes.size()];
        const std::size_t both = std::min(here.stretches.size(), next.stretches.size());
        for (std::size_t i = 0; i < both; ++i) {
            const Stretch &a = here.stretches[i], &b = next.stretches[i];
            if (a.from != 0 || b.from != 0) pieces.push_back({towards_film(here, a.from), towards_film(next, b.from)});
            pieces.push_back({towards_film(here, a.to), towards_film(next, b.to)});
        }
        for (const LitSpoke* longer : {&here, &next})
            for (std::size_t i = both; i < longer->stretches.size(); ++i)
                pieces.push_back(
                    {towards_film(*longer, longer->stretches[i].from), towards_film(*longer, longer->stretches[i].to)});
    }
    return pieces;
}

}  // namespace

FilmPupil film_pupil(const LensSystem& lens, double wavelength_nm, Vec2<double> film, const RayLoop& loop) {
    constexpr int kSpokes = 128;
    const RaysFromFilm rays(lens, wavelength_nm);
    const std::optional<ChiefRay> chief = chief_ray_of_film_point(rays, film);
    if (!chief) return {};
    const FilmPointLight light(lens, wavelength_nm, film, parabasal_rays(lens, rays, *chief));
    const std::vector<LitSpoke> spokes = lit_spokes(light, kSpokes, loop);
    double squares = 0;
    for (const LitSpoke& spoke : spokes)
        for (const Stretch& stretch : spoke.stretches) squares += stretch.to * stretch.to - stretch.from * stretch.from;
    const double each = std::numbers::pi / static_cast<double>(spokes.size());
    return {each * light.reach.x * light.reach.y * squares, outline_of(light, spokes)};
}

}  // namespace realcam
