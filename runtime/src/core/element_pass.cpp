// SPDX-License-Identifier: Apache-2.0
#include "core/element_pass.h"

#include <algorithm>

#include "core/rotation.h"

namespace knead::core {
namespace {

Mat edges(const std::array<std::uint32_t, 4>& nodes, const Field& x) {
    Mat result;
    const Vec& origin = x[nodes[0]];
    for (int k = 0; k < 3; ++k)
        result.col(k) = x[nodes[k + 1]] - origin;
    return result;
}

/// Stress (times volume) of linear elasticity for a displacement gradient.
Mat linear_stress(const Element& element, const Mat& gradient) {
    Mat stress = element.mu_volume * (gradient + gradient.transpose());
    stress.diagonal().array() += element.lambda_volume * gradient.trace();
    return stress;
}

/// Adds column k of `columns` to node k + 1 and takes their sum from node 0.
void scatter(const std::array<std::uint32_t, 4>& nodes, const Mat& columns, Field& out) {
    for (int k = 0; k < 3; ++k)
        out[nodes[k + 1]] += columns.col(k);
    out[nodes[0]] -= columns.rowwise().sum();
}

}  // namespace

ElementPass::ElementPass(const Model& model)
    : rotations_(model.elements.size()), gradients_(model.elements.size(), Mat::Zero()) {
    reset();
}

void ElementPass::reset() noexcept {
    std::fill(rotations_.begin(), rotations_.end(), Quat::Identity());
}

void ElementPass::linearise(const Model& model, const Field& x, Field& forces) noexcept {
    std::fill(forces.begin(), forces.end(), Vec::Zero());
    for (std::size_t e = 0; e < model.elements.size(); ++e) {
        const Element& element = model.elements[e];
        const Mat f = edges(element.nodes, x) * element.rest_inverse;
        const Mat r = warm_rotation(f, rotations_[e]);
        const Real stretch = r.cwiseProduct(f).sum() - 3;
        const Mat stress = 2 * element.mu_volume * (f - r) + (element.lambda_volume * stretch) * r;
        scatter(element.nodes, -stress * element.rest_inverse.transpose(), forces);
        gradients_[e].noalias() = r * element.rest_inverse.transpose();
    }
}

void ElementPass::apply_stiffness(const Model& model, const Field& u, Field& out) const noexcept {
    std::fill(out.begin(), out.end(), Vec::Zero());
    for (std::size_t e = 0; e < model.elements.size(); ++e) {
        const Element& element = model.elements[e];
        const Mat& gradients = gradients_[e];
        const Mat stress = linear_stress(element, edges(element.nodes, u) * gradients.transpose());
        scatter(element.nodes, stress * gradients, out);
    }
}

void ElementPass::diagonal_blocks(const Model& model, std::vector<Mat>& blocks) const noexcept {
    std::fill(blocks.begin(), blocks.end(), Mat::Zero());
    for (std::size_t e = 0; e < model.elements.size(); ++e) {
        const Element& element = model.elements[e];
        const Real outer = element.lambda_volume + element.mu_volume;
        const auto add = [&](std::uint32_t node, const Vec& g) {
            Mat& block = blocks[node];
            block.noalias() += (outer * g) * g.transpose();
            block.diagonal().array() += element.mu_volume * g.squaredNorm();
        };
        for (int k = 0; k < 3; ++k)
            add(element.nodes[k + 1], gradients_[e].col(k));
        add(element.nodes[0], -gradients_[e].rowwise().sum());
    }
}

Mat ElementPass::reduced_stiffness(const Model& model, const std::vector<Mat>& columns,
                                   const std::vector<std::uint8_t>& marked) const noexcept {
    Mat result = Mat::Zero();
    for (std::size_t e = 0; e < model.elements.size(); ++e) {
        const Element& element = model.elements[e];
        const auto& n = element.nodes;
        if (!(marked[n[0]] || marked[n[1]] || marked[n[2]] || marked[n[3]])) continue;
        for (int axis = 0; axis < 3; ++axis) {
            Mat moved;
            for (int k = 0; k < 3; ++k)
                moved.col(k) = columns[n[k + 1]].col(axis) - columns[n[0]].col(axis);
            const Mat forces = linear_stress(element, moved * gradients_[e].transpose()) * gradients_[e];
            for (int k = 0; k < 3; ++k) {
                result.col(axis) += (columns[n[k + 1]] - columns[n[0]]).transpose() * forces.col(k);
            }
        }
    }
    return result;
}

}  // namespace knead::core
