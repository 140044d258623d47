#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "../../optics/prescription/lens_system.hpp"

namespace realcam::io {

/// Row of another program's lens table. Lengths in mm.
struct PrescriptionSurface {
    int line = 0;    ///< line in the file; 0: unknown
    int number = 0;  ///< surface number in that program
    double curvature = 0, conic = 0;
    std::map<int, double> aspheric;  ///< power of r: coefficient in mm^(1 - power), including odd powers and 2
    double thickness = 0;
    bool is_mirror = false, is_stop = false;
    Glass material = Glass::air();   ///< medium behind it; not for mirrors
    double clear_semi_diameter = 0;  ///< 0: not stated in the file
    double inner_semi_diameter = 0;
    /// Has an aperture set by the designer, which counts even on a surface that does not bend light.
    bool blocks = false;
    SurfaceForm form;
    ApertureShape aperture_shape;
    Affine<double> before;  ///< transform from its frame to the axis before it, at the surface's position on that axis
    Affine<double> behind;  ///< transform from the axis after it to its own frame
    /// True if its aperture is an obscuring disc, the inner semi-diameter, and light passes everywhere outside it. The
    /// clear semi-diameter, if any, is only the size for drawing.
    bool is_open_outside = false;
};

/// Limit on unknown words that are reported: a file of another kind has as many as lines.
inline constexpr std::size_t kMostUnknown = 1000;

/// Definition of the aperture in a file.
enum class ApertureKind {
    stop_size,  ///< the clear semi-diameter of the stop
    entrance_pupil_diameter,  ///< mm
    f_number,  ///< focal length over entrance pupil diameter, for an object at infinity
    working_f_number,  ///< 1 / (2 slope of the marginal ray behind the lens)
    object_aperture,  ///< numerical aperture in object space
    image_aperture,
};

/// Definition of the field points in a file.
enum class FieldKind { angle_deg, object_height, image_height };

struct PrescriptionField {
    double x = 0, y = 0;
    /// Vignetting factors: fractions of the pupil that are cut off.
    double upper_x = 0, lower_x = 0, upper_y = 0, lower_y = 0;
};

/// Feature of a file that realcam does not model.
struct ForeignFeature {
    std::string what;
    int line = 0, surface = 0;
};

/// Lens as stated in another program's file, before conversion.
struct Prescription {
    std::string file;  ///< name in messages
    std::string format;  ///< "Zemax", ...
    std::string title;
    std::vector<PrescriptionSurface> surfaces;  ///< between object and image
    double object_distance = kInfinity;  ///< object to the first row, mm
    double defocus = 0;  ///< added to the last thickness, mm
    bool has_film_distance = true;  ///< if false, the film lies where the axial spot is smallest
    bool paraxial_image = false;  ///< if the last thickness is 0, the paraxial image distance is used
    ApertureKind aperture_kind = ApertureKind::stop_size;
    double aperture = 0;  ///< in the unit of aperture_kind
    FieldKind field_kind = FieldKind::angle_deg;
    std::vector<PrescriptionField> fields;
    double image_semi_diameter = 0;  ///< size of the image surface; 0: not stated
    double image_curvature = 0;  ///< curvature of the image surface, 1/mm
    SurfacePlacement image_placement;  ///< relative to the axis that leads to the image
    double wavelength_nm = kLineD_nm;
    std::vector<double> wavelengths_nm;  ///< all wavelengths of the file; empty if not stated

    /// Zoom positions: their names, and the thicknesses that change: by row (-1: the object's distance), one value per
    /// position.
    std::vector<std::string> zoom_names;
    int zoom_current = 0;
    std::map<int, std::vector<double>> zoom_thicknesses;
    std::vector<double> zoom_apertures;  ///< empty if constant

    std::vector<ForeignFeature> foreign;
    std::vector<std::string> remarks;  ///< for the user: what was omitted or assumed
};

/// Converts the aspheric terms of a row to those of the core: r^4 to r^18. A term of r^2 is folded into the curvature
/// (see the source), accurately up to `height`, the clear semi-diameter. Returns the terms that cannot be expressed,
/// for a message, or an empty string.
std::string set_aspheric_terms(const PrescriptionSurface& row, double height, Surface& surface);

}  // namespace realcam::io
