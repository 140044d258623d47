#pragma once
#include <optional>
#include <span>
#include <vector>

#include "motion.hpp"

namespace REALCAM_NAMESPACE {

// Keys for kernels: transforms at uniform times of an interval, whose entries are interpolated linearly.

inline constexpr int kMostKeySteps = 128;  ///< Embree supports 129 keys

std::vector<Affine<double>> uniform_keys(const Motion& motion, const TimeInterval& interval, int steps);

/// Returns the number of steps between keys that keeps each of the points close to its position in the motion. The
/// tolerance is 1/1000 of the greatest displacement of a point, or 1e-5 of the distance between points if that is more.
/// 0: nothing moves. kMostKeySteps if these are too few for the tolerance, and std::nullopt if the error is then more
/// than a tenth of the displacement, because the motion has more than about twenty rotations.
std::optional<int> key_steps(const Motion& motion, const TimeInterval& interval, std::span<const Vec3d> points);

}  // namespace REALCAM_NAMESPACE
