// SPDX-License-Identifier: Apache-2.0
#include "core/elements.h"

#include "core/rotation.h"
#include "core/tet_strips.h"

namespace knead::core {
namespace {

template <class S>
void find_rotation(const S* grad_u, S* q) {
    Mat f = Mat::Identity();
    for (int k = 0; k < 9; ++k)
        f(k / 3, k % 3) += static_cast<Real>(grad_u[k]);
    if (!f.allFinite()) return;
    const Quat result = nearest_rotation(f);
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

template <class V>
Stiffness<V>::Stiffness(const Model& model, const std::vector<TetStrip>& strips, std::size_t width,
                        Apply apply)
    : apply_(apply), width_(width), blocks_((strips.size() + width - 1) / width) {
    const std::size_t slots = kTetsInStrip * width * blocks_;
    nodes_ = AlignedArray<std::int32_t>((kTetsInStrip + 3) * width * blocks_);
    lame_volume_ = AlignedArray<V>(2 * slots);
    rotations_ = AlignedArray<V>(4 * slots);
    gradients_ = AlignedArray<V>(9 * slots);
    rotation_at_.resize(model.elements.size());
    const auto zero_node = static_cast<std::uint32_t>(model.rest_m.size());
    std::fill_n(nodes_.data(), nodes_.size(), static_cast<std::int32_t>(4 * zero_node));
    for (std::size_t s = 0; s < strips.size(); ++s)
        add(model, strips[s], s % blocks_, s / blocks_);
}

template <class V>
void Stiffness<V>::add(const Model& model, const TetStrip& strip, std::size_t block, std::size_t lane) {
    for (std::size_t k = 0; k < strip.nodes.size(); ++k) {
        if (strip.nodes[k] == TetStrip::kNone) continue;
        nodes_[((kTetsInStrip + 3) * block + k) * width_ + lane] =
            static_cast<std::int32_t>(4 * strip.nodes[k]);
    }
    for (std::size_t k = 0; k < kTetsInStrip && strip.elements[k] != TetStrip::kNone; ++k) {
        const Element& element = model.elements[strip.elements[k]];
        const std::size_t slot = kTetsInStrip * block + k;
        lame_volume_[2 * slot * width_ + lane] = static_cast<V>(element.mu_volume);
        lame_volume_[(2 * slot + 1) * width_ + lane] = static_cast<V>(element.lambda_volume);
        rotation_at_[strip.elements[k]] = static_cast<std::uint32_t>(4 * slot * width_ + lane);
    }
}

template <class V>
StiffnessArrays<V> Stiffness<V>::view() const noexcept {
    return {blocks_, nodes_.data(), lame_volume_.data(), rotations_.data(), gradients_.data()};
}

template <class V>
Quat Stiffness<V>::rotation(std::size_t element) const noexcept {
    const V* const q = rotations_.data() + rotation_at_[element];
    return Quat(static_cast<Real>(q[0]), static_cast<Real>(q[width_]), static_cast<Real>(q[2 * width_]),
                static_cast<Real>(q[3 * width_]));
}

template <class S, class V>
Elements<S, V>::Elements(const Model& model, const Kernels& kernels)
    : Elements(model, make_tet_strips(model.elements), kernels.element<S, V>()) {}

template <class S, class V>
Elements<S, V>::Elements(const Model& model, const std::vector<TetStrip>& strips,
                         const ElementKernels<S, V>& kernels)
    : Stiffness<V>(model, strips, kernels.width, kernels.apply_stiffness), kernels_(kernels) {
    const std::size_t width = this->width(), blocks = this->blocks();
    rest_inverse_ = AlignedArray<S>(this->gradients().size());
    if constexpr (!std::is_same_v<S, V>) state_ = AlignedArray<S>(this->rotations().size());
    for (std::size_t s = 0; s < strips.size(); ++s) {
        const TetStrip& strip = strips[s];
        for (std::size_t k = 0; k < kTetsInStrip && strip.elements[k] != TetStrip::kNone; ++k) {
            const std::size_t slot = kTetsInStrip * (s % blocks) + k;
            for (std::size_t j = 0; j < 3; ++j) {
                const Vec gradient = gradient_of(model.elements[strip.elements[k]], strip.nodes[k + j + 1]);
                for (std::size_t c = 0; c < 3; ++c)
                    rest_inverse_[(9 * slot + 3 * j + c) * width + s / blocks] = static_cast<S>(gradient[c]);
            }
        }
    }
    reset();
}

template <class S, class V>
void Elements<S, V>::reset() noexcept {
    const auto to_identity = [&](auto& rotations) {
        const std::size_t width = this->width();
        std::fill_n(rotations.data(), rotations.size(), 0);
        for (std::size_t slot = 0; slot < kTetsInStrip * this->blocks(); ++slot)
            std::fill_n(rotations.data() + 4 * slot * width, width, 1);
    };
    to_identity(this->rotations());
    if constexpr (!std::is_same_v<S, V>) to_identity(state_);
    for (std::size_t k = 0; k < rest_inverse_.size(); ++k)
        this->gradients()[k] = static_cast<V>(rest_inverse_[k]);
}

template <class S, class V>
bool Elements<S, V>::linearise(S scale, const NodeField<S>& u, NodeField<S>& forces) noexcept {
    forces.fill_zero();
    return kernels_.linearise({this->view(), rest_inverse_.data(), state().data()}, scale, u.data(),
                              forces.data(), find_rotation<S>);
}

template class Stiffness<float>;
template class Stiffness<double>;
template class Elements<float>;
template class Elements<double, float>;
template class Elements<double>;

}  // namespace knead::core
