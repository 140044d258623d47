// Uses realcam's optics alone: a singlet, its focal length, and one real ray through it.
#include <cmath>
#include <cstdio>
#include <realcam/optics/lens/focus.hpp>
#include <realcam/optics/lens/paraxial.hpp>
#include <realcam/optics/prescription/lens_checks.hpp>
#include <realcam/optics/trace/lens_path.hpp>

int main() {
    using namespace realcam;
    LensSystem lens;
    lens.name = "singlet";
    Surface front, back, stop;
    front.curvature = 1 / 50.0;
    front.thickness = 5;
    front.material = Glass::constant(1.5);
    back.curvature = -1 / 50.0;
    stop.type = SurfaceType::stop;
    front.clear_semi_diameter = back.clear_semi_diameter = stop.clear_semi_diameter = 10;
    lens.surfaces = {front, back, stop};
    lens.stop_semi_diameter = 10;
    validate(lens);

    // Lensmaker's equation for a thick lens: 1/f = (n - 1)(1/R1 - 1/R2 + (n - 1) t / (n R1 R2)).
    const double power = 0.5 * (1 / 50.0 + 1 / 50.0 - 0.5 * 5 / (1.5 * 50 * 50));
    const double focal_length = first_order(lens, kLineD_nm).effective_focal_length;

    const LensPath<double> path(lens, LightDirection::to_film, kLineD_nm);
    LensRays<double, 1> ray{};
    ray.origin.set(0, {1, 0, 0});
    ray.direction.set(0, {0, 0, 1});
    trace_lens(path.view(), ray);

    std::printf("f = %.6f mm, closed form %.6f mm\n", focal_length, 1 / power);
    const bool bends_to_axis = ray.status[0] == 0 && ray.direction.x[0] < 0;
    return std::fabs(focal_length * power - 1) < 1e-12 && bends_to_axis ? 0 : 1;
}
