// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "reference/elastic_body.h"

namespace knead::tools {

/// A symmetric 3 x 3 matrix to be added at a node whose three unknowns are free.
struct NodeBlock {
    std::uint32_t node = 0;
    Eigen::Matrix3d block_n_per_m;
};

/// The linear system of the unknowns that are not prescribed: assembly and direct solution.
///
/// Unknown 3 * n + i is axis i of node n. The sparsity pattern and the elimination order (CHOLMOD's symbolic
/// analysis) are made once and serve every factorisation.
/// @thread-safety one thread at a time; different objects are independent
class FreeSystem {
  public:
    /// @param is_prescribed [3 nodes] true where the unknown is given
    FreeSystem(const ElasticBody& body, const std::vector<bool>& is_prescribed);
    FreeSystem(FreeSystem&&) noexcept;
    FreeSystem& operator=(FreeSystem&&) noexcept;
    ~FreeSystem();

    /// Factorises the second derivative at `positions_m`, plus `diagonal_n_per_m` ([3 nodes], or empty) and
    /// `blocks`.
    /// @return false when it is not positive definite
    bool factorise(const Eigen::VectorXd& positions_m, Curvature curvature,
                   const Eigen::VectorXd& diagonal_n_per_m, const std::vector<NodeBlock>& blocks = {});
    /// Solves with the last factor for the free part of `rhs`; zero at the prescribed unknowns.
    /// @param rhs [3 nodes]
    [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& rhs) const;
    /// Column 3 k + i: the displacements under a unit force along axis i of nodes[k].
    [[nodiscard]] Eigen::MatrixXd unit_force_responses(const std::vector<std::uint32_t>& nodes) const;

    [[nodiscard]] const std::vector<bool>& is_prescribed() const;
    [[nodiscard]] std::size_t unknown_count() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The system of the set of prescribed unknowns last asked for.
class KeptSystem {
  public:
    [[nodiscard]] FreeSystem& of(const ElasticBody& body, const std::vector<bool>& is_prescribed) {
        if (!system_ || system_->is_prescribed() != is_prescribed) system_.emplace(body, is_prescribed);
        return *system_;
    }

  private:
    std::optional<FreeSystem> system_;
};

}  // namespace knead::tools
