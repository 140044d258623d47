#include "dual_surface.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "../lens/lens_changes.hpp"
#include "../trace/film_frame.hpp"

namespace realcam {

namespace {

/// Calls f(a's number, b's number) for all differentiable numbers of two surface views.
template <class A, class B, class F>
void for_numbers(A& a, B& b, F&& f) {
    f(a.shift, b.shift);
    f(a.curvature, b.curvature);
    f(a.direction_sign_in, b.direction_sign_in);
    f(a.direction_sign_out, b.direction_sign_out);
    f(a.squared_index_change, b.squared_index_change);
    f(a.index_squared, b.index_squared);
    f(a.conic_factor, b.conic_factor);
    f(a.search_squared, b.search_squared);
    f(a.inverse_search_squared, b.inverse_search_squared);
    for (int i = 0; i < kMaxAsphericTerms; ++i) f(a.aspheric[i], b.aspheric[i]);
}

/// Same for two freeforms.
template <class A, class B, class F>
void for_form_numbers(A& a, B& b, F&& f) {
    f(a.middle_x, b.middle_x), f(a.middle_y, b.middle_y), f(a.half_x, b.half_x), f(a.half_y, b.half_y);
    f(a.reach, b.reach), f(a.inverse_reach, b.inverse_reach), f(a.term_size, b.term_size);
    f(a.curvature_x, b.curvature_x), f(a.curvature_y, b.curvature_y);
    f(a.conic_factor_x, b.conic_factor_x), f(a.conic_factor_y, b.conic_factor_y);
    for (int i = 0; i < kMaxAsphericTerms; ++i) f(a.section[i], b.section[i]);
    for (int i = 0; i < kMaxRadialTerms; ++i) f(a.radial[i], b.radial[i]);
    for (int i = 0; i < kMaxForbesTerms; ++i) f(a.forbes[i], b.forbes[i]);
    f(a.forbes_scale, b.forbes_scale), f(a.forbes_curvature_squared, b.forbes_curvature_squared);
    f(a.is_bfs, b.is_bfs);
    for (int i = 0; i < kXyCoefficients; ++i) f(a.xy[i], b.xy[i]);
}

/// Same for two vectors.
template <class A, class B, class F>
void for_vector_numbers(A& a, B& b, F&& f) {
    f(a.x, b.x), f(a.y, b.y), f(a.z, b.z);
}

/// Same for two dual surfaces: their views, forms, and frames.
template <class A, class B, class F>
void for_all_numbers(A& a, B& b, F&& f) {
    for_numbers(a.view, b.view, f);
    for (std::size_t i = 0; i < a.form.size(); ++i) for_form_numbers(a.form[i], b.form[i], f);
    for_vector_numbers(a.before.origin, b.before.origin, f);
    for_vector_numbers(a.before.x, b.before.x, f);
    for_vector_numbers(a.before.y, b.before.y, f);
    for_vector_numbers(a.before.z, b.before.z, f);
}

/// Returns a translation along z.
Affine<Dual8> dual_along_axis(const Dual8& distance) {
    Affine<Dual8> frame;
    frame.origin.z = distance;
    return frame;
}

/// Returns the inverse of a rotation with translation.
Affine<Dual8> inverse(const Affine<Dual8>& motion) {
    const Vec3<Dual8>&x = motion.x, &y = motion.y, &z = motion.z;
    Affine<Dual8> inverse{{x.x, y.x, z.x}, {x.y, y.y, z.y}, {x.z, y.z, z.z}, {0.0, 0.0, 0.0}};
    inverse.origin = -inverse.direction(motion.origin);
    return inverse;
}

/// SurfacePlacement::frame in dual numbers. Cosines and sines of right angles are exact, as they are there.
Affine<Dual8> frame_of(const Vec3<Dual8>& decentre, const Vec3<Dual8>& tilt_deg) {
    struct CosSin {
        Dual8 cos, sin;
    };
    const auto cos_sin = [](const Dual8& degrees) -> CosSin {
        const Vec3d y = SurfacePlacement{{0, 0, 0}, {degrees.value, 0, 0}, false}.frame().y;
        return {degrees.mapped(y.y, -y.z * kDegree), degrees.mapped(y.z, y.y * kDegree)};
    };
    const auto is_zero = [](const Dual8& angle) {
        bool any = angle.value != 0;
        for (int lane = 0; lane < kDualLanes; ++lane) any |= angle.by[lane] != 0;
        return !any;
    };
    if (is_zero(tilt_deg.x) && is_zero(tilt_deg.y) && is_zero(tilt_deg.z)) return {.origin = decentre};
    const CosSin a = cos_sin(tilt_deg.x), b = cos_sin(tilt_deg.y), c = cos_sin(tilt_deg.z);
    const Affine<Dual8> about_x{{1.0, 0.0, 0.0}, {0.0, a.cos, a.sin}, {0.0, -a.sin, a.cos}, decentre},
        about_y{{b.cos, 0.0, -b.sin}, {0.0, 1.0, 0.0}, {b.sin, 0.0, b.cos}, {0.0, 0.0, 0.0}},
        about_z{{c.cos, c.sin, 0.0}, {-c.sin, c.cos, 0.0}, {0.0, 0.0, 1.0}, {0.0, 0.0, 0.0}};
    return about_x * about_y * about_z;
}

/// Returns component 0 to 2 of a vector.
Dual8& component(Vec3<Dual8>& v, int axis) {
    return axis == 0 ? v.x : axis == 1 ? v.y : v.z;
}

/// Sets the derivative in `lane` to 1 for the shape's number that is the variable. Returns false if the variable is not
/// a number of the shape.
bool seed(ShapeNumbers<Dual8>& numbers, const LensVariable& variable, int lane) {
    const auto at = [](std::vector<Dual8>& list, int element) -> Dual8& {
        const auto index = static_cast<std::size_t>(element);
        if (list.size() <= index) list.resize(index + 1, 0.0);
        return list[index];
    };
    const auto xy = [&]() -> Dual8& {
        for (XyTermOf<Dual8>& term : numbers.xy)
            if (term.x == variable.number && term.y == variable.number_y) return term.coefficient;
        return numbers.xy.emplace_back(variable.number, variable.number_y, 0.0).coefficient;
    };
    switch (variable.quantity) {
        case LensQuantity::curvature: numbers.curvature.by[lane] = 1; return true;
        case LensQuantity::conic: numbers.conic.by[lane] = 1; return true;
        case LensQuantity::aspheric: at(numbers.aspheric, variable.number / 2 - 2).by[lane] = 1; return true;
        case LensQuantity::curvature_x: numbers.curvature_x.by[lane] = 1; return true;
        case LensQuantity::conic_x: numbers.conic_x.by[lane] = 1; return true;
        case LensQuantity::radial: at(numbers.radial, variable.number - 1).by[lane] = 1; return true;
        case LensQuantity::xy: xy().by[lane] = 1; return true;
        case LensQuantity::terms: {
            const auto row = static_cast<std::size_t>(variable.row);
            at(numbers.terms[row], variable.number - kFormNames[row].first_number).by[lane] = 1;
            return true;
        }
        default: return false;
    }
}

}  // namespace

DualLens::DualLens(const LensSystem& lens, double wavelength_nm, const std::vector<LensVariable>& variables,
                   std::size_t first) {
    std::vector<Dual8> thickness;
    std::vector<Vec3<Dual8>> decentre, tilt;
    for (const double n : lens.indices(wavelength_nm)) indices.emplace_back(n);
    for (const Surface& surface : lens.surfaces) {
        thickness.emplace_back(surface.thickness);
        decentre.push_back(static_cast<Vec3<Dual8>>(surface.placement.decentre));
        tilt.push_back(static_cast<Vec3<Dual8>>(surface.placement.tilt_deg));
    }
    film_distance = lens.film_distance;
    for (int lane = 0; lane < kDualLanes && first + static_cast<std::size_t>(lane) < variables.size(); ++lane) {
        const LensVariable& v = variables[first + static_cast<std::size_t>(lane)];
        const auto s = static_cast<std::size_t>(v.surface);
        switch (v.quantity) {
            case LensQuantity::thickness: thickness[s].by[lane] = 1; break;
            case LensQuantity::film_distance: film_distance.by[lane] = 1; break;
            case LensQuantity::index:
                indices[s + 1].by[lane] = 1;
                // Mirrors, stops and apertures have the same medium behind them.
                for (std::size_t k = s + 1; k < lens.surfaces.size(); ++k) {
                    if (lens.surfaces[k].type == SurfaceType::refracting) break;
                    indices[k + 1].by[lane] = 1;
                }
                break;
            case LensQuantity::decentre: component(decentre[s], v.number).by[lane] = 1; break;
            case LensQuantity::tilt: component(tilt[s], v.number).by[lane] = 1; break;
            default: break;
        }
    }
    vertices.emplace_back(0);
    for (std::size_t i = 0; i < thickness.size(); ++i) {
        placements.push_back(frame_of(decentre[i], tilt[i]));
        const bool is_last = i + 1 == thickness.size();
        vertices.push_back(vertices.back() + (is_last ? film_distance : thickness[i]));
    }
}

Affine<Dual8> DualLens::neighbour(const LensSystem& lens, int from, int to) const {
    if (to < from) return inverse(neighbour(lens, to, from));
    const auto here = static_cast<std::size_t>(from);
    const Affine<Dual8> to_next = dual_along_axis(vertices[here + 1] - vertices[here]) * placements[here + 1];
    return moves_alone(lens.surfaces[here]) ? inverse(placements[here]) * to_next : to_next;
}

Affine<Dual8> DualLens::frame(const LensSystem& lens, int surface) const {
    Affine<Dual8> frame = placements.front();
    for (int i = 0; i < surface; ++i) frame = frame * neighbour(lens, i, i + 1);
    return frame;
}

Affine<Dual8> DualLens::last_axis(const LensSystem& lens) const {
    return moves_alone(lens.surfaces.back()) ? placements.back() : Affine<Dual8>{};
}

Affine<Dual8> DualLens::film(const LensSystem& lens) const {
    const SurfacePlacement& own = lens.film_placement;
    const Affine<Dual8> on_axis = dual_along_axis(film_distance) * frame_of(static_cast<Vec3<Dual8>>(own.decentre),
                                                                            static_cast<Vec3<Dual8>>(own.tilt_deg));
    Affine<Dual8> film = inverse(on_axis) * last_axis(lens);
    // If light arrives from behind the film, film_path_ends turns its frame about y by 180 degrees.
    const std::optional<Affine<double>> exit = film_path_ends(lens, LightDirection::to_film).exit;
    if (exit && dot(exit->z, (surface_frames(lens).last_axis * own.frame()).z) < 0)
        film = Affine<Dual8>{{-1.0, 0.0, 0.0}, {0.0, 1.0, 0.0}, {0.0, 0.0, -1.0}, {0.0, 0.0, 0.0}} * film;
    return film;
}

DualSurface::DualSurface(const SurfaceView<double>& from, const Surface& surface,
                         const std::vector<LensVariable>& shape)
    : DualSurface() {
    SurfaceView<double> converted = from;
    std::vector<int> aspheric;
    for (const LensVariable& v : shape)
        if (v.quantity == LensQuantity::aspheric) aspheric.push_back(v.number);
    if (converted.kind == SurfaceShape::sphere || converted.kind == SurfaceShape::conic) {
        const auto is_conic = [](const LensVariable& v) { return v.quantity == LensQuantity::conic; };
        if (std::any_of(shape.begin(), shape.end(), is_conic)) converted.kind = SurfaceShape::conic;
        if (!aspheric.empty()) {
            const double reach = 1.02 * surface.clear_semi_diameter;
            converted.kind = SurfaceShape::asphere;
            converted.search_squared = reach * reach;
            converted.inverse_search_squared = 1 / converted.search_squared;
        }
    }
    for_numbers(view, converted, [](Dual8& to, double number) { to = number; });
    view.kind = converted.kind;
    view.surface_index = converted.surface_index;
    if (converted.kind != SurfaceShape::freeform) return;
    // The shape's numbers, with derivatives by all its variables, so that set_shape creates all terms that they
    // require.
    ShapeNumbers<Dual8> numbers(surface);
    for (const LensVariable& v : shape) seed(numbers, v, 0);
    const FreeformView<double> freeform = freeform_view<double>(surface);
    FreeformView<Dual8>& terms = form.emplace_back();
    for_form_numbers(terms, freeform, [](Dual8& to, double number) { to = number; });
    terms.xy_degree = -1;
    set_shape(terms, surface, numbers);
    for_form_numbers(terms, terms, [](Dual8& number, const Dual8&) { number.by = Dual8::Derivatives{}; });
}

void DualSurface::clear_lanes() {
    for_all_numbers(*this, *this, [](Dual8& number, const Dual8&) { number.by = Dual8::Derivatives{}; });
    variables.assign(kDualLanes, -1);
    powers.assign(kDualLanes, 0);
}

std::vector<int> DualSurface::lanes() const {
    bool used[kDualLanes] = {};
    for_all_numbers(*this, *this, [&](const Dual8& number, const Dual8&) {
        for (int lane = 0; lane < kDualLanes; ++lane) used[lane] |= number.by[lane] != 0;
    });
    std::vector<int> list;
    for (int lane = 0; lane < kDualLanes; ++lane)
        if (used[lane] || powers[static_cast<std::size_t>(lane)] != 0) list.push_back(lane);
    return list;
}

void DualSurface::copy_lane(int lane, const DualSurface& from, int from_lane) {
    for_all_numbers(*this, from, [&](Dual8& to, const Dual8& number) { to.by[lane] = number.by[from_lane]; });
    const auto to = static_cast<std::size_t>(lane), other = static_cast<std::size_t>(from_lane);
    variables[to] = from.variables[other];
    powers[to] = from.powers[other];
}

void seed_shape(DualSurface& dual, const Surface& surface, const LensVariable& variable, int lane) {
    if (dual.form.empty()) {
        if (variable.quantity == LensQuantity::curvature) dual.view.curvature.by[lane] = 1;
        if (variable.quantity == LensQuantity::conic) dual.view.conic_factor.by[lane] = 1;
        if (variable.quantity == LensQuantity::aspheric) dual.powers[static_cast<std::size_t>(lane)] = variable.number;
        return;
    }
    ShapeNumbers<Dual8> numbers(surface);
    if (!seed(numbers, variable, lane)) return;
    FreeformView<Dual8>& form = dual.form.front();
    FreeformView<Dual8> seeded{};
    seeded.inverse_reach = form.inverse_reach.value;
    seeded.xy_degree = form.xy_degree;
    set_shape(seeded, surface, numbers);
    for_form_numbers(form, seeded, [lane](Dual8& to, const Dual8& from) { to.by[lane] = from.by[lane]; });
}

}  // namespace realcam
