// Uses realcam's lens files: a bundled lens by its name, one real ray through it, a glass, and an error.
#include <cmath>
#include <cstdio>
#include <realcam/io/lens/lens_file.hpp>
#include <realcam/optics/lens/focus.hpp>
#include <realcam/optics/lens/paraxial.hpp>
#include <realcam/optics/trace/lens_path.hpp>

int main() {
    using namespace realcam;
    const LensSystem lens = io::read_lens("double-gauss-100mm");
    const LensPath<double> path(lens, LightDirection::to_film, lens.wavelength_nm);
    LensRays<double, 1> ray{};
    ray.origin.set(0, {25, 0, 0});
    ray.direction.set(0, {0, 0, 1});
    trace_lens(path.view(), ray);

    // CODE V's listing of this lens prints this ray's point on the last surface and its slope behind it, with six
    // decimals: half of the last one is what it leaves open.
    const double height = ray.origin.x[0], slope = ray.direction.x[0] / ray.direction.z[0];
    std::printf("%s: x = %.6f mm, slope %.6f\n", lens.name.c_str(), height, slope);
    if (ray.status[0] != 0 || std::fabs(height - 16.261006) > 5e-7 || std::fabs(slope + 0.258832) > 5e-7) return 1;

    // Schott's data sheet of N-BK7: n_d = 1.51680.
    if (std::fabs(io::catalogue_glass("N-BK7").index(kLineD_nm) - 1.51680) > 5e-6) return 2;

    try {
        io::read_lens("double-gauss-100");
    } catch (const LensFileError& error) {
        std::printf("%s\n", error.what());
        return 0;
    }
    return 3;
}
