#pragma once
#include <string>
#include <string_view>

#include "../../checkpoint.hpp"
#include "toml_table.hpp"

namespace realcam::io {

/// Parses a TOML text. Invalid TOML, or nesting that would exhaust the stack, is reported by `raise` with the line.
/// Throws Cancelled if `keep_going` returns false.
toml::table parse_toml(std::string_view text, const std::string& file, RaiseFileError raise,
                       const KeepGoing& keep_going = {});

}  // namespace realcam::io
