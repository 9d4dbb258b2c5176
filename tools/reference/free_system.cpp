// SPDX-License-Identifier: GPL-3.0-or-later
#include "reference/free_system.h"

#include <Eigen/CholmodSupport>
#include <Eigen/SparseCore>
#include <algorithm>
#include <array>
#include <utility>

#include "common/metis_lock.h"

namespace knead::tools {
namespace {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;
constexpr int kNotFree = -1;
constexpr int kLowerEntries = 78;  // of a symmetric 12 x 12 matrix

/// How much of a free column is in one of a tetrahedron's twelve unknowns.
struct Share {
    int local = 0;
    int column = 0;
    double weight = 0;
    bool tied = false;
};

/// What a tetrahedron with tied nodes adds to the matrix beyond its free unknowns' own entries.
struct TiedElement {
    struct Entry {
        int local_row = 0, local_column = 0;
        int position = 0;
        double weight = 0;
    };
    std::size_t tetrahedron = 0;
    std::vector<Entry> entries;
};

}  // namespace

struct FreeSystem::Impl {
    const ElasticBody* body;
    std::vector<bool> is_prescribed;
    std::vector<int> free_index;  // [3 nodes] column in the matrix, or kNotFree
    int free_count = 0;
    SparseMatrix lower;                                    // lower triangle
    std::vector<std::array<int, kLowerEntries>> position;  // [tetrahedra] where each entry is added
    std::vector<int> diagonal_position;                    // [free]
    std::vector<TiedNode> ties;
    std::vector<const TiedNode*> tie_of;     // [nodes] or null
    std::vector<TiedElement> tied_elements;  // those with a tied node
    bool has_factor = false;
    Eigen::CholmodSupernodalLLT<SparseMatrix, Eigen::Lower> factor;

    void make_pattern();
    void make_positions();
    [[nodiscard]] int find(int row, int column) const;
    [[nodiscard]] std::array<int, 12> columns_of(std::size_t tetrahedron) const;
    [[nodiscard]] std::vector<Share> shares_of(std::size_t tetrahedron) const;
    [[nodiscard]] bool has_tie(std::size_t tetrahedron) const;
    void make_tied_elements();
};

bool FreeSystem::Impl::has_tie(std::size_t tetrahedron) const {
    const Tetrahedron& nodes = body->nodes_of(tetrahedron);
    return std::any_of(nodes.begin(), nodes.end(),
                       [&](std::uint32_t node) { return tie_of[node] != nullptr; });
}

/// Every free column that an unknown of the tetrahedron depends on, itself or through a tie.
std::vector<Share> FreeSystem::Impl::shares_of(std::size_t tetrahedron) const {
    std::vector<Share> shares;
    const Tetrahedron& nodes = body->nodes_of(tetrahedron);
    for (int a = 0; a < 4; ++a)
        for (int i = 0; i < 3; ++i) {
            const std::uint32_t node = nodes[static_cast<std::size_t>(a)];
            const auto column = [&](std::uint32_t of) {
                return free_index[3 * std::size_t{of} + static_cast<std::size_t>(i)];
            };
            if (tie_of[node] == nullptr) {
                if (column(node) != kNotFree) shares.push_back({3 * a + i, column(node), 1, false});
                continue;
            }
            for (const auto& [master, weight] : tie_of[node]->masters)
                if (column(master) != kNotFree) shares.push_back({3 * a + i, column(master), weight, true});
        }
    return shares;
}

void FreeSystem::Impl::make_tied_elements() {
    for (std::size_t t = 0; t < body->tetrahedron_count(); ++t) {
        if (!has_tie(t)) continue;
        TiedElement element{t, {}};
        const std::vector<Share> shares = shares_of(t);
        for (const Share& row : shares)
            for (const Share& column : shares)
                if ((row.tied || column.tied) && row.column >= column.column)
                    element.entries.push_back({row.local, column.local, find(row.column, column.column),
                                               row.weight * column.weight});
        tied_elements.push_back(std::move(element));
    }
}

std::array<int, 12> FreeSystem::Impl::columns_of(std::size_t tetrahedron) const {
    std::array<int, 12> columns{};
    const Tetrahedron& nodes = body->nodes_of(tetrahedron);
    for (std::size_t a = 0; a < 4; ++a)
        for (std::size_t i = 0; i < 3; ++i)
            columns[3 * a + i] = free_index[3 * std::size_t{nodes[a]} + i];
    return columns;
}

void FreeSystem::Impl::make_pattern() {
    std::vector<std::vector<int>> rows_of_column(static_cast<std::size_t>(free_count));
    for (std::size_t t = 0; t < body->tetrahedron_count(); ++t) {
        const std::array<int, 12> columns = columns_of(t);
        for (const int row : columns)
            for (const int column : columns)
                if (column != kNotFree && row >= column)
                    rows_of_column[static_cast<std::size_t>(column)].push_back(row);
        if (!has_tie(t)) continue;
        const std::vector<Share> shares = shares_of(t);
        for (const Share& row : shares)
            for (const Share& column : shares)
                if (row.column >= column.column)
                    rows_of_column[static_cast<std::size_t>(column.column)].push_back(row.column);
    }
    lower.resize(free_count, free_count);
    std::vector<int> counts(static_cast<std::size_t>(free_count));
    for (std::size_t column = 0; column < rows_of_column.size(); ++column) {
        std::vector<int>& rows = rows_of_column[column];
        std::sort(rows.begin(), rows.end());
        rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
        counts[column] = static_cast<int>(rows.size());
    }
    lower.reserve(counts);
    for (int column = 0; column < free_count; ++column)
        for (const int row : rows_of_column[static_cast<std::size_t>(column)])
            lower.insert(row, column) = 0;
    lower.makeCompressed();
}

int FreeSystem::Impl::find(int row, int column) const {
    const int* const first = lower.innerIndexPtr() + lower.outerIndexPtr()[column];
    const int* const last = lower.innerIndexPtr() + lower.outerIndexPtr()[column + 1];
    return static_cast<int>(std::lower_bound(first, last, row) - lower.innerIndexPtr());
}

void FreeSystem::Impl::make_positions() {
    position.resize(body->tetrahedron_count());
    for (std::size_t t = 0; t < position.size(); ++t) {
        const std::array<int, 12> columns = columns_of(t);
        std::size_t entry = 0;
        for (std::size_t j = 0; j < 12; ++j)
            for (std::size_t i = j; i < 12; ++i, ++entry) {
                const int low = std::min(columns[i], columns[j]);
                const int high = std::max(columns[i], columns[j]);
                position[t][entry] = low == kNotFree ? kNotFree : find(high, low);
            }
    }
    diagonal_position.resize(static_cast<std::size_t>(free_count));
    for (int k = 0; k < free_count; ++k)
        diagonal_position[static_cast<std::size_t>(k)] = find(k, k);
}

FreeSystem::FreeSystem(const ElasticBody& body, const std::vector<bool>& is_prescribed,
                       std::vector<TiedNode> ties)
    : impl_(std::make_unique<Impl>()) {
    impl_->ties = std::move(ties);
    impl_->tie_of.assign(body.node_count(), nullptr);
    for (const TiedNode& tie : impl_->ties)
        impl_->tie_of[tie.node] = &tie;
    impl_->body = &body;
    impl_->is_prescribed = is_prescribed;
    impl_->free_index.assign(is_prescribed.size(), kNotFree);
    for (std::size_t k = 0; k < is_prescribed.size(); ++k)
        if (!is_prescribed[k]) impl_->free_index[k] = impl_->free_count++;
    if (impl_->free_count == 0) return;
    impl_->make_pattern();
    impl_->make_positions();
    impl_->make_tied_elements();
    impl_->factor.cholmod().print = 0;  // an indefinite matrix is an answer here, not a message
    {
        const auto lock = lock_metis();
        impl_->factor.analyzePattern(impl_->lower);
    }
}

FreeSystem::FreeSystem(FreeSystem&&) noexcept = default;
FreeSystem& FreeSystem::operator=(FreeSystem&&) noexcept = default;
FreeSystem::~FreeSystem() = default;

bool FreeSystem::factorise(const Eigen::VectorXd& positions_m, Curvature curvature,
                           const Eigen::VectorXd& diagonal_n_per_m, const std::vector<NodeBlock>& blocks) {
    if (impl_->free_count == 0) return true;
    double* const values = impl_->lower.valuePtr();
    std::fill(values, values + impl_->lower.nonZeros(), 0.0);
    for (std::size_t t = 0; t < impl_->position.size(); ++t) {
        const Matrix12d stiffness = impl_->body->stiffness_n_per_m(t, positions_m, curvature);
        std::size_t entry = 0;
        for (int j = 0; j < 12; ++j)
            for (int i = j; i < 12; ++i, ++entry)
                if (const int where = impl_->position[t][entry]; where != kNotFree)
                    values[where] += stiffness(i, j);
    }
    for (const TiedElement& element : impl_->tied_elements) {
        const Matrix12d stiffness =
            impl_->body->stiffness_n_per_m(element.tetrahedron, positions_m, curvature);
        for (const TiedElement::Entry& entry : element.entries)
            values[entry.position] += entry.weight * stiffness(entry.local_row, entry.local_column);
    }
    if (diagonal_n_per_m.size() > 0)
        for (std::size_t k = 0; k < impl_->free_index.size(); ++k)
            if (const int column = impl_->free_index[k]; column != kNotFree)
                values[impl_->diagonal_position[static_cast<std::size_t>(column)]] +=
                    diagonal_n_per_m[static_cast<Eigen::Index>(k)];
    for (const NodeBlock& added : blocks)
        for (int j = 0; j < 3; ++j)
            for (int i = j; i < 3; ++i) {
                const auto first = static_cast<std::size_t>(first_unknown(added.node));
                const int row = impl_->free_index[first + static_cast<std::size_t>(i)];
                const int column = impl_->free_index[first + static_cast<std::size_t>(j)];
                values[impl_->find(row, column)] += added.block_n_per_m(i, j);
            }
    impl_->factor.factorize(impl_->lower);
    impl_->has_factor = impl_->factor.info() == Eigen::Success;
    return impl_->has_factor;
}

Eigen::VectorXd FreeSystem::solve(const Eigen::VectorXd& rhs) const {
    Eigen::VectorXd result = Eigen::VectorXd::Zero(rhs.size());
    if (impl_->free_count == 0) return result;
    const Eigen::VectorXd whole = reduced(rhs);
    Eigen::VectorXd compact(impl_->free_count);
    for (std::size_t k = 0; k < impl_->free_index.size(); ++k)
        if (const int column = impl_->free_index[k]; column != kNotFree)
            compact[column] = whole[static_cast<Eigen::Index>(k)];
    const Eigen::VectorXd solution = impl_->factor.solve(compact);
    for (std::size_t k = 0; k < impl_->free_index.size(); ++k)
        if (const int column = impl_->free_index[k]; column != kNotFree)
            result[static_cast<Eigen::Index>(k)] = solution[column];
    for (const TiedNode& tie : impl_->ties)
        for (const auto& [master, weight] : tie.masters)
            result.segment<3>(first_unknown(tie.node)) += weight * result.segment<3>(first_unknown(master));
    return result;
}

Eigen::VectorXd FreeSystem::reduced(const Eigen::VectorXd& gradient) const {
    Eigen::VectorXd result = gradient;
    for (const TiedNode& tie : impl_->ties)
        for (const auto& [master, weight] : tie.masters) {
            const Eigen::Vector3d share = weight * gradient.segment<3>(first_unknown(tie.node));
            result.segment<3>(first_unknown(master)) += share;
            result.segment<3>(first_unknown(tie.node)) -= share;
        }
    return result;
}

Eigen::VectorXd FreeSystem::given(const Eigen::VectorXd& positions_m) const {
    Eigen::VectorXd result = positions_m;
    for (const TiedNode& tie : impl_->ties)
        for (const auto& [master, weight] : tie.masters)
            result.segment<3>(first_unknown(tie.node)) -=
                weight * positions_m.segment<3>(first_unknown(master));
    return result;
}

void FreeSystem::put_given(const Eigen::VectorXd& target_m, Eigen::VectorXd& positions_m) const {
    for (Eigen::Index k = 0; k < positions_m.size(); ++k)
        if (impl_->is_prescribed[static_cast<std::size_t>(k)]) positions_m[k] = target_m[k];
    for (const TiedNode& tie : impl_->ties)
        for (const auto& [master, weight] : tie.masters)
            positions_m.segment<3>(first_unknown(tie.node)) +=
                weight * positions_m.segment<3>(first_unknown(master));
}

Eigen::MatrixXd FreeSystem::unit_force_responses(const std::vector<std::uint32_t>& nodes) const {
    const auto columns = 3 * static_cast<Eigen::Index>(nodes.size());
    Eigen::MatrixXd result =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(impl_->free_index.size()), columns);
    if (impl_->free_count == 0 || nodes.empty()) return result;
    Eigen::MatrixXd compact = Eigen::MatrixXd::Zero(impl_->free_count, columns);
    for (std::size_t k = 0; k < nodes.size(); ++k)
        for (std::size_t i = 0; i < 3; ++i)
            if (const int row = impl_->free_index[3 * std::size_t{nodes[k]} + i]; row != kNotFree)
                compact(row, static_cast<Eigen::Index>(3 * k + i)) = 1;
    compact = impl_->factor.solve(compact).eval();
    for (std::size_t k = 0; k < impl_->free_index.size(); ++k)
        if (const int row = impl_->free_index[k]; row != kNotFree)
            result.row(static_cast<Eigen::Index>(k)) = compact.row(row);
    return result;
}

const std::vector<bool>& FreeSystem::is_prescribed() const {
    return impl_->is_prescribed;
}
bool FreeSystem::has_factor() const {
    return impl_->has_factor;
}
const std::vector<TiedNode>& FreeSystem::ties() const {
    return impl_->ties;
}
std::size_t FreeSystem::unknown_count() const {
    return static_cast<std::size_t>(impl_->free_count);
}

}  // namespace knead::tools
