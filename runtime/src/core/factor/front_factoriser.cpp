// SPDX-License-Identifier: Apache-2.0
#include "core/factor/front_factoriser.h"

#include <algorithm>
#include <numeric>

namespace knead::core {
namespace {

constexpr std::size_t kPad = 8;              ///< numbers: a vector of every instruction set
constexpr std::uint64_t kCopies = 1 << 14;   ///< numbers moved in one piece of work
constexpr std::size_t kColumnsOfMatrix = 8;  ///< nodes whose columns of A are added in one piece

}  // namespace

FrontFactoriser::FrontFactoriser(const MatrixPattern& pattern, const SymbolicFactor& symbolic,
                                 const FactorLayout& layout, FactorStorage storage,
                                 const FactorKernels& kernels)
    : symbolic_(symbolic), layout_(layout), storage_(storage), kernels_(kernels) {
    sort_entries(pattern);
    local_.resize(symbolic.node_count());
    const auto count = static_cast<std::uint32_t>(symbolic.supernodes.size());
    child_begin_.assign(count + 1, 0);
    for (const std::uint32_t parent : symbolic.parents)
        if (parent != SymbolicFactor::kNoParent) ++child_begin_[parent + 1];
    std::partial_sum(child_begin_.begin(), child_begin_.end(), child_begin_.begin());
    children_.resize(child_begin_[count]);
    std::vector<std::uint32_t> next(child_begin_.begin(), child_begin_.end());
    for (std::uint32_t s = 0; s < count; ++s)
        if (symbolic.parents[s] != SymbolicFactor::kNoParent) children_[next[symbolic.parents[s]]++] = s;
    size_stack();
}

std::size_t FrontFactoriser::padded(std::size_t numbers) noexcept {
    return (numbers + kPad - 1) / kPad * kPad;
}

void FrontFactoriser::sort_entries(const MatrixPattern& pattern) {
    const std::uint32_t n = pattern.node_count;
    const auto& place = symbolic_.place_of;
    entry_begin_.assign(n + 1, 0);
    // A neighbour that is eliminated later is an ancestor in the tree, and stays behind in every postorder:
    // the lower triangle is the lower triangle of the places too.
    for (std::uint32_t j = 0; j < n; ++j)
        entry_begin_[place[j] + 1] = pattern.column_begin[j + 1] - pattern.column_begin[j];
    std::partial_sum(entry_begin_.begin(), entry_begin_.end(), entry_begin_.begin());
    entries_.resize(entry_begin_[n]);
    for (std::uint32_t j = 0; j < n; ++j) {
        std::uint32_t next = entry_begin_[place[j]];
        for (std::uint32_t k = pattern.column_begin[j]; k < pattern.column_begin[j + 1]; ++k)
            entries_[next++] = {place[pattern.row_nodes[k]], k};
    }
}

/// The stack when every supernode is open: what its children left, then its front; what remains of the front
/// moves down to where its first child's was.
void FrontFactoriser::size_stack() {
    std::size_t top = 0, largest = 0, largest_front = 0, widest = 0;
    stack_begin_.resize(symbolic_.supernodes.size());
    for (std::size_t s = 0; s < symbolic_.supernodes.size(); ++s) {
        const Front front = front_of(s, nullptr);
        largest = std::max(largest, top + front.ld * front.size);
        largest_front = std::max(largest_front, front.ld);
        widest = std::max(widest, front.columns);
        if (child_begin_[s] < child_begin_[s + 1]) top = stack_begin_[children_[child_begin_[s]]];
        stack_begin_[s] = top;
        top += padded(front.rows) * front.rows;
    }
    stack_ = AlignedArray<double>(largest + kPad);
    strip_ = AlignedArray<double>(2 * largest_front * layout_.max_width + kPad);
    inverses_ = AlignedArray<double>((widest + layout_.max_width) * layout_.max_width);
}

FrontFactoriser::Front FrontFactoriser::front_of(std::size_t supernode, double* data) const noexcept {
    const FactorView::Supernode& s = symbolic_.supernodes[supernode];
    Front front{};
    front.columns = std::size_t{s.columns} * layout_.block;
    front.rows = std::size_t{s.row_count} * layout_.block;
    front.size = front.columns + front.rows;
    front.width = layout_.strip_width(s.columns);
    front.ld = padded(front.size + kPad);  // products write up to a vector beyond the last row
    front.data = data;
    return front;
}

void FrontFactoriser::begin(const double* values, void* panels, float* units, float* diagonal) noexcept {
    values_ = values;
    panels_ = panels;
    units_ = units;
    diagonal_ = diagonal;
    supernode_ = 0;
    refused_ = false;
    open();
}

Progress FrontFactoriser::advance(std::uint64_t work) noexcept {
    std::uint64_t spent = 0;
    do {
        if (refused_) return Progress::refused;
        if (supernode_ == symbolic_.supernodes.size()) return Progress::done;
        spent += piece();
    } while (spent < work);
    if (refused_) return Progress::refused;
    return supernode_ == symbolic_.supernodes.size() ? Progress::done : Progress::working;
}

std::uint64_t FrontFactoriser::largest_piece() const noexcept {
    std::uint64_t largest = kCopies;
    for (std::size_t s = 0; s < symbolic_.supernodes.size(); ++s) {
        const Front front = front_of(s, nullptr);
        largest = std::max<std::uint64_t>(largest, 2 * front.ld * front.width * layout_.max_width);
        largest = std::max<std::uint64_t>(largest, front.ld * layout_.max_width);
    }
    return largest;
}

std::uint64_t FrontFactoriser::piece() noexcept {
    switch (stage_) {
        case Stage::clear:
            return clear();
        case Stage::matrix:
            return add_matrix();
        case Stage::child:
            return add_child();
        case Stage::pivot:
            return eliminate_strip();
        case Stage::update:
            return update_strip();
        case Stage::invert:
            return invert_strip();
        case Stage::keep:
            return keep_rest();
        case Stage::next:
            ++supernode_;
            open();
            return 0;
    }
    return 0;
}

void FrontFactoriser::open() noexcept {
    if (supernode_ == symbolic_.supernodes.size()) return;
    const FactorView::Supernode& s = symbolic_.supernodes[supernode_];
    std::size_t top = stack_begin_[supernode_];
    if (child_begin_[supernode_] < child_begin_[supernode_ + 1]) {
        const std::uint32_t last = children_[child_begin_[supernode_ + 1] - 1];
        const std::size_t rows = std::size_t{symbolic_.supernodes[last].row_count} * layout_.block;
        top = stack_begin_[last] + padded(rows) * rows;
    }
    front_ = front_of(supernode_, stack_.data() + top);
    for (std::uint32_t i = 0; i < s.columns; ++i)
        local_[s.first + i] = i;
    for (std::uint32_t i = 0; i < s.row_count; ++i)
        local_[symbolic_.rows[s.rows_begin + i]] = s.columns + i;
    panel_offset_ = s.values_begin;
    stage_ = Stage::clear;
    at_ = inner_ = 0;
}

std::uint64_t FrontFactoriser::clear() noexcept {
    const std::size_t columns = std::min<std::size_t>(front_.size - at_, 1 + kCopies / front_.ld);
    std::fill_n(front_.data + at_ * front_.ld, columns * front_.ld, 0.0);
    at_ += columns;
    if (at_ == front_.size) {
        stage_ = Stage::matrix;
        at_ = 0;
    }
    return columns * front_.ld / kPad;
}

std::uint64_t FrontFactoriser::add_matrix() noexcept {
    const FactorView::Supernode& s = symbolic_.supernodes[supernode_];
    const std::size_t block = layout_.block;
    const std::size_t end = std::min<std::size_t>(at_ + kColumnsOfMatrix, s.columns);
    std::uint64_t work = 0;
    for (; at_ < end; ++at_) {
        const std::size_t place = s.first + at_;
        for (std::uint32_t k = entry_begin_[place]; k < entry_begin_[place + 1]; ++k) {
            const Entry& entry = entries_[k];
            const double* from = values_ + std::size_t{entry.entry} * block * block;
            double* to = front_.data + at_ * block * front_.ld + local_[entry.row] * block;
            for (std::size_t c = 0; c < block; ++c)
                for (std::size_t r = 0; r < block; ++r)
                    to[c * front_.ld + r] = from[c * block + r];
        }
        work += (entry_begin_[place + 1] - entry_begin_[place]) * block * block;
    }
    if (at_ == s.columns) {
        stage_ = Stage::child;
        at_ = child_begin_[supernode_];
        inner_ = 0;
    }
    return work;
}

/// Adds some columns of what child `at_` left.
std::uint64_t FrontFactoriser::add_child() noexcept {
    if (at_ == child_begin_[supernode_ + 1]) {
        stage_ = Stage::pivot;
        at_ = inner_ = 0;
        return 0;
    }
    const std::uint32_t child = children_[at_];
    const FactorView::Supernode& s = symbolic_.supernodes[child];
    const std::uint32_t* rows = symbolic_.rows.data() + s.rows_begin;
    const std::size_t block = layout_.block;
    const std::size_t ld = padded(s.row_count * block);
    const double* left = stack_.data() + stack_begin_[child];
    const std::size_t end =
        std::min<std::size_t>(s.row_count, inner_ + 1 + kCopies / (block * block * s.row_count + 1));
    std::uint64_t work = 0;
    for (; inner_ < end; ++inner_) {
        for (std::size_t c = 0; c < block; ++c) {
            const double* from = left + (inner_ * block + c) * ld;
            double* to = front_.data + (local_[rows[inner_]] * block + c) * front_.ld;
            if (block == 3) {
                for (std::size_t i = inner_; i < s.row_count; ++i) {
                    double* three = to + 3 * std::size_t{local_[rows[i]]};
                    three[0] += from[3 * i];
                    three[1] += from[3 * i + 1];
                    three[2] += from[3 * i + 2];
                }
            } else {
                for (std::size_t i = inner_; i < s.row_count; ++i)
                    to[local_[rows[i]]] += from[i];
            }
        }
        work += (s.row_count - inner_) * block * block;
    }
    if (inner_ == s.row_count) {
        ++at_;
        inner_ = 0;
    }
    return work;
}

/// Numbers of the strip that starts at `column`, of the eliminated columns or of the rest.
std::size_t FrontFactoriser::width_at(std::size_t column) const noexcept {
    if (column < front_.columns) return std::min(front_.width, front_.columns - column);
    return std::min<std::size_t>(layout_.max_width, front_.size - column);
}

double* FrontFactoriser::inverse_at(std::size_t column) noexcept {
    return inverses_.data() + column * layout_.max_width;
}

/// Turns the strip at column `at_` into columns of L.
std::uint64_t FrontFactoriser::eliminate_strip() noexcept {
    const std::size_t width = width_at(at_);
    double* diagonal = front_.data + at_ * front_.ld + at_;
    if (!kernels_.factor_block(width, diagonal, front_.ld, inverse_at(at_))) {
        refused_ = true;
        return 0;
    }
    const std::size_t below = front_.size - at_ - width;
    double* copy = strip_.data();
    for (std::size_t c = 0; c < width; ++c) {
        double* from = diagonal + c * front_.ld + width;
        for (std::size_t i = 0; i < below; ++i)
            copy[c * front_.ld + i] = -from[i];
        std::fill_n(from, below, 0.0);
    }
    // L = A W^T: element (k, j) of W^T is W(j, k).
    kernels_.subtract_product(below, width, width, copy, front_.ld, inverse_at(at_), width, 1,
                              diagonal + width, front_.ld);
    stage_ = Stage::update;
    inner_ = at_ + width;
    return 2 * width * width * (below + width);
}

/// Takes the strip at `at_` from the columns of the strip at `inner_`.
std::uint64_t FrontFactoriser::update_strip() noexcept {
    const std::size_t pivots = width_at(at_);
    std::uint64_t work = 0;
    if (inner_ < front_.size) {
        const std::size_t width = width_at(inner_);
        const double* l = front_.data + at_ * front_.ld + inner_;
        kernels_.subtract_product(front_.size - inner_, width, pivots, l, front_.ld, l, front_.ld, 1,
                                  front_.data + inner_ * front_.ld + inner_, front_.ld);
        work = 2 * pivots * width * (front_.size - inner_);
        inner_ += width;
    }
    if (inner_ < front_.size) return work;
    at_ += pivots;
    stage_ = Stage::pivot;
    if (at_ == front_.columns) {
        stage_ = Stage::invert;
        at_ = inner_ = 0;
    }
    return work;
}

/// One block row of the panel's strip at column `at_`: [W; -L_R W] from the top, by substitution.
std::uint64_t FrontFactoriser::invert_strip() noexcept {
    const std::size_t width = width_at(at_);
    const std::size_t ld = front_.ld;
    double* x = strip_.data();                    // rows from 0 on: the strip
    double* solved = x + ld * layout_.max_width;  // the block row under way
    const std::size_t height = width_at(inner_);
    const double* inverse = inverse_at(inner_);
    if (inner_ == at_) {
        std::fill_n(x, ld * width, 0.0);
        for (std::size_t c = 0; c < width; ++c)
            std::copy_n(inverse + c * width, width, x + c * ld + at_);
        for (std::size_t c = 0; c < width; ++c)
            std::copy_n(inverse + c * width, width, solved + c * ld);
    } else {
        for (std::size_t c = 0; c < width; ++c) {
            std::fill_n(solved + c * ld, height, 0.0);
            for (std::size_t k = 0; k < height; ++k) {
                const double value = x[c * ld + inner_ + k];
                for (std::size_t r = k; r < height; ++r)
                    solved[c * ld + r] += inverse[k * height + r] * value;
            }
            std::copy_n(solved + c * ld, height, x + c * ld + inner_);
        }
    }
    const std::size_t below = inner_ + height;
    kernels_.subtract_product(front_.size - below, width, height, front_.data + inner_ * ld + below, ld,
                              solved, 1, ld, x + below, ld);
    const std::uint64_t work = 2 * width * height * (front_.size - inner_);
    inner_ = below;
    if (inner_ < front_.columns) return work;

    store_strip();
    at_ += width;
    inner_ = at_;
    if (at_ == front_.columns) {
        stage_ = Stage::keep;
        at_ = 0;
    }
    return work + width * front_.size;
}

/// The strip at `at_`, just computed.
void FrontFactoriser::store_strip() noexcept {
    const std::size_t width = width_at(at_);
    const std::size_t lanes = layout_.lanes;
    const std::size_t first_tile = at_ / lanes;
    const std::size_t tiles = (front_.size + lanes - 1) / lanes - first_tile;
    float* units = nullptr;
    std::size_t bytes = storage_ == FactorStorage::single_precision ? 4 : 8;
    if (storage_ == FactorStorage::fixed_point_16) {
        bytes = 2;
        const std::size_t first = std::size_t{symbolic_.supernodes[supernode_].first} * layout_.block;
        units = units_ + first + at_;
        for (std::size_t r = at_; r < front_.columns; ++r) {
            const double pivot = front_.data[r * front_.ld + r];  // W(r, r) is its inverse
            diagonal_[first + r] = static_cast<float>(1 / (pivot * pivot));
            for (std::size_t c = 0; c < width; ++c)
                strip_[c * front_.ld + r] *= pivot;
        }
    }
    refused_ |= !kernels_.store_strip(storage_, front_.size - first_tile * lanes, tiles, width,
                                      strip_.data() + first_tile * lanes, front_.ld,
                                      static_cast<unsigned char*>(panels_) + panel_offset_ * bytes, units);
    panel_offset_ += tiles * lanes * layout_.stored_width(width);
}

/// Moves some columns of what remains to where the parent looks for it; downwards, so in ascending order.
std::uint64_t FrontFactoriser::keep_rest() noexcept {
    const std::size_t ld = padded(front_.rows);
    double* to = stack_.data() + stack_begin_[supernode_];
    const std::size_t end = std::min<std::size_t>(front_.rows, at_ + 1 + kCopies / (front_.rows + 1));
    std::uint64_t work = 0;
    for (; at_ < end; ++at_) {
        const double* from = front_.data + (front_.columns + at_) * front_.ld + front_.columns;
        std::memmove(to + at_ * ld + at_, from + at_, (front_.rows - at_) * sizeof(double));
        work += (front_.rows - at_) / 4;
    }
    if (at_ == front_.rows) stage_ = Stage::next;
    return work + 1;
}

}  // namespace knead::core
