// SPDX-License-Identifier: Apache-2.0
#include "core/elements.h"

#include "core/rotation.h"

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

}  // namespace

template <class S>
Elements<S>::Elements(const Model& model, const Kernels& kernels)
    : kernels_(kernels.element<S>()),
      blocks_((model.elements.size() + kernels_.width - 1) / kernels_.width),
      nodes_(4 * kernels_.width * blocks_),
      rest_inverse_(9 * kernels_.width * blocks_),
      lame_volume_(2 * kernels_.width * blocks_),
      rotations_(4 * kernels_.width * blocks_),
      gradients_(9 * kernels_.width * blocks_) {
    const std::size_t width = kernels_.width;
    const auto zero_node = static_cast<std::uint32_t>(model.rest_m.size());
    for (std::size_t block = 0; block < blocks_; ++block) {
        for (std::size_t lane = 0; lane < width; ++lane) {
            const std::size_t e = lane * blocks_ + block;
            const bool real = e < model.elements.size();
            for (std::size_t k = 0; k < 4; ++k) {
                const std::uint32_t node = real ? model.elements[e].nodes[k] : zero_node;
                nodes_[(4 * block + k) * width + lane] = static_cast<std::int32_t>(4 * node);
            }
            if (!real) continue;
            const Element& element = model.elements[e];
            for (std::size_t k = 0; k < 9; ++k) {
                rest_inverse_[(9 * block + k) * width + lane] =
                    static_cast<S>(element.rest_inverse(k / 3, k % 3));
            }
            lame_volume_[2 * block * width + lane] = static_cast<S>(element.mu_volume);
            lame_volume_[(2 * block + 1) * width + lane] = static_cast<S>(element.lambda_volume);
        }
    }
    reset();
}

template <class S>
void Elements<S>::reset() noexcept {
    std::fill_n(rotations_.data(), rotations_.size(), S(0));
    for (std::size_t block = 0; block < blocks_; ++block) {
        for (std::size_t lane = 0; lane < kernels_.width; ++lane)
            rotations_[4 * block * kernels_.width + lane] = 1;
    }
}

template <class S>
ElementArrays<S> Elements<S>::view() noexcept {
    return {blocks_,           nodes_.data(),     rest_inverse_.data(),
            lame_volume_.data(), rotations_.data(), gradients_.data()};
}

template <class S>
void Elements<S>::linearise(S scale, const NodeField<S>& u, NodeField<S>& forces) noexcept {
    forces.fill_zero();
    kernels_.linearise(view(), scale, u.data(), forces.data(), find_rotation<S>);
}

template <class S>
Quat Elements<S>::rotation(std::size_t element) const noexcept {
    const std::size_t width = kernels_.width;
    const S* const q = rotations_.data() + element % blocks_ * 4 * width + element / blocks_;
    return Quat(static_cast<Real>(q[0]), static_cast<Real>(q[width]), static_cast<Real>(q[2 * width]),
                static_cast<Real>(q[3 * width]));
}

template class Elements<float>;
template class Elements<double>;

}  // namespace knead::core
