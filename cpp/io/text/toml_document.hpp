#pragma once
#include <string>
#include <string_view>

#include "../../keep_going.hpp"
#include "toml_table.hpp"

namespace realcam::io {

/// The table that a TOML text is. What is no TOML, and what is nested so deeply that reading it would exhaust the
/// stack, is an error of `raise` with the line. Throws Cancelled where `keep_going` returns false.
toml::table parse_toml(std::string_view text, const std::string& file, RaiseFileError raise,
                       const KeepGoing& keep_going = {});

}  // namespace realcam::io
