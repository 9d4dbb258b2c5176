// SPDX-License-Identifier: Apache-2.0
#include "core/factor/supernodal_factor.h"

#include <algorithm>
#include <limits>

namespace knead::core {
namespace {

FactorLayout make_layout(int block_size, FactorStorage storage, const FactorKernels& kernels) {
    FactorLayout layout;
    layout.block = static_cast<std::uint32_t>(block_size);
    layout.lanes = kernels.vector_bytes / (storage == FactorStorage::double_precision ? 8 : 4);
    layout.max_width = block_size == 3 ? kernels.strip_width_blocks : kernels.strip_width_scalar;
    layout.pairs = storage == FactorStorage::fixed_point_16;
    return layout;
}

std::size_t bytes_per_value(FactorStorage storage) {
    switch (storage) {
        case FactorStorage::fixed_point_16:
            return 2;
        case FactorStorage::single_precision:
            return 4;
        case FactorStorage::double_precision:
            break;
    }
    return 8;
}

/// Of the longest panel, padded to tiles of every kind, with room for what is written beyond the end.
std::size_t find_own_stride(const SymbolicFactor& symbolic, const FactorLayout& layout) {
    std::size_t longest = 0;
    for (const FactorView::Supernode& s : symbolic.supernodes)
        longest = std::max<std::size_t>(longest, std::size_t{s.columns + s.row_count} * layout.block);
    return (longest / 16 + 3) * 16;
}

}  // namespace

SupernodalFactor::Scratch::Scratch(const SupernodalFactor& factor) {
    const std::size_t vectors = factor.layout_.block == 3 ? 3 : 1;
    const std::size_t work = (vectors * 4 * factor.node_count() + 15) / 16 * 16;
    const std::size_t size = work + 6 * factor.own_stride_;
    if (factor.storage_ == FactorStorage::double_precision)
        double_ = AlignedArray<double>(size);
    else
        single_ = AlignedArray<float>(size);
}

SupernodalFactor::SupernodalFactor(const MatrixPattern& pattern, int block_size, FactorStorage storage,
                                   SimdTarget target)
    : kernels_(kernels(target).factor),
      storage_(storage),
      layout_(make_layout(block_size, storage_, kernels_)),
      symbolic_(analyse(pattern, layout_)),
      own_stride_(find_own_stride(symbolic_, layout_)),
      fronts_(pattern, symbolic_, layout_, storage_, kernels_) {
    for (int k = 0; k < 2; ++k) {
        panels_[k] = AlignedArray<unsigned char>(symbolic_.value_count * bytes_per_value(storage_));
        if (storage_ != FactorStorage::fixed_point_16) continue;
        units_[k] = AlignedArray<float>(std::size_t{layout_.block} * node_count());
        diagonals_[k] = AlignedArray<float>(std::size_t{layout_.block} * node_count());
    }
}

void SupernodalFactor::begin(const double* values) noexcept {
    const int other = 1 - current_;
    refused_ = staged_ = false;
    fronts_.begin(values, panels_[other].data(), units_[other].data(), diagonals_[other].data());
}

Progress SupernodalFactor::advance_staged(std::uint64_t work) noexcept {
    if (refused_) return Progress::refused;
    if (staged_) return Progress::done;
    const Progress progress = fronts_.advance(work);
    staged_ = progress == Progress::done;
    refused_ = progress == Progress::refused;
    return progress;
}

Progress SupernodalFactor::advance(std::uint64_t work) noexcept {
    const Progress progress = advance_staged(work);
    adopt();
    return progress;
}

void SupernodalFactor::adopt() noexcept {
    if (!staged_) return;
    current_ = 1 - current_;
    ready_ = true;
    staged_ = false;
    refused_ = true;  // nothing to do until the next begin()
}

bool SupernodalFactor::factorise(const double* values) noexcept {
    begin(values);
    return advance(std::numeric_limits<std::uint64_t>::max()) == Progress::done;
}

std::size_t SupernodalFactor::bytes() const noexcept {
    return panels_[0].bytes() + panels_[1].bytes() + 2 * (units_[0].bytes() + diagonals_[0].bytes()) +
           fronts_.bytes() + symbolic_.rows.size() * sizeof(std::uint32_t) +
           symbolic_.supernodes.size() * sizeof(FactorView::Supernode);
}

FactorView SupernodalFactor::view(int which) const noexcept {
    FactorView view;
    view.layout = layout_;
    view.supernodes = symbolic_.supernodes.data();
    view.supernode_count = symbolic_.supernodes.size();
    view.rows = symbolic_.rows.data();
    view.place_of = symbolic_.place_of.data();
    view.node_count = node_count();
    view.values = panels_[which].data();
    view.own_stride = own_stride_;
    view.units = units_[which].data();
    view.diagonal = diagonals_[which].data();
    return view;
}

void SupernodalFactor::solve(const float* rhs, float* x, Scratch& scratch) const noexcept {
    kernels_.solve_float(view(current_), storage_, rhs, x, scratch.single_.data());
}
void SupernodalFactor::solve(const double* rhs, double* x, Scratch& scratch) const noexcept {
    kernels_.solve_double(view(current_), rhs, x, scratch.double_.data());
}
void SupernodalFactor::solve_three(const float* rhs, float* x, Scratch& scratch) const noexcept {
    kernels_.solve_three_float(view(current_), storage_, rhs, x, scratch.single_.data());
}
void SupernodalFactor::solve_three(const double* rhs, double* x, Scratch& scratch) const noexcept {
    kernels_.solve_three_double(view(current_), rhs, x, scratch.double_.data());
}
void SupernodalFactor::solve_newest(const float* rhs, float* x, Scratch& scratch) const noexcept {
    kernels_.solve_float(view(newest()), storage_, rhs, x, scratch.single_.data());
}
void SupernodalFactor::solve_newest(const double* rhs, double* x, Scratch& scratch) const noexcept {
    kernels_.solve_double(view(newest()), rhs, x, scratch.double_.data());
}
void SupernodalFactor::solve_three_newest(const float* rhs, float* x, Scratch& scratch) const noexcept {
    kernels_.solve_three_float(view(newest()), storage_, rhs, x, scratch.single_.data());
}
void SupernodalFactor::solve_three_newest(const double* rhs, double* x, Scratch& scratch) const noexcept {
    kernels_.solve_three_double(view(newest()), rhs, x, scratch.double_.data());
}

}  // namespace knead::core
