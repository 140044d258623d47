#pragma once
#include <cstddef>

#include "../optics/lens_view.hpp"
#include "../optics/pupil_view.hpp"
#include "circle_of_confusion.hpp"

namespace REALCAM_NAMESPACE {

/// How the film is lit, from the crudest to the real. All have the same film, focus and exposure on the axis.
enum class CameraModel : int {
    pinhole,     ///< the entrance pupil's middle: everything sharp
    thin_lens,   ///< an ideal lens in the entrance pupil: defocus only, light falls off with cos^4
    thick_lens,  ///< the paraxial matrix of the real lens, with its two pupils and its real film distance
    full_lens,   ///< every surface of the prescription
};

/// An ideal lens in its entrance pupil. mm.
struct ThinLens {
    float image_distance;           ///< film to pupil that gives the real lens's magnification
    float inverse_object_distance;  ///< pupil to the plane in focus; 0 at infinity
    float pupil_radius;
};

/// The paraxial lens as a matrix from the last vertex back to the front one: h = D h' - B u', u = -C h' + A u'.
struct ThickLens {
    float A, B, C, D;
    float exit_pupil_distance;  ///< film to exit pupil, positive towards the scene, mm
    float exit_pupil_radius;
};

struct CameraView {
    CameraModel model;
    int width, height;                    ///< pixels
    float film_half_width, film_half_height;  ///< mm
    float film_distance;                  ///< last vertex to film, mm
    float axis_irradiance;  ///< of the real lens on the axis for unit radiance; the ideal models take it over
    float front_vertex_m;   ///< film to front vertex, metres
    float pupil_m;          ///< film to entrance pupil, metres
    ThinLens thin;
    ThickLens thick;
    CircleOfConfusion circle;
    PupilView pupil;
    LensView<float> lens;
    Vec3f position;                ///< of the film's middle, relative to the origin of the placed scene, metres
    Vec3f right, up, backward;     ///< axes of the camera in the scene: x, y, z of the lens frame
};

/// A camera's view with every array replaced by a copy elsewhere: `copy(pointer, count)` returns where to.
template <class Copy>
CameraView with_copied_arrays(CameraView view, Copy&& copy) {
    const auto move = [&](auto*& array, int count) {
        if (array) array = copy(array, static_cast<std::size_t>(count));
    };
    move(view.lens.surfaces, view.lens.count);
    move(view.pupil.nodes, view.pupil.rows + 1);
    move(view.pupil.outline, view.pupil.rows * view.pupil.sectors);
    return view;
}

}  // namespace REALCAM_NAMESPACE
