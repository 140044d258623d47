#pragma once
#include <vector>

#include "alias_table.hpp"

namespace REALCAM_NAMESPACE {

/// Appends the table of these weights, of which one at least is above 0 (Vose 1991).
void append_alias_table(const std::vector<double>& weights, std::vector<AliasEntry>& tables);

}  // namespace REALCAM_NAMESPACE
