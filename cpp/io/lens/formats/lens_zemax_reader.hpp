#pragma once
#include "../lens_text.hpp"
#include "lens_zemax_file.hpp"

namespace realcam::io {

/// Reads a .zmx file line by line.
class ZemaxReader {
public:
    ZemaxReader(std::string_view text, const std::string& file, const LensReadOptions& options);
    ZemaxFile read();

private:
    using Words = std::vector<LensWord>;

    double number(const Words& words, std::size_t i, const char* what) const;
    double number_or(const Words& words, std::size_t i, const char* what, double otherwise) const;
    double length(const Words& words, std::size_t i, const char* what) const;
    /// Returns a length, which may be infinite.
    double length_or_infinity(const Words& words, std::size_t i, const char* what) const;
    int whole(const Words& words, const char* what, int least, int most) const;
    /// Records a feature that is not modelled, at this line and surface.
    void foreign(const std::string& what);
    int current_number() const;

    void read_line(std::string_view line);
    void begin_surface(const Words& words);

    /// Returns false if the keyword is not known.
    bool read_surface_line(const std::string& word, std::string_view rest);
    void read_tilt(ZemaxSurface& s, const Words& words);
    void read_glass(ZemaxSurface& s, const Words& words);

    /// Returns false if the keyword is not known.
    bool read_system_line(const std::string& word, std::string_view rest);
    void set_unit(const Words& words);
    void set_aperture(ApertureKind kind, double value);
    /// Reads an operand of the multi-configuration editor: NAME surface configuration value.
    bool read_zoom_line(const std::string& word, std::string_view rest);

    LensLines lines_;
    ZemaxFile out_;
    bool in_surface_ = false, has_indents_ = false;
    std::set<std::string> zoom_foreign_;  ///< features already recorded
    std::set<std::pair<std::string, int>> foreign_;  ///< features already recorded, by surface
};

/// True for keywords that do not affect the path of light, or that repeat others: names, solves, tolerances, drawing.
bool is_harmless_in_zemax(const std::string& word, bool in_surface);

}  // namespace realcam::io
