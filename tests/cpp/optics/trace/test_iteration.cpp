// Every search of the core ends within a stated number of steps, whatever it is given, and gives no point as good that
// it has not found.

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "math/random.hpp"
#include "math/root.hpp"
#include "measurement.hpp"
#include "optics/lens/best_focus.hpp"
#include "optics/pupil/pupil.hpp"
#include "pupil_region.hpp"
#include "traced_ray.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

struct SearchEnd {
    int steps = 0;
    bool found = false;
};

/// The search of cross_asphere for one ray, step by step. The ray is relative to the surface's vertex.
template <class T>
SearchEnd search_asphere(const SurfaceView<T>& step, Vec3<T> o, Vec3<T> p) {
    T t, below, above, residual = 0, tolerance = 0;
    const T outside = begin_search(step, o, p, t, below, above);
    if (outside > T(0) && !find_bracket(step, o, p, t, below, above) && outside > kSideways<T> / 2) return {};
    SearchEnd end;
    while (end.steps < kMaxAsphereSteps<T>) {
        const bool halve = end.steps >= kNewtonSteps && end.steps % 2 == 0;
        improve_search(step, o, p, halve, t, below, above, residual, tolerance);
        ++end.steps;
        if (!(residual > tolerance)) break;
    }
    end.found = residual <= tolerance;
    return end;
}

struct Steps {
    int worst = 0, unfound = 0, unfound_but_passed = 0;
    long rays = 0;

    template <class T>
    void take(const SurfaceView<T>& step, Vec3<T> o, Vec3<T> p) {
        const SearchEnd end = search_asphere(step, o, p);
        LensRays<T, 1> ray;
        ray.origin.set(0, o);
        ray.direction.set(0, p);
        ray.status[0] = 0;
        SurfaceView<T> alone = step;
        alone.shift = 0;
        trace_lens(LensView<T>{&alone, 1, LensKind::rotational, {}}, ray, PathRecord<T, 1>{});
        worst = std::max(worst, end.steps);
        unfound += static_cast<int>(!end.found);
        unfound_but_passed += static_cast<int>(!end.found && ray.status[0] == 0);
        ++rays;
    }
};

/// Every asphere of a lens, with the rays that reach it from the film.
template <class T>
Steps steps_in_lens(const LensSystem& lens) {
    const LensPath<T> path(lens, LightDirection::to_scene, lens.wavelength_nm);
    const LensView<T> view = path.view();
    Random random(5);
    Steps steps;
    for (int i = 0; i < 3000; ++i) {
        const Vec3d film = point_on_film(lens, random), target = point_on_last_surface(lens, random);
        LensRays<T, 1> ray;
        ray.origin.set(0, static_cast<Vec3<T>>(film - Vec3d{0, 0, lens.last_vertex()}));
        ray.direction.set(0, static_cast<Vec3<T>>(normalized(target - film)));
        ray.status[0] = 0;
        for (int k = 0; k < view.count && ray.status[0] == 0; ++k) {
            const SurfaceView<T>& step = view.surfaces[k];
            Vec3<T> o = ray.origin[0];
            o.z -= step.shift;
            if (step.kind == SurfaceShape::asphere) steps.take(step, o, ray.direction[0]);
            trace_lens(LensView<T>{&step, 1, LensKind::rotational, {}}, ray, PathRecord<T, 1>{});
        }
    }
    return steps;
}

/// Aspheres whose terms nearly cancel, stand on end at the rim, or are as large as validate() lets them be; rays from
/// all sides, some of them no numbers.
template <class T>
Steps steps_in_absurdities() {
    Random random(9);
    Steps steps;
    const T nan = std::numeric_limits<T>::quiet_NaN(), most = std::numeric_limits<T>::max();
    for (int trial = 0; trial < 400; ++trial) {
        const double rim = std::pow(10.0, random.between(-6, 6));
        Surface surface = refracting(rim * random.between(1.001, 50), 0, Glass::constant(1.5), rim);
        surface.conic = trial % 2 ? random.between(-20, 0) : 0;
        const double lift = std::pow(10.0, random.between(-6, 3));
        for (int i = 0; i < kMaxAsphericTerms; ++i)
            surface.aspheric.push_back(random.between(-lift, lift) * std::pow(rim, -3 - 2 * i));
        const LensPath<T> path(lens_of({surface}), LightDirection::to_film, kLineD_nm);
        const SurfaceView<T> step = path.view().surfaces[0];
        for (int i = 0; i < 100; ++i) {
            const double scale = rim * std::pow(10.0, random.between(-3, 3));
            const auto any = [&] { return static_cast<T>(scale * random.between(-1, 1)); };
            const Vec3<T> o{any(), any(), any()};
            Vec3<T> p = static_cast<Vec3<T>>(
                normalized(Vec3d{random.between(-1, 1), random.between(-1, 1), random.between(-1, 1)}));
            if (i % 10 == 0) p.z = 0;
            if (i % 10 == 1) p = {0, 0, i % 20 == 1 ? T(1) : T(-1)};
            steps.take(step, o, p);
        }
        for (const T wrong :
             {nan, most, -most, T(0), std::numeric_limits<T>::denorm_min(), std::numeric_limits<T>::infinity()}) {
            steps.take(step, {wrong, 0, 0}, {0, 0, 1});
            steps.take(step, {0, wrong, wrong}, {0, 0, 1});
            steps.take(step, {0, 0, T(-1)}, {wrong, 0, 1});
            steps.take(step, {0, 0, T(-1)}, {0, wrong, wrong});
        }
    }
    return steps;
}

template <class T>
void check_asphere_search(const char* number_type) {
    const Steps made = steps_in_lens<T>(io::read_lens("phone-4mm")), absurd = steps_in_absurdities<T>();
    CHECK(made.unfound_but_passed == 0);
    CHECK(absurd.unfound_but_passed == 0);
    hold({"Iteration", "search on the 12 aspheres of a phone lens", std::to_string(made.rays) + " rays", "core",
          number_type, static_cast<double>(made.worst), kNewtonSteps + 1,
          "steps"});  // the last one sees that it is there
    hold({"Iteration", "search on absurd aspheres, some rays no numbers", std::to_string(absurd.rays) + " rays", "core",
          number_type, static_cast<double>(absurd.worst), kMaxAsphereSteps<T>, "steps"});
}

/// Calls of find_root, and how near the root it came.
struct RootEnd {
    int calls = 0;
    Root root{};
};
template <class F>
RootEnd root_of(F&& f, double a, double b, double tolerance = 0) {
    RootEnd end;
    const double f_a = f(a), f_b = f(b);
    end.root = find_root([&](double x) { return ++end.calls, f(x); }, a, f_a, b, f_b, tolerance);
    return end;
}

}  // namespace

TEST_CASE("the search on an asphere ends within its bound, and lets no ray pass that it has not placed") {
    check_asphere_search<double>("float64");
    check_asphere_search<float>("float32");
}

TEST_CASE("the root search of focusing ends within its bound, on functions that have no root too") {
    int worst = 0, count = 0;
    double off = 0;
    const auto tried = [&](const RootEnd& end) {
        worst = std::max(worst, end.calls);
        ++count;
        return end.root;
    };
    for (const double root : {0.0, 1e-300, 1e-9, 0.3, 7.0, 1e9}) {
        const double reach = 1e12;
        for (int power = 1; power <= 9; power += 2) {  // flat ones have many numbers for a root
            const Root end = tried(root_of([&](double x) { return std::pow(x - root, power); }, -1, reach));
            if (power == 1) off = std::max(off, std::fabs(end.at - root) / std::max(root, 1e-9));
        }
        tried(root_of([&](double x) { return x < root ? -1.0 : 1.0; }, -1, reach));         // a jump
        tried(root_of([&](double x) { return x < root ? -1e-300 : 1e300; }, -1, reach));
        const Root pole = tried(root_of([&](double x) { return 1e9 / (x - root); }, root - 1.3, root + 3.1));
        CHECK_FALSE(std::fabs(pole.value) <= 1e-9);  // which the caller takes for no root
        tried(root_of([&](double x) { return std::exp(x - root) - 1; }, -700, root + 700));
        tried(root_of([&](double x) { return x < root ? -1.0 : std::nan(""); }, -1, reach));
    }
    CHECK(std::isnan(tried(root_of([](double x) { return x < 0 ? -1.0 : x > 1 ? 1.0 : std::nan(""); }, -1, 3)).value));
    tried(root_of([](double) { return std::nan(""); }, 0, 1));
    tried(root_of([](double x) { return x; }, -1e308, 1e308));
    tried(root_of([](double x) { return x - 1; }, -kInfinity, kInfinity));
    hold({"Iteration", "root search of focusing: smooth, flat, jumps, poles, NaN", std::to_string(count) + " functions",
          "core", "float64", static_cast<double>(worst), kMaxRootCalls, "calls"});
    hold({"Iteration", "root search of focusing: simple roots from 0 to 1e9 in a bracket of 1e12", "6 functions",
          "core", "float64", off, 0x1p-52, "of the root"});
}

TEST_CASE("the root search of focusing has all digits after a dozen calls") {
    int worst = 0, count = 0;
    double off = 0;
    const auto tried = [&](auto&& f, double a, double b, double root) {
        const RootEnd end = root_of(f, a, b, 1e-14);
        worst = std::max(worst, end.calls);
        off = std::max(off, std::fabs(end.root.at - root) / root);
        ++count;
    };
    tried([](double x) { return x * x - 2; }, 0, 2, std::sqrt(2.0));
    tried([](double x) { return x * x * x - 3; }, 1, 2, std::cbrt(3.0));
    tried([](double x) { return std::exp(x) - 2; }, 0, 1, std::log(2.0));
    tried([](double x) { return std::sin(x) - 0.5; }, 0, 1, M_PI / 6);
    // Object to film of a thin lens of focal length 1, less 100, each a share of it; as focusing asks, by the far
    // branch.
    tried([](double s) { return (s + s / (s - 1)) / 100 - 1; }, 2, 100, 50 + std::sqrt(2400.0));
    // Two or three calls until the secant is a good one, with a tenth left; seven that bring one digit to sixteen, as
    // 3^(7/3) = 13; and one that begins the next three.
    hold({"Iteration", "root search of focusing: smooth functions with simple roots",
          std::to_string(count) + " functions", "core", "float64", static_cast<double>(worst), 12, "calls"});
    // Values are within 1e-14, and slope times root is at least 0.45 in all of them.
    hold({"Iteration", "root search of focusing: smooth functions, the root", std::to_string(count) + " functions",
          "core", "float64", off, 1e-14 / 0.45, "of the root"});
}

TEST_CASE("the quadrature of best focus has its nodes to the last digits") {
    const best_focus_detail::GaussRule<32> rule;
    double worst = 0;
    for (int power = 0; power <= 63; ++power) {
        double sum = 0;
        for (int k = 0; k < 32; ++k) sum += rule.weight[k] * std::pow(rule.node[k], power);
        worst = std::max(worst, std::fabs(sum * (power + 1) - 1));
    }
    // Powers of a node that is off by half a unit in the last place are off by 32 of them.
    hold({"Iteration", "Gauss and Legendre, 32 nodes: integrals of x^0 to x^63", "64 powers", "core", "float64", worst,
          1e-14, "of the integral"});
}

TEST_CASE("the blades leave open the area of their circle, however small") {
    double worst = 0;
    int count = 0;
    for (const int blades : {3, 5, kMaxIrisBlades})
        for (const double rounding : {0.0, 0.3, 1.0})
            for (const double rim : {1e-6, 10.0, 1e9})
                for (const double share : {0.99, 0.5, 1e-3, 1e-9, 1e-15, 1e-18, 1e-30}) {
                    const IrisShape shape{blades, rounding, 0.1};
                    const double radius = share * rim, apothem = open_iris(shape, radius, rim).apothem;
                    worst = std::max(worst, std::fabs(iris_area(shape, apothem, rim) / (M_PI * radius * radius) - 1));
                    ++count;
                }
    const Iris<double> closed = open_iris({5, 0.3, 0}, 0, 10);
    CHECK(std::isfinite(closed.apothem + closed.curvature));
    CHECK(closed.apothem < 1e-15);
    // 60 halvings of an interval as large as its middle; sums of 2048 terms.
    hold({"Iteration", "opening of the iris, 0.99 to 1e-30 of its rim: area", std::to_string(count) + " openings",
          "core", "float64", worst, 1e-12, "of the circle's"});
}

TEST_CASE("the pupil search ends within its bound, whatever passes") {
    const LensSystem gauss = io::read_lens("double-gauss-50mm"), fisheye = io::read_lens("fisheye-6mm-220deg");
    long worst = 0;
    int count = 0;
    const auto look = [&](const LensSystem& lens, double film_radius, const std::function<bool(Vec3f, long)>& passes) {
        long blocks = 0;
        const PupilTracer tracer{[&](const LensView<float>&, PupilTracer::Rays& rays) {
            for (int i = 0; i < 256; ++i)
                rays.status[i] =
                    passes(rays.direction[i], 256 * blocks + i) ? 0 : static_cast<int>(RayStatus::vignetted);
            ++blocks;
        }};
        const Pupil pupil(lens, film_radius, tracer);
        worst = std::max(worst, blocks);
        ++count;
        const PupilView view = pupil.view();
        for (int i = 0; i <= view.rows; ++i) CHECK(std::isfinite(view.nodes[i].centre_l + view.nodes[i].half_width));
        for (int i = 0; i < view.rows * PupilView::kSectors; ++i)
            CHECK(std::isfinite(view.outline[i].x + view.outline[i].dx));
    };
    for (const LensSystem& lens : {gauss, fisheye})
        for (const double radius : {1e-30, 21.0, 1e9}) {
            look(lens, radius, [](Vec3f, long) { return false; });
            look(lens, radius, [](Vec3f, long) { return true; });
            look(lens, radius, [](Vec3f, long ray) { return hash32(static_cast<std::uint32_t>(ray)) % 2 == 0; });
            look(lens, radius, [](Vec3f, long ray) { return hash32(static_cast<std::uint32_t>(ray)) % 1000 == 0; });
            look(lens, radius, [](Vec3f d, long) { return std::fmod(std::fabs(d.x), 0.01f) < 0.003f; });  // stripes
            look(lens, radius, [](Vec3f d, long) { return std::fabs(d.x - 0.31f) < 1e-7f; });
        }
    for (const double wrong : {0.0, -1.0, std::nan(""), kInfinity}) CHECK_THROWS_AS(Pupil(gauss, wrong), InputError);
    hold({"Iteration",
          "pupil search: nothing, everything, noise, stripes and a needle pass; film radii of 1e-30 to 1e9 mm",
          std::to_string(count) + " searches", "core", "float32", static_cast<double>(worst), Pupil::kMaxBlocks,
          "blocks of 256 rays"});
}
