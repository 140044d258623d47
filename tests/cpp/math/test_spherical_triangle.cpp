// The solid angle of triangles, against its closed form in long double.

#include <cmath>
#include <random>

#include "math/spherical_triangle.hpp"
#include "measurement.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

using Vec3l = Vec3<long double>;

// van Oosterom and Strackee 1983, with the volume of the tetrahedron from its height.
double solid_angle(Vec3f a, Vec3f b, Vec3f c, double height) {
    const Vec3l u = static_cast<Vec3l>(a), v = static_cast<Vec3l>(b), w = static_cast<Vec3l>(c);
    const long double l = length(u), m = length(v), n = length(w),
                      volume = length(cross(v - u, w - u)) * static_cast<long double>(height);
    return static_cast<double>(2 * std::atan2(volume, l * m * n + dot(u, v) * n + dot(v, w) * l + dot(w, u) * m));
}

}  // namespace

TEST_CASE("the solid angle of a triangle is its closed form") {
    std::mt19937 engine(3);
    std::uniform_real_distribution<float> across(-1, 1);
    double worst = 0;
    int large = 0;
    for (int i = 0; i < 20000; ++i) {
        // In a plane below the point: from a hundredth of the triangle's size to a hundred times as far.
        const float height = std::pow(10.0f, 2 * across(engine));
        const auto corner = [&] { return Vec3f{across(engine), across(engine), -height}; };
        const Vec3f a = corner(), b = corner(), c = corner();
        const float double_area = length(cross(b - a, c - a));
        const double expected = solid_angle(a, b, c, static_cast<double>(height));
        const SphericalTriangle seen(a, b, c, double_area, height);
        worst = std::max(worst, std::fabs(static_cast<double>(seen.solid_angle) / expected - 1));
        large += expected > 3;
    }
    CHECK(large > 100);
    // The sum 1 + cosines is of the order of height^2 where the point is next to the plane and beside the triangle; its
    // terms are rounded to 6e-8 each. From a hundredth of the size 1e-7 may become 1e4 times as much.
    hold({"Samplers", "solid angle of triangles: closed form in long double",
          "20000 triangles, from 0.01 to 100 times their size", "core", "float32", worst, 1e-3, "of it"});
}
