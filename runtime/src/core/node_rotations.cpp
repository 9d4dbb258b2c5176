// SPDX-License-Identifier: Apache-2.0
#include "core/node_rotations.h"

#include <cmath>

namespace knead::core {

template <class S>
NodeRotations<S>::NodeRotations(const Model& model)
    : begin_(model.free_count + 1, 0), matrices_(model.free_count) {
    const auto visit = [&](auto&& use) {
        for (std::uint32_t e = 0; e < model.elements.size(); ++e) {
            for (const std::uint32_t node : model.elements[e].nodes) {
                if (node < model.free_count) use(node, e);
            }
        }
    };
    visit([&](std::uint32_t node, std::uint32_t) { ++begin_[node + 1]; });
    for (std::size_t i = 0; i < model.free_count; ++i)
        begin_[i + 1] += begin_[i];
    neighbours_.resize(begin_.back());
    std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
    visit([&](std::uint32_t node, std::uint32_t e) {
        const Element& element = model.elements[e];
        neighbours_[next[node]++] = {e, static_cast<float>(2 * element.mu_volume + element.lambda_volume)};
    });
    reset();
}

template <class S>
void NodeRotations<S>::reset() noexcept {
    for (auto& matrix : matrices_)
        matrix = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    next_share_ = 0;
}

template <class S>
void NodeRotations<S>::update(const Elements<S>& elements, std::uint32_t shares) noexcept {
    for (std::size_t i = next_share_ % shares; i < matrices_.size(); i += shares)
        update_node(elements, i);
    next_share_ = (next_share_ + 1) % shares;
}

template <class S>
void NodeRotations<S>::update_node(const Elements<S>& elements, std::size_t node) noexcept {
    Eigen::Vector4d sum = Eigen::Vector4d::Zero();
    for (std::uint32_t k = begin_[node]; k < begin_[node + 1]; ++k) {
        const Eigen::Vector4d q = elements.rotation(neighbours_[k].element).coeffs();
        // q and -q are the same rotation; neighbours are added on the same side.
        sum += (q.dot(sum) < 0 ? -1.0 : 1.0) * static_cast<Real>(neighbours_[k].weight) * q;
    }
    const Real norm = sum.norm();
    if (!(norm > 0) || !std::isfinite(norm)) return;
    const Mat matrix = Quat(Eigen::Vector4d(sum / norm)).toRotationMatrix();
    for (int k = 0; k < 9; ++k)
        matrices_[node][static_cast<std::size_t>(k)] = static_cast<S>(matrix(k / 3, k % 3));
}

template <class S>
void NodeRotations<S>::precondition(const std::vector<std::array<S, 9>>& blocks, const NodeField<S>& v,
                                    NodeField<S>& out) const noexcept {
    for (std::size_t i = 0; i < matrices_.size(); ++i) {
        using Block = Eigen::Matrix<S, 3, 3, Eigen::RowMajor>;
        const Eigen::Map<const Block> turn(matrices_[i].data()), block(blocks[i].data());
        const Eigen::Map<const Eigen::Matrix<S, 3, 1>> in(v.data() + 4 * i);
        Eigen::Map<Eigen::Matrix<S, 3, 1>> to(out.data() + 4 * i);
        const Eigen::Matrix<S, 3, 1> back = turn.transpose() * in;
        const Eigen::Matrix<S, 3, 1> solved = block * back;
        to = turn * solved;
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
