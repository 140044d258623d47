#pragma once
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "../lens_file.hpp"
#include "../lens_prescription.hpp"

namespace realcam::io {

/// A surface as the lines of a .zmx file state it, in the file's unit where a parameter's unit depends on its type.
struct ZemaxSurface {
    PrescriptionSurface row;
    std::string type = "STANDARD";  // files without TYPE lines mean that
    std::map<int, double> parameters, extra;
    std::map<int, int> parameter_lines;
    std::string glass, hint;
    int glass_line = 0, glass_kind = 0;
    int pickup = 0;  ///< the surface whose glass it takes, where the kind says so
    double n_d = 0, v_d = 0, partial = 0;  ///< of a model glass; of others, what may be left of an earlier one
    double diameter = 0;
    Vec2d aperture_offset = {0, 0};  ///< of its aperture and its obscurations, mm
    double arm_width = 0;            ///< of a spider, mm
    int arms = 0;
    bool has_thickness = false, at_infinity = false;
};

/// Whether the n_d and V_d in the line of a glass are those of a glass, and not what new files have there, 1.5 and 40,
/// or the figures of something else.
bool states_a_glass(const ZemaxSurface& s);

/// What the lines of a .zmx file say.
struct ZemaxFile {
    Prescription prescription;  ///< title, aperture, remarks and what is foreign; the rest is made of what follows
    std::vector<ZemaxSurface> surfaces;  ///< object and image too
    /// The file lists faces alone: no surface is the object, and none has to be the image.
    bool has_faces_alone = false;
    double unit = 1;  ///< mm
    std::vector<std::string> catalogues;
    int field_type = 0;
    std::size_t field_count = 0;
    std::vector<double> x, y, decentre_y, compress_y;
    std::map<int, double> wavelengths;  ///< um, by number
    int primary = 1, positions = 1, current = 1;
    std::map<int, std::vector<double>> zoom;  ///< thicknesses by surface, nan where none is stated
    std::map<int, std::vector<double>> zoom_sizes;  ///< the same of semi-diameters
    std::vector<double> zoom_apertures;
    std::set<std::string> coatings, unknown;
};

/// Throws LensFileError with the line for what is wrong in one.
ZemaxFile zemax_file_of(std::string_view text, const std::string& file, const LensReadOptions& options);

}  // namespace realcam::io
