#pragma once
#include <string>
#include <string_view>

#include "../../checkpoint.hpp"
#include "toml_table.hpp"

namespace realcam::io {

/// Parses a TOML text. `file`: its name in messages. Calls `raise`, which throws, with the line of invalid TOML, or of
/// nesting that would exhaust the stack.
/// Throws Cancelled if `keep_going` returns false.
toml::table parse_toml(std::string_view text, const std::string& file, RaiseFileError raise,
                       const KeepGoing& keep_going = {});

}  // namespace realcam::io
