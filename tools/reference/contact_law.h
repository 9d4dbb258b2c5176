// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

namespace knead::tools {

/// How one node may move against a tool and what force it may pass on. Entries of its 3-vectors: outward
/// normal, then two tangents.
struct NodeLaw {
    bool bilateral = false;  ///< held in all directions whatever the force (a bonded tool)
    double friction = 0;     ///< Coulomb's coefficient; 0: none, infinity: no slip while it touches
};

/// Many nodes in contact with a linear elastic object: displacement = compliance * force + offset, with, node
/// by node, force 0 and normal displacement >= 0, or normal displacement 0 and normal force >= 0 and the law
/// of friction: |tangential force| <= friction * normal force, and where the node slips, equality and the
/// force against the slip.
struct LawProblem {
    Eigen::MatrixXd compliance_m_per_n;  ///< [3 nodes x 3 nodes] symmetric, positive definite
    Eigen::VectorXd offset_m;            ///< [3 nodes] displacement without contact forces
    std::vector<NodeLaw> nodes;
};

struct LawSolution {
    bool converged = false;
    int iterations = 0;          ///< of Newton's method; sweeps of the fallback are not counted
    int fallbacks = 0;           ///< how often Newton's method was helped by sweeps
    double error_n = 0;          ///< Euclidean norm of what the equations leave, as a force
    Eigen::VectorXd force_n;     ///< [3 nodes] of the tool on the node
    std::vector<bool> touching;  ///< [nodes]
    std::vector<bool> slipping;  ///< [nodes] touching, with friction, and the cone reached
    /// [nodes] not converged: those that went to and fro at the end. With infinite friction there may be no
    /// solution: a node that would be pulled where it sticks may go inside when it is let go.
    std::vector<bool> unsettled;
};

/// Solves the laws of all nodes together: semismooth Newton on the equations of Alart and Curnier, which is
/// the primal-dual active set method when there is no friction to decide on; where it does not converge, it
/// starts anew from sweeps of projected block Gauss-Seidel.
/// @param start_n forces to start from ([3 nodes])
/// @param start_touching [nodes] the set for the first solve
/// Source: P. Alart, A. Curnier: A mixed formulation for frictional contact problems prone to Newton like
/// solution methods, 1991.
[[nodiscard]] LawSolution solve_law(const LawProblem& problem, const Eigen::VectorXd& start_n,
                                    const std::vector<bool>& start_touching);

}  // namespace knead::tools
