#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "../io/lens/lens_error.hpp"
#include "../io/lens/lens_file.hpp"

namespace realcam::app {

/// Command-line options that control how a lens file is read.
struct LensWords {
    std::vector<std::string> glasses, catalogues, folders;
    std::string pbrt_thickness;
    bool force = false;
};

/// Adds --lens-path: folders that are searched before those of REALCAM_LENS_PATH.
void add_lens_path_option(CLI::App& command, std::vector<std::string>& folders);

/// Prepends the folders to REALCAM_LENS_PATH. Throws InputError if one is not a folder.
void set_lens_path(const std::vector<std::string>& folders);

/// Adds --glass, --glass-catalogue, --lens-path, --force and --pbrt-thickness.
void add_lens_options(CLI::App& command, LensWords& words);

/// The option that would resolve an error of a lens file, as the end of its message; empty if no option would.
std::string advice_on(const io::LensReadError& error);

/// Converts the options. Warnings of the lens reader go to stderr. Throws InputError.
io::LensReadOptions lens_options_of(const LensWords& words);

}  // namespace realcam::app
