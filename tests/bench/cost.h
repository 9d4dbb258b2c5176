// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <string>

#include "baseline/body.h"

namespace knead::bench {

using baseline::Body;

/// What a part of a step must read and compute in single precision (factors stored in 16 bits), however well
/// it is written.
struct Work {
    double bytes = 0;  ///< read or written once each
    double flops = 0;
};

/// Sizes that the work depends on.
struct StepSizes {
    double tetrahedra = 0;
    double nodes = 0;          ///< that move
    double unknown_nodes = 0;  ///< that move and are not the plate's
    double factor_blocks = 0;  ///< 3x3 blocks below the diagonal of the Cholesky factor, asset order
};
[[nodiscard]] StepSizes step_sizes(const Body& body);

[[nodiscard]] Work element_pass_work(const StepSizes& sizes);
[[nodiscard]] Work product_work(const StepSizes& sizes);        ///< one A u, without assembly
[[nodiscard]] Work factor_work(const StepSizes& sizes);         ///< one application of the 3x3 factor
[[nodiscard]] Work scalar_factor_work(const StepSizes& sizes);  ///< of the factor of a scalar Laplacian
[[nodiscard]] Work jacobi_work(const StepSizes& sizes);
[[nodiscard]] Work vector_work(const StepSizes& sizes);  ///< the vector updates of one iteration

/// The least time of a step.
struct Bound {
    double us = 0;
    std::string method;  ///< the preconditioner that gives the least
    Work work;           ///< of the whole step with it
    double bytes_per_s = 0;
    double flops_per_s = 0;
};

/// One element pass and k iterations (product, preconditioner, vector updates), for the cheapest of: 3x3
/// factor, k = 1; scalar Laplacian factor, k = 2; block Jacobi, k = what the baseline needed. Each part takes
/// the longer of its bytes at the bandwidth measured at the step's working set and its flops at the peak;
/// parts add up, for one needs the result of the other.
[[nodiscard]] Bound step_bound(const StepSizes& sizes, double jacobi_iterations, double flops_per_s);

}  // namespace knead::bench
