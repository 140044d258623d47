#include "lens_polynomial.hpp"

#include <cmath>

#include "../../math/hypotenuse.hpp"
#include "../../math/least_squares.hpp"
#include "../../math/random.hpp"
#include "../trace/lens_path.hpp"
#include "paraxial.hpp"

namespace realcam {

LensPolynomial::LensPolynomial(const LensSystem& lens, const PupilView& pupil, double film_radius) {
    const FirstOrder data = first_order(lens, lens.wavelength_nm);
    // In the plane of the entrance pupil rays are near the axis at every field angle.
    plane_ = std::isfinite(data.entrance_pupil_position) ? data.entrance_pupil_position : 0;
    focal_length_ = std::isfinite(data.effective_focal_length) ? std::fabs(data.effective_focal_length) : 1;
    film_radius_ = film_radius;
    last_radius_ = lens.surfaces.back().clear_semi_diameter;
    front_radius_ = lens.surfaces.front().clear_semi_diameter;
    last_rim_ = lens.surfaces.back().sag(last_radius_);
    front_rim_ = lens.surfaces.front().sag(front_radius_);
    constexpr std::uint32_t kFitRays = 1500, kTestRays = 750;
    constexpr std::size_t kMinFitRays = 200, kMinTestRays = 100;  // that pass the lens
    const std::vector<TracedRay> rays = traced_rays(lens, pupil, 0, kFitRays),
                                 others = traced_rays(lens, pupil, 1, kTestRays);
    if (rays.size() < kMinFitRays || others.size() < kMinTestRays)
        throw InputError("too few rays pass lens \"" + lens.name + "\" to fit polynomials to it");
    choose_degree(rays, others);
    drop_negligible_terms(others);
}

LensPolynomialView LensPolynomial::view() const {
    return {coefficients_.data(),
            monomial_count(degree_),
            degree_,
            static_cast<float>(1 / film_radius_),
            static_cast<float>(1 / last_radius_),
            static_cast<float>(plane_),
            static_cast<float>(last_radius_ * last_radius_),
            static_cast<float>(last_rim_),
            static_cast<float>(front_radius_ * front_radius_),
            static_cast<float>(front_rim_),
            nullptr,
            nullptr,
            0};
}

std::vector<double> LensPolynomial::monomials(const TracedRay& ray, int degree, double film_scale, double last_scale) {
    const Vec2d x = {film_scale * ray.film.x, film_scale * ray.film.y};
    const Vec2d p = {last_scale * ray.last.x, last_scale * ray.last.y};
    const double u = x.x * x.x + x.y * x.y, v = p.x * p.x + p.y * p.y, w = x.x * p.x + x.y * p.y;
    std::vector<double> values;
    for (int i = 0; i <= degree; ++i)
        for (int j = 0; i + j <= degree; ++j)
            for (int k = 0; i + j + k <= degree; ++k)
                values.push_back(std::pow(u, i) * std::pow(v, j) * std::pow(w, k));
    return values;
}

std::vector<LensPolynomial::TracedRay> LensPolynomial::traced_rays(const LensSystem& lens, const PupilView& pupil,
                                                                   std::uint32_t stream, std::uint32_t count) const {
    const LensPath<double> path(lens, LightDirection::to_scene, lens.wavelength_nm);
    LensView<double> to_stop = path.view();
    to_stop.count -= lens.stop_index();
    std::vector<TracedRay> found;
    for (std::uint32_t i = 0; i < count; ++i) {
        const Vec2f film_sample = sample_2d(stream, i, 0), u = sample_2d(stream, i, 1);
        const auto radius = static_cast<float>(film_radius_) * film_sample.x;
        const PupilSample sample = sample_pupil(pupil, radius, 0, u.x, u.y);
        if (!(sample.weight > 0)) continue;
        LensRays<double, 1> ray;
        const auto set_start = [&] {
            ray.origin.set(0, {static_cast<double>(radius), 0, lens.film_distance});
            ray.direction.set(0, static_cast<Vec3d>(sample.direction));
            ray.status[0] = 0;
        };
        set_start();
        const Vec3d inside = ray.direction[0];
        trace_lens(to_stop, ray);
        const Vec3d at_stop = ray.origin[0];
        set_start();
        trace_lens(path.view(), ray);
        if (ray.status[0] != 0) continue;
        const Vec3d direction = normalized(ray.direction[0]), origin = ray.origin[0];
        // Ray parameters: from the front surface to the plane of the positions, and, negated, from the film to the
        // plane of the last vertex.
        const double distance = (plane_ - origin.z) / direction.z, down = lens.film_distance / inside.z;
        found.push_back({{static_cast<double>(radius), 0},
                         {static_cast<double>(radius) - down * inside.x, -down * inside.y},
                         {{origin.x + distance * direction.x, origin.y + distance * direction.y},
                          {direction.x, direction.y},
                          {at_stop.x / lens.stop_semi_diameter, at_stop.y / lens.stop_semi_diameter}}});
    }
    return found;
}

void LensPolynomial::choose_degree(const std::vector<TracedRay>& rays, const std::vector<TracedRay>& others) {
    for (int degree = 0; degree <= kMaxDegree; ++degree) {
        const std::vector<float> fitted = fit(rays, degree);
        const PolynomialError error = error_of(fitted, degree, others);
        // A higher degree must reduce the error by 20% to be worth its time.
        if (degree > 0 && !(error.rms < 0.8 * error_.rms)) continue;
        coefficients_ = fitted;
        degree_ = degree;
        error_ = error;
    }
}

std::vector<float> LensPolynomial::fit(const std::vector<TracedRay>& rays, int degree) const {
    const auto count = static_cast<std::size_t>(monomial_count(degree));
    std::vector<std::vector<double>> columns(2 * count), targets(kVectors);
    for (const TracedRay& ray : rays) {
        const std::vector<double> values = monomials(ray, degree, 1 / film_radius_, 1 / last_radius_);
        for (const bool is_x : {true, false}) {
            const double x = (is_x ? ray.film.x : ray.film.y) / film_radius_;
            const double p = (is_x ? ray.last.x : ray.last.y) / last_radius_;
            for (std::size_t k = 0; k < count; ++k) {
                columns[2 * k].push_back(values[k] * x);
                columns[2 * k + 1].push_back(values[k] * p);
            }
            for (std::size_t t = 0; t < kVectors; ++t) targets[t].push_back(is_x ? ray.vectors[t].x : ray.vectors[t].y);
        }
    }
    const auto factors = least_squares(columns, targets);
    std::vector<float> coefficients;
    for (std::size_t k = 0; k < count; ++k)
        for (std::size_t t = 0; t < kVectors; ++t)
            for (const std::size_t i : {0u, 1u}) coefficients.push_back(static_cast<float>(factors[t][2 * k + i]));
    return coefficients;
}

LensPolynomialRay<float> LensPolynomial::evaluate_at(const LensPolynomialView& view, const TracedRay& ray) {
    const auto in_float = [](Vec2d v) { return Vec2f{static_cast<float>(v.x), static_cast<float>(v.y)}; };
    return evaluate(view, LensPolynomialArguments<float>(view, in_float(ray.film), in_float(ray.last)));
}

PolynomialError LensPolynomial::error_of(const std::vector<float>& coefficients, int degree,
                                         const std::vector<TracedRay>& rays) const {
    LensPolynomialView view = this->view();
    view.coefficients = coefficients.data();
    view.degree = degree;
    PolynomialError error;
    for (const TracedRay& ray : rays) {
        const Vec3f found = evaluate_at(view, ray).direction;
        const double error_mm = focal_length_ * hypotenuse(static_cast<double>(found.x) - ray.vectors[1].x,
                                                           static_cast<double>(found.y) - ray.vectors[1].y);
        error.rms += error_mm * error_mm / static_cast<double>(rays.size());
        if (error_mm > error.worst) {
            error.worst = error_mm;
            error.worst_film_radius = ray.film.x;
        }
    }
    error.rms = std::sqrt(error.rms);
    return error;
}

void LensPolynomial::drop_negligible_terms(const std::vector<TracedRay>& others) {
    const double max_rms = 1.01 * error_.rms;
    const double stop_error = stop_rms(coefficients_, others);
    for (float& coefficient : coefficients_) {
        const float original = coefficient;
        coefficient = 0;
        const PolynomialError error = error_of(coefficients_, degree_, others);
        if (error.rms > max_rms || stop_rms(coefficients_, others) > 1.01 * stop_error)
            coefficient = original;
        else
            error_ = error;
    }
}

double LensPolynomial::stop_rms(const std::vector<float>& coefficients, const std::vector<TracedRay>& rays) const {
    LensPolynomialView view = this->view();
    view.coefficients = coefficients.data();
    double sum = 0;
    for (const TracedRay& ray : rays) {
        const LensPolynomialRay<float> found = evaluate_at(view, ray);
        const auto squared_distance = [](Vec2f a, Vec2d b, double scale) {
            const double x = (static_cast<double>(a.x) - b.x) / scale, y = (static_cast<double>(a.y) - b.y) / scale;
            return x * x + y * y;
        };
        sum += squared_distance(found.at_stop, ray.vectors[2], 1) +
               squared_distance({found.position.x, found.position.y}, ray.vectors[0], front_radius_);
    }
    return std::sqrt(sum / static_cast<double>(rays.size()));
}

}  // namespace realcam
