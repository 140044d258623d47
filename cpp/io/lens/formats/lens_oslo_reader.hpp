#pragma once
#include <map>
#include <optional>
#include <set>
#include <utility>

#include "../lens_glass.hpp"
#include "../lens_prescription.hpp"
#include "../lens_text.hpp"

namespace realcam::io {

/// Surface as stated in a .len file, in the file's unit.
struct OsloSurface {
    int line = 0, number = 0;
    double curvature = 0, conic = 0, thickness = 0, semi_diameter = 0;
    std::map<int, double> aspheric;  ///< by the number in the command's name: ASn
    std::map<int, double> plain_terms;  ///< by power: AD is the term of r^4
    int aspheric_step = 0;  ///< AS1 is the term of r^2 (2) or of r (1); 0: not stated
    bool is_mirror = false, is_stop = false, is_checked = false;
    /// Medium: a name, indices at the file's wavelengths, or n_d and V_d. Air if all are empty.
    std::string glass;
    std::vector<double> indices;
    std::optional<AbbePair> pair;
    int glass_line = 0;

    struct Pickup {
        std::string what;  ///< CV, CVM, TH, THM, GLA or AP
        int from;          ///< surface
        double added;
        int line;
    };
    std::vector<Pickup> pickups;
    std::optional<double> axial_slope, axial_height;  ///< solves: PU for the curvature, PY for the thickness
};

/// Reads an OSLO .len file command by command.
class OsloReader {
public:
    OsloReader(std::string_view text, const std::string& file, LensGlasses& glasses);
    Prescription read();

private:
    using Words = std::vector<LensWord>;

    double number(const Words& words, std::size_t i, const std::string& what) const;
    /// Records a feature that is not modelled, at this line and surface; once for each surface.
    void foreign(const std::string& what);

    /// Reads the commands of a line, separated by ';'; "//" begins a remark.
    void read_line(std::string_view line);
    void read_command(std::string_view text);
    bool read_system(const std::string& word, const Words& words);
    bool read_wavelengths(const std::string& word, const Words& words);
    void begin_lens(const Words& words);
    void next_surface();
    void end_lens(const Words& words);

    /// Returns false if the command does not apply to a surface.
    bool read_surface(const std::string& word, const Words& words);
    void read_glass(const Words& words);
    void read_aperture(const Words& words);
    void read_pickup(const Words& words);
    bool read_asphere(const std::string& word, const Words& words);
    /// True if the command is about a feature that is not modelled, which is recorded unless its value is 0.
    bool read_foreign(const std::string& word, const Words& words);

    OsloSurface& surface() { return rows_[current_]; }
    void resolve_pickups();
    void pick_up(OsloSurface& s, const OsloSurface::Pickup& pickup);
    /// Resolves solves by tracing the marginal ray through the surfaces in order.
    void resolve_solves();
    Glass medium_of(const OsloSurface& s);
    Glass named_glass(const std::string& name);
    std::vector<double> wavelengths_um() const;
    void finish();
    void finish_aperture();

    LensLines lines_;
    LensGlasses& glasses_;
    Prescription p_;
    std::vector<OsloSurface> rows_;  ///< including object and image
    std::vector<Glass> media_;       ///< medium behind each surface
    std::size_t current_ = 0;
    bool has_ended_ = false, has_late_wavelengths_ = false, has_configurations_ = false;
    int stated_last_ = -1;  ///< number of the image surface, from the first line
    double unit_ = 1;       ///< mm
    std::map<int, double> wavelengths_;  ///< um, from 1
    std::optional<double> beam_radius_;  ///< at the first surface, in the file's unit
    std::optional<std::pair<ApertureKind, double>> aperture_;
    std::optional<std::pair<FieldKind, double>> field_;
    std::set<std::string> unknown_, shared_names_;
    std::set<std::pair<std::string, int>> foreign_;
};

}  // namespace realcam::io
