// SPDX-License-Identifier: Apache-2.0
#include "core/node_rotations.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace knead::core {
namespace {

/// Tetrahedra whose rotations a node's is the mean of: enough for a preconditioner, few enough to visit
/// often.
constexpr std::size_t kStiffest = 6;

}  // namespace

template <class S>
NodeRotations<S>::NodeRotations(const Model& model)
    : begin_(model.free_count + 1, 0), matrices_(model.free_count) {
    std::vector<std::vector<Neighbour>> around(model.free_count);
    for (std::uint32_t e = 0; e < model.elements.size(); ++e) {
        const Element& element = model.elements[e];
        const auto weight = static_cast<float>(2 * element.mu_volume + element.lambda_volume);
        for (const std::uint32_t node : element.nodes) {
            if (node < model.free_count) around[node].push_back({e, weight});
        }
    }
    for (std::uint32_t i = 0; i < model.free_count; ++i) {
        std::stable_sort(around[i].begin(), around[i].end(),
                         [](const Neighbour& a, const Neighbour& b) { return a.weight > b.weight; });
        around[i].resize(std::min(around[i].size(), kStiffest));
        neighbours_.insert(neighbours_.end(), around[i].begin(), around[i].end());
        begin_[i + 1] = static_cast<std::uint32_t>(neighbours_.size());
    }
    reset();
}

template <class S>
void NodeRotations<S>::reset() noexcept {
    for (auto& matrix : matrices_)
        matrix = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    next_share_ = 0;
    squared_angles_.fill(0);
}

template <class S>
void NodeRotations<S>::update(const Elements<S>& elements, std::uint32_t shares) noexcept {
    Real sum = 0;
    for (std::size_t i = next_share_; i < matrices_.size(); i += shares)
        sum += update_node(elements, i);
    squared_angles_[next_share_] = sum;
    next_share_ = (next_share_ + 1) % shares;
}

template <class S>
Real NodeRotations<S>::update_node(const Elements<S>& elements, std::size_t node) noexcept {
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (std::uint32_t k = begin_[node]; k < begin_[node + 1]; ++k) {
        const Eigen::Vector4d q = elements.rotation(neighbours_[k].element).coeffs();
        // q and -q are the same rotation; neighbours are added on the same side.
        sum += (q.dot(sum) < 0 ? -1.0 : 1.0) * static_cast<Real>(neighbours_[k].weight) * q;
    }
    const Real norm = sum.norm();
    if (!(norm > 0) || !std::isfinite(norm)) return 0;
    const Mat matrix = Quat(Eigen::Vector4d(sum / norm)).toRotationMatrix();
    for (int k = 0; k < 9; ++k)
        matrices_[node][static_cast<std::size_t>(k)] = static_cast<S>(matrix(k / 3, k % 3));
    const Real half_sine_squared = std::max(Real(0), 1 - sum.w() * sum.w() / (norm * norm));
    return 4 * half_sine_squared;  // good enough up to a right angle
}

template <class S>
Real NodeRotations<S>::mean_angle_rad() const noexcept {
    const Real sum = std::accumulate(squared_angles_.begin(), squared_angles_.end(), Real(0));
    return matrices_.empty() ? 0 : std::sqrt(sum / static_cast<Real>(matrices_.size()));
}

template <class S>
void NodeRotations<S>::turn_back(const NodeField<S>& v, NodeField<S>& out) const noexcept {
    const S* in = v.data();
    S* to = out.data();
    for (const std::array<S, 9>& r : matrices_) {
        const S x = in[0], y = in[1], z = in[2];
        to[0] = r[0] * x + r[3] * y + r[6] * z;
        to[1] = r[1] * x + r[4] * y + r[7] * z;
        to[2] = r[2] * x + r[5] * y + r[8] * z;
        in += 4;
        to += 4;
    }
}

template <class S>
void NodeRotations<S>::turn(const NodeField<S>& v, NodeField<S>& out) const noexcept {
    const S* in = v.data();
    S* to = out.data();
    for (const std::array<S, 9>& r : matrices_) {
        const S x = in[0], y = in[1], z = in[2];
        to[0] = r[0] * x + r[1] * y + r[2] * z;
        to[1] = r[3] * x + r[4] * y + r[5] * z;
        to[2] = r[6] * x + r[7] * y + r[8] * z;
        in += 4;
        to += 4;
    }
}

template <class S>
Mat NodeRotations<S>::rotation(std::size_t node) const noexcept {
    Mat result;
    for (int k = 0; k < 9; ++k)
        result(k / 3, k % 3) = static_cast<Real>(matrices_[node][static_cast<std::size_t>(k)]);
    return result;
}

template class NodeRotations<float>;
template class NodeRotations<double>;

}  // namespace knead::core
