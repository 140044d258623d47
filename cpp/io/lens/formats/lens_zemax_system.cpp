// Lines of a .zmx file for the whole lens: unit, aperture, fields, wavelengths, configurations.

#include <algorithm>
#include <cmath>

#include "../../text/printable.hpp"
#include "lens_zemax_reader.hpp"

namespace realcam::io {

bool ZemaxReader::read_system_line(const std::string& word, std::string_view rest) {
    if (is_harmless_in_zemax(word, false)) return true;
    static const std::set<std::string> ours{"MODE", "UNIT", "ENPD", "FNUM", "OBNA", "FLOA", "GCAT",
                                            "FTYP", "XFLN", "YFLN", "XFLD", "YFLD", "VDYN", "VCYN",
                                            "WAVM", "WAVL", "PWAV", "MNUM", "AFOC"};
    if (!ours.contains(word)) return read_zoom_line(word, rest);
    const Words words = lines_.words(rest);
    const auto list = [&](std::vector<double>& values) {
        values.clear();
        if (words.size() > kMostFileFields) lines_.fail(word + " has more than 1000 values");
        for (const LensWord& w : words) values.push_back(lines_.number_of(w.text, "each value of " + word));
    };
    if (word == "MODE") {
        if (!words.empty() && upper_case(words[0].text) != "SEQ")
            lines_.fail("the mode is " + in_quotes(words[0].text) + "; a sequential lens (MODE SEQ) is wanted");
    } else if (word == "UNIT") {
        set_unit(words);
    } else if (word == "ENPD") {
        set_aperture(ApertureKind::entrance_pupil_diameter, length(words, 0, "the entrance pupil diameter"));
    } else if (word == "FNUM") {
        const bool working = number_or(words, 1, "the kind of f-number", 0) == 1;
        set_aperture(working ? ApertureKind::working_f_number : ApertureKind::f_number,
                     number(words, 0, "the f-number"));
    } else if (word == "OBNA") {
        if (number_or(words, 1, "the kind of aperture", 0) != 0)
            lines_.fail(
                "the aperture is a cone angle; "
                "an entrance pupil diameter, an f-number or a numerical aperture is wanted");
        set_aperture(ApertureKind::object_aperture, number(words, 0, "the numerical aperture"));
    } else if (word == "FLOA") {
        out_.prescription.aperture_kind = ApertureKind::stop_size;
    } else if (word == "GCAT") {
        for (const LensWord& w : words) {
            if (out_.catalogues.size() >= 100) lines_.fail("GCAT lists more than 100 catalogues of glass");
            out_.catalogues.emplace_back(w.text);
        }
    } else if (word == "FTYP") {
        out_.field_type = whole(words, "the type of the fields", 0, 10);
        const double count = number_or(words, 2, "the number of fields", 0);
        out_.field_count = static_cast<std::size_t>(std::clamp(count, 0.0, static_cast<double>(kMostFileFields)));
    } else if (word == "XFLN" || word == "XFLD") {
        list(out_.x);
    } else if (word == "YFLN" || word == "YFLD") {
        list(out_.y);
    } else if (word == "VDYN") {
        list(out_.decentre_y);
    } else if (word == "VCYN") {
        list(out_.compress_y);
    } else if (word == "WAVM") {
        out_.wavelengths[whole(words, "the number of the wavelength", 1, 1000)] = number(words, 1, "the wavelength");
    } else if (word == "WAVL") {
        for (std::size_t i = 0; i < words.size() && i < kMostFileFields; ++i)
            out_.wavelengths[static_cast<int>(i) + 1] = number(words, i, "each wavelength");
    } else if (word == "PWAV") {
        out_.primary = whole(words, "the number of the primary wavelength", 1, 1000);
    } else if (word == "AFOC") {
        out_.prescription.remarks.push_back("its image is afocal, which is left out");
    } else {
        out_.positions = whole(words, "the number of configurations", 1, 1000);
        out_.current =
            words.size() > 1 ? lines_.whole_number_of(words[1].text, "the current configuration", 1, 1000) : 1;
    }
    return true;
}

void ZemaxReader::set_unit(const Words& words) {
    const std::string unit = words.empty() ? "MM" : upper_case(words[0].text);
    if (!out_.surfaces.empty()) lines_.fail("UNIT has to stand in front of the surfaces");
    if (unit == "MM")
        out_.unit = 1;
    else if (unit == "CM")
        out_.unit = 10;
    else if (unit == "IN" || unit == "INCH")
        out_.unit = 25.4;
    else if (unit == "METER" || unit == "M")
        out_.unit = 1000;
    else
        lines_.fail("the unit is " + in_quotes(unit) + "; MM, CM, IN or METER is wanted");
}

void ZemaxReader::set_aperture(ApertureKind kind, double value) {
    if (!(value > 0)) lines_.fail("the aperture must be positive");
    out_.prescription.aperture_kind = kind;
    out_.prescription.aperture = value;
}

bool ZemaxReader::read_zoom_line(const std::string& word, std::string_view rest) {
    if (out_.positions <= 1) return false;
    static const std::set<std::string> left_out{"FVCX", "FVCY", "FVDX", "FVDY", "FVAN", "YFIE", "XFIE",
                                                "FLWT", "WLWT", "FLTP", "MCOM", "LTTL", "HOLD", "RAIM"};
    static const std::set<std::string> others{"CRVT", "CONN", "PRAM", "PAR1", "PAR2", "PAR3", "PAR4", "GLSS",
                                              "STPS", "CSP1", "IGNR", "IGNM", "WAVE", "PRWV", "TEMP", "PRES",
                                              "MIND", "MABB", "MDPG", "NPAR", "NPOS", "CATN", "APDX", "APDY",
                                              "APMN", "APMX", "APTP", "AFOC", "EDVA", "PSCX", "PSCY"};
    const bool thickness = word == "THIC", aperture = word == "APER", size = word == "SDIA";
    if (!thickness && !aperture && !size) {
        if (others.contains(word) && zoom_foreign_.insert(word).second)
            foreign("configurations that change more than thicknesses (" + word + ")");
        else if (left_out.contains(word) && zoom_foreign_.insert(word).second)
            out_.prescription.remarks.push_back("fields and their vignetting are taken from the first configuration (" +
                                                word + " is left out)");
        return others.contains(word) || left_out.contains(word);
    }
    const Words words = lines_.words(rest);
    if (words.size() < 3) lines_.fail(word + " needs a surface, a configuration and a value");
    const int position = lines_.whole_number_of(words[1].text, "the configuration", 1, out_.positions);
    const double value = is_infinity(words[2].text) ? kInfinity : number(words, 2, "the value");
    const auto set = [&](std::vector<double>& values) {
        values.resize(static_cast<std::size_t>(out_.positions), std::nan(""));
        values[static_cast<std::size_t>(position) - 1] = value;
    };
    if (aperture)
        set(out_.zoom_apertures);
    else
        set((size ? out_.zoom_sizes : out_.zoom)[lines_.whole_number_of(words[0].text, "the surface", 0, 1 << 20)]);
    return true;
}
}  // namespace realcam::io
