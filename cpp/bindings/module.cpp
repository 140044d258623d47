#include "bindings.hpp"
#include "values/value_state.hpp"

PYBIND11_MODULE(_core, m) {
    using namespace realcam::bindings;
    m.doc() = "The C++ core of realcam.";
    m.attr("__version__") = REALCAM_VERSION;
    m.attr("_STATE_FORMAT") = kStateFormat;
    bind_errors(m);
    bind_coating(m);
    bind_glass(m);
    bind_surface(m);
    bind_first_order(m);
    bind_lens(m);
    bind_lens_file(m);
    bind_lens_edits(m);
    bind_device_array(m);
    bind_trace(m);
    bind_derivatives(m);
    bind_seidel(m);
    bind_ghosts(m);
    bind_analysis(m);
    bind_psf(m);
    bind_bundle(m);
    bind_transmission(m);
    bind_tolerance(m);
    bind_camera(m);
    bind_camera_rays(m);
    bind_pupil_table(m);
    bind_projection(m);
    bind_material(m);
    bind_scene(m);
    bind_settings(m);
    bind_render(m);
    bind_plan(m);
    bind_view(m);
    bind_shot(m);
    bind_live(m);
    bind_film_parts(m);
    bind_session(m);
    bind_sensor(m);
    bind_toml(m);
    bind_denoiser(m);
    bind_bench(m);
    bind_help(m);
#if REALCAM_HAS_PICTURES
    bind_pictures(m);
    bind_command(m);
#endif
    finish_module(m);
    watch_exit_and_fork();
}
