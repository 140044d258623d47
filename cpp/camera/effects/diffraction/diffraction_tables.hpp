#pragma once
#include <memory>
#include <vector>

#include "../../../error.hpp"
#include "../../../optics/analysis/aperture_diffraction.hpp"
#include "../direct_lens_path.hpp"
#include "../entrance_pupil_search.hpp"
#include "diffraction_view.hpp"

namespace REALCAM_NAMESPACE {

/// Bounds of the entrance pupil, for each direction to a light, of the rays without reflections. Starbursts are traced
/// from lights along this path as ghosts are along theirs, with the same view. Owns the memory of its view.
class StarburstTables {
public:
    /// `film_radius`: radius of a circle that contains the film, mm. `direct_path`: direct path of the same lens.
    StarburstTables(const LensSystem& lens, double film_radius, std::shared_ptr<const DirectLensPath> direct_path,
                    const PupilTracer& tracer);

    GhostView view() const;

private:
    std::shared_ptr<const DirectLensPath> direct_path_;
    HalfTangentBins directions_;
    std::vector<GhostBounds> entries_;
};

/// Diffraction of a lens, prepared for rendering. Owns the memory of its view.
class DiffractionTables {
public:
    /// `film_radius`: radius of a circle that contains the film, mm. Throws InputError if no light passes the lens.
    DiffractionTables(const LensSystem& lens, double film_radius, const PupilTracer& tracer);

    /// `film_steradians`: approximate solid angle of the film (EffectTables::views).
    DiffractionView view(double film_steradians) const;

private:
    static constexpr int kRadii = 12;  ///< number of film radii of a circular stop
    static constexpr int kRadiiWithBlades = 5, kAzimuths = 8;  ///< numbers of film radii and azimuths with blades

    static InputError no_light(const LensSystem& lens) {
        return InputError("diffraction: no light passes lens \"" + lens.name + "\" to the film centre");
    }
    /// True if blades, and not the wide-open rim, form the aperture.
    static bool has_blades(const LensSystem& lens) { return lens.iris.blades > 0 && !lens.is_wide_open(); }

    /// Returns a film radius, mm.
    double radius_of(int row) const { return film_radius_ * row / (radii_ - 1); }
    /// Returns the azimuth of a sector in radians. Sectors have equal lengths on the square |x| + |y| = 1.
    double azimuth_of(int sector) const;

    /// Bounds of the pupil as seen from each film radius. Where no light arrives, those of the previous radius.
    std::vector<DirectionBox> boxes_of(const LensSystem& lens, const PupilTracer& tracer) const;

    /// Appends the node of a film point with its alias tables and edges.
    void add(const ApertureDiffraction& diffraction);

    double film_radius_;
    int radii_, azimuths_;
    std::vector<DiffractionNode> nodes_;
    std::vector<AliasEntry> entries_;
    std::vector<DiffractionEdge> edges_;
};

}  // namespace REALCAM_NAMESPACE
