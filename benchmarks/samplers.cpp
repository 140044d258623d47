// Which sequence of sample points errs least, for pictures through lenses?
//
//     g++ -std=c++20 -O3 -march=native -fopenmp-simd -fopenmp -Icpp benchmarks/samplers.cpp \
//         build/cpu/librealcam_lens_io.a build/cpu/librealcam_io.a -o /tmp/samplers && /tmp/samplers
//
// Film, pupil, light and time are sampled together: a ray leaves the film, passes every surface of the lens, and meets
// a board with a pattern that moves while the film is exposed, in the penumbra that a disc casts in the light of a
// square lamp. Reports the error of the pixels against many more samples of another seed: its root mean square, and the
// same after a blur of two pixels, which models the noise that is visible at some distance.

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <string>
#include <vector>

#include "../cpp/optics/lens/paraxial.hpp"
#include "io/lens/lens_file.hpp"
#include "io/lens/lens_text.hpp"
#include "math/random.hpp"
#include "optics/lens/focus.hpp"
#include "optics/pupil/pupil.hpp"
#include "optics/trace/lens_path.hpp"

namespace {

using namespace realcam;

constexpr int kDimensions = 7;  // film 2, pupil 2, light 2, time
using Point = std::array<float, kDimensions>;

struct Place {
    std::uint32_t pixel, column, row, sample, samples, seed;
};

/// The renderer's sampler.
struct Joint {
    static constexpr const char* name = "joint";
    static Point at(const Place& place) {
        const std::uint32_t stream = hash32(place.pixel, place.seed);
        const auto pair = [&](std::uint32_t number) { return sample_joint_2d(stream, place.sample, number); };
        const Vec2f film = pair(0), pupil = pair(1), light = pair(2), time = pair(4);
        return {film.x, film.y, pupil.x, pupil.y, light.x, light.y, time.x};
    }
};

/// An independent shuffled and scrambled (0,2)-sequence for each pair of dimensions.
struct Pairs {
    static constexpr const char* name = "(0,2) pairs";
    static Point at(const Place& place) {
        const std::uint32_t stream = hash32(place.pixel, place.seed);
        const Vec2f film = sample_2d(stream, place.sample, 0), pupil = sample_2d(stream, place.sample, 1),
                    light = sample_2d(stream, place.sample, 2), time = sample_2d(stream, place.sample, 0x20000);
        return {film.x, film.y, pupil.x, pupil.y, light.x, light.y, time.x};
    }
};

struct Random {
    static constexpr const char* name = "random";
    static Point at(const Place& place) {
        Point point;
        const std::uint32_t stream = hash32(hash32(place.pixel, place.seed), place.sample);
        for (std::uint32_t d = 0; d < kDimensions; ++d) point[d] = unit_float(hash32(stream, d));
        return point;
    }
};

/// Sobol's dimensions after the first, by S. Joe and F. Y. Kuo, "Constructing Sobol sequences with better
/// two-dimensional projections" (SIAM J. Sci. Comput. 30, 2008): degree and coefficients of the polynomial, first
/// direction numbers.
struct SobolMatrix {
    std::uint32_t columns[32];

    SobolMatrix(int degree, std::uint32_t coefficients, std::initializer_list<std::uint32_t> first) {
        std::uint32_t m[32];
        std::copy(first.begin(), first.end(), m);
        for (int i = degree; i < 32; ++i) {
            m[i] = m[i - degree] ^ (m[i - degree] << degree);
            for (int k = 1; k < degree; ++k)
                if (coefficients >> (degree - 1 - k) & 1u) m[i] ^= m[i - k] << k;
        }
        for (int i = 0; i < 32; ++i) columns[i] = m[i] << (31 - i);
    }
    std::uint32_t operator()(std::uint32_t index) const {
        std::uint32_t v = 0;
        for (int i = 0; index; index >>= 1, ++i)
            if (index & 1u) v ^= columns[i];
        return v;
    }
};

const SobolMatrix kSobol[] = {{1, 0, {1}},       {2, 1, {1, 3}},       {3, 1, {1, 3, 1}},
                              {3, 2, {1, 1, 1}}, {4, 1, {1, 1, 3, 3}}, {4, 4, {1, 3, 5, 13}}};

float sobol(std::uint32_t index, int dimension, std::uint32_t seed) {
    const std::uint32_t v = dimension == 0 ? reverse_bits(index) : kSobol[dimension - 1](index);
    return unit_float(reverse_bits(scramble_reversed(reverse_bits(v), seed)));
}

std::uint32_t shuffled(std::uint32_t index, std::uint32_t seed) {
    return reverse_bits(scramble_reversed(reverse_bits(index), seed));
}

/// Sobol's first four for film and pupil together, and again for light and time (B. Burley, "Practical Hash-based Owen
/// Scrambling", JCGT 9, 2020).
struct Fours {
    static constexpr const char* name = "Sobol 4 + 3";
    static Point at(const Place& place) {
        const std::uint32_t stream = hash32(place.pixel, place.seed);
        Point point;
        for (int d = 0; d < kDimensions; ++d) {
            const std::uint32_t group = hash32(stream, static_cast<std::uint32_t>(d / 4));
            point[static_cast<std::size_t>(d)] =
                sobol(shuffled(place.sample, group), d % 4, hash32(group, static_cast<std::uint32_t>(d)));
        }
        return point;
    }
};

/// All dimensions of one Sobol sequence.
struct Sevens {
    static constexpr const char* name = "Sobol 7";
    static Point at(const Place& place) {
        const std::uint32_t stream = hash32(place.pixel, place.seed);
        Point point;
        for (int d = 0; d < kDimensions; ++d)
            point[static_cast<std::size_t>(d)] =
                sobol(shuffled(place.sample, stream), d, hash32(stream, static_cast<std::uint32_t>(d)));
        return point;
    }
};

/// Generator matrix of one dimension of a (0, 2^kBits)-sequence in base 2^kBits, as a binary matrix: Faure's
/// construction over a field of 2^kBits elements (A. Ahmed, M. Skopenkov, M. Hadwiger and P. Wonka, "SZ Sequences:
/// Binary-Constructed (0, 2^q)-Sequences", SIGGRAPH Asia 2024). Digit i of a sample is the sum over the index's digits
/// j of binomial(j, i) a^(j - i) times digit j, with a different element a in each dimension.
template <int kBits, unsigned kModulus>
class FieldMatrix {
public:
    explicit FieldMatrix(unsigned element) {
        constexpr int kDigits = 32 / kBits;
        for (int bit = 0; bit < kDigits * kBits; ++bit) {
            const int j = bit / kBits;
            columns_[bit] = 0;
            unsigned product = 1u << (bit % kBits);  // of the digit and a power of the element
            for (int i = j; i >= 0; --i) {
                if ((i & (j - i)) == 0)  // binomial(j, i) is odd
                    columns_[bit] |= product << (32 - kBits * (i + 1));
                product = times(product, element);
            }
        }
    }
    std::uint32_t operator()(std::uint32_t index) const {
        std::uint32_t v = 0;
        for (int i = 0; index && i < 32 / kBits * kBits; index >>= 1, ++i)
            if (index & 1u) v ^= columns_[i];
        return v;
    }

private:
    static unsigned times(unsigned a, unsigned b) {
        unsigned product = 0;
        for (; b; b >>= 1) {
            if (b & 1u) product ^= a;
            a <<= 1;
            if (a >> kBits & 1u) a ^= kModulus;
        }
        return product;
    }

    std::uint32_t columns_[32];
};

struct Eights {
    static constexpr const char* name = "(0,8)-sequence";
    static Point at(const Place& place) {
        using Matrix = FieldMatrix<3, 0b1011>;
        static const Matrix matrices[] = {Matrix(0), Matrix(1), Matrix(2), Matrix(3), Matrix(4), Matrix(5), Matrix(6)};
        const std::uint32_t stream = hash32(place.pixel, place.seed), index = shuffled(place.sample, stream);
        Point point;
        for (std::size_t d = 0; d < kDimensions; ++d)
            point[d] = unit_float(reverse_bits(
                scramble_reversed(reverse_bits(matrices[d](index)), hash32(stream, static_cast<std::uint32_t>(d)))));
        return point;
    }
};

/// Film and pupil together, and light and time together, each a (0,4)-sequence.
struct TwiceFour {
    static constexpr const char* name = "(0,4)-sequences, 4 + 3";
    static Point at(const Place& place) {
        using Matrix = FieldMatrix<2, 0b111>;
        static const Matrix matrices[] = {Matrix(0), Matrix(1), Matrix(2), Matrix(3)};
        const std::uint32_t stream = hash32(place.pixel, place.seed);
        Point point;
        for (std::size_t d = 0; d < kDimensions; ++d) {
            const std::uint32_t group = hash32(stream, static_cast<std::uint32_t>(d / 4));
            point[d] =
                unit_float(reverse_bits(scramble_reversed(reverse_bits(matrices[d % 4](shuffled(place.sample, group))),
                                                          hash32(group, static_cast<std::uint32_t>(d)))));
        }
        return point;
    }
};

/// One sequence for the whole picture, whose pieces go to the pixels in Morton's order, shuffled in fours (A. Ahmed and
/// P. Wonka, "Screen-Space Blue-Noise Diffusion of Monte Carlo Sampling Error via Hierarchical Ordering of Pixels",
/// SIGGRAPH Asia 2020). The number of samples has to be known beforehand, and be a power of two.
template <class Index>
Point in_morton_order(const Place& place, Index&& index_in_pair) {
    std::uint32_t morton = 0;
    for (int bit = 0; bit < 12; ++bit)
        morton |= (place.column >> bit & 1u) << (2 * bit) | (place.row >> bit & 1u) << (2 * bit + 1);
    int bits = 0;
    while ((1u << bits) < place.samples) ++bits;
    const std::uint32_t index = morton << bits | place.sample;
    return index_in_pair(index);
}

struct MortonPairs {
    static constexpr const char* name = "(0,2) pairs, Morton";
    static Point at(const Place& place) {
        return in_morton_order(place, [&](std::uint32_t index) {
            Point point;
            const auto pair = [&](std::uint32_t dimension) { return sample_2d(place.seed, index, dimension); };
            const Vec2f film = pair(0), pupil = pair(1), light = pair(2), time = pair(3);
            return Point{film.x, film.y, pupil.x, pupil.y, light.x, light.y, time.x};
        });
    }
};

/// A lens and the board in front of it.
class Scene {
public:
    static constexpr int kSide = 32;

    explicit Scene(const LensSystem& lens)
        : path_(lens, LightDirection::to_scene, lens.wavelength_nm),
          pupil_(lens, 0.5 * std::hypot(lens.film_width, lens.film_height)),
          half_width_(static_cast<float>(0.5 * std::min(lens.film_width, lens.film_height))),
          film_distance_(static_cast<float>(lens.film_distance)) {
        const double focus = std::isfinite(lens.focus_distance) ? lens.focus_distance : 1e4;
        distance_ = static_cast<float>(focus - lens.film_position());
        const double f = std::fabs(first_order(lens, lens.wavelength_nm).effective_focal_length);
        field_ = static_cast<float>(static_cast<double>(distance_) * static_cast<double>(half_width_) / f);
    }

    float light(std::uint32_t column, std::uint32_t row, const Point& u) const {
        const float x = half_width_ * (2 * (static_cast<float>(column) + u[0]) / kSide - 1),
                    y = half_width_ * (2 * (static_cast<float>(row) + u[1]) / kSide - 1);
        const PupilSample start = sample_pupil(pupil_.view(), x, y, u[2], u[3]);
        if (!(start.weight > 0)) return 0;
        LensRays<float, 1> ray;
        ray.origin.set(0, {x, y, film_distance_});
        ray.direction.set(0, start.direction);
        ray.status[0] = 0;
        trace_lens(path_.view(), ray);
        const Vec3f o = ray.origin[0], d = ray.direction[0];
        if (ray.status[0] != 0 || !(d.z < 0)) return 0;
        const float way = (-distance_ - o.z) / d.z;
        return start.weight * board((o.x + way * d.x) / field_, (o.y + way * d.y) / field_, u);
    }

private:
    /// Light of a point on the board; x and y in units of the field's half width.
    static float board(float x, float y, const Point& u) {
        const float moved = x + 0.05f * u[6];
        const bool is_bright = (static_cast<int>(std::floor(7 * moved)) + static_cast<int>(std::floor(7 * y))) & 1;
        // Point in the plane of a disc half-way between the board and the point on the lamp.
        const float from_x = 0.5f * (x + u[4] - 0.2f), from_y = 0.5f * (y + u[5] - 0.5f);
        const bool is_lit = from_x * from_x + from_y * from_y > 0.04f;
        return (is_bright ? 1.0f : 0.1f) * (is_lit ? 1.0f : 0.05f);
    }

    LensPath<float> path_;
    Pupil pupil_;
    float half_width_, film_distance_, distance_, field_;
};

using Picture = std::vector<double>;
constexpr int kPixels = Scene::kSide * Scene::kSide;

template <class Sampler>
Picture picture_of(const Scene& scene, std::uint32_t samples, std::uint32_t seed) {
    Picture picture(kPixels);
#pragma omp parallel for
    for (int pixel = 0; pixel < kPixels; ++pixel) {
        Place place{static_cast<std::uint32_t>(pixel),
                    static_cast<std::uint32_t>(pixel % Scene::kSide),
                    static_cast<std::uint32_t>(pixel / Scene::kSide),
                    0,
                    samples,
                    seed};
        double sum = 0;
        for (; place.sample < samples; ++place.sample)
            sum += static_cast<double>(scene.light(place.column, place.row, Sampler::at(place)));
        picture[static_cast<std::size_t>(pixel)] = sum / samples;
    }
    return picture;
}

Picture blurred(const Picture& picture) {
    const auto at = [](const Picture& from, int x, int y) {
        const auto inside = [](int v) { return std::clamp(v, 0, Scene::kSide - 1); };
        return from[static_cast<std::size_t>(inside(y) * Scene::kSide + inside(x))];
    };
    Picture now = picture;
    for (int pass = 0; pass < 2; ++pass) {
        Picture next(now.size());
        for (int y = 0; y < Scene::kSide; ++y)
            for (int x = 0; x < Scene::kSide; ++x) {
                double sum = 0, weight = 0;
                for (int k = -6; k <= 6; ++k) {
                    const double w = std::exp(-k * k / 8.0);
                    sum += w * (pass == 0 ? at(now, x + k, y) : at(now, x, y + k));
                    weight += w;
                }
                next[static_cast<std::size_t>(y * Scene::kSide + x)] = sum / weight;
            }
        now = next;
    }
    return now;
}

struct Errors {
    double plain = 0, seen = 0;  ///< sums of squares
};

template <class Sampler>
Errors errors_of(const Scene& scene, const Picture& reference, std::uint32_t samples) {
    constexpr std::uint32_t kSeeds = 4;
    double mean = 0;
    for (const double value : reference) mean += value / kPixels;
    Errors errors;
    for (std::uint32_t seed = 1; seed <= kSeeds; ++seed) {
        Picture difference = picture_of<Sampler>(scene, samples, seed);
        for (std::size_t i = 0; i < difference.size(); ++i) difference[i] = (difference[i] - reference[i]) / mean;
        const Picture seen = blurred(difference);
        for (std::size_t i = 0; i < difference.size(); ++i) {
            errors.plain += difference[i] * difference[i] / (kPixels * kSeeds);
            errors.seen += seen[i] * seen[i] / (kPixels * kSeeds);
        }
    }
    return errors;
}

template <class Sampler>
double nanoseconds_of() {
    constexpr std::uint32_t kCount = 1u << 20;
    const auto begin = std::chrono::steady_clock::now();
    float sum = 0;
    for (std::uint32_t i = 0; i < kCount; ++i)
        for (const float u : Sampler::at({i >> 6, i >> 6 & 31u, i >> 11, i & 63u, 64, 1})) sum += u;
    const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - begin;
    return sum > 0 ? time.count() / kCount : 0;
}

constexpr std::uint32_t kCounts[] = {4, 16, 64, 256, 1024};

template <class... Samplers>
void compare(const std::vector<std::string>& lenses) {
    constexpr std::size_t kSamplers = sizeof...(Samplers);
    std::array<std::array<Errors, std::size(kCounts)>, kSamplers> logarithms{};
    for (const std::string& name : lenses) {
        const Scene scene(focused(io::read_lens(name), 3500));
        const Picture reference = picture_of<Joint>(scene, 1u << 16, 99);
        std::printf("\n%s: error, percent of the mean\n\n| samples |", name.c_str());
        for (const char* sampler : {Samplers::name...}) std::printf(" %s |", sampler);
        std::printf("\n|---|");
        for (std::size_t k = 0; k < kSamplers; ++k) std::printf("---|");
        std::printf("\n");
        for (std::size_t k = 0; k < std::size(kCounts); ++k) {
            const Errors errors[] = {errors_of<Samplers>(scene, reference, kCounts[k])...};
            std::printf("| %u |", kCounts[k]);
            for (std::size_t s = 0; s < kSamplers; ++s) {
                std::printf(" %.3g (%.3g) |", 100 * std::sqrt(errors[s].plain), 100 * std::sqrt(errors[s].seen));
                logarithms[s][k].plain += std::log(errors[s].plain / errors[0].plain) / 2;
                logarithms[s][k].seen += std::log(errors[s].seen / errors[0].seen) / 2;
            }
            std::printf("\n");
            std::fflush(stdout);
        }
    }
    std::printf("\nError over that of the first, geometric mean of %zu lenses (blurred)\n\n", lenses.size());
    for (std::size_t k = 0; k < std::size(kCounts); ++k) {
        std::printf("| %u |", kCounts[k]);
        for (std::size_t s = 0; s < kSamplers; ++s)
            std::printf(" %.3f (%.3f) |", std::exp(logarithms[s][k].plain / static_cast<double>(lenses.size())),
                        std::exp(logarithms[s][k].seen / static_cast<double>(lenses.size())));
        std::printf("\n");
    }
    std::printf("| ns a sample |");
    for (const double time : {nanoseconds_of<Samplers>()...}) std::printf(" %.0f |", time);
    std::printf("\n");
}

}  // namespace

int main(int count, char** words) {
    std::vector<std::string> lenses(words + 1, words + count);
    if (lenses.empty())
        for (const auto& file : io::bundled_lens_files()) lenses.emplace_back(file.name);
    compare<Joint, Pairs, Fours, Sevens, TwiceFour, Eights, MortonPairs, Random>(lenses);
}
