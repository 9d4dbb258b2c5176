// SPDX-License-Identifier: Apache-2.0
#include "core/elements.h"

#include "core/rotation.h"
#include "core/tet_strips.h"

namespace knead::core {
namespace {

template <class S>
void find_rotation(const S* f, S* q) {
    Mat matrix;
    for (int k = 0; k < 9; ++k)
        matrix(k / 3, k % 3) = static_cast<Real>(f[k]);
    if (!matrix.allFinite()) return;
    const Quat result = nearest_rotation(matrix);
    q[0] = static_cast<S>(result.w());
    q[1] = static_cast<S>(result.x());
    q[2] = static_cast<S>(result.y());
    q[3] = static_cast<S>(result.z());
}

/// Gradient of the shape function of one of its nodes.
Vec gradient_of(const Element& element, std::uint32_t node) {
    for (int k = 0; k < 3; ++k) {
        if (element.nodes[static_cast<std::size_t>(k) + 1] == node) return element.rest_inverse.row(k);
    }
    return -element.rest_inverse.colwise().sum();
}

}  // namespace

template <class S>
Elements<S>::Elements(const Model& model, const Kernels& kernels) : kernels_(kernels.element<S>()) {
    const std::vector<TetStrip> strips = make_tet_strips(model.elements);
    const std::size_t width = kernels_.width;
    blocks_ = (strips.size() + width - 1) / width;
    const std::size_t slots = kTetsInStrip * width * blocks_;
    nodes_ = AlignedArray<std::int32_t>((kTetsInStrip + 3) * width * blocks_);
    rest_inverse_ = AlignedArray<S>(9 * slots);
    lame_volume_ = AlignedArray<S>(2 * slots);
    rotations_ = AlignedArray<S>(4 * slots);
    gradients_ = AlignedArray<S>(9 * slots);
    rotation_at_.resize(model.elements.size());
    const auto zero_node = static_cast<std::uint32_t>(model.rest_m.size());
    std::fill_n(nodes_.data(), nodes_.size(), static_cast<std::int32_t>(4 * zero_node));
    for (std::size_t s = 0; s < strips.size(); ++s)
        add(model, strips[s], s % blocks_, s / blocks_);
    reset();
}

template <class S>
void Elements<S>::add(const Model& model, const TetStrip& strip, std::size_t block, std::size_t lane) {
    const std::size_t width = kernels_.width;
    for (std::size_t k = 0; k < strip.nodes.size(); ++k) {
        if (strip.nodes[k] == TetStrip::kNone) continue;
        nodes_[((kTetsInStrip + 3) * block + k) * width + lane] =
            static_cast<std::int32_t>(4 * strip.nodes[k]);
    }
    for (std::size_t k = 0; k < kTetsInStrip && strip.elements[k] != TetStrip::kNone; ++k) {
        const Element& element = model.elements[strip.elements[k]];
        const std::size_t slot = kTetsInStrip * block + k;
        for (std::size_t j = 0; j < 3; ++j) {
            const Vec gradient = gradient_of(element, strip.nodes[k + j + 1]);
            for (std::size_t c = 0; c < 3; ++c)
                rest_inverse_[(9 * slot + 3 * j + c) * width + lane] = static_cast<S>(gradient[c]);
        }
        lame_volume_[2 * slot * width + lane] = static_cast<S>(element.mu_volume);
        lame_volume_[(2 * slot + 1) * width + lane] = static_cast<S>(element.lambda_volume);
        rotation_at_[strip.elements[k]] = static_cast<std::uint32_t>(4 * slot * width + lane);
    }
}

template <class S>
void Elements<S>::reset() noexcept {
    const std::size_t width = kernels_.width;
    std::fill_n(rotations_.data(), rotations_.size(), S(0));
    for (std::size_t slot = 0; slot < kTetsInStrip * blocks_; ++slot)
        std::fill_n(rotations_.data() + 4 * slot * width, width, S(1));
}

template <class S>
ElementArrays<S> Elements<S>::view() noexcept {
    return {blocks_,           nodes_.data(),    rest_inverse_.data(), lame_volume_.data(),
            rotations_.data(), gradients_.data()};
}

template <class S>
void Elements<S>::linearise(S scale, const NodeField<S>& u, NodeField<S>& forces) noexcept {
    forces.fill_zero();
    kernels_.linearise(view(), scale, u.data(), forces.data(), find_rotation<S>);
}

template <class S>
Quat Elements<S>::rotation(std::size_t element) const noexcept {
    const std::size_t width = kernels_.width;
    const S* const q = rotations_.data() + rotation_at_[element];
    return Quat(static_cast<Real>(q[0]), static_cast<Real>(q[width]), static_cast<Real>(q[2 * width]),
                static_cast<Real>(q[3 * width]));
}

template class Elements<float>;
template class Elements<double>;

}  // namespace knead::core
