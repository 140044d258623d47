#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "../camera/camera_setup.hpp"
#include "../checkpoint.hpp"
#include "../optics/derivatives/outline_rays.hpp"
#include "../render/settings/render_settings.hpp"
#include "../scene/assembly.hpp"

namespace realcam {

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
};

/// Derivatives of a picture by numbers of its camera, on the CPU. Pixels are filtered sums of samples on the film
/// (PixelFilter), in lux seconds. The derivative by a number p, at fixed scene rays r of radiance L(r), weight W and
/// film point x(r; p), is
///     sum over samples of L W grad h . dx/dp + sum over the pupil's outline of L h (speed of the outline by p),
/// because a scene ray neither changes its radiance nor, through a lens without coatings, its weight.
///
/// The numbers of a camera, in this order: the lens variables; translation (mm) and rotation (rad) of the film and of
/// the camera (CameraDerivatives); and the radius of the diaphragm, mm.
class PictureGradient {
public:
    /// Throws InputError if scene or camera are invalid, or if derivatives do not support one of their features.
    PictureGradient(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                    std::vector<LensVariable> variables);
    ~PictureGradient();
    PictureGradient(const PictureGradient&) = delete;
    PictureGradient& operator=(const PictureGradient&) = delete;

    int width() const { return camera_.film.width; }
    int height() const { return camera_.film.height; }
    /// True if the scene moves during the exposure.
    bool scene_moves() const { return view_.exposed_time > 0; }
    /// Number of numbers of the camera.
    std::size_t number_count() const { return path_.variable_count() + kOtherNumbers; }

    /// Returns the picture, height x width x 3.
    std::vector<float> picture(const GradientSamples& samples, const KeepGoing& keep_going);

    /// Returns the derivatives of a function of the picture by all numbers. `adjoint`: derivatives of the function by
    /// the pixels, height x width x 3. `control`: control variate of the radiance of each pixel's light, of the same
    /// shape, or null. The derivatives by the pose are those of the picture less the control variate times that of
    /// uniform light, which does not depend on the pose.
    std::vector<double> reverse(const float* adjoint, const float* control, const GradientSamples& samples,
                                const KeepGoing& keep_going);

    /// Returns derivatives of the picture, count x height x width x 3, along `count` directions, each with
    /// number_count() numbers. `control`: see reverse.
    std::vector<float> forward(const std::vector<double>& directions, const float* control,
                               const GradientSamples& samples, const KeepGoing& keep_going);

    /// Number of edges of the pupil that no rim explains, and of all edges, in the last call.
    std::int64_t unexplained_edges() const { return unexplained_; }
    std::int64_t all_edges() const { return edges_; }

private:
    static constexpr std::size_t kOtherNumbers = 13;
    static constexpr int kLanes = 256;  ///< film samples per block
    static constexpr int kRays = TangentPath::kLanes;  ///< rays with tangents per block
    class Row;
    class FilmRows;
    struct SampleLight;
    struct RayBlock;
    struct OutlineBlock;
    struct EmbreeParts;
    struct ReverseSums;
    struct Direction;
    struct Motions;

    /// Camera whose film extends past the picture's border by the pixels of the margin, from which light counts for
    /// pixels at the border.
    static Camera extended(Camera camera, int margin);
    /// Effects of the samples' camera, which are uniform on the extended film.
    static LensEffects sample_effects(const RenderSettings& settings);
    /// Calls pass(row) in parallel for all rows of the extended film.
    template <class Pass>
    void run(const Pass& pass, const KeepGoing& keep_going);
    /// Exposure of a pixel, in lux seconds, by a sample of 1 lux.
    double exposure_per_sample(int spp) const;
    /// Columns per mm along x of the film, and rows per mm along y.
    Vec2d pixels_per_mm() const;
    /// Indices of samples with wavelengths; `variable`: WavelengthVariable of each sample.
    WavelengthsInDouble wavelengths(const float* variable) const;
    /// Returns the address of `many`, or null if the camera has no dispersion.
    const WavelengthsInDouble* if_dispersed(const WavelengthsInDouble& many) const;
    /// Traces a block of rays from the film with their tangents.
    void trace_film(RayBlock& block, TangentPath::Sums& sums) const;
    /// Traces a block of rays on the outline, with the rims' tangents times the weight of each ray.
    void trace_outline(OutlineBlock& block, const std::array<double, kRays>& weights, TangentPath::Sums& sums) const;
    // Ray at the film, in the double precision of its tangent.
    Vec3d film_origin(Vec3f origin) const;
    Vec3d film_direction(Vec3f direction) const;

    Camera camera_;
    RenderSettings settings_;
    int margin_;
    TangentPath path_;
    OutlineRays outline_;
    std::shared_ptr<const CameraSetup> setup_;
    double film_index_;  ///< refractive index in front of the film
    std::unique_ptr<const EmbreeParts> embree_;
    CameraView view_{};
    std::int64_t unexplained_ = 0, edges_ = 0;
};

}  // namespace realcam
