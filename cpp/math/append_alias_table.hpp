#pragma once
#include <vector>

#include "alias_table.hpp"

namespace REALCAM_NAMESPACE {

/// Appends the alias table of these weights (Vose 1991). At least one weight must be above 0.
void append_alias_table(const std::vector<double>& weights, std::vector<AliasEntry>& tables);

}  // namespace REALCAM_NAMESPACE
