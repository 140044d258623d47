#include "lens_file.hpp"

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <iterator>
#include <set>
#include <system_error>

#include "../../optics/prescription/lens_checks.hpp"
#include "../files/regular_file.hpp"
#include "../files/uri.hpp"
#include "../text/toml_document.hpp"
#include "lens_format.hpp"
#include "lens_text.hpp"
#include "lens_toml.hpp"

namespace realcam::io {
namespace {

/// Format of lens files, with its reader and writer.
struct LensFormat {
    std::string_view suffix;
    LensSystem (*read)(std::string_view bytes, const std::string& file, const LensReadOptions& options);
    LensText (*write)(const LensSystem& lens);  ///< null if the format is only read
};

/// Reads a lens file of another program by its reader of prescriptions.
template <Prescription (*read)(std::string_view, const std::string&, LensGlasses&)>
LensSystem read_prescription(std::string_view bytes, const std::string& file, const LensReadOptions& options) {
    LensGlasses glasses(options);
    const std::string text = decoded_lens_text(bytes, file);
    Prescription prescription = read(text, file, glasses);
    glasses.check_all_used();
    return lens_from(std::move(prescription), options);
}

LensSystem read_toml(std::string_view bytes, const std::string& file, const LensReadOptions& options);

LensText write_toml(const LensSystem& lens) {
    return {lens_as_toml(lens), {}};
}

/// All formats; other suffixes are read as the first one.
constexpr LensFormat kFormats[] = {
    {".toml", read_toml, write_toml},
    {".zmx", read_prescription<read_zemax>, lens_as_zemax},
    {".seq", read_prescription<read_code_v>, lens_as_code_v},
    {".len", read_prescription<read_oslo>, nullptr},
    {".dat", read_prescription<read_pbrt>, nullptr},
    {".json", read_prescription<read_optiland>, lens_as_optiland},
    {".roa", read_prescription<read_ray_optics>, lens_as_ray_optics},
};

/// Returns the format by the suffix of a file's name, ignoring case; null if it is not known.
const LensFormat* format_of(const std::string& path) {
    const auto found = std::ranges::find(kFormats, std::string_view(suffix_of(path)), &LensFormat::suffix);
    return found == std::end(kFormats) ? nullptr : found;
}

/// Returns the suffixes that are read, or those that are written, for a sentence: ".toml, .zmx or .seq".
std::string lens_suffixes(bool written) {
    std::vector<std::string_view> suffixes;
    for (const LensFormat& format : kFormats)
        if (!written || format.write) suffixes.push_back(format.suffix);
    if (written) suffixes.push_back(".osl");  // written by the Python package
    std::string text(suffixes.front());
    for (std::size_t i = 1; i < suffixes.size(); ++i)
        text.append(i + 1 < suffixes.size() ? ", " : " or ").append(suffixes[i]);
    return text;
}

/// Reads a lens file of realcam. If the text is not TOML, the error says that the suffix is unknown.
LensSystem read_toml(std::string_view bytes, const std::string& file, const LensReadOptions& options) {
    toml::table table;
    try {
        table = parse_toml(bytes, file, raise_lens_file_error, options.keep_going);
    } catch (const LensFileError&) {
        const std::string suffix = suffix_of(file);
        if (suffix == ".toml") throw;
        const std::string why = suffix.empty() ? "it has no ending"
                                               : "its ending is " + in_quotes(file.substr(file.size() - suffix.size()));
        throw LensFileError("is not a lens file of a known format: " + why + ", and its text is not TOML; expected " +
                                lens_suffixes(false),
                            file);
    }
    LensSystem lens = lens_from_table(table, file, options.keep_going);
    LensGlasses(options).check_all_used();  // reports that this file defines its own glasses
    return lens;
}

/// Returns the contents of a file. Throws LensFileError if it is not a regular file, or is too large for a lens file.
std::string text_of_file(const std::string& path) {
    constexpr std::size_t kMaxBytes = 16 << 20;  // bytes; the bundled lenses have some thousand
    try {
        RegularFile file(path);
        if (file.size() > kMaxBytes) throw LensFileError("is larger than 16 MiB; expected a lens file", path);
        std::string text(file.size(), '\0');
        text.resize(file.read(text.data(), text.size()));
        return text;
    } catch (const FileError& error) {
        throw LensFileError(error.reason, path);
    }
}

}  // namespace

std::vector<std::string> lens_names() {
    std::vector<std::string> names;
    for (const BundledFile& file : bundled_lens_files()) names.emplace_back(file.name);
    std::sort(names.begin(), names.end());  // file names with ".toml" have another order: '-' comes before '.'
    return names;
}

std::map<std::string, std::string> lens_files_on_path() {
    std::map<std::string, std::string> files;
    const char* variable = std::getenv("REALCAM_LENS_PATH");
    std::string_view rest = variable ? variable : "";
    while (!rest.empty()) {
        const std::size_t colon = std::min(rest.find(':'), rest.size());
        const std::filesystem::path folder(rest.substr(0, colon));
        rest.remove_prefix(std::min(colon + 1, rest.size()));
        std::error_code error;
        std::set<std::filesystem::path> sorted;
        for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
             entry.increment(error))
            if (entry->is_regular_file(error)) sorted.insert(entry->path());
        for (const std::filesystem::path& path : sorted)
            if (format_of(path.string())) files.emplace(path.stem().string(), path.string());
    }
    for (const BundledFile& file : bundled_lens_files()) files.erase(std::string(file.name));
    return files;
}

std::string_view bundled_lens_text(const std::string& name) {
    for (const BundledFile& file : bundled_lens_files())
        if (file.name == name) return file.text;
    std::vector<std::string> known = lens_names();
    for (const auto& [found, path] : lens_files_on_path()) known.push_back(found);
    throw LensFileError("unknown lens " + in_quotes(name) + did_you_mean(name, known) +
                        "; expected a bundled lens or the path of a lens file");
}

bool is_lens_path(const std::string& name, const std::string& path) {
    for (const BundledFile& file : bundled_lens_files())
        if (file.name == name) return false;
    std::error_code nothing;  // errors mean that there is no file of that name
    return name.find('/') != name.npos || format_of(name) || std::filesystem::is_regular_file(path, nothing);
}

LensSystem parse_lens_file(std::string_view bytes, const std::string& file, const LensReadOptions& options) {
    const LensFormat* format = format_of(file);
    return (format ? format->read : read_toml)(bytes, file, options);
}

LensSystem read_lens(const std::string& name_or_path, const LensReadOptions& options) {
    if (!is_lens_path(name_or_path, name_or_path)) {
        const auto files = lens_files_on_path();
        if (const auto found = files.find(name_or_path); found != files.end()) return read_lens(found->second, options);
        LensSystem lens = parse_lens(bundled_lens_text(name_or_path), name_or_path);
        LensGlasses(options).check_all_used();
        return lens;
    }
    return parse_lens_file(text_of_file(name_or_path), name_or_path, options);
}

LensText lens_text_for(const LensSystem& lens, const std::string& path) {
    validate(lens);
    // Requires the suffix, because without it the file could not be read by its name.
    const LensFormat* format = format_of(path);
    if (!format || !format->write) throw InputError(path + ": expected the suffix " + lens_suffixes(true));
    return format->write(lens);
}

}  // namespace realcam::io
