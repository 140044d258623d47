// Traces rays of a point far away on the axis through a bundled lens, and prints where they meet the film, in mm.
#include <cstdio>
#include <realcam/io/lens/lens_file.hpp>
#include <realcam/optics/lens/paraxial.hpp>
#include <realcam/optics/trace/lens_path.hpp>

int main(int count, char** words) {
    using namespace realcam;
    try {
        const LensSystem lens = io::read_lens(count > 1 ? words[1] : "tessar-50mm");
        const LensPath<double> path(lens, LightDirection::to_film, lens.wavelength_nm);
        const double radius = first_order(lens, lens.wavelength_nm).entrance_pupil_diameter / 2;
        for (int i = -15; i <= 15; ++i) {
            for (int j = -15; j <= 15; ++j) {
                LensRays<double, 1> ray{};  // one ray, in mm, relative to the front vertex
                ray.origin.set(0, {radius * i / 15, radius * j / 15, 0});
                ray.direction.set(0, {0, 0, 1});
                trace_lens(path.view(), ray);          // now it is on the last surface, relative to that vertex
                if (ray.status[0] != 0) continue;      // a rim or the stop is in its way
                const double along = (lens.film_distance - ray.origin.z[0]) / ray.direction.z[0];
                std::printf("%.9f %.9f\n", ray.origin.x[0] + along * ray.direction.x[0],
                            ray.origin.y[0] + along * ray.direction.y[0]);
            }
        }
    } catch (const LensFileError& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
