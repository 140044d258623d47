// Reads Zemax OpticStudio's .zmx: a line is a keyword of four letters and its values; "SURF n" begins a surface, and
// later lines with a surface's keyword belong to it. Surface 0 is the object, the last one the image.

#include <algorithm>

#include "../../text/printable.hpp"
#include "../lens_prescription.hpp"
#include "lens_zemax_reader.hpp"

namespace realcam::io {
bool is_harmless_in_zemax(const std::string& word, bool in_surface) {
    static const std::set<std::string> of_surface{
        "HIDE", "MIRR", "SLAB", "POPS", "MEMA", "COMM", "FIMP", "VDSZ", "PPAR", "VPAR", "PZUP", "PKUP",
        "MAZH", "BRDF", "EDGE", "VCON", "VCUR", "DMFS", "SCAT", "RLIN", "GOPT", "LSEL", "TCED", "TRAC",
        "TOLE", "CRIX", "WCBK", "HDEN", "COFN", "VGLA", "CUPD", "ISNA", "PCUR", "MACH", "PTHI"};
    static const std::set<std::string> of_system{
        "VERS", "PFIL", "LANG", "ENVD", "GFAC", "RAIM", "PUSH", "SDMA", "OMMA", "ROPD", "PICB", "HYPR", "FWGN", "FWGT",
        "WWGT", "WWGN", "ZVAN", "POLS", "GLRS", "GSTD", "NSCD", "COFN", "NOTE", "BLNK", "TOL",  "MOFF", "DBDT", "OPDX",
        "CONF", "PUPD", "EFFL", "MNCA", "MNEA", "MNCG", "MNEG", "MXCA", "MXCG", "RGLA", "TCMM", "TOTR", "XDFL", "CHCO",
        "FCHR", "TCNT", "ANGC", "COMN", "WFNO", "PMAG", "DMFS", "ANON", "MCOM", "VANN", "VDXN", "VCXN", "UDFL", "LOCK"};
    return (in_surface ? of_surface : of_system).contains(word);
}

ZemaxReader::ZemaxReader(std::string_view text, const std::string& file, const LensReadOptions& options)
    : lines_(text, file, options.keep_going) {
    out_.prescription.file = file;
    out_.prescription.format = "Zemax";
}

ZemaxFile ZemaxReader::read() {
    std::string_view line;
    while (lines_.next(line)) read_line(line);
    const bool begins_with_face =
        out_.has_faces_alone || (!out_.surfaces.empty() && !out_.surfaces.front().glass.empty());
    if (out_.surfaces.size() < (begins_with_face ? 2 : 3))
        throw LensFileError("has " + std::to_string(out_.surfaces.size()) +
                                " surfaces (SURF); an object, a lens and an image are wanted",
                            lines_.file());
    return std::move(out_);
}

double ZemaxReader::number(const Words& words, std::size_t i, const char* what) const {
    if (i >= words.size()) lines_.fail(std::string(what) + " is missing");
    return lines_.number_of(words[i].text, what);
}

double ZemaxReader::number_or(const Words& words, std::size_t i, const char* what, double otherwise) const {
    return i < words.size() && !words[i].is_quoted ? lines_.number_of(words[i].text, what) : otherwise;
}

double ZemaxReader::length(const Words& words, std::size_t i, const char* what) const {
    return out_.unit * number(words, i, what);
}

double ZemaxReader::length_or_infinity(const Words& words, std::size_t i, const char* what) const {
    if (i < words.size() && is_infinity(words[i].text)) return words[i].text.starts_with('-') ? -kInfinity : kInfinity;
    return length(words, i, what);
}

int ZemaxReader::whole(const Words& words, const char* what, int least, int most) const {
    if (words.empty()) lines_.fail(std::string(what) + " is missing");
    return lines_.whole_number_of(words[0].text, what, least, most);
}

void ZemaxReader::foreign(const std::string& what) {
    if (foreign_.emplace(what, current_number()).second)
        out_.prescription.foreign.push_back({what, lines_.number(), current_number()});
}

int ZemaxReader::current_number() const {
    return out_.surfaces.empty() || !in_surface_ ? 0 : out_.surfaces.back().row.number;
}

void ZemaxReader::read_line(std::string_view line) {
    std::string_view rest = without_blanks(line);
    if (rest.empty()) return;
    const std::string word = upper_case(rest.substr(0, rest.find_first_of(" \t")));
    rest = without_blanks(rest.substr(std::min(rest.size(), word.size())));
    if (word == "NAME" || word == "NOTE" || word == "COMM" || word == "COFN") {  // free text
        if (word == "NAME") out_.prescription.title = std::string(rest);
        if (out_.prescription.title.size() > 1 && out_.prescription.title.front() == '"' &&
            out_.prescription.title.back() == '"')
            out_.prescription.title = out_.prescription.title.substr(1, out_.prescription.title.size() - 2);
        return;
    }
    if (word == "SURF") return begin_surface(lines_.words(rest));
    // Indents are ignored, because programs other than OpticStudio omit them. The keyword tells whether a line belongs
    // to a surface.
    const bool is_indented = line[0] == ' ' || line[0] == '\t';
    if (!out_.surfaces.empty()) {
        lines_.set_surface(out_.surfaces.back().row.number);
        in_surface_ = true;
        has_indents_ = has_indents_ || is_indented;
        if (read_surface_line(word, rest) || is_harmless_in_zemax(word, true)) return;
    }
    in_surface_ = false;
    lines_.set_surface(0);
    if (read_system_line(word, rest)) return;
    // The surfaces are followed by hundreds of operands of the merit function, which are not indented.
    if (out_.surfaces.empty() || !has_indents_ || is_indented)
        if (out_.unknown.size() < kMostUnknown) out_.unknown.insert(printable(word.substr(0, 40)));
}

void ZemaxReader::begin_surface(const Words& words) {
    if (words.empty()) lines_.fail("SURF needs the surface's number");
    // Exporters that insert a stop between two numbered faces label it "5AS".
    const std::string_view digits = words[0].text.substr(0, words[0].text.find_first_of("ASas"));
    const bool is_between = digits.size() < words[0].text.size() && !out_.surfaces.empty();
    const int number =
        lines_.whole_number_of(is_between ? digits : words[0].text, "the number of the surface", 0, 1 << 30);
    if (out_.surfaces.size() >= kMostFileSurfaces)
        lines_.fail("the file has more than " + std::to_string(kMostFileSurfaces) + " surfaces");
    if (number == 1 && out_.surfaces.empty()) {  // exporters of faces alone begin with the first face
        out_.has_faces_alone = true;
        out_.surfaces.emplace_back();
        out_.surfaces.back().has_thickness = out_.surfaces.back().at_infinity = true;
    }
    const int expected = out_.surfaces.empty() ? 0 : out_.surfaces.back().row.number + (is_between ? 0 : 1);
    if (number != expected)
        lines_.fail("surface " + std::to_string(number) + " follows " +
                    (out_.surfaces.empty() ? std::string("nothing; surface 0, the object,")
                                           : "surface " + std::to_string(out_.surfaces.back().row.number) +
                                                 "; surface " + std::to_string(expected)) +
                    " is wanted");
    out_.surfaces.emplace_back();
    out_.surfaces.back().row.number = number;
    out_.surfaces.back().row.line = lines_.number();
    in_surface_ = true;
    lines_.set_surface(number);
}

ZemaxFile zemax_file_of(std::string_view text, const std::string& file, const LensReadOptions& options) {
    return ZemaxReader(text, file, options).read();
}

}  // namespace realcam::io
