#pragma once
#include <cmath>
#include <numbers>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Node of Gauss-Legendre quadrature on [0, 1], and its weight; the weights of a rule sum to 1.
struct GaussNode {
    double node, weight;
};

/// Returns node k (from 0) of the rule with n nodes, which is exact for polynomials up to degree 2 n - 1. Nodes are in
/// descending order.
inline GaussNode gauss_node(int n, int k) {
    // Root of the Legendre polynomial P_n by Newton's method, from Tricomi's estimate.
    double x = std::cos(std::numbers::pi * (k + 0.75) / (n + 0.5)), slope = 1;
    for (int step = 0; step < 10; ++step) {  // four suffice for double precision
        double previous = 1, value = x;  // P_(j - 2) and P_(j - 1)
        for (int j = 2; j <= n; ++j) {
            const double next = ((2 * j - 1) * x * value - (j - 1) * previous) / j;
            previous = value;
            value = next;
        }
        slope = n * (x * value - previous) / (x * x - 1);
        x -= value / slope;
    }
    return {0.5 * (1 + x), 1 / ((1 - x * x) * slope * slope)};
}

}  // namespace REALCAM_NAMESPACE
