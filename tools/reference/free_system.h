// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "reference/elastic_body.h"
#include "reference/tied_node.h"

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
    /// @param is_prescribed [3 nodes] true where the unknown is given, by a tie too
    /// @param ties without contradiction to `is_prescribed` (spread_with_ties)
    FreeSystem(const ElasticBody& body, const std::vector<bool>& is_prescribed,
               std::vector<TiedNode> ties = {});
    FreeSystem(FreeSystem&&) noexcept;
    FreeSystem& operator=(FreeSystem&&) noexcept;
    ~FreeSystem();

    /// Factorises the second derivative at `positions_m`, plus `diagonal_n_per_m` ([3 nodes], or empty) and
    /// `blocks`.
    /// @return false when it is not positive definite
    bool factorise(const Eigen::VectorXd& positions_m, Curvature curvature,
                   const Eigen::VectorXd& diagonal_n_per_m, const std::vector<NodeBlock>& blocks = {});
    /// Whether the last factorisation succeeded.
    [[nodiscard]] bool has_factor() const;
    /// Solves with the last factor for the free part of `rhs`, to which tied nodes hand what is at them on;
    /// zero at the prescribed unknowns, and at the tied ones what their masters make of the result.
    /// @param rhs [3 nodes]
    [[nodiscard]] Eigen::VectorXd solve(const Eigen::VectorXd& rhs) const;
    /// Column 3 k + i: the displacements under a unit force along axis i of nodes[k].
    [[nodiscard]] Eigen::MatrixXd unit_force_responses(const std::vector<std::uint32_t>& nodes) const;

    /// Derivative to the free unknowns of what has this derivative to all: a tied node's share is its
    /// masters'; what is left at the tied unknowns belongs to what carries them.
    [[nodiscard]] Eigen::VectorXd reduced(const Eigen::VectorXd& gradient) const;
    /// What of `positions_m` is given: the position where prescribed; where tied, what is left of it without
    /// the masters' share.
    [[nodiscard]] Eigen::VectorXd given(const Eigen::VectorXd& positions_m) const;
    /// Puts the given unknowns to `target_m` (as of given()), the free ones as they are in `positions_m`.
    void put_given(const Eigen::VectorXd& target_m, Eigen::VectorXd& positions_m) const;

    [[nodiscard]] const std::vector<bool>& is_prescribed() const;
    [[nodiscard]] const std::vector<TiedNode>& ties() const;
    [[nodiscard]] std::size_t unknown_count() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

/// The system of the set of prescribed unknowns last asked for.
class KeptSystem {
  public:
    [[nodiscard]] FreeSystem& of(const ElasticBody& body, const std::vector<bool>& is_prescribed,
                                 const std::vector<TiedNode>& ties = {}) {
        if (!system_ || system_->is_prescribed() != is_prescribed || !system_->ties().empty() ||
            !ties.empty())
            system_.emplace(body, is_prescribed, ties);
        return *system_;
    }

  private:
    std::optional<FreeSystem> system_;
};

}  // namespace knead::tools
