// SPDX-License-Identifier: Apache-2.0
#include "core/factor/contact_correction.h"

#include <algorithm>
#include <limits>

namespace knead::core {
namespace {

/// Cosine between a sliding node's normal now and when it was taken in: 6 degrees.
constexpr double kTurnedTooFar = 0.995;
/// Change of a tool's own inverse, relative, that makes everything be taken in anew.
constexpr double kToolChanged = 0.05;
/// Removals at once beyond which it is cheaper to start over (and half of all at least).
constexpr std::size_t kManyRemovals = 8;
/// A node whose rows are this small beside what others already hold of them adds nothing but rounding.
constexpr double kDependent = 1e-6;
/// Reading a column is worth less than reading the factor: short streams.
constexpr double kColumnCost = 1.25;

bool sticks(const Mat& held) {
    return held.trace() > 1.5;
}

/// Of n n^T.
Vec normal_of(const Mat& held) {
    Eigen::Index largest = 0;
    held.diagonal().maxCoeff(&largest);
    return held.col(largest).normalized();
}

/// Inverse of the leading count x count block, count 1 or 3; symmetric. False: not positive definite enough.
bool invert_small(const double* block, std::size_t count, const double* scale, Mat& result) {
    result.setZero();
    for (std::size_t k = 0; k < count; ++k)
        if (!(block[4 * k] > kDependent * scale[k])) return false;
    if (count == 1) {
        result(0, 0) = 1 / block[0];
        return true;
    }
    Mat m;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
            m(r, c) = (block[3 * c + r] + block[3 * r + c]) / 2;
    Mat cofactors;
    cofactors.col(0) = m.col(1).cross(m.col(2));
    cofactors.col(1) = m.col(2).cross(m.col(0));
    cofactors.col(2) = m.col(0).cross(m.col(1));
    const double determinant = m.col(0).dot(cofactors.col(0));
    const double minor = m(0, 0) * m(1, 1) - m(0, 1) * m(1, 0);
    if (!(minor > kDependent * m(0, 0) * m(1, 1))) return false;
    if (!(determinant > kDependent * minor * m(2, 2))) return false;
    result = cofactors / determinant;
    return result.allFinite();
}

}  // namespace

ContactCorrection::Scratch::Scratch(const ContactCorrection& correction)
    : solve_(correction.factor_),
      reactions_(2 * correction.ld_),
      columns_(3 * correction.touchable_.size() + 1),
      factors_(3 * correction.touchable_.size() + 1),
      tools_(correction.tool_inverses_.size()) {
    const std::size_t size = std::size_t{3} * correction.factor_.node_count();
    if (correction.factor_.storage() == FactorStorage::double_precision)
        double_ = AlignedArray<double>(size);
    else
        single_ = AlignedArray<float>(size);
}

ContactCorrection::ContactCorrection(SupernodalFactor& factor, const std::vector<std::uint32_t>& touchable,
                                     std::size_t tool_count, std::size_t column_bytes, SimdTarget target)
    : factor_(factor),
      kernels_(kernels(target).factor),
      touchable_(touchable),
      touch_of_(factor.node_count(), kNone),
      keeps_columns_(factor.storage() != FactorStorage::double_precision &&
                     touchable.size() * 9 * sizeof(float) * factor.node_count() <= column_bytes),
      column_stride_((3 * (keeps_columns_ ? factor.node_count() : touchable.size()) + 15) / 16 * 16),
      tool_inverses_(tool_count, Mat::Zero()),
      member_of_(touchable.size(), kNone),
      wanted_(touchable.size(), kNone),
      solve_(factor) {
    for (std::uint32_t t = 0; t < touchable_.size(); ++t)
        touch_of_[touchable_[t]] = t;
    for (AlignedArray<float>& table : tables_)
        table = AlignedArray<float>(3 * touchable_.size() * column_stride_);
    const std::size_t rows = 3 * touchable_.size();
    ld_ = (rows + 15) / 8 * 8;  // products write up to a vector beyond the last row
    inverse_ = AlignedArray<double>(ld_ * rows + 8);
    border_ = AlignedArray<double>(3 * ld_);
    product_ = AlignedArray<double>(3 * ld_);
    weighted_ = AlignedArray<double>(3 * ld_);
    members_.reserve(touchable_.size());
    rows_.reserve(rows);
    const std::size_t size = std::size_t{9} * factor.node_count();
    if (factor.storage() == FactorStorage::double_precision) {
        rhs_double_ = AlignedArray<double>(size);
        x_double_ = AlignedArray<double>(size);
    } else {
        rhs_single_ = AlignedArray<float>(size);
        x_single_ = AlignedArray<float>(size);
    }
}

std::size_t ContactCorrection::bytes() const noexcept {
    return tables_[0].bytes() + tables_[1].bytes() + inverse_.bytes();
}

// ---- The table -------------------------------------------------------------------------------------------

void ContactCorrection::begin() noexcept {
    next_ = 0;
    made_ = false;
}

Progress ContactCorrection::advance(std::uint64_t work) noexcept {
    std::uint64_t spent = 0;
    while (next_ < touchable_.size()) {
        if (spent > 0 && spent >= work) return Progress::working;
        const auto touch = static_cast<std::uint32_t>(next_++);
        spent += factor_.storage() == FactorStorage::double_precision
                     ? make_columns(touch, rhs_double_, x_double_)
                     : make_columns(touch, rhs_single_, x_single_);
    }
    made_ = true;
    return Progress::done;
}

template <class S>
std::uint64_t ContactCorrection::make_columns(std::uint32_t touch, AlignedArray<S>& rhs,
                                              AlignedArray<S>& x) noexcept {
    const std::size_t size = std::size_t{3} * factor_.node_count();
    const std::size_t node = touchable_[touch];
    for (std::size_t c = 0; c < 3; ++c)
        rhs[c * size + 3 * node + c] = 1;
    if (factor_.solves_three_directions()) {
        factor_.solve_three_newest(rhs.data(), x.data(), solve_);
    } else {  // the same number in all directions
        for (std::size_t c = 0; c < 3; ++c)
            factor_.solve_newest(rhs.data() + c * size, x.data() + c * size, solve_);
    }
    for (std::size_t c = 0; c < 3; ++c) {
        rhs[c * size + 3 * node + c] = 0;
        float* to = tables_[1 - current_].data() + (3 * touch + c) * column_stride_;
        if (keeps_columns_) {
            for (std::size_t i = 0; i < size; ++i)
                to[i] = static_cast<float>(x[c * size + i]);
        } else {
            for (std::size_t t = 0; t < touchable_.size(); ++t)
                for (std::size_t d = 0; d < 3; ++d)
                    to[3 * t + d] = static_cast<float>(x[c * size + 3 * std::size_t{touchable_[t]} + d]);
        }
    }
    return 12 * factor_.symbolic().value_count;
}

void ContactCorrection::adopt() noexcept {
    if (!made_) return;
    made_ = false;
    current_ = 1 - current_;
    in_use_ = true;
    factor_.adopt();
    clear();
}

void ContactCorrection::build() noexcept {
    begin();
    advance(std::numeric_limits<std::uint64_t>::max());
    adopt();
}

/// A^-1 between two touchable nodes; of the two places where it stands always the same one.
double ContactCorrection::table(std::uint32_t row, int r, std::uint32_t column, int c) const noexcept {
    if (row < column || (row == column && r < c)) {
        std::swap(row, column);
        std::swap(r, c);
    }
    const std::size_t place =
        3 * std::size_t{keeps_columns_ ? touchable_[row] : row} + static_cast<std::size_t>(r);
    return tables_[current_]
                  [(3 * std::size_t{column} + static_cast<std::size_t>(c)) * column_stride_ + place];
}

// ---- The set ---------------------------------------------------------------------------------------------

void ContactCorrection::clear() noexcept {
    for (const Member& member : members_)
        member_of_[member.touch] = kNone;
    members_.clear();
    rows_.clear();
}

bool ContactCorrection::update(const HeldNode* held, std::size_t count, const Mat* tool_inverses,
                               std::size_t most_insertions) noexcept {
    for (std::size_t t = 0; t < tool_inverses_.size(); ++t) {
        const double change = (tool_inverses[t] - tool_inverses_[t]).norm();
        if (change > kToolChanged * std::min(tool_inverses[t].norm(), tool_inverses_[t].norm())) {
            clear();
            break;
        }
    }
    if (members_.empty()) std::copy_n(tool_inverses, tool_inverses_.size(), tool_inverses_.begin());
    if (!in_use_) return false;
    remove_stale(held, count);
    bool all = true;
    for (std::size_t k = 0; k < count; ++k) {
        const std::uint32_t touch = touch_of_[held[k].node];
        if (touch == kNone || member_of_[touch] != kNone) continue;
        if (most_insertions == 0) {
            all = false;
            break;
        }
        if (insert(held[k])) --most_insertions;
    }
    return all;
}

void ContactCorrection::remove_stale(const HeldNode* held, std::size_t count) noexcept {
    for (std::size_t k = 0; k < count; ++k)
        if (touch_of_[held[k].node] != kNone)
            wanted_[touch_of_[held[k].node]] = static_cast<std::uint32_t>(k);
    const auto stale = [&](const Member& member) {
        return wanted_[member.touch] == kNone || !still_holds(member, held[wanted_[member.touch]]);
    };
    const auto leaving = static_cast<std::size_t>(std::count_if(members_.begin(), members_.end(), stale));
    if (leaving == members_.size() || leaving > std::max(kManyRemovals, members_.size() / 2)) {
        clear();
    } else {
        for (std::size_t m = members_.size(); m-- > 0;)
            if (stale(members_[m])) remove(m);
    }
    for (std::size_t k = 0; k < count; ++k)
        if (touch_of_[held[k].node] != kNone) wanted_[touch_of_[held[k].node]] = kNone;
}

bool ContactCorrection::still_holds(const Member& member, const HeldNode& held) const noexcept {
    if (member.tool != held.tool || (member.count == 3) != sticks(held.held)) return false;
    if (member.count == 3) return true;
    const Vec normal = held.rotation.transpose() * normal_of(held.held);
    const double cosine = normal.dot(rows_[member.first].at_node);
    return cosine > kTurnedTooFar || cosine < -kTurnedTooFar;
}

/// W between the rows of two members.
void ContactCorrection::coupling(const Member& a, const Member& b, double* block,
                                 std::size_t ld) const noexcept {
    Mat w;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
            w(r, c) = table(a.touch, r, b.touch, c);
    for (std::size_t j = 0; j < b.count; ++j)
        for (std::size_t i = 0; i < a.count; ++i) {
            const Row &row = rows_[a.first + i], &column = rows_[b.first + j];
            double value = row.at_node.dot(w * column.at_node);
            if (a.tool == b.tool) value += row.at_tool.dot(tool_inverses_[a.tool] * column.at_tool);
            block[j * ld + i] = value;
        }
}

/// Borders the inverse: with U = V w and S = W_nn - w^T U it becomes [V + U S^-1 U^T, -U S^-1; ., S^-1].
bool ContactCorrection::insert(const HeldNode& held) noexcept {
    const std::size_t h = row_count();
    Member member{touch_of_[held.node], held.node, held.tool, h, 0};
    if (sticks(held.held)) {
        member.count = 3;
        for (int k = 0; k < 3; ++k)
            rows_.push_back({held.rotation.transpose().col(k), Vec::Unit(k)});
    } else {
        member.count = 1;
        const Vec normal = normal_of(held.held);
        rows_.push_back({held.rotation.transpose() * normal, normal});
    }
    for (const Member& other : members_)
        coupling(other, member, border_.data() + other.first, ld_);
    double corner[9] = {};
    coupling(member, member, corner, member.count);
    double own[3];
    for (std::size_t k = 0; k < member.count; ++k)
        own[k] = corner[(member.count + 1) * k];

    for (std::size_t k = 0; k < member.count; ++k) {
        std::fill_n(product_.data() + k * ld_, h, 0.0);
        for (std::size_t i = 0; i < h; ++i)
            border_[k * ld_ + i] = -border_[k * ld_ + i];
    }
    kernels_.subtract_product(h, member.count, h, inverse_.data(), ld_, border_.data(), 1, ld_,
                              product_.data(), ld_);
    for (std::size_t c = 0; c < member.count; ++c)
        for (std::size_t r = 0; r < member.count; ++r)
            for (std::size_t i = 0; i < h; ++i)
                corner[c * member.count + r] += border_[r * ld_ + i] * product_[c * ld_ + i];
    Mat schur;
    if (!invert_small(corner, member.count, own, schur)) {
        rows_.resize(h);
        return false;
    }
    for (std::size_t c = 0; c < member.count; ++c)
        for (std::size_t i = 0; i < h; ++i) {
            double value = 0;
            for (std::size_t k = 0; k < member.count; ++k)
                value -= product_[k * ld_ + i] * schur(static_cast<int>(k), static_cast<int>(c));
            weighted_[c * ld_ + i] = value;
        }
    kernels_.subtract_product(h, h, member.count, product_.data(), ld_, weighted_.data(), ld_, 1,
                              inverse_.data(), ld_);
    for (std::size_t c = 0; c < member.count; ++c) {
        double* column = inverse_.data() + (h + c) * ld_;
        std::copy_n(weighted_.data() + c * ld_, h, column);
        for (std::size_t i = 0; i < h; ++i)
            inverse_[i * ld_ + h + c] = weighted_[c * ld_ + i];
        for (std::size_t r = 0; r < member.count; ++r)
            column[h + r] = schur(static_cast<int>(r), static_cast<int>(c));
    }
    member_of_[member.touch] = static_cast<std::uint32_t>(members_.size());
    members_.push_back(member);
    return true;
}

/// The inverse without some rows is its Schur complement on them.
void ContactCorrection::remove(std::size_t index) noexcept {
    const Member member = members_[index];
    const std::size_t h = row_count(), first = member.first, count = member.count;
    double corner[9] = {};
    const double own[3] = {};
    for (std::size_t c = 0; c < count; ++c) {
        std::copy_n(inverse_.data() + (first + c) * ld_, h, product_.data() + c * ld_);
        for (std::size_t r = 0; r < count; ++r)
            corner[c * count + r] = inverse_[(first + c) * ld_ + first + r];
    }
    Mat schur;
    if (!invert_small(corner, count, own, schur)) return clear();
    for (std::size_t c = 0; c < count; ++c)
        for (std::size_t i = 0; i < h; ++i) {
            double value = 0;
            for (std::size_t k = 0; k < count; ++k)
                value += product_[k * ld_ + i] * schur(static_cast<int>(k), static_cast<int>(c));
            weighted_[c * ld_ + i] = value;
        }
    kernels_.subtract_product(h, h, count, product_.data(), ld_, weighted_.data(), ld_, 1, inverse_.data(),
                              ld_);
    // Close the gap: rows, then columns.
    for (std::size_t c = 0; c < h; ++c) {
        if (c >= first && c < first + count) continue;
        double* from = inverse_.data() + c * ld_;
        double* to = inverse_.data() + (c < first ? c : c - count) * ld_;
        std::memmove(to, from, first * sizeof(double));
        std::memmove(to + first, from + first + count, (h - first - count) * sizeof(double));
    }
    rows_.erase(rows_.begin() + static_cast<std::ptrdiff_t>(first),
                rows_.begin() + static_cast<std::ptrdiff_t>(first + count));
    member_of_[member.touch] = kNone;
    members_.erase(members_.begin() + static_cast<std::ptrdiff_t>(index));
    for (std::size_t m = index; m < members_.size(); ++m) {
        members_[m].first -= count;
        member_of_[members_[m].touch] = static_cast<std::uint32_t>(m);
    }
}

// ---- Application -----------------------------------------------------------------------------------------

bool ContactCorrection::columns_pay() const noexcept {
    if (!keeps_columns_) return false;
    const double columns = 3.0 * static_cast<double>(members_.size() * column_stride_ * sizeof(float));
    return kColumnCost * columns < 2.0 * static_cast<double>(factor_.panel_bytes());
}

/// reactions = W^-1 J P rhs.
template <class S>
void ContactCorrection::find_reactions(const S* y, const Vec* tool_rhs, Scratch& scratch) const noexcept {
    const std::size_t h = row_count();
    double* reactions = scratch.reactions_.data();
    double* gaps = reactions + ld_;
    for (const Member& member : members_) {
        const Vec node(y[3 * std::size_t{member.node}], y[3 * std::size_t{member.node} + 1],
                       y[3 * std::size_t{member.node} + 2]);
        const Vec tool = tool_inverses_[member.tool] * tool_rhs[member.tool];
        for (std::size_t k = member.first; k < member.first + member.count; ++k)
            gaps[k] = rows_[k].at_tool.dot(tool) - rows_[k].at_node.dot(node);
    }
    std::fill_n(reactions, h, 0.0);
    kernels_.subtract_product(h, 1, h, inverse_.data(), ld_, gaps, 1, h, reactions, ld_);
}

void ContactCorrection::subtract_columns(const double* reactions, float* x, Scratch& scratch) const noexcept {
    std::size_t used = 0;
    for (const Member& member : members_) {
        Vec force = Vec::Zero();
        for (std::size_t k = member.first; k < member.first + member.count; ++k)
            force += reactions[k] * rows_[k].at_node;
        for (std::size_t c = 0; c < 3; ++c) {
            scratch.columns_[used] =
                tables_[current_].data() + (3 * std::size_t{member.touch} + c) * column_stride_;
            scratch.factors_[used++] = static_cast<float>(force(static_cast<Eigen::Index>(c)));
        }
    }
    kernels_.subtract_columns(std::size_t{3} * factor_.node_count(), used, scratch.columns_.data(),
                              scratch.factors_.data(), x);
}

template <class S>
void ContactCorrection::apply_to(const S* rhs, const Vec* tool_rhs, S* x, Vec* tool_x, AlignedArray<S>& copy,
                                 Scratch& scratch) const noexcept {
    factor_.solve(rhs, x, scratch.solve_);
    for (std::size_t t = 0; t < tool_inverses_.size(); ++t)
        scratch.tools_[t] = tool_rhs[t];
    if (!members_.empty()) {
        find_reactions(x, tool_rhs, scratch);
        const double* reactions = scratch.reactions_.data();
        for (const Member& member : members_)
            for (std::size_t k = member.first; k < member.first + member.count; ++k)
                scratch.tools_[member.tool] += reactions[k] * rows_[k].at_tool;
        bool done = false;
        if constexpr (sizeof(S) == sizeof(float)) {
            done = columns_pay();
            if (done) subtract_columns(reactions, x, scratch);
        }
        if (!done) {
            std::copy_n(rhs, copy.size(), copy.data());
            for (const Member& member : members_)
                for (std::size_t k = member.first; k < member.first + member.count; ++k)
                    for (std::size_t d = 0; d < 3; ++d)
                        copy[3 * std::size_t{member.node} + d] -=
                            static_cast<S>(reactions[k] * rows_[k].at_node(static_cast<Eigen::Index>(d)));
            factor_.solve(copy.data(), x, scratch.solve_);
        }
    }
    for (std::size_t t = 0; t < tool_inverses_.size(); ++t)
        tool_x[t] = tool_inverses_[t] * scratch.tools_[t];
}

void ContactCorrection::apply(const float* rhs, const Vec* tool_rhs, float* x, Vec* tool_x,
                              Scratch& scratch) const noexcept {
    apply_to(rhs, tool_rhs, x, tool_x, scratch.single_, scratch);
}
void ContactCorrection::apply(const double* rhs, const Vec* tool_rhs, double* x, Vec* tool_x,
                              Scratch& scratch) const noexcept {
    apply_to(rhs, tool_rhs, x, tool_x, scratch.double_, scratch);
}

Mat ContactCorrection::reaction_kg(std::uint32_t tool) const noexcept {
    Mat result = Mat::Zero();
    for (const Member& a : members_)
        for (const Member& b : members_) {
            if (a.tool != tool || b.tool != tool) continue;
            for (std::size_t i = a.first; i < a.first + a.count; ++i)
                for (std::size_t j = b.first; j < b.first + b.count; ++j)
                    result += inverse_[j * ld_ + i] * rows_[i].at_tool * rows_[j].at_tool.transpose();
        }
    return result;
}

}  // namespace knead::core
