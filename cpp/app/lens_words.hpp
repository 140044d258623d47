#pragma once
#include <CLI/CLI.hpp>
#include <string>
#include <vector>

#include "../io/lens/lens_error.hpp"
#include "../io/lens/lens_file.hpp"

namespace realcam::app {

/// What the command line says of how a lens file is read.
struct LensWords {
    std::vector<std::string> glasses, catalogues, folders;
    std::string pbrt_thickness;
    bool force = false;
};

/// Adds --lens-path: folders that come before those of REALCAM_LENS_PATH.
void add_lens_path_option(CLI::App& command, std::vector<std::string>& folders);

/// Puts the folders into REALCAM_LENS_PATH.
void set_lens_path(const std::vector<std::string>& folders);

/// Adds --glass, --glass-catalogue, --lens-path, --force and --pbrt-thickness.
void add_lens_options(CLI::App& command, LensWords& words);

/// What of them settles an error of a lens file, as the end of its message; empty where none does.
std::string advice_on(const io::LensReadError& error);

/// Their meaning; what a reader has to tell goes to stderr. Throws InputError.
io::LensReadOptions lens_options_of(const LensWords& words);

}  // namespace realcam::app
