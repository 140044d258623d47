#pragma once
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "../../optics/prescription/lens_system.hpp"

namespace realcam::io {

/// One row of another program's lens table. Lengths in mm.
struct PrescriptionSurface {
    int line = 0;    ///< of the file; 0: it has none
    int number = 0;  ///< as its program counts
    double curvature = 0, conic = 0;
    std::map<int, double> aspheric;  ///< power of r: mm^(1 - power); odd powers and 2 too
    double thickness = 0;
    bool is_mirror = false, is_stop = false;
    Glass material = Glass::air();   ///< behind it; not of a mirror
    double clear_semi_diameter = 0;  ///< 0: the file does not say it
    double inner_semi_diameter = 0;
    bool blocks = false;  ///< it has an aperture that somebody gave it, so that it counts even where it bends no light
    SurfaceForm form;
    ApertureShape aperture_shape;
    Affine<double> before;  ///< from its frame to that of the axis in front of it, at its place there
    Affine<double> behind;  ///< from the frame of the axis behind it to its own
    /// Its aperture is a disc that blocks, the inner semi-diameter, and light passes everywhere beyond it. The clear
    /// semi-diameter, if any, is how large the surface is drawn.
    bool is_open_outside = false;
};

/// Words that are not known are named; a file of another kind has as many as lines.
inline constexpr std::size_t kMostUnknown = 1000;

/// How a file says how wide the light's cone is.
enum class ApertureKind {
    stop_size,  ///< the clear semi-diameter of the stop
    entrance_pupil_diameter,  ///< mm
    f_number,  ///< of the lens at infinity: focal length over entrance pupil diameter
    working_f_number,  ///< 1 / (2 slope of the marginal ray behind the lens)
    object_aperture,  ///< numerical, of the object's side
    image_aperture,
};

/// How a file says where its field points are.
enum class FieldKind { angle_deg, object_height, image_height };

struct PrescriptionField {
    double x = 0, y = 0;
    double upper_x = 0, lower_x = 0, upper_y = 0, lower_y = 0;  ///< shares of the pupil that are cut off
};

/// What a file has that realcam has no model of.
struct ForeignFeature {
    std::string what;
    int line = 0, surface = 0;
};

/// A lens as another program's file states it, before anything is made of it.
struct Prescription {
    std::string file;  ///< what messages call it
    std::string format;  ///< "Zemax", ...
    std::string title;
    std::vector<PrescriptionSurface> surfaces;  ///< between object and image
    double object_distance = kInfinity;  ///< object to the first row, mm
    double defocus = 0;  ///< added to the last thickness, mm
    bool has_film_distance = true;  ///< else the film lies where the axial spot is smallest
    bool paraxial_image = false;  ///< the last thickness is that to the paraxial image where it is 0
    ApertureKind aperture_kind = ApertureKind::stop_size;
    double aperture = 0;  ///< in the unit of its kind
    FieldKind field_kind = FieldKind::angle_deg;
    std::vector<PrescriptionField> fields;
    double image_semi_diameter = 0;  ///< of the image surface; 0: not said
    double image_curvature = 0;  ///< of the image surface
    SurfacePlacement image_placement;  ///< as seen from the axis that leads to it
    double wavelength_nm = kLineD_nm;
    std::vector<double> wavelengths_nm;  ///< all of the file; empty: it states none

    /// Zoom positions: their names, and what changes: by row (-1: the object's distance), a value for each.
    std::vector<std::string> zoom_names;
    int zoom_current = 0;
    std::map<int, std::vector<double>> zoom_thicknesses;
    std::vector<double> zoom_apertures;  ///< empty: they do not change

    std::vector<ForeignFeature> foreign;
    std::vector<std::string> remarks;  ///< for whoever reads the file: what was left out or assumed
};

}  // namespace realcam::io
