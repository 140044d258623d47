#pragma once
#include <memory>

#include "field_fan.hpp"
#include "study_request.hpp"

namespace REALCAM_NAMESPACE {

/// Image quality of one field of a lens copy. NaN if no light passes.
struct FieldFigures {
    double rms_spot;  ///< RMS spot radius about the centroid, of all colours, mm
    double distortion;  ///< along the field, relative to the image scale near the axis; 0 on the axis
    double light;  ///< fraction of the stop's area that light passes to the film
    Vec2<double> at;  ///< intersection of the chief ray with the film, mm
    std::vector<double>
        mtf;  ///< geometric MTF times the diffraction limit: all frequencies along the field, then all across it
};

struct CopyFigures {
    double focal_length;  ///< from paraxial rays, mean of both meridians, mm; inf if the lens is afocal
    CopySettings settings;
    std::vector<FieldFigures> fields;
};

/// Monte Carlo tolerance evaluation: computes the image quality of copies that differ little from a nominal lens, also
/// tilted and decentred ones. Rays are aimed once, in the nominal lens. operator() may be called from several threads.
class ToleranceEvaluator {
public:
    /// Throws InputError if the request is invalid or no light of a field passes; passes on what `loop` throws to stop
    /// it.
    ToleranceEvaluator(const LensSystem& nominal, StudyRequest request, const RayLoop& loop = {});
    ~ToleranceEvaluator();
    ToleranceEvaluator(ToleranceEvaluator&&) noexcept;

    CopyFigures operator()(const LensSystem& copy) const;

    const LensSystem& nominal() const;
    const StudyRequest& request() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace REALCAM_NAMESPACE
