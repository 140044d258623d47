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
    /// The same, or infinity.
    double number_or_infinity(const Words& words, std::size_t i, const std::string& what) const;
    std::vector<double> numbers(const Words& words, std::size_t from, const std::string& what) const;
    /// Notes what there is no model of, at this line and surface.
    void foreign(const std::string& what);
    /// Something to tell once.
    void remark(const std::string& what);
    /// Whether the command is one that makes another lens of this one, which is noted.
    bool changes_lens(const std::string& command, const Words& words);
    /// Whether the first value of a command names surfaces: S3, S2..5, SA.
    static bool names_surfaces(const Words& words);

    void read_line(std::string_view line);
    void read_command(Words words);

    void add_surface(const std::string& command, const Words& words);
    void change_surface(const std::string& command, const Words& words);
    void select(int surface);
    /// Radius or curvature, thickness, glass.
    void read_row(const Words& words);
    /// Sets the curvature from the value behind the command.
    void set_curvature(PrescriptionSurface& row, const Words& words, bool is_radius) const;
    /// The surface that a qualifier names, S3, SS (stop) or SI; takes it from the words. Others: the current one.
    PrescriptionSurface& row_of(Words& words);
    /// False where the command is none of a surface.
    bool read_surface_command(const std::string& word, Words words);
    /// Of these, radius, asphere, thickness, glass and stop.
    bool read_profile(const std::string& word, Words& words);
    /// Toroids and other forms that are not of revolution, decentres, tilts and apertures.
    bool read_form_or_place(const std::string& word, Words& words);
    /// What is not read, and changes the lens.
    bool tell_foreign_surface(const std::string& word, Words& words);
    /// A circle, a side of a rectangle or an ellipse, or where its middle is and how it is turned.
    void read_aperture(const std::string& word, Words& words);
    /// SPS and the kind of special surface.
    void read_special_kind(Words& words);
    /// SCO and a coefficient of it.
    void read_special_term(Words& words);
    /// AR to DR and AP to DP, of an anamorphic asphere (AAS).
    void read_anamorphic_term(const std::string& word, Words& words);
    /// Of XDE, YDE, ZDE, ADE, BDE and CDE; -1: another word.
    static int place_number(const std::string& word);
    /// From what is known of it so far.
    void set_place(PrescriptionSurface& row);

    /// Glasses of the file's own: PWL and the wavelengths, then a name and an index for each, or a name, a formula and
    /// its coefficients. What is wrong with one is told where a surface has it: makers' files carry some that none has.
    void read_private(const Words& words);
    Glass private_glass(const Words& words) const;
    void set_glass(PrescriptionSurface& row, std::string_view text);

    /// False where the command says nothing about all of the lens.
    bool read_specification(const std::string& word, const Words& words);
    void read_zoom(const Words& words);
    std::vector<double> zoom_values(const Words& words, std::size_t from, const std::string& what) const;

    void finish();
    void finish_image(PrescriptionSurface& image);
    /// What a row's commands make of it, once all of them are known.
    void finish_aperture(PrescriptionSurface& row);
    void finish_shape(PrescriptionSurface& row);
    void finish_special(PrescriptionSurface& row);
    void finish_anamorphic(PrescriptionSurface& row);
    void finish_fields();
    void finish_wavelength();
    void finish_zoom();

    /// An aperture of a surface, or what blocks in it.
    struct Aperture {
        std::string label;
        char shape = 'C';  ///< C, R or E: circle, rectangle, ellipse
        bool blocks = false;
        Vec2d half = {0, 0}, offset = {0, 0};
        double angle_deg = 0;
    };
    /// A special surface: its kind (XYP, ODD), its normalization radius in the file's unit, and its coefficients by
    /// number, the conic's aside.
    struct Special {
        std::string kind;
        double radius = 1;
        std::map<int, double> terms;
    };

    LensLines lines_;
    LensGlasses& glasses_;
    Prescription p_;
    std::vector<PrescriptionSurface> rows_;  ///< object and image too
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
    std::map<int, std::array<double, 6>> places_;  ///< decentres and tilts, by the number of the surface
    std::map<int, std::string> place_kinds_;  ///< DAR, BEN or REV
    std::map<int, std::vector<Aperture>> apertures_;
    std::map<int, Special> specials_;
    std::map<int, std::map<std::string, double>> anamorphic_;
    std::map<int, std::string> toroids_;  ///< CYL, XTO, YTO or AAS
};

/// Whether a word is digits alone.
bool is_digits(std::string_view word);

}  // namespace realcam::io
