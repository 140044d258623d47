// Polynomials that approximate a lens.

#include "optics/lens/lens_polynomial.hpp"

#include <cmath>

#include "about.hpp"
#include "doctest/doctest.h"
#include "measurement.hpp"
#include "optics/pupil/pupil.hpp"
#include "traced_ray.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

LensPolynomial fitted(const LensSystem& lens, double film_radius) {
    return {lens, Pupil(lens, film_radius).view(), film_radius};
}

}  // namespace

// A pixel is 5 um wide: pictures by these polynomials are indistinguishable from the lens's, so that the cost of both
// can be compared.
TEST_CASE("a double Gauss is a polynomial of some degree") {
    const LensSystem lens = io::read_lens("double-gauss-50mm");
    const LensPolynomial polynomial = fitted(lens, 21.6);
    CHECK(polynomial.degree() >= 7);
    hold({"Bundled lenses", "directions of polynomials fitted to double-gauss-50mm, against its rays", "750 rays",
          "core", "float32", 1000 * polynomial.error().rms, 1.0, "um"});
}

TEST_CASE("turned about the axis, a lens makes the same ray, turned") {
    const LensPolynomial polynomial = fitted(io::read_lens("tessar-50mm"), 21.6);
    const float c = 0.6f, s = 0.8f;
    const auto turned = [&](Vec2f v) { return Vec2f{c * v.x - s * v.y, s * v.x + c * v.y}; };
    const Vec2f film = {7, -3}, last = {2, 4};
    const LensPolynomialView view = polynomial.view();
    const LensPolynomialRay ray = evaluate(view, LensPolynomialArguments<float>(view, film, last)),
                            other = evaluate(view, LensPolynomialArguments<float>(view, turned(film), turned(last)));
    const auto same = [](Vec2f a, Vec2f b) { CHECK(std::hypot(a.x - b.x, a.y - b.y) < 1e-5f); };
    const auto across = [](Vec3f v) { return Vec2f{v.x, v.y}; };
    same(turned(across(ray.position)), across(other.position));
    same(turned(across(ray.direction)), across(other.direction));
    same(turned(ray.at_stop), other.at_stop);
}

// A ray's slope here is 5e-3 at most, and its seventh power is below the resolution of float32.
TEST_CASE("a lens that hardly bends light needs no high powers") {
    LensSystem lens = lens_of(
        {stop_plane(0, 0.5), refracting(1000, 1, Glass::constant(1.5), 5), refracting(-1000, 0, Glass::air(), 5)});
    lens.film_distance = 1000;
    const LensPolynomial polynomial = fitted(lens, 5);
    CHECK(polynomial.degree() <= 5);
    CHECK(polynomial.error().rms < 1e-3);  // mm, of a film 1 m away: 1e-6 of the slope
}
