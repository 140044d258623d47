#pragma once
#include <array>
#include <memory>
#include <vector>

#include "../render/gradients/camera_gradient.hpp"
#include "../render/gradients/filtered_film.hpp"

namespace realcam {

/// Derivatives of a picture on the CPU.
class PictureGradient final : public CameraGradient {
public:
    /// Throws InputError as CameraGradient.
    PictureGradient(const Assembly& scene, const Camera& camera, const RenderSettings& settings,
                    std::vector<LensVariable> variables);
    ~PictureGradient() override;

    std::vector<float> picture(const GradientSamples& samples, const KeepGoing& keep_going) override;
    std::vector<double> reverse(const float* adjoint, const float* control, const GradientSamples& samples,
                                const KeepGoing& keep_going) override;
    std::vector<float> forward(const std::vector<double>& directions, const float* control,
                               const GradientSamples& samples, const KeepGoing& keep_going) override;

private:
    static constexpr int kLanes = 256;  ///< film samples per block
    static constexpr int kRays = TangentPath::kLanes;  ///< rays with tangents per block
    class Row;
    class FilmRows;
    struct SampleLight;
    template <int M>
    struct RayBlock;
    struct OutlineBlock;
    struct Direction;
    struct Motions;
    struct EmbreeParts;

    /// Calls pass(row) in parallel for all rows of the extended film.
    template <class Pass>
    void run(const Pass& pass, const KeepGoing& keep_going);
    /// Indices of samples with wavelengths; `variable`: WavelengthVariable of each sample.
    WavelengthsInDouble wavelengths(const float* variable) const;
    /// Returns the address of `many`, or null if the camera has no dispersion.
    const WavelengthsInDouble* if_dispersed(const WavelengthsInDouble& many) const;
    /// Traces a block of rays from the film with their tangents.
    template <int M>
    void trace_film(RayBlock<M>& block, TangentPath::Sums& sums) const;
    /// Traces a block of rays on the outline, with the rims' tangents times the M weights of each ray.
    template <int M>
    void trace_outline(const OutlineBlock& block, const double (&weights)[kRays][M], TangentPath::Sums& sums) const;
    /// Returns the result of `reverse` by M tangents of each ray: 2 if the film has a control variate, else 1.
    template <int M>
    std::vector<double> reverse_along(const AdjointFilm& film, const GradientSamples& samples,
                                      const KeepGoing& keep_going);

    std::unique_ptr<const EmbreeParts> embree_;
    CameraView view_{};
};

}  // namespace realcam
