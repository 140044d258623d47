#pragma once
#include <optional>
#include <span>
#include <vector>

#include "motion.hpp"

namespace REALCAM_NAMESPACE {

// Keys for kernels: transforms at even times of an interval, whose entries change evenly from one to the next.

inline constexpr int kMostKeySteps = 128;  ///< Embree takes 129 keys

std::vector<Affine<double>> uniform_keys(const Motion& motion, const TimeInterval& interval, int steps);

/// The number of steps between keys that keeps each of some points where the motion has it. The tolerance is 1/1000 of
/// the longest way that one of them goes, or 1e-5 of the distance between them. 0: nothing moves. Where kMostKeySteps
/// are too few for that, so many; and nothing where it would be off by a tenth of the way then, because it turns more
/// often than some twenty times.
std::optional<int> key_steps(const Motion& motion, const TimeInterval& interval, std::span<const Vec3d> points);

}  // namespace REALCAM_NAMESPACE
