// SPDX-License-Identifier: Apache-2.0
#include "core/solver.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "unit/runtime/block_asset.h"

namespace knead::test {
namespace {

using namespace core;

constexpr double kDt_s = 10e-3;
/// Steps of this dt in which the preconditioner has turned all nodes, whatever the contrast.
constexpr int kRotationShares = 4;
constexpr double kForceTolerance = 1e-3;
constexpr double kVelocityTolerance_m_per_s = 1e-4;
/// Dense solves and sums in double of systems whose condition number is up to 1e9.
constexpr double kRounding = 1e-6;

struct Matter {
    double contrast = 1e6;
    double poissons_ratio = 0.49;
    double twist_rad = 0.6;  ///< of the top against the bottom
    bool followed = true;    ///< by the preconditioner; else it is that of the rest state
};

/// The cube on its table under a bonded plate, every eighth tetrahedron stiff, twisted and squeezed: a system
/// as a step sets it up, with the same matrix assembled densely as the oracle.
class TwistedCube {
  public:
    explicit TwistedCube(const Matter& matter, SimdTarget target = best_simd_target())
        : asset_(make(matter)),
          model(build_model(asset_, {0})),
          elements(model, kernels(target)),
          masses(model),
          tools(1),
          system{model, elements, masses, kernels(target).field<double>(), none_, tools, kDt_s, 1},
          preconditioner(model, elements, numerics(matter), target, kDt_s, {}) {
        NodeField<double> u(model.rest_m.size()), forces(model.rest_m.size());
        for (std::size_t i = 0; i < model.rest_m.size(); ++i)
            u.set(i, displaced(model.rest_m[i], matter.twist_rad) - model.rest_m[i]);
        elements.linearise(1, u, forces);
        for (int share = 0; matter.followed && share < kRotationShares; ++share)
            preconditioner.begin_step(system);
        preconditioner.hold(system);
        assemble();
    }

    [[nodiscard]] Eigen::Index size() const { return 3 * static_cast<Eigen::Index>(model.free_count); }

    /// What the free nodes feel of a motion of the plate, kg m.
    [[nodiscard]] NodeField<double> load_of(const Vec& plate_m) const {
        Eigen::VectorXd moved = Eigen::VectorXd::Zero(a_.rows());
        for (std::uint32_t i = model.bonded[0].begin; i < model.bonded[0].end; ++i)
            moved.segment<3>(3 * i) = plate_m;
        const Eigen::VectorXd rows = -a_ * moved;
        NodeField<double> load(model.rest_m.size());
        for (std::uint32_t i = 0; i < model.moving_count; ++i)
            load.set(i, rows.segment<3>(3 * i));
        return load;
    }

    [[nodiscard]] Eigen::VectorXd free_part(const NodeField<double>& field) const {
        Eigen::VectorXd v(size());
        for (std::uint32_t i = 0; i < model.free_count; ++i)
            v.segment<3>(3 * i) = field.get(i);
        return v;
    }
    [[nodiscard]] Eigen::VectorXd exact(const NodeField<double>& load) const {
        return factor_.solve(free_part(load));
    }
    /// Of the object on the plate, if the free nodes are displaced by d.
    [[nodiscard]] Vec force_n(const NodeField<double>& load, const Eigen::VectorXd& d) const {
        Vec sum = Vec::Zero();
        for (std::uint32_t i = model.bonded[0].begin; i < model.bonded[0].end; ++i)
            sum += load.get(i) - a_.block(3 * i, 0, 3, size()) * d;
        return sum / (kDt_s * kDt_s);
    }
    [[nodiscard]] double energy(const Eigen::VectorXd& e) const {
        return e.dot(a_.topLeftCorner(size(), size()) * e);
    }
    [[nodiscard]] double velocity_error_m_per_s(const Eigen::VectorXd& e) const {
        double sum = 0;
        for (std::uint32_t i = 0; i < model.free_count; ++i)
            sum += model.mass_kg[i] * e.segment<3>(3 * i).squaredNorm();
        return std::sqrt(sum / model.free_mass_kg) / kDt_s;
    }
    /// r^T P r of what d leaves of the load.
    [[nodiscard]] double rz(const NodeField<double>& load, const Eigen::VectorXd& d) const {
        Unknowns<double> residual{NodeField<double>(model.rest_m.size()), {Vec::Zero()}};
        Unknowns<double> z{NodeField<double>(model.rest_m.size()), {Vec::Zero()}};
        const Eigen::VectorXd r = free_part(load) - a_.topLeftCorner(size(), size()) * d;
        for (std::uint32_t i = 0; i < model.free_count; ++i)
            residual.nodes.set(i, r.segment<3>(3 * i));
        preconditioner.apply(system, residual, z);
        return r.dot(free_part(z.nodes));
    }

    [[nodiscard]] Solution<double> from_zero() const {
        Solution<double> solution;
        solution.displacement = {NodeField<double>(model.rest_m.size()), {Vec::Zero()}};
        solution.from_zero = true;
        solution.force_n.assign(1, Vec::Zero());
        return solution;
    }
    [[nodiscard]] Solution<double> solve(Solver<double>& solver, const NodeField<double>& load,
                                         SolverLimits limits) const {
        Solution<double> solution = from_zero();
        solver.solve(system, preconditioner, load, limits, solution);
        return solution;
    }

  private:
    const Asset asset_;
    const std::vector<Constraint> none_;

  public:
    const Model model;
    Elements<double> elements;
    const Masses<double> masses;
    const std::vector<ToolUnknown> tools;
    const System<double> system;
    core::Preconditioner<double> preconditioner;

  private:
    static Asset make(const Matter& matter) {
        Asset asset = cube_asset(4, ToolShape::plate, ToolContact::bonded);
        asset.palette = {{10e3, matter.poissons_ratio, 1000},
                         {matter.contrast * 10e3, matter.poissons_ratio, 1000}};
        for (std::size_t t = 0; t < asset.palette_index.size(); t += 8)
            asset.palette_index[t] = 1;
        return asset;
    }
    static Numerics numerics(const Matter& matter) {
        Numerics result;
        result.arithmetic = Precision::float64;
        result.factor_storage = knead::FactorStorage::float32;
        result.contrast = matter.contrast;
        result.max_poissons_ratio = matter.poissons_ratio;
        return result;
    }
    static Vec displaced(const Vec& rest, double twist_rad) {
        const Vec middle(0.05, 0.05, 0);
        const Eigen::AngleAxisd turn(twist_rad * rest.z() / 0.1, Vec::UnitZ());
        return turn * Vec((rest - middle).cwiseProduct(Vec(1, 1, 0.9))) + middle;
    }

    void assemble() {
        const auto rows = 3 * static_cast<Eigen::Index>(model.rest_m.size());
        a_ = Eigen::MatrixXd::Zero(rows, rows);
        for (std::size_t t = 0; t < model.elements.size(); ++t) {
            const Element& element = model.elements[t];
            Eigen::Matrix<double, 4, 3> g;
            g.bottomRows<3>() = element.rest_inverse * elements.rotation(t).toRotationMatrix().transpose();
            g.row(0) = -g.bottomRows<3>().colwise().sum();
            for (int i = 0; i < 4; ++i)
                for (int j = 0; j < 4; ++j)
                    a_.block<3, 3>(3 * element.nodes[static_cast<std::size_t>(i)],
                                   3 * element.nodes[static_cast<std::size_t>(j)]) +=
                        kDt_s * kDt_s *
                        (element.mu_volume *
                             (g.row(i).dot(g.row(j)) * Mat::Identity() + g.row(j).transpose() * g.row(i)) +
                         element.lambda_volume * g.row(i).transpose() * g.row(j));
        }
        for (std::uint32_t i = 0; i < model.free_count; ++i)
            a_.diagonal().segment<3>(3 * i).array() += model.mass_kg[i];
        factor_.compute(a_.topLeftCorner(size(), size()));
    }

    Eigen::MatrixXd a_;
    Eigen::LDLT<Eigen::MatrixXd> factor_;
};

SolverLimits limits_of(Belief belief) {
    return {500, kForceTolerance, kVelocityTolerance_m_per_s, belief};
}

/// Turned as a step would have it, and turned less than the matter: where r.z is far too small.
const Matter kMatters[] = {{1e2, 0.49, 0.3, true},  {1e2, 0.49, 0.6, true}, {1e2, 0.49, 1.2, true},
                           {1e6, 0.49, 0.3, true},  {1e6, 0.49, 0.6, true}, {1e6, 0.49, 1.2, true},
                           {1e6, 0.3, 0.05, false}, {1e6, 0.3, 0.1, false}, {1e2, 0.49, 0.6, false}};
const Vec kMotions_m[] = {{0, 0, -1e-4}, {2e-4, 0, 0}, {-1e-4, 1e-4, 1e-4}, {0, 0, -2e-3}};

/// Solves for every motion and checks the promise. @return by how much r.z was too small on the way
double largest_underestimate_in(const Matter& matter, SimdTarget target) {
    double largest = 0;
    TwistedCube cube(matter, target);
    for (const Vec& motion : kMotions_m) {
        const NodeField<double> load = cube.load_of(motion);
        const Eigen::VectorXd exact = cube.exact(load);
        const Vec force = cube.force_n(load, exact);
        Solver<double> solver(cube.model, 1, 0);
        const auto solution = cube.solve(solver, load, limits_of(Belief::after_watching));
        const Eigen::VectorXd d = cube.free_part(solution.displacement.nodes);
        EXPECT_TRUE(solution.converged);
        EXPECT_LE((solution.force_n[0] - cube.force_n(load, d)).norm(), kRounding * force.norm());
        EXPECT_LE((solution.force_n[0] - force).norm(), kForceTolerance * force.norm());
        EXPECT_LE(cube.velocity_error_m_per_s(d - exact), kVelocityTolerance_m_per_s);
        for (int k = 1; k < solution.iterations; ++k) {
            Solver<double> shorter(cube.model, 1, 0);
            SolverLimits limits = limits_of(Belief::after_watching);
            limits.max_iterations = k;
            const auto part = cube.solve(shorter, load, limits);
            const Eigen::VectorXd now = cube.free_part(part.displacement.nodes);
            largest = std::max(largest, cube.energy(now - exact) / cube.rz(load, now));
        }
    }
    return largest;
}

/// By the arithmetic of each instruction set: their rounding differs, and the promise shall not hang on it.
TEST(Solver, that_watches_keeps_its_promise_where_the_preconditioned_residual_is_too_small) {
    double largest_underestimate = 0;
    for (const SimdTarget target : {SimdTarget::portable, SimdTarget::avx2, SimdTarget::avx512}) {
        if (!has_simd_target(target)) continue;
        for (const Matter& matter : kMatters) {
            SCOPED_TRACE(testing::Message() << "instruction set " << static_cast<int>(target) << ", twist "
                                            << matter.twist_rad << ", contrast " << matter.contrast);
            largest_underestimate = std::max(largest_underestimate, largest_underestimate_in(matter, target));
        }
    }
    EXPECT_GT(largest_underestimate, 4) << "or the cases show nothing";
}

TEST(Solver, starts_at_the_best_point_in_the_span_of_the_last_two_solutions) {
    TwistedCube cube({1e6, 0.49, 0.6});
    Solver<double> solver(cube.model, 1, 0);
    std::vector<Eigen::VectorXd> last;
    for (const Vec& motion : {Vec(0, 0, -1e-4), Vec(1e-4, 0, -1e-4)}) {
        const auto solution = cube.solve(solver, cube.load_of(motion), limits_of(Belief::after_watching));
        ASSERT_GE(solution.iterations, 3) << "or it is not a hard step";
        last.push_back(cube.free_part(solution.displacement.nodes));
    }
    const NodeField<double> load = cube.load_of({1e-4, 1e-4, -3e-4});
    const Eigen::VectorXd exact = cube.exact(load);
    SolverLimits none = limits_of(Belief::after_watching);
    none.max_iterations = 0;
    const Eigen::VectorXd start = cube.free_part(cube.solve(solver, load, none).displacement.nodes);
    // The least energy over the span, by the normal equations of the dense matrix.
    const Eigen::VectorXd b = cube.free_part(load);
    Eigen::Matrix2d gram;
    Eigen::Vector2d along;
    for (int i = 0; i < 2; ++i) {
        const Eigen::VectorXd& d = last[static_cast<std::size_t>(i)];
        along(i) = d.dot(b);
        gram(i, i) = cube.energy(d);
        gram(0, 1) = gram(1, 0) = (cube.energy(last[0] + last[1]) - cube.energy(last[0] - last[1])) / 4;
    }
    const Eigen::Vector2d weights = gram.ldlt().solve(along);
    const Eigen::VectorXd best = weights(0) * last[0] + weights(1) * last[1];
    EXPECT_NEAR(cube.energy(start - exact), cube.energy(best - exact), kRounding * cube.energy(exact));
    EXPECT_LT(cube.energy(start - exact), 0.5 * cube.energy(exact)) << "or the case shows nothing";
}

TEST(Solver, that_starts_from_the_last_solutions_is_never_farther_away_than_from_zero) {
    TwistedCube cube({1e6, 0.49, 1.2});
    SolverLimits none = limits_of(Belief::after_watching);
    none.max_iterations = 0;
    for (const double scale : {1.0, -1.0, 1e-3, 1e3})
        for (const Vec& next : kMotions_m) {
            Solver<double> solver(cube.model, 1, 0);
            for (const Vec& motion : kMotions_m)
                (void)cube.solve(solver, cube.load_of(motion), limits_of(Belief::after_watching));
            const NodeField<double> load = cube.load_of(scale * next);
            const Eigen::VectorXd exact = cube.exact(load);
            const auto start = cube.solve(solver, load, none);
            const Eigen::VectorXd d = cube.free_part(start.displacement.nodes);
            EXPECT_GT(d.norm(), 0) << "or it did not start there";
            EXPECT_LE(cube.energy(d - exact), (1 + kRounding) * cube.energy(exact));
            // What the residual and the force say belongs to where it starts.
            EXPECT_LE((start.force_n[0] - cube.force_n(load, d)).norm(),
                      kRounding * cube.force_n(load, exact).norm());
        }
}

TEST(Solver, after_reset_starts_from_zero) {
    TwistedCube cube({1e6, 0.49, 0.6});
    Solver<double> solver(cube.model, 1, 0);
    const NodeField<double> load = cube.load_of(kMotions_m[0]);
    (void)cube.solve(solver, load, limits_of(Belief::after_watching));
    solver.reset();
    SolverLimits none = limits_of(Belief::after_watching);
    none.max_iterations = 0;
    EXPECT_TRUE(cube.free_part(cube.solve(solver, load, none).displacement.nodes).isZero(0));
}

}  // namespace
}  // namespace knead::test
