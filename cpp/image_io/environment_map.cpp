#include "environment_map.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <utility>

namespace realcam::image_io {
namespace {

/// OpenEXR's cube map (ImfEnvmap.h): each face is a view from the inside with +y upwards, or, for the upper and lower
/// face, with +z and -z upwards. The centres of its outer pixels lie on the edges of the cube.
class CubeMap {
public:
    explicit CubeMap(const Environment& file) : file_(file), size_(file.width) {}

    /// Radiance from a direction, which need not have unit length.
    Color in_direction(Vec3d d) const {
        const double x = std::abs(d.x), y = std::abs(d.y), z = std::abs(d.z);
        if (x >= y && x >= z) return d.x > 0 ? in_face(0, d.z / x, d.y / x) : in_face(1, -d.z / x, d.y / x);
        if (y >= z) return d.y > 0 ? in_face(2, d.x / y, d.z / y) : in_face(3, d.x / y, -d.z / y);
        return d.z > 0 ? in_face(4, -d.x / z, d.y / z) : in_face(5, d.x / z, d.y / z);
    }

private:
    /// Interpolates bilinearly in face `number`. `right`, `up`: position in the face, from -1 to 1.
    Color in_face(int number, double right, double up) const {
        const double max_index = size_ - 1;
        const double column = std::clamp(0.5 * (right + 1) * max_index, 0.0, max_index),
                     row = std::clamp(0.5 * (1 - up) * max_index, 0.0, max_index);
        const int left = std::min(static_cast<int>(column), std::max(size_ - 2, 0)),
                  top = std::min(static_cast<int>(row), std::max(size_ - 2, 0));
        const int next = size_ > 1 ? 1 : 0;
        const auto s = static_cast<float>(column - left), t = static_cast<float>(row - top);
        const auto pixel = [&](int c, int r) {
            return file_.pixels[(static_cast<std::size_t>(number) * static_cast<std::size_t>(size_) +
                                 static_cast<std::size_t>(r)) *
                                    static_cast<std::size_t>(size_) +
                                static_cast<std::size_t>(c)];
        };
        return (1 - t) * ((1 - s) * pixel(left, top) + s * pixel(left + next, top)) +
               t * ((1 - s) * pixel(left, top + next) + s * pixel(left + next, top + next));
    }

    const Environment& file_;
    int size_;  // pixels along an edge of a face
};

/// Resamples a cube map to a latitude-longitude picture, with four samples per pixel, and as many pixels along the
/// horizon as the cube has.
Environment lat_long_of_cube(const Environment& file, const KeepGoing& keep_going) {
    if (file.height != 6 * std::int64_t{file.width})
        throw Error("is declared to be a cube map, and has " + std::to_string(file.width) + " x " +
                    std::to_string(file.height) + " pixels; expected six squares below each other");
    const CubeMap cube(file);
    Environment out;
    out.width = 4 * file.width;
    out.height = 2 * file.width;
    out.pixels.reserve(static_cast<std::size_t>(out.width) * static_cast<std::size_t>(out.height));
    for (int row = 0; row < out.height; ++row) {
        check(keep_going);
        for (int column = 0; column < out.width; ++column) {
            Color sum = {0, 0, 0};
            for (const double down : {0.25, 0.75})
                for (const double across : {0.25, 0.75}) {
                    const double polar = std::numbers::pi * (row + down) / out.height,
                                 azimuth = 2 * std::numbers::pi * ((column + across) / out.width - 0.5);
                    sum += cube.in_direction(
                        {std::sin(polar) * std::sin(azimuth), std::cos(polar), -std::sin(polar) * std::cos(azimuth)});
                }
            out.pixels.push_back(0.25f * sum);
        }
    }
    return out;
}

}  // namespace

Environment environment_of(EnvironmentMap map, Environment file, const KeepGoing& keep_going) {
    if (map == EnvironmentMap::cube) return lat_long_of_cube(file, keep_going);
    if (map == EnvironmentMap::lat_long)  // the middle column looks to +z in OpenEXR, and to -z here
        for (int row = 0; row < file.height; ++row) {
            const auto begin = file.pixels.begin() + std::ptrdiff_t{row} * file.width;
            std::rotate(begin, begin + file.width / 2, begin + file.width);
        }
    return file;
}

}  // namespace realcam::image_io
