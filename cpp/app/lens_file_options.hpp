#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "../io/lens/lens_error.hpp"
#include "../io/lens/lens_file.hpp"

namespace realcam::app {

/// Values of the command-line options that control how a lens file is read, as typed.
struct LensFileOptions {
    std::vector<std::string> glasses;     ///< --glass: "NAME=N,V" or "NAME=CATALOGUE:GLASS"
    std::vector<std::string> catalogues;  ///< --glass-catalogue: .agf files
    std::vector<std::string> folders;     ///< --lens-path
    std::string pbrt_thickness;           ///< --pbrt-thickness: "after", "before", or empty
    bool force = false;                   ///< --force: unsupported features of the lens file are left out
};

/// Adds the option --lens-path: folders of lens files, which are searched before those of REALCAM_LENS_PATH.
void add_lens_path_option(CLI::App& command, std::vector<std::string>& folders);

/// Prepends the folders to the environment variable REALCAM_LENS_PATH. Throws InputError if one is not a folder.
void set_lens_path(const std::vector<std::string>& folders);

/// Adds --glass, --glass-catalogue, --lens-path, --force and --pbrt-thickness.
void add_lens_options(CLI::App& command, LensFileOptions& values);

/// Names the option that would resolve an error of a lens file, as the end of its message; empty if no option would.
std::string advice_on(const io::LensReadError& error);

/// Converts the options to those of read_lens, and applies --lens-path. Warnings of the lens reader go to stderr.
/// Throws InputError.
io::LensReadOptions lens_options_of(const LensFileOptions& values);

}  // namespace realcam::app
