#pragma once
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "../lens_file.hpp"
#include "../lens_prescription.hpp"

namespace realcam::io {

/// Surface as stated in a .zmx file; parameters whose unit depends on the surface type are in the file's unit.
struct ZemaxSurface {
    PrescriptionSurface row;
    std::string type = "STANDARD";  // the type in files without TYPE lines
    std::map<int, double> parameters, extra;
    std::map<int, int> parameter_lines;
    std::string glass, hint;
    int glass_line = 0, glass_kind = 0;
    int pickup = 0;  ///< surface whose glass is picked up, if the kind says so
    /// Of a model glass; for other glasses possibly left over from an earlier one.
    double n_d = 0, v_d = 0, partial = 0;
    double diameter = 0;
    Vec2d aperture_offset = {0, 0};  ///< offset of its aperture and its obscurations, mm
    double arm_width = 0;            ///< width of the arms of a spider, mm
    int arms = 0;
    bool has_thickness = false, at_infinity = false;
};

/// True if n_d and V_d in the line of a glass are those of a glass, and not the defaults of new files, 1.5 and 40, or
/// unrelated numbers.
bool states_a_glass(const ZemaxSurface& s);

/// Content of a .zmx file.
struct ZemaxFile {
    /// Title, aperture, remarks and unsupported features; other members are derived from the following.
    Prescription prescription;
    std::vector<ZemaxSurface> surfaces;  ///< including object and image
    /// True if the file lists faces alone: no surface is the object, and the last need not be the image.
    bool has_faces_alone = false;
    double unit = 1;  ///< mm
    std::vector<std::string> catalogues;
    int field_type = 0;
    std::size_t field_count = 0;
    std::vector<double> x, y, decentre_y, compress_y;
    std::map<int, double> wavelengths;  ///< um, by number
    int primary = 1, positions = 1, current = 1;
    std::map<int, std::vector<double>> zoom;  ///< thicknesses by surface, NaN if not stated
    std::map<int, std::vector<double>> zoom_sizes;  ///< semi-diameters by surface, NaN if not stated
    std::vector<double> zoom_apertures;
    std::set<std::string> coatings, unknown;
};

/// Reads the lines of a .zmx file. Throws LensFileError, with the line, if they are invalid.
ZemaxFile zemax_file_of(std::string_view text, const std::string& file, const LensReadOptions& options);

}  // namespace realcam::io
