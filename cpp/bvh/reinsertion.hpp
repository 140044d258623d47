#pragma once
#include "binary_tree.hpp"

namespace REALCAM_NAMESPACE {

/// Removes the largest subtrees one by one and reinserts each where the tree's boxes grow least (Bittner, Hapala and
/// Havran, "Fast Insertion-Based Optimization of Bounding Volume Hierarchies", 2013). Top-down splits cannot separate a
/// table from the objects on it; reinsertion can. The tree must have been processed by measure(), whose results are
/// kept up to date.
void reinsert_largest(BinaryNode& root);

}  // namespace REALCAM_NAMESPACE
