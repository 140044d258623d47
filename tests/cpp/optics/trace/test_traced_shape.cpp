// A shape cached for the next trace is used only for the surface that it was made from.

#include <thread>
#include <vector>

#include "doctest/doctest.h"
#include "optics/trace/traced_shape.hpp"

using namespace realcam;

namespace {

/// Shape of a surface computed from scratch, in a new thread, because each thread starts with an empty cache.
TracedShape<double> computed_from_scratch(const Surface& surface) {
    TracedShape<double> shape;
    std::thread([&] { shape = traced_shape<double>(surface); }).join();
    return shape;
}

void check_same(const TracedShape<double>& a, const TracedShape<double>& b) {
    CHECK(a.view.kind == b.view.kind);
    CHECK(a.view.curvature == b.view.curvature);
    CHECK(a.view.conic_factor == b.view.conic_factor);
    CHECK(a.view.rim_squared == b.view.rim_squared);
    CHECK(a.view.hole_squared == b.view.hole_squared);
    CHECK(a.view.sag_max == b.view.sag_max);
    CHECK(a.view.aspheric[0] == b.view.aspheric[0]);
    CHECK(a.freeform.half_x == b.freeform.half_x);
    CHECK(a.freeform.curvature_x == b.freeform.curvature_x);
    CHECK(a.freeform.conic_factor_x == b.freeform.conic_factor_x);
    CHECK(a.freeform.sag_max == b.freeform.sag_max);
}

}  // namespace

TEST_CASE("a surface that differs in anything that shapes it is made ready anew") {
    Surface asphere;
    asphere.curvature = 0.02;
    asphere.conic = -0.3;
    asphere.aspheric = {1e-6, -2e-9};
    asphere.clear_semi_diameter = 11;
    std::vector<Surface> surfaces(7, asphere);
    surfaces[1].curvature = 0.021;
    surfaces[2].conic = 0;
    surfaces[3].aspheric[1] = 2e-9;
    surfaces[4].clear_semi_diameter = 12;
    surfaces[5].inner_semi_diameter = 2;
    surfaces[6].form.base = BaseForm::biconic;
    surfaces[6].form.curvature_x = 0.01;
    surfaces.push_back(surfaces[6]);
    surfaces[7].form.conic_x = 0.5;
    surfaces.push_back(surfaces[6]);
    surfaces[8].aperture_shape.kind = ApertureOutline::rectangle;
    surfaces[8].aperture_shape.half = {6, 4};
    // More surfaces than the cache holds, so that some are evicted and computed again.
    for (int i = 1; i <= 80; ++i) {
        surfaces.push_back(asphere);
        surfaces.back().curvature = 1e-4 * i;
    }
    std::vector<TracedShape<double>> expected;
    for (const Surface& surface : surfaces) expected.push_back(computed_from_scratch(surface));
    for (int turn = 0; turn < 2; ++turn)
        for (std::size_t i = 0; i < surfaces.size(); ++i) {
            CAPTURE(i);
            check_same(traced_shape<double>(surfaces[i]), expected[i]);
        }
}
