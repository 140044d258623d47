// From a pixel to its pupil: the directions that are drawn follow pupil_pdf, and the weight is one over it.

#include <cmath>
#include <string>
#include <vector>

#include "chi_square.hpp"
#include "pupil_region.hpp"

using namespace realcam;
using namespace realcam::test;

namespace {

constexpr int kPupilSamples = 1 << 18, kSide = 20;

struct FilmPoint {
    std::string lens;
    double share;  // of the half diagonal
    double f_number;  // 0: wide open
};

// The axis, the picture and its corner; a mirror lens with its hole; a fisheye's edge, whose pupil is a crescent.
const FilmPoint kPoints[] = {{"double-gauss-50mm", 0, 0},          {"double-gauss-50mm", 0.5, 0},
                             {"double-gauss-50mm", 0.97, 0},       {"double-gauss-50mm", 0.97, 16},
                             {"mirror-telephoto-500mm", 0.6, 0},   {"mirror-telephoto-500mm", 0, 0},
                             {"fisheye-6mm-220deg", 0.3, 0},       {"phone-4mm", 0.9, 0},
                             {"telephoto-200mm-inner-focus", 1, 0}};

LensSystem lens_at(const FilmPoint& point) {
    const LensSystem lens = io::read_lens(point.lens);
    return point.f_number > 0 ? stopped_down(lens, point.f_number) : lens;
}

// Square bins in optical direction cosines around the region's box, the film point at 0.7 radians.
template <class Sampler>
Bins in_direction_cosines(const PupilView& pupil, float x, float y, Sampler&& sampler, unsigned seed) {
    const PupilLookup place(pupil, x, y);
    // Rows reach past the box where their ends differ or stray rays have widened them.
    const double half = 2.2 * static_cast<double>(std::max(place.box.half_width, place.box.half_height));
    const double l = static_cast<double>(place.box.centre_l * place.at.frame.cos),
                 m = static_cast<double>(place.box.centre_l * place.at.frame.sin);
    Bins bins(Bins::even(l - half, l + half, kSide), Bins::even(m - half, m + half, kSide));
    // The density jumps at the sectors' edges: the rule's error in a bin that an edge cuts is 1e-3.
    bins.expect(
        [&](double a, double b) { return pupil_pdf(pupil, x, y, static_cast<float>(a), static_cast<float>(b)); },
        kPupilSamples, 10);
    Uniform uniform(seed);
    for (int i = 0; i < kPupilSamples; ++i) {
        const Vec3f d = sampler(uniform.pair());
        bins.add(static_cast<double>(d.x), static_cast<double>(d.y));
    }
    return bins;
}

}  // namespace

TEST_CASE("sample_pupil follows pupil_pdf, from the axis to the edge of the image") {
    ChiSquareTests tests("sample_pupil: pixel to pupil");
    unsigned seed = 1;
    for (const FilmPoint& point : kPoints) {
        CAPTURE(point.lens);
        CAPTURE(point.share);
        const LensSystem lens = lens_at(point);
        const Pupil pupil(lens, half_diagonal(lens));
        const double r = 0.999 * point.share * std::min(half_diagonal(lens), pupil.image_radius());
        const float x = static_cast<float>(r * std::cos(0.7)), y = static_cast<float>(r * std::sin(0.7));
        const PupilView view = pupil.view();
        tests.add(in_direction_cosines(
            view, x, y, [&](Vec2f u) { return sample_pupil(view, x, y, u.x, u.y).direction; }, seed++));
    }
    // 1.3e-3 of the density lies in bins that an edge cuts, which limits the rule of 70 x 70 points in each bin.
    tests.hold(3e-3);

    const LensSystem lens = lens_at(kPoints[1]);
    const Pupil pupil(lens, half_diagonal(lens));
    const PupilView view = pupil.view();
    ChiSquareTests broken("sample_pupil without the square root");
    broken.add(in_direction_cosines(
        view, 6, 5, [&](Vec2f u) { return sample_pupil(view, 6, 5, u.x, u.y * u.y).direction; }, 1));
    broken.breaks();
}

TEST_CASE("the weight of a pupil sample is one over its density") {
    for (const FilmPoint& point : kPoints) {
        CAPTURE(point.lens);
        CAPTURE(point.share);
        const LensSystem lens = lens_at(point);
        const Pupil pupil(lens, half_diagonal(lens));
        const double r = 0.999 * point.share * std::min(half_diagonal(lens), pupil.image_radius());
        const float x = static_cast<float>(r * std::cos(0.7)), y = static_cast<float>(r * std::sin(0.7));
        Uniform uniform(5);
        int different = 0;
        for (int i = 0; i < 10000; ++i) {
            const Vec2f u = uniform.pair();
            const PupilSample sample = sample_pupil(pupil.view(), x, y, u.x, u.y);
            const float pdf = pupil_pdf(pupil.view(), x, y, sample.direction.x, sample.direction.y);
            different += !(std::fabs(sample.weight * pdf - 1) < 1e-5f);
        }
        // Rounding takes a sample over an edge where it lies within 1e-7 of it, over the box's size of 1e-2 and more;
        // a sliver of a crescent's 64 sectors has two edges.
        CHECK(different <= 20);
    }
}

TEST_CASE("the ends of the square give directions of the region") {
    for (const FilmPoint& point : kPoints) {
        CAPTURE(point.lens);
        const LensSystem lens = lens_at(point);
        const Pupil pupil(lens, half_diagonal(lens));
        for (const double share : {0.0, 0.5, 0.999})
            for (const Vec2f u : extreme_inputs()) {
                const float radius = static_cast<float>(share * pupil.image_radius());
                const PupilSample sample = sample_pupil(pupil.view(), radius, 0, u.x, u.y);
                const Vec3f d = sample.direction;
                CHECK(std::fabs(dot(d, d) - pupil.view().index_squared) < 1e-6f);
                CHECK(d.z < 0);
                CHECK(sample.weight > 0);
                CHECK(PupilRegion(pupil.view(), static_cast<double>(radius))
                          .contains(static_cast<double>(d.x), static_cast<double>(d.y), 1e-4));
            }
        const float outside = 1.001f * pupil.view().image_radius;
        CHECK(pupil_pdf(pupil.view(), outside, 0, 0, 0) == 0);
        CHECK(sample_pupil(pupil.view(), outside, 0, 0.5f, 0.5f).weight == 0);
    }
}
