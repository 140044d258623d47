#pragma once
#include <cmath>
#include <numbers>

#include "../platform.hpp"

namespace REALCAM_NAMESPACE {

/// Node of Gauss-Legendre quadrature on [0, 1], and its weight; the weights of a rule sum to 1.
struct GaussNode {
    double node, weight;
};

/// Returns node k, from 0, of n. Nodes decrease from 1 towards 0.
inline GaussNode gauss_node(int n, int k) {
    double x = std::cos(std::numbers::pi * (k + 0.75) / (n + 0.5)), slope = 1;
    for (int step = 0; step < 10; ++step) {  // from there, Newton's method has all digits after four
        double last = 1, value = x;
        for (int j = 2; j <= n; ++j) {
            const double next = ((2 * j - 1) * x * value - (j - 1) * last) / j;
            last = value;
            value = next;
        }
        slope = n * (x * value - last) / (x * x - 1);
        x -= value / slope;
    }
    return {0.5 * (1 + x), 1 / ((1 - x * x) * slope * slope)};
}

}  // namespace REALCAM_NAMESPACE
