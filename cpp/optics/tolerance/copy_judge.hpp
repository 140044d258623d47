#pragma once
#include <memory>

#include "field_fan.hpp"
#include "study_request.hpp"

namespace REALCAM_NAMESPACE {

/// What became of one field of a copy. NaN where no light passes.
struct FieldFigures {
    double rms_spot;    ///< radius about the middle of the spot, of all colours, mm
    double distortion;  ///< share of the picture's scale near the axis, along the field; 0 on the axis
    double light;       ///< share of the stop from which light comes
    Vec2<double> at;    ///< where the chief ray meets the film, mm
    std::vector<double>
        mtf;  ///< of rays alone times its limit by diffraction; for each frequency along the field, then across it
};

struct CopyFigures {
    double focal_length;  ///< of close rays, the mean of both meridians, mm; inf where the lens is afocal
    CopySettings settings;
    std::vector<FieldFigures> fields;
};

/// Judges lenses that are nearly the one that it was made for, tilted and decentred ones too. Rays are aimed once, in
/// that lens. It may be asked from several threads.
class CopyJudge {
public:
    /// Throws InputError for an impossible request and where no light passes, and what `loop` throws to stop it.
    CopyJudge(const LensSystem& nominal, StudyRequest request, const RayLoop& loop = {});
    ~CopyJudge();
    CopyJudge(CopyJudge&&) noexcept;

    CopyFigures operator()(const LensSystem& copy) const;

    const LensSystem& nominal() const;
    const StudyRequest& request() const;

private:
    struct Parts;
    std::unique_ptr<Parts> parts_;
};

}  // namespace REALCAM_NAMESPACE
