#pragma once
#include <array>
#include <map>
#include <set>

#include "../lens_glass.hpp"
#include "../lens_prescription.hpp"
#include "../lens_text.hpp"

namespace realcam::io {

/// Reads a .seq file command by command.
class CodeVReader {
public:
    CodeVReader(std::string_view text, const std::string& file, LensGlasses& glasses);
    Prescription read();

private:
    using Words = std::vector<LensWord>;

    [[noreturn]] void fail_file(const std::string& message) const;
    double number(const Words& words, std::size_t i, const std::string& what) const;
    /// Returns a number, which may be infinite.
    double number_or_infinity(const Words& words, std::size_t i, const std::string& what) const;
    std::vector<double> numbers(const Words& words, std::size_t from, const std::string& what) const;
    /// Records a feature that is not modelled, at this line and surface.
    void foreign(const std::string& what);
    /// Adds a remark, once.
    void remark(const std::string& what);
    /// True if the command changes the lens defined so far, which is recorded as not supported.
    bool changes_lens(const std::string& command, const Words& words);
    /// True if the first value of a command names surfaces: S3, S2..5, SA.
    static bool names_surfaces(const Words& words);

    void read_line(std::string_view line);
    void read_command(Words words);

    void add_surface(const std::string& command, const Words& words);
    void change_surface(const std::string& command, const Words& words);
    void select(int surface);
    /// Reads radius or curvature, thickness and glass.
    void read_row(const Words& words);
    /// Sets the curvature from the value after the command.
    void set_curvature(PrescriptionSurface& row, const Words& words, bool is_radius) const;
    /// Returns the surface that a qualifier names, S3, SO (object) or SI (image), and removes the qualifier; without
    /// one, the current surface.
    PrescriptionSurface& row_of(Words& words);
    /// Returns false if the command does not apply to a surface.
    bool read_surface_command(const std::string& word, Words words);
    /// Reads surface commands for radius, asphere, thickness, glass and stop.
    bool read_profile(const std::string& word, Words& words);
    /// Reads toroids and other forms without rotational symmetry, decentres, tilts and apertures.
    bool read_form_or_place(const std::string& word, Words& words);
    /// Records commands that change a surface and are not supported.
    bool tell_foreign_surface(const std::string& word, Words& words);
    /// Reads a circle, one half-width of a rectangle or an ellipse, or the offset or rotation of an aperture.
    void read_aperture(const std::string& word, Words& words);
    /// Reads SPS and the kind of special surface.
    void read_special_kind(Words& words);
    /// Reads SCO and one coefficient.
    void read_special_term(Words& words);
    /// Reads AR to DR and AP to DP, of an anamorphic asphere (AAS).
    void read_anamorphic_term(const std::string& word, Words& words);
    /// Returns the index of a word among XDE, YDE, ZDE, ADE, BDE and CDE, or -1.
    static int place_number(const std::string& word);
    /// Sets a surface's placement from the commands read so far.
    void set_place(PrescriptionSurface& row);

    /// Reads private glasses: PWL and the wavelengths, then a name and an index for each, or a name, a formula and its
    /// coefficients. Errors are reported only if a surface uses the glass: makers' files contain unused ones.
    void read_private(const Words& words);
    Glass private_glass(const Words& words) const;
    void set_glass(PrescriptionSurface& row, std::string_view text);

    /// Returns false if the command does not apply to the whole lens.
    bool read_specification(const std::string& word, const Words& words);
    void read_zoom(const Words& words);
    std::vector<double> zoom_values(const Words& words, std::size_t from, const std::string& what) const;

    void finish();
    void finish_image(PrescriptionSurface& image);
    /// Converts the commands of a surface, once all of them are known.
    void finish_aperture(PrescriptionSurface& row);
    void finish_shape(PrescriptionSurface& row);
    void finish_special(PrescriptionSurface& row);
    void finish_anamorphic(PrescriptionSurface& row);
    void finish_fields();
    void finish_wavelength();
    void finish_zoom();

    /// Aperture or obscuration of a surface.
    struct Aperture {
        std::string label;
        char shape = 'C';  ///< C, R or E: circle, rectangle, ellipse
        bool blocks = false;
        Vec2d half = {0, 0}, offset = {0, 0};
        double angle_deg = 0;
    };
    /// Special surface: its kind (XYP, ODD), its normalization radius in the file's unit, and its coefficients by
    /// number, except the conic constant.
    struct Special {
        std::string kind;
        double radius = 1;
        std::map<int, double> terms;
    };

    LensLines lines_;
    LensGlasses& glasses_;
    Prescription p_;
    std::vector<PrescriptionSurface> rows_;  ///< including object and image
    std::size_t current_ = 0;
    bool has_image_ = false, in_private_ = false;
    std::optional<bool> radius_mode_;
    double unit_ = 1;
    std::vector<double> wavelengths_, private_nm_, x_, y_;
    int reference_ = 0, positions_ = 0;
    std::map<std::string, std::vector<double>> vignetting_;
    std::map<int, std::vector<double>> zoom_;
    std::map<int, int> zoom_lines_;
    std::vector<double> zoom_aperture_;
    std::set<std::string> private_names_, zoom_left_out_, unknown_, remarks_;
    std::map<std::string, LensFileError> broken_private_;
    std::set<std::pair<std::string, int>> shaped_, foreign_;
    std::map<int, std::array<double, 6>> places_;  ///< decentres and tilts, by surface number
    std::map<int, std::string> place_kinds_;  ///< DAR, BEN or REV
    std::map<int, std::vector<Aperture>> apertures_;
    std::map<int, Special> specials_;
    std::map<int, std::map<std::string, double>> anamorphic_;
    std::map<int, std::string> toroids_;  ///< CYL, XTO, YTO or AAS
};

/// True if a word consists of digits only.
bool is_digits(std::string_view word);

}  // namespace realcam::io
