#pragma once
#include "binary_tree.hpp"

namespace REALCAM_NAMESPACE {

/// Takes the largest subtrees out, one by one, and puts each back where it makes the tree's boxes grow least (Bittner,
/// Hapala and Havran, "Fast Insertion-Based Optimization of Bounding Volume Hierarchies", 2013). Splitting from above
/// cannot separate a table from what stands on it; this does. For a tree that has been measured, which it stays.
void reinsert_largest(BinaryNode& root);

}  // namespace REALCAM_NAMESPACE
