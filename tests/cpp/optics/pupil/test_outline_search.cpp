// Outlines of a pupil: looked for near expected ones, and seen from the middle of another box.

#include <algorithm>
#include <cmath>
#include <string>

#include "doctest/doctest.h"
#include "io/lens/lens_file.hpp"
#include "optics/pupil/pupil_outline.hpp"
#include "optics/pupil/pupil_outline_search.hpp"
#include "optics/pupil/pupil_track.hpp"

using namespace realcam;

namespace {

constexpr int kAzimuths = PupilOutline::kAzimuths;

double largest_difference(const PupilOutline& a, const PupilOutline& b, double (PupilOutline::*edge)[kAzimuths + 1]) {
    double largest = 0;
    for (int i = 0; i <= kAzimuths; ++i) largest = std::max(largest, std::fabs((a.*edge)[i] - (b.*edge)[i]));
    return largest;
}

std::vector<OutlineRequest> requests_through(const PupilSearch& search, double film_radius) {
    std::vector<OutlineRequest> requests;
    PupilTrack track;
    for (const double share : {0.0, 0.3, 0.6, 0.9}) {
        const double radius = share * film_radius;
        const std::optional<DirectionBox> box = track.find(search, radius);
        REQUIRE(box);
        requests.push_back({{radius, 0}, {box->centre().l, 0}, box->half_width(), box->half_height()});
    }
    return requests;
}

}  // namespace

TEST_CASE("an outline is the same whatever was expected") {
    // Rims cut the light of one, and one has a hole.
    for (const char* name : {"double-gauss-50mm", "mirror-telephoto-500mm"}) {
        CAPTURE(std::string(name));
        const LensSystem lens = io::read_lens(name);
        const PupilSearch search(lens, FilmMap::radial, {});
        const std::vector<OutlineRequest> requests = requests_through(search, 0.5 * lens.film_width);
        const std::vector<PupilOutline> scanned = OutlineSearch::find(search.lens(), requests);
        // Right within the tolerance; within eight times that; not at all; nothing known.
        for (const double factor : {1.003, 0.998, 1.03, 1.4, 0.0}) {
            CAPTURE(factor);
            std::vector<PupilOutline> expected = scanned;
            for (PupilOutline& outline : expected)
                for (int a = 0; a <= kAzimuths; ++a) outline.outer[a] *= factor, outline.inner[a] *= factor;
            const std::vector<PupilOutline> found =
                OutlineSearch::find_near(search.lens(), requests, expected, OutlineSearch::kNeighbourTolerance);
            for (std::size_t i = 0; i < requests.size(); ++i) {
                // An edge lies in intervals of 1.5e-4 and of 6.25e-4 of the box.
                CHECK(largest_difference(found[i], scanned[i], &PupilOutline::outer) < 6.3e-4);
                CHECK(largest_difference(found[i], scanned[i], &PupilOutline::inner) < 6.3e-4);
            }
        }
    }
}

TEST_CASE("a circle is seen from beside its middle as it is by the cosine rule") {
    OutlineHalves circle;
    for (PupilOutline& half : circle)
        for (int a = 0; a <= kAzimuths; ++a) half.outer[a] = 1, half.inner[a] = 0.5;
    const DirectionBox from{-1, 1, -1, 1}, to{-1.3, 1.5, -1.2, 1};
    const OutlineHalves moved = moved_outline(circle, from, to);
    for (std::size_t half = 0; half < 2; ++half)
        for (int a = 0; a <= kAzimuths; ++a) {
            const PupilDirection unit = PupilOutline::direction(a);
            const double x = to.half_width() * unit.l, y = (half == 0 ? 1 : -1) * to.half_height() * unit.m;
            const double cx = to.centre().l, cy = to.centre().m, square = x * x + y * y, along = cx * x + cy * y;
            const auto reach = [&](double radius) {
                return (std::sqrt(along * along - square * (cx * cx + cy * cy - radius * radius)) - along) / square;
            };
            // Between 128 azimuths the circle is a polygon, and that lies inside of it by 1 - cos(180 degrees / 128).
            CHECK(moved[half].outer[a] == doctest::Approx(reach(1)).epsilon(4e-4));
            CHECK(moved[half].inner[a] == doctest::Approx(reach(0.5)).epsilon(4e-4));
        }
}

TEST_CASE("an outline that does not go around the other middle is not known there") {
    OutlineHalves circle;
    for (PupilOutline& half : circle)
        for (int a = 0; a <= kAzimuths; ++a) half.outer[a] = 1;
    for (const PupilOutline& half : moved_outline(circle, {-1, 1, -1, 1}, {1.2, 3, -1, 1}))
        for (int a = 0; a <= kAzimuths; ++a) CHECK(half.outer[a] == 0);
}
