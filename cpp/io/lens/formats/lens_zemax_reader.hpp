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
    /// The same, or infinity.
    double length_or_infinity(const Words& words, std::size_t i, const char* what) const;
    int whole(const Words& words, const char* what, int least, int most) const;
    /// Notes what there is no model of, at this line and surface.
    void foreign(const std::string& what);
    int current_number() const;

    void read_line(std::string_view line);
    void begin_surface(const Words& words);

    /// False where the keyword is not known.
    bool read_surface_line(const std::string& word, std::string_view rest);
    void read_tilt(ZemaxSurface& s, const Words& words);
    void read_glass(ZemaxSurface& s, const Words& words);

    /// False where the keyword is not known.
    bool read_system_line(const std::string& word, std::string_view rest);
    void set_unit(const Words& words);
    void set_aperture(ApertureKind kind, double value);
    /// An operand of the multi-configuration editor: NAME what configuration value.
    bool read_zoom_line(const std::string& word, std::string_view rest);

    LensLines lines_;
    ZemaxFile out_;
    bool in_surface_ = false, has_indents_ = false;
    std::set<std::string> zoom_foreign_;  ///< what has been named once
    std::set<std::pair<std::string, int>> foreign_;  ///< the same, by surface
};

/// Keywords that say nothing about where light goes, or repeat what others say: names, solves, tolerances, drawing.
bool is_harmless_in_zemax(const std::string& word, bool in_surface);

}  // namespace realcam::io
