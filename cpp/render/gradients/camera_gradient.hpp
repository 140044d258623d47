#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "../../camera/camera_setup.hpp"
#include "../../checkpoint.hpp"
#include "../../optics/derivatives/outline_rays.hpp"
#include "../../scene/assembly.hpp"
#include "../settings/render_settings.hpp"
#include "gradient_film.hpp"

namespace REALCAM_NAMESPACE {

/// Samples of a derivative.
struct GradientSamples {
    std::uint32_t seed = 0;
    int spp = 64;  ///< samples per pixel on the film; those of a picture with the same seed
    int outline_spp = 16;  ///< samples per pixel on the outline of the pupil
    /// Samples on the film come in pairs, whose film points are mirrored in the pixel's centre and whose other random
    /// numbers are equal: the gradient of the filter, where the light is even, cancels in them.
    bool pairs = true;
    bool interior = true, boundary = true;  ///< terms of the derivative; false only for tests
    /// True: the scene is replaced by uniform light of radiance 1 in all channels, and no ray is traced in it.
    bool uniform = false;

    /// Seed of the samples on the outline, which are independent of those on the film.
    std::uint32_t outline_seed() const { return hash32(seed, 0x6f75746cu); }
};

/// Derivatives of a picture by numbers of its camera, on one device. Pixels are filtered sums of samples on the film
/// (PixelFilter), in lux seconds. The derivative by a number p, at fixed scene rays r of radiance L(r), weight W and
/// film point x(r; p), is
///     sum over samples of L W grad h . dx/dp + sum over the pupil's outline of L h (speed of the outline by p),
/// because a scene ray neither changes its radiance nor, through a lens without coatings, its weight.
///
/// The numbers of a camera, in this order: the lens variables; translation (mm) and rotation (rad) of the film and of
/// the camera (CameraDerivatives); the radius of the diaphragm, mm; and a common factor of the semi-diameters of all
/// surfaces but the stop.
class CameraGradient {
public:
    virtual ~CameraGradient() = default;
    CameraGradient(const CameraGradient&) = delete;
    CameraGradient& operator=(const CameraGradient&) = delete;

    int width() const { return camera_.film.width; }
    int height() const { return camera_.film.height; }
    /// True if the scene moves during the exposure.
    bool scene_moves() const { return scene_moves_; }
    /// Number of numbers of the camera.
    std::size_t number_count() const { return path_.variable_count() + kOtherNumbers; }

    // All results have three channels, and `keep_going` is called on the calling thread. Throws Cancelled if it returns
    // false.

    /// Returns the picture, height x width x 3.
    virtual std::vector<float> picture(const GradientSamples& samples, const KeepGoing& keep_going) = 0;

    /// Returns the derivatives of a function of the picture by all numbers. `adjoint`: derivatives of the function by
    /// the pixels, height x width x 3. `control`: control variate of the radiance of each pixel's light, of the same
    /// shape, or null. The derivatives by the pose are those of the picture less the control variate times that of
    /// uniform light, which does not depend on the pose.
    virtual std::vector<double> reverse(const float* adjoint, const float* control, const GradientSamples& samples,
                                        const KeepGoing& keep_going) = 0;

    /// Returns derivatives of the picture, count x height x width x 3, along `count` directions, each with
    /// number_count() numbers. `control`: see reverse.
    virtual std::vector<float> forward(const std::vector<double>& directions, const float* control,
                                       const GradientSamples& samples, const KeepGoing& keep_going) = 0;

    /// Number of edges of the pupil that no rim explains, and of all edges, in the last call.
    std::int64_t unexplained_edges() const { return unexplained_; }
    std::int64_t all_edges() const { return edges_; }

protected:
    /// `tracer`: traces the rays of the pupil search. Throws InputError if scene or camera are invalid, or if
    /// derivatives do not support one of their features.
    CameraGradient(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                   std::vector<LensVariable> variables, const PupilTracer& tracer);

    static constexpr std::size_t kOtherNumbers = 14;

    /// Returns the sum over the channels of the adjoint times the control variate, for AdjointFilm; empty without one.
    std::vector<float> adjoint_of_control(const float* adjoint, const float* control) const;
    /// Exposure of a pixel, in lux seconds, by a sample of 1 lux.
    double exposure_per_sample(int spp) const;
    /// Columns per mm along x of the film, and rows per mm along y.
    Vec2d pixels_per_mm() const;
    /// Returns the derivatives by all numbers, in their order.
    static std::vector<double> by_all_numbers(const CameraDerivatives& by, double by_stop, double by_rims);

    Camera camera_;
    RenderSettings settings_;
    GradientFilm film_;
    TangentPath path_;
    OutlineRays outline_;
    /// The camera with the film that extends past the picture's border.
    std::shared_ptr<const CameraSetup> setup_;
    bool scene_moves_ = false;  ///< set by the device's class, which places the scene
    std::int64_t unexplained_ = 0, edges_ = 0;
};

}  // namespace REALCAM_NAMESPACE
