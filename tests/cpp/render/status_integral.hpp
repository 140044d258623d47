#pragma once
// The irradiance of a film point by quadrature over the directions that pass, from single rays in double precision.

#include <boost/math/quadrature/gauss.hpp>
#include <cmath>
#include <utility>
#include <vector>

#include "traced_ray.hpp"

namespace realcam::test {

/// Area of the passing region in direction cosines: irradiance for a field of radiance 1 (source paper, equations 6 and
/// 7, in which n^2 cos(theta') dω = dl dm). Chords along l, whose ends are found by bisection, are integrated over m by
/// Gauss's rule; with m = middle + half * sin(t) a chord's square root at the ends does no harm.
class StatusIntegral {
public:
    explicit StatusIntegral(const LensSystem& lens)
        : lens_(lens), trace_(lens, LightDirection::to_scene), index_(lens.indices(lens.wavelength_nm).back()) {}

    /// 0 where nothing passes.
    double operator()(double film_x, double film_y) {
        film_ = {film_x, film_y, lens_.film_position()};
        find_box();
        if (!(m_high_ > m_low_)) return 0;
        const double low = end_of_region(m_low_, m_low_ - step_m_), high = end_of_region(m_high_, m_high_ + step_m_);
        const double middle = 0.5 * (low + high), half = 0.5 * (high - low);
        // An outline has corners, where two surfaces cut it: 8 rules of 15 points.
        double sum = 0;
        for (int i = 0; i < 8; ++i)
            sum += boost::math::quadrature::gauss<double, 15>::integrate(
                [&](double t) { return half * std::cos(t) * chord(middle + half * std::sin(t)); },
                M_PI * (i / 8.0 - 0.5), M_PI * ((i + 1) / 8.0 - 0.5));
        return sum;
    }

private:
    static constexpr int kScan = 160;

    bool passes(double l, double m) const {
        const double square = index_ * index_ - l * l - m * m;
        return square > 0 && trace_(film_, {l, m, -std::sqrt(square)}).passed();
    }

    /// Finds the bounding box of the passing region by successively finer grids.
    void find_box() {
        const Vec3d rim{0, 0,
                        lens_.last_vertex() + lens_.surfaces.back().sag(lens_.surfaces.back().clear_semi_diameter)};
        const double radius = lens_.surfaces.back().clear_semi_diameter;
        double box[4] = {1, -1, 1, -1};
        for (int k = 0; k < 64; ++k) {
            const double a = 2 * M_PI * k / 64;
            take_in(box, index_ * normalized(rim + Vec3d{radius * std::cos(a), radius * std::sin(a), 0} - film_));
        }
        if (film_.z - rim.z < radius) box[0] = box[2] = -index_, box[1] = box[3] = index_;  // a rim beside the film
        for (int level = 0; level < 4; ++level) {
            const double dl = (box[1] - box[0]) / kScan, dm = (box[3] - box[2]) / kScan;
            double found[4] = {1, -1, 1, -1};
            for (int i = 0; i < kScan; ++i)
                for (int k = 0; k < kScan; ++k) {
                    const double l = box[0] + (i + 0.5) * dl, m = box[2] + (k + 0.5) * dm;
                    if (passes(l, m)) take_in(found, {l, m, 0});
                }
            l_low_ = found[0] - 2 * dl, l_high_ = found[1] + 2 * dl;
            m_low_ = found[2], m_high_ = found[3];
            step_m_ = dm;
            if (found[1] < found[0] ||
                (found[1] - found[0] > 0.5 * (box[1] - box[0]) && found[3] - found[2] > 0.5 * (box[3] - box[2])))
                return;
            box[0] = l_low_, box[1] = l_high_, box[2] = m_low_ - 2 * dm, box[3] = m_high_ + 2 * dm;
        }
    }

    static void take_in(double (&box)[4], Vec3d d) {
        box[0] = std::min(box[0], d.x), box[1] = std::max(box[1], d.x);
        box[2] = std::min(box[2], d.y), box[3] = std::max(box[3], d.y);
    }

    /// Edge of the passing interval, between a position inside and one outside, by bisection.
    template <class Passes>
    static double edge(Passes&& passes_at, double in, double out) {
        for (int i = 0; i < 45; ++i) {
            const double middle = 0.5 * (in + out);
            (passes_at(middle) ? in : out) = middle;
        }
        return 0.5 * (in + out);
    }

    /// The m beyond which no chord is left; `inside` has one.
    double end_of_region(double inside, double outside) const {
        const auto has_light = [&](double m) {
            for (int i = 0; i < 2 * kScan; ++i)
                if (passes(l_low_ + (l_high_ - l_low_) * (i + 0.5) / (2 * kScan), m)) return true;
            return false;
        };
        double in = inside, out = outside;
        for (int i = 0; i < 16; ++i) {
            const double middle = 0.5 * (in + out);
            (has_light(middle) ? in : out) = middle;
        }
        return in;
    }

    double chord(double m) const {
        const auto at = [&](int i) { return l_low_ + (l_high_ - l_low_) * i / kScan; };
        const auto passes_at = [&](double l) { return passes(l, m); };
        double sum = 0;
        bool before = false;
        for (int i = 1; i <= kScan; ++i) {
            const bool here = i < kScan && passes_at(at(i));
            if (here != before) sum += here ? -edge(passes_at, at(i), at(i - 1)) : edge(passes_at, at(i - 1), at(i));
            before = here;
        }
        return sum;
    }

    LensSystem lens_;
    RayTracer trace_;
    double index_;
    Vec3d film_{};
    double l_low_ = 0, l_high_ = 0, m_low_ = 0, m_high_ = 0, step_m_ = 0;
};

}  // namespace realcam::test
