#pragma once
#include <memory>

#include "field_fan.hpp"
#include "study_request.hpp"

namespace REALCAM_NAMESPACE {

/// Image quality of one field of a lens copy.
struct FieldFigures {
    double rms_spot;  ///< RMS spot radius about the centroid, of all wavelengths, mm; NaN if no light passes
    double distortion;  ///< along the field, relative to the image scale near the axis; 0 on the axis
    double light;  ///< fraction of the stop's area through which light reaches the film
    Vec2<double> at;  ///< intersection of the chief ray with the film, mm
    /// Geometric MTF times the diffraction limit: at all frequencies along the field's direction, then at all
    /// frequencies across it; NaN if no light passes.
    std::vector<double> mtf;
};

/// Image quality of a lens copy after compensation.
struct CopyFigures {
    double focal_length;  ///< from rays close to the axis, mean of both meridians, mm; infinite for an afocal lens
    CopySettings settings;  ///< of the compensators
    std::vector<FieldFigures> fields;
};

/// Evaluator of Monte Carlo tolerancing: adjusts the compensators of lens copies that differ little from a nominal
/// lens, and computes their image quality. Errors may include tilts and decentres. Rays are aimed once, in the nominal
/// lens.
class ToleranceEvaluator {
public:
    /// Aims the rays of all fields in the nominal lens. Throws InputError if the request is invalid or no light of a
    /// field passes, and Cancelled if `loop` is cancelled.
    ToleranceEvaluator(const LensSystem& nominal, StudyRequest request, const RayLoop& loop = {});
    ~ToleranceEvaluator();
    ToleranceEvaluator(ToleranceEvaluator&&) noexcept;

    /// Evaluates a copy of the lens. Several threads may call it at once.
    CopyFigures operator()(const LensSystem& copy) const;

    const LensSystem& nominal() const;
    const StudyRequest& request() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace REALCAM_NAMESPACE
