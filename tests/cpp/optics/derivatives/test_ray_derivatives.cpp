// Derivatives of rays against central differences in 50 decimal digits. A step of 2^-20 of a number's scale is exact in
// double; the error of the difference is about its square, 1e-12 of the derivative, and that of the derivatives some
// roundings. 1e-9 is between both and a mistake.

#include <cmath>
#include <functional>

#include "doctest/doctest.h"
#include "form_oracle.hpp"
#include "optics/derivatives/adjoint_path.hpp"
#include "optics/derivatives/dual_path.hpp"
#include "optics/lens/lens_changes.hpp"
#include "refusal.hpp"
#include "traced_ray.hpp"
#include "variable_lens.hpp"

namespace {

using namespace realcam;
using namespace realcam::test;

/// Adds `step` to a number of the lens.
LensSystem changed(LensSystem lens, const LensVariable& v, double step) {
    if (v.quantity == LensQuantity::film_distance) {
        lens.film_distance += step;
        return lens;
    }
    Surface& s = lens.surfaces[static_cast<std::size_t>(v.surface)];
    const auto number = static_cast<std::size_t>(v.number);
    const auto part = [&](Vec3d& of) -> double& { return v.number == 0 ? of.x : v.number == 1 ? of.y : of.z; };
    const auto term = [](std::vector<double>& list, std::size_t i) -> double& {
        if (list.size() <= i) list.resize(i + 1, 0.0);
        return list[i];
    };
    if (v.quantity == LensQuantity::decentre || v.quantity == LensQuantity::tilt) s.placement.returns = moves_alone(s);
    switch (v.quantity) {
        case LensQuantity::curvature: s.curvature += step; break;
        case LensQuantity::conic: s.conic += step; break;
        case LensQuantity::aspheric: term(s.aspheric, number / 2 - 2) += step; break;
        case LensQuantity::thickness: s.thickness += step; break;
        case LensQuantity::index: s.material = Glass::constant(s.material.index(587.6) + step); break;
        case LensQuantity::decentre: part(s.placement.decentre) += step; break;
        case LensQuantity::tilt: part(s.placement.tilt_deg) += step; break;
        case LensQuantity::curvature_x: s.form.curvature_x += step; break;
        case LensQuantity::conic_x: s.form.conic_x += step; break;
        case LensQuantity::radial: term(s.form.radial, number - 1) += step; break;
        case LensQuantity::xy: s.form.xy.push_back({v.number, v.number_y, step}); break;
        case LensQuantity::terms: {
            int row = 0;
            for_each_kind_of_terms(s.form, [&](auto& terms) {
                if (row++ == v.row) term(terms->coefficients, number - terms->words.first_number) += step;
            });
            break;
        }
        case LensQuantity::film_distance: break;
    }
    return lens;
}

constexpr int kZernike = 0, kForbes = 1;  // rows of kFormTerms

/// A step that moves the surface by a micrometre or less at 8 mm from the vertex, a power of two.
double step_of(const LensVariable& v) {
    const auto at = [](int power) { return std::exp2(-20 - 3 * power); };
    switch (v.quantity) {
        case LensQuantity::aspheric:
        case LensQuantity::radial: return at(v.number);
        case LensQuantity::xy: return at(v.number + v.number_y);
        case LensQuantity::curvature:
        case LensQuantity::curvature_x: return at(2);
        default: return std::exp2(-20);
    }
}

using SevenNumbers = std::array<Real, 7>;

SevenNumbers seven(const FormRay& ray) {
    return {ray.origin.x, ray.origin.y, ray.origin.z, ray.direction.x, ray.direction.y, ray.direction.z, ray.path};
}

/// Error of seven derivatives, as a share of the largest of those of its kind: positions, directions, path.
double error_of(const SevenNumbers& wanted, const std::function<double(int)>& found, double least = 1e-6) {
    double worst = 0;
    for (const auto& [from, to] : {std::pair{0, 3}, {3, 6}, {6, 7}}) {
        Real error = 0, size = 0;
        for (int i = from; i < to; ++i) {
            const auto k = static_cast<std::size_t>(i);
            error += (wanted[k] - found(i)) * (wanted[k] - found(i));
            size += wanted[k] * wanted[k];
        }
        // A derivative of a value that does not depend on the variable must be 0 within rounding.
        worst = std::max(worst, static_cast<double>(sqrt(error) / std::max(sqrt(size), Real(least))));
    }
    return worst;
}

struct Start {
    Vec3d origin, towards;
};

/// The same in reverse mode: the adjoints of one ray's seven numbers, whose direction is a unit vector, one by one.
void check_adjoints(const LensSystem& lens, LightDirection way, const std::vector<LensVariable>& variables,
                    Vec3d origin, Vec3d towards) {
    const auto traced = [&](const LensSystem& of, const RealVector& o, const RealVector& p) {
        FormRay ray = form_oracle(of, way, o, p);
        ray.direction = (1 / sqrt(dot(ray.direction, ray.direction))) * ray.direction;
        return seven(ray);
    };
    const RealVector o = exact(origin), p = exact(towards);
    const AdjointPath path(lens, way, lens.wavelength_nm, variables);
    std::vector<double> by_variable[7];
    double by_start[7][6];
    for (int i = 0; i < 7; ++i) {
        double of[7] = {};
        of[i] = 1;
        by_variable[i] = path.gradient({1, &origin.x, &towards.x, of, of + 3, of + 6, by_start[i], by_start[i] + 3});
    }
    const auto check = [&](const SevenNumbers& above, const SevenNumbers& below, const Real& step, const auto& found) {
        SevenNumbers wanted;
        for (std::size_t i = 0; i < 7; ++i) wanted[i] = (above[i] - below[i]) / (2 * step);
        CHECK(error_of(wanted, found) < 1e-9);
    };
    for (std::size_t v = 0; v < variables.size(); ++v) {
        CAPTURE(static_cast<int>(variables[v].quantity));
        CAPTURE(variables[v].surface);
        const double h = step_of(variables[v]);
        check(traced(changed(lens, variables[v], h), o, p), traced(changed(lens, variables[v], -h), o, p), h,
              [&](int i) { return by_variable[i][v]; });
    }
    for (int j = 0; j < 6; ++j) {
        CAPTURE(j);
        const Real h = 1e-15;
        const auto moved = [&](const Real& step) {
            RealVector from = o, along = p;
            RealVector& part = j < 3 ? from : along;
            (j % 3 == 0 ? part.x : j % 3 == 1 ? part.y : part.z) += step;
            return traced(lens, from, along);
        };
        check(moved(h), moved(-h), h, [&](int i) { return by_start[i][j]; });
    }
}

void check_lens(const LensSystem& lens, LightDirection way, const std::vector<LensVariable>& variables,
                const std::vector<Start>& starts) {
    const DualPath path(lens, way, lens.wavelength_nm, variables, ExitFrame::lens);
    for (const Start& start : starts) {
        DualPath::Tape tape;
        RayDerivatives ray;
        const Vec3d towards = path.entry_index() * normalized(start.towards);
        REQUIRE(path.trace(start.origin - Vec3d{0, 0, path.entry_position()}, towards, tape) == RayStatus::ok);
        path.derivatives(tape, ray);
        const auto traced = [&](const LensSystem& of, const RealVector& o, const RealVector& p) {
            return seven(form_oracle(of, way, o, p));
        };
        const RealVector o = exact(start.origin), p = exact(towards);
        CHECK(error_of(
                  traced(lens, o, p),
                  [&](int i) {
                      const double numbers[7] = {ray.origin.x,    ray.origin.y,    ray.origin.z, ray.direction.x,
                                                 ray.direction.y, ray.direction.z, ray.path};
                      return numbers[i];
                  },
                  1) < 1e-13);
        for (std::size_t v = 0; v < variables.size(); ++v) {
            CAPTURE(v);
            CAPTURE(static_cast<int>(variables[v].quantity));
            CAPTURE(variables[v].surface);
            const double h = step_of(variables[v]);
            const SevenNumbers above = traced(changed(lens, variables[v], h), o, p),
                               below = traced(changed(lens, variables[v], -h), o, p);
            SevenNumbers wanted;
            for (std::size_t i = 0; i < 7; ++i) wanted[i] = (above[i] - below[i]) / (2 * Real(h));
            CHECK(error_of(wanted, [&](int i) { return ray.by_variable[7 * v + static_cast<std::size_t>(i)]; }) < 1e-9);
        }
        for (int j = 0; j < 6; ++j) {
            CAPTURE(j);
            const Real h = 1e-15;
            const auto moved = [&](const Real& step) {
                RealVector from = o, along = p;
                (j == 0   ? from.x
                 : j == 1 ? from.y
                 : j == 2 ? from.z
                 : j == 3 ? along.x
                 : j == 4 ? along.y
                          : along.z) += step;
                return traced(lens, from, along);
            };
            const SevenNumbers above = moved(h), below = moved(-h);
            SevenNumbers wanted;
            for (std::size_t i = 0; i < 7; ++i) wanted[i] = (above[i] - below[i]) / (2 * h);
            // The oracle makes directions unit vectors; the core takes their length for the index.
            const auto found = [&](int i) {
                const auto& by = ray.by_start[i];
                if (j < 3) return by[j];
                const double unit = 1 / length(towards);
                const Vec3d u = unit * towards;
                const double along = by[3] * u.x + by[4] * u.y + by[5] * u.z;
                return by[j] - along * (j == 3 ? u.x : j == 4 ? u.y : u.z);
            };
            CHECK(error_of(wanted, found) < 1e-9);
        }
        check_adjoints(lens, way, variables, start.origin, 3.0 * start.towards);
    }
}

const std::vector<Start> kFromScene = {
    {{0, 0, -10}, {0, 0, 1}}, {{3, -2, -10}, {0.1, 0.2, 1}}, {{-5, 1, -3}, {0.2, 0, 1}}};
const std::vector<Start> kFilmStarts = {{{0, 0, 50}, {0, 0, -1}}, {{8, -6, 60}, {-0.15, 0.1, -1}}};

}  // namespace

TEST_CASE("derivatives of rays through spheres, conics and aspheres, from either side") {
    const LensSystem lens = mixed_lens();
    check_lens(lens, LightDirection::to_film, shape_variables(), kFromScene);
    check_lens(lens, LightDirection::to_scene, shape_variables(), kFilmStarts);
}

TEST_CASE("derivatives by tilts and decentres of a lens that is still centred") {
    const LensSystem lens = mixed_lens();
    std::vector<LensVariable> variables = shape_variables();
    for (const int s : {0, 2, 3, 5})
        for (const LensVariable& v : tilts_and_decentres(s)) variables.push_back(v);
    check_lens(lens, LightDirection::to_film, variables, kFromScene);
    check_lens(lens, LightDirection::to_scene, variables, kFilmStarts);
}

TEST_CASE("derivatives of a lens with tilts, decentres and a mirror") {
    LensSystem lens = mixed_lens();
    lens.surfaces[1].placement = {{0.3, -0.2, 0.1}, {3, -2, 10}, false};
    lens.surfaces[4].placement = {{0, 0.5, 0}, {0, 5, 0}, true};
    std::vector<LensVariable> variables = shape_variables();
    for (const int s : {0, 1, 4, 5})
        for (const LensVariable& v : tilts_and_decentres(s)) variables.push_back(v);
    check_lens(lens, LightDirection::to_film, variables, kFromScene);
    check_lens(lens, LightDirection::to_scene, variables, {{{0, 0, 50}, {0.02, 0.01, -1}}});

    Surface mirror = refracting(-300, 0, Glass::air(), 30);
    mirror.type = SurfaceType::mirror;
    mirror.placement.tilt_deg = {45, 0, 0};
    mirror.conic = -1;
    Surface behind = refracting(60, 5, Glass::constant(1.5), 20);
    behind.placement = {{0, 20, -20}, {45, 0, 0}, false};  // the light goes to +y of the lens
    Surface last = refracting(-60, 0, Glass::air(), 20);
    last.thickness = 0;
    behind.thickness = -5;
    LensSystem folded = lens_of({stop_plane(40, 8), mirror, behind, last});
    folded.wavelength_nm = 587.6;
    std::vector<LensVariable> of_folded = {{LensQuantity::curvature, 1}, {LensQuantity::conic, 1},
                                           {LensQuantity::thickness, 0}, {LensQuantity::curvature, 2},
                                           {LensQuantity::index, 2},     {LensQuantity::thickness, 2}};
    for (const int s : {1, 2})
        for (const LensVariable& v : tilts_and_decentres(s)) of_folded.push_back(v);
    check_lens(folded, LightDirection::to_film, of_folded, {{{1, -2, -5}, {0.01, 0.02, 1}}});
}

TEST_CASE("derivatives by the coefficients of every form") {
    const auto with = [](double radius, double conic, const SurfaceForm& form) {
        Surface first = refracting(radius, 5, Glass::constant(1.6), 10);
        first.conic = conic;
        first.form = form;
        LensSystem lens = lens_of({first, refracting(-80, 0, Glass::air(), 12), stop_plane(0, 12)});
        lens.surfaces[1].thickness = 2;
        lens.wavelength_nm = 587.6;
        return lens;
    };
    const std::vector<LensVariable> shape = {{LensQuantity::curvature, 0},   {LensQuantity::conic, 0},
                                             {LensQuantity::aspheric, 0, 4}, {LensQuantity::aspheric, 0, 8},
                                             {LensQuantity::thickness, 0},   {LensQuantity::tilt, 0, 1}};
    const auto check = [&](const LensSystem& lens, std::vector<LensVariable> more) {
        more.insert(more.end(), shape.begin(), shape.end());
        check_lens(lens, LightDirection::to_film, more, {{{2, -3, -6}, {0.1, 0.05, 1}}, {{0.5, 4, -6}, {0, -0.1, 1}}});
    };
    SurfaceForm form;
    form.base = BaseForm::toroid;
    form.curvature_x = -1 / 60.0;
    check(with(40, 0.4, form), {{LensQuantity::curvature_x, 0}});
    form.base = BaseForm::biconic;
    form.conic_x = 2;
    check(with(40, 0.4, form), {{LensQuantity::curvature_x, 0}, {LensQuantity::conic_x, 0}});
    form = {};
    form.radial = {0.01, 1e-3, -2e-4, 0, 1e-6};
    check(with(60, -0.5, form),
          {{LensQuantity::radial, 0, 1}, {LensQuantity::radial, 0, 3}, {LensQuantity::radial, 0, 7}});
    form = {};
    form.xy = {{1, 0, 0.03}, {0, 3, -3e-4}, {2, 2, 5e-6}};
    check(with(-70, 1, form), {{LensQuantity::xy, 0, 1, 0}, {LensQuantity::xy, 0, 2, 2}, {LensQuantity::xy, 0, 3, 3}});
    form = {};
    form.zernike = ZernikeTerms{ZernikeOrder::noll, 11, {0, 0.1, -0.2, 0.05, 0.04, -0.06, 0.02, 0.01}};
    check(with(80, 0.2, form), {{LensQuantity::terms, 0, 2, 0, kZernike},
                                {LensQuantity::terms, 0, 5, 0, kZernike},
                                {LensQuantity::terms, 0, 8, 0, kZernike}});
    form.zernike->coefficients = {0, 0.1, 0, 0, 0, 0};  // a coefficient of 0 whose degree is above those of the others
    check(with(80, 0.2, form), {{LensQuantity::terms, 0, 6, 0, kZernike}});
    form = {};
    form.forbes = ForbesTerms{ForbesKind::con, 11, {0.1, -0.05, 0.02}};
    check(with(50, -0.7, form), {{LensQuantity::terms, 0, 0, 0, kForbes}, {LensQuantity::terms, 0, 2, 0, kForbes}});
    form.forbes->kind = ForbesKind::bfs;
    check(with(50, 0.1, form), {{LensQuantity::terms, 0, 0, 0, kForbes},
                                {LensQuantity::terms, 0, 1, 0, kForbes},
                                {LensQuantity::terms, 0, 2, 0, kForbes}});
}

TEST_CASE("adjoints of many rays add up, whatever the threads, and rays that end are left out") {
    const LensSystem lens = mixed_lens();
    const std::vector<LensVariable> variables = shape_variables();
    const AdjointPath path(lens, LightDirection::to_film, 587.6, variables);
    constexpr std::size_t kRays = 1500;  // neither whole parts nor whole blocks
    std::vector<double> origins, directions, of(3 * kRays), of_paths(kRays, 0.5), by(3 * kRays), along(3 * kRays);
    std::vector<double> wanted(variables.size()), sizes(variables.size());
    for (std::size_t i = 0; i < kRays; ++i) {
        const double x = i % 5 == 0 ? 100 : 0.005 * static_cast<double>(i), nan = std::nan("");
        origins.insert(origins.end(), {x, -2, -10}), directions.insert(directions.end(), {0.02, 0.1, 1});
        for (std::size_t j = 0; j < 3; ++j) of[3 * i + j] = x == 100 ? nan : std::sin(static_cast<double>(3 * i + j));
        if (x == 100) of_paths[i] = nan;
    }
    const auto request = [&](std::size_t first, std::size_t count) {
        const std::size_t at = 3 * first;
        return AdjointRequest{count,   &origins[at],     &directions[at], &of[at],
                              &of[at], &of_paths[first], &by[at],         &along[at]};
    };
    for (std::size_t i = 0; i < kRays; ++i) {
        const std::vector<double> one = path.gradient(request(i, 1));
        for (std::size_t v = 0; v < one.size(); ++v) wanted[v] += one[v], sizes[v] += std::fabs(one[v]);
        CHECK((by[3 * i + 1] == 0) == (origins[3 * i] == 100));
    }
    const std::vector<double> of_singles = by, along_singles = along;
    RayLoop backwards;
    backwards.run = [](std::size_t first, std::size_t last, const RayTask& task) {
        while (last-- > first) task(last, last + 1);
    };
    const std::vector<double> all = path.gradient(request(0, kRays));
    CHECK(all == path.gradient(request(0, kRays), backwards));
    for (std::size_t v = 0; v < all.size(); ++v) CHECK(std::fabs(all[v] - wanted[v]) <= 1e-13 * sizes[v]);
    CHECK(by == of_singles);
    CHECK(along == along_singles);
}

TEST_CASE("variables that make no sense are refused with one line") {
    const LensSystem lens = mixed_lens();
    const auto refused = [&](const LensVariable& v, const std::string& why) {
        CHECK(message_of([&] { check_variables(lens, {v}); }).find(why) != std::string::npos);
    };
    refused({LensQuantity::curvature, 9}, "there is no surface 9; the lens has 6, counted from 0");
    refused({LensQuantity::conic, 5}, "surface 6 is a plane: its conic has no effect");
    refused({LensQuantity::curvature, 3}, "only blocks light");
    refused({LensQuantity::index, 3}, "the same medium on both sides");
    refused({LensQuantity::thickness, 5}, "is the last");
    refused({LensQuantity::aspheric, 0, 5}, "powers 4, 6, ...");
    refused({LensQuantity::tilt, 0, 3}, "has axes from 0 to 2");
    refused({LensQuantity::curvature_x, 0}, "has one radius");
    refused({LensQuantity::terms, 0, 4, 0, kZernike}, "has no Zernike terms");
}
