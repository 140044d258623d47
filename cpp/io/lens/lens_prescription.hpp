#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "../../optics/prescription/lens_system.hpp"

namespace realcam::io {

/// Row of another program's lens table: a surface and the medium behind it. Lengths in mm.
struct PrescriptionSurface {
    int line = 0;    ///< line in the file; 0: unknown
    int number = 0;  ///< surface number in that program
    double curvature = 0, conic = 0;  ///< vertex curvature in 1/mm, conic constant
    std::map<int, double> aspheric;  ///< power of r: coefficient in mm^(1 - power), including odd powers and 2
    double thickness = 0;  ///< axial distance to the next row
    bool is_mirror = false, is_stop = false;
    Glass material = Glass::air();   ///< medium behind the surface; unused for mirrors
    double clear_semi_diameter = 0;  ///< 0: not stated in the file
    double inner_semi_diameter = 0;  ///< radius of a central obscuration; 0: none
    /// True if the designer has specified an aperture, which blocks light even on a surface that does not bend it.
    bool has_aperture = false;
    SurfaceForm form;
    ApertureShape aperture_shape;
    /// Rigid motion from the surface's frame to the frame of the axis that leads to it, whose origin lies at the
    /// surface's position on that axis.
    Affine<double> before;
    Affine<double> behind;  ///< rigid motion from the frame of the axis that leaves the surface to the surface's frame
    /// True if the aperture is an obscuring disc, of the inner semi-diameter, outside which all light passes. The clear
    /// semi-diameter, if any, is only the size for drawing.
    bool is_open_outside = false;
};

/// Limit on the unknown keywords that are stored for a warning: a file that is not a lens file has one per line.
inline constexpr std::size_t kMaxUnknownWords = 1000;

/// Definition of the aperture in a file.
enum class ApertureKind {
    stop_size,  ///< the clear semi-diameter of the stop
    entrance_pupil_diameter,  ///< mm
    f_number,  ///< focal length over entrance pupil diameter, for an object at infinity
    working_f_number,  ///< 1 / (2 slope of the marginal ray behind the lens)
    object_aperture,  ///< numerical aperture in object space
    image_aperture,  ///< numerical aperture in image space
};

/// Definition of the field points in a file.
enum class FieldKind { angle_deg, object_height, image_height };  // heights in mm

/// Field point of a file.
struct PrescriptionField {
    double x = 0, y = 0;  ///< in the unit of the file's FieldKind
    /// Vignetting factors: fractions of the pupil's radius that are cut off at its +x, -x, +y and -y edges.
    double upper_x = 0, lower_x = 0, upper_y = 0, lower_y = 0;
};

/// Feature of a file that realcam does not model.
struct UnsupportedFeature {
    std::string description;  ///< noun phrase for messages, such as "a Fresnel surface"
    int line = 0, surface = 0;  ///< in the file; 0: unknown
};

/// Lens as stated in another program's file, before conversion.
struct Prescription {
    std::string file;  ///< name in messages
    std::string format;  ///< name of the format, such as "Zemax"
    std::string title;
    std::vector<PrescriptionSurface> surfaces;  ///< between object and image
    double object_distance = kInfinity;  ///< object to the first row, mm
    double defocus = 0;  ///< added to the last thickness, the distance from the last row to the image, mm
    bool has_film_distance = true;  ///< if false, the film lies where the axial spot is smallest
    bool paraxial_image = false;  ///< if the last thickness is 0, the paraxial image distance is used
    ApertureKind aperture_kind = ApertureKind::stop_size;
    double aperture = 0;  ///< in the unit of aperture_kind
    FieldKind field_kind = FieldKind::angle_deg;
    std::vector<PrescriptionField> fields;
    double image_semi_diameter = 0;  ///< semi-diameter of the image surface, mm; 0: not stated
    double image_curvature = 0;  ///< curvature of the image surface, 1/mm
    SurfacePlacement image_placement;  ///< relative to the axis that leads to the image
    double wavelength_nm = kLineD_nm;
    std::vector<double> wavelengths_nm;  ///< all wavelengths of the file; empty if not stated

    std::vector<std::string> zoom_names;  ///< names of the zoom positions; empty if the lens is not a zoom lens
    int zoom_current = 0;  ///< index of the position in which the lens is read
    /// Thicknesses that differ between zoom positions, by index of the row (-1: the object distance): one value per
    /// position, in mm.
    std::map<int, std::vector<double>> zoom_thicknesses;
    std::vector<double> zoom_apertures;  ///< `aperture` in each zoom position; empty if constant

    std::vector<UnsupportedFeature> unsupported;
    std::vector<std::string> remarks;  ///< warnings for the user about everything omitted or assumed
};

/// Sets curvature, conic, form and aspheric terms of `surface` from a row. The core has even terms from r^4 to r^18,
/// and radial terms of other powers. A term of r^2 is converted to curvature and higher terms (see
/// convert_square_term), accurately up to `height`, the clear semi-diameter in mm. Returns a noun phrase for the terms
/// that cannot be expressed, or an empty string.
std::string set_aspheric_terms(const PrescriptionSurface& row, double height, Surface& surface);

}  // namespace realcam::io
