// SPDX-License-Identifier: Apache-2.0
#include "core/node_rotations.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace knead::core {
namespace {

struct Neighbour {
    std::uint32_t element = 0;
    Real weight = 0;
};

/// [free nodes] the stiffest tetrahedra around each, the stiffest first.
std::vector<std::vector<Neighbour>> stiffest_around(const Model& model) {
    std::vector<std::vector<Neighbour>> around(model.free_count);
    for (std::uint32_t e = 0; e < model.elements.size(); ++e) {
        const Element& element = model.elements[e];
        const Real weight = 2 * element.mu_volume + element.lambda_volume;
        for (const std::uint32_t node : element.nodes) {
            if (node < model.free_count) around[node].push_back({e, weight});
        }
    }
    for (std::vector<Neighbour>& neighbours : around) {
        std::stable_sort(neighbours.begin(), neighbours.end(),
                         [](const Neighbour& a, const Neighbour& b) { return a.weight > b.weight; });
        neighbours.resize(std::min(neighbours.size(), kTetsOfNode));
    }
    return around;
}

}  // namespace

template <class S>
NodeRotations<S>::NodeRotations(const Model& model, const Stiffness<S>& elements, const Kernels& kernels)
    : kernels_(kernels.rotation<S>()), count_(model.free_count) {
    const std::size_t width = kernels_.width;
    blocks_ = (count_ + width - 1) / width;
    tets_ = AlignedArray<std::int32_t>(blocks_ * kTetsOfNode * width);
    weights_ = AlignedArray<S>(blocks_ * kTetsOfNode * width);
    diagonals_ = AlignedArray<S>(blocks_ * 12 * width);
    const auto around = stiffest_around(model);
    for (std::size_t node = 0; node < count_; ++node) {
        for (std::size_t k = 0; k < around[node].size(); ++k) {
            const std::size_t place = (node / width * kTetsOfNode + k) * width + lane_of(node);
            tets_[place] = static_cast<std::int32_t>(elements.rotation_place(around[node][k].element));
            weights_[place] = static_cast<S>(around[node][k].weight / around[node][0].weight);
        }
    }
    reset();
}

/// As NodeTurns orders the nodes of a block.
template <class S>
std::size_t NodeRotations<S>::lane_of(std::size_t node) const noexcept {
    const std::size_t group = kernels_.width / 4;
    return node % group * 4 + node / group % 4;
}

/// Where the first diagonal of its matrix stands; the others follow at distances of the width.
template <class S>
std::size_t NodeRotations<S>::diagonal_of(std::size_t node) const noexcept {
    const std::size_t width = kernels_.width, group = width / 4;
    return 3 * width * (node / group) + 4 * (node % group);
}

template <class S>
NodeTurns<S> NodeRotations<S>::view() const noexcept {
    const std::size_t group = kernels_.width / 4;
    return {(count_ + group - 1) / group, diagonals_.data(), tets_.data(), weights_.data()};
}

template <class S>
void NodeRotations<S>::reset() noexcept {
    std::fill_n(diagonals_.data(), diagonals_.size(), S(0));
    for (std::size_t node = 0; node < count_; ++node)
        std::fill_n(diagonals_.data() + diagonal_of(node), 3, S(1));
    next_share_ = 0;
    squared_angles_.fill(0);
}

template <class S>
void NodeRotations<S>::update(const Stiffness<S>& elements, std::uint32_t shares) noexcept {
    Real sum = 0;
    for (std::size_t block = next_share_; block < blocks_; block += shares) {
        sum += static_cast<Real>(
            kernels_.average(view(), block, elements.rotations().data(), elements.rotation_stride()));
    }
    squared_angles_[next_share_] = sum;
    next_share_ = (next_share_ + 1) % shares;
}

template <class S>
Real NodeRotations<S>::mean_angle_rad() const noexcept {
    const Real sum = std::accumulate(squared_angles_.begin(), squared_angles_.end(), Real(0));
    return count_ == 0 ? 0 : std::sqrt(sum / static_cast<Real>(count_));
}

template <class S>
Mat NodeRotations<S>::rotation(std::size_t node) const noexcept {
    Mat result;
    for (int k = 0; k < 3; ++k) {
        const S* const diagonal =
            diagonals_.data() + diagonal_of(node) + static_cast<std::size_t>(k) * kernels_.width;
        for (int row = 0; row < 3; ++row)
            result(row, (row + k) % 3) = static_cast<Real>(diagonal[row]);
    }
    return result;
}

template class NodeRotations<float>;
template class NodeRotations<double>;

}  // namespace knead::core
