// SPDX-License-Identifier: Apache-2.0
#include "core/node_rotations.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <random>

#include "unit/runtime/block_asset.h"

namespace knead::test {
namespace {

using namespace core;

/// Roundings of the numbers in use: a mean of six and products of three.
template <class S>
constexpr double kRounding = 20 * std::numeric_limits<S>::epsilon();

/// A cube of which every tetrahedron is as stiff as it likes, bent so that rotations differ.
template <class S>
struct BentCube {
    Model model;
    Elements<S> elements;
    NodeRotations<S> rotations;

    BentCube(std::uint32_t cells, SimdTarget target)
        : model(make(cells)), elements(model, kernels(target)), rotations(model, elements, kernels(target)) {}

    void bend() {
        NodeField<S> u(model.rest_m.size()), forces(model.rest_m.size());
        for (std::size_t i = 0; i < model.rest_m.size(); ++i) {
            const Vec& x = model.rest_m[i];
            const Eigen::AngleAxisd turn(20 * x.z() + 5 * x.x(), Vec(1, 2, 3).normalized());
            u.set(i, turn * x - x);
        }
        elements.linearise(1, u, forces);
    }

    static Model make(std::uint32_t cells) {
        Asset asset = cube_asset(cells, ToolShape::plate, ToolContact::bonded);
        make_heterogeneous(asset, cells);
        return build_model(asset, {0});
    }

    /// Mean of the quaternions of the six stiffest around a node, the greatest eigenvector of sum w q q^T
    /// up to the square of how far they are apart.
    [[nodiscard]] Quat expected(std::uint32_t node) const {
        std::vector<std::pair<double, std::size_t>> around;
        for (std::size_t t = 0; t < model.elements.size(); ++t) {
            const Element& e = model.elements[t];
            if (std::find(e.nodes.begin(), e.nodes.end(), node) != e.nodes.end())
                around.emplace_back(-(2 * e.mu_volume + e.lambda_volume), t);
        }
        std::stable_sort(around.begin(), around.end(),
                         [](const auto& a, const auto& b) { return a.first < b.first; });
        around.resize(std::min<std::size_t>(around.size(), 6));
        const Eigen::Vector4d first = elements.rotation(around[0].second).coeffs();
        Eigen::Vector4d sum = Eigen::Vector4d::Zero();
        for (const auto& [weight, t] : around) {
            const Eigen::Vector4d q = elements.rotation(t).coeffs();
            sum -= weight * (q.dot(first) < 0 ? Eigen::Vector4d(-q) : q);
        }
        return Quat(Eigen::Vector4d(sum.normalized()));
    }
};

template <class S>
NodeField<S> random_field(std::size_t nodes) {
    std::mt19937_64 engine(nodes);
    NodeField<S> field(nodes);
    for (std::size_t i = 0; i < nodes; ++i) {
        Vec v;
        for (double& x : v)
            x = static_cast<double>(engine() >> 11U) * 0x1.0p-52 - 1;
        field.set(i, v);
    }
    return field;
}

template <class S>
class NodeRotationsOf : public testing::Test {
  public:
    /// Sizes that fill the last group of every kernel, and that do not.
    template <class Check>
    void for_all(const Check& check) {
        for (const SimdTarget target : {SimdTarget::portable, SimdTarget::avx2, SimdTarget::avx512}) {
            if (!has_simd_target(target)) continue;
            for (const std::uint32_t cells : {2U, 3U, 4U, 5U}) {
                SCOPED_TRACE(testing::Message() << "target " << int(target) << ", cells " << cells);
                BentCube<S> cube(cells, target);
                check(cube);
            }
        }
    }
};

using Scalars = testing::Types<float, double>;
TYPED_TEST_SUITE(NodeRotationsOf, Scalars, );

TYPED_TEST(NodeRotationsOf, matter_at_rest_are_the_identity) {
    using S = TypeParam;
    this->for_all([](BentCube<S>& cube) {
        for (std::uint32_t i = 0; i < cube.model.free_count; ++i)
            EXPECT_EQ(cube.rotations.rotation(i), Mat(Mat::Identity()));
        EXPECT_EQ(cube.rotations.mean_angle_rad(), 0);
    });
}

TYPED_TEST(NodeRotationsOf, bent_matter_are_the_means_of_the_stiffest_tetrahedra) {
    using S = TypeParam;
    this->for_all([](BentCube<S>& cube) {
        cube.bend();
        cube.rotations.update(cube.elements, 1);
        double squared = 0;
        for (std::uint32_t i = 0; i < cube.model.free_count; ++i) {
            const Quat mean = cube.expected(i);
            EXPECT_LE((cube.rotations.rotation(i) - mean.toRotationMatrix()).norm(), kRounding<S>) << i;
            squared += 4 * (1 - mean.w() * mean.w());
        }
        EXPECT_NEAR(cube.rotations.mean_angle_rad(), std::sqrt(squared / cube.model.free_count),
                    kRounding<S>);
        cube.rotations.reset();
        EXPECT_EQ(cube.rotations.rotation(0), Mat(Mat::Identity()));
    });
}

TYPED_TEST(NodeRotationsOf, bent_matter_in_shares_are_the_same_after_all_of_them) {
    using S = TypeParam;
    this->for_all([](BentCube<S>& cube) {
        cube.bend();
        constexpr std::uint32_t kShares = 5;
        for (std::uint32_t share = 0; share < kShares; ++share)
            cube.rotations.update(cube.elements, kShares);
        const double angle = cube.rotations.mean_angle_rad();
        std::vector<Mat> matrices;
        for (std::uint32_t i = 0; i < cube.model.free_count; ++i)
            matrices.push_back(cube.rotations.rotation(i));
        cube.rotations.reset();
        cube.rotations.update(cube.elements, 1);
        EXPECT_NEAR(angle, cube.rotations.mean_angle_rad(), kRounding<S>);
        for (std::uint32_t i = 0; i < cube.model.free_count; ++i)
            EXPECT_EQ(cube.rotations.rotation(i), matrices[i]);
    });
}

/// @param packed x, y, z of every free node
template <class S, class T>
void expect_turned(const BentCube<S>& cube, const NodeField<S>& v, bool back) {
    const std::size_t size = NodeRotations<S>::packed_size(cube.model.free_count);
    AlignedArray<T> packed(size);
    NodeField<S> out(cube.model.rest_m.size()), field(cube.model.rest_m.size());
    field.copy(v);
    if (back) {
        cube.rotations.turn_back(v, packed.data());
        cube.rotations.turn_back(field, field);
    } else {
        for (std::size_t i = 0; i < cube.model.free_count; ++i)
            for (int d = 0; d < 3; ++d)
                packed[3 * i + static_cast<std::size_t>(d)] = static_cast<T>(v.get(i)[d]);
        cube.rotations.turn(packed.data(), out);
        cube.rotations.turn(field, field);
    }
    const double tolerance = std::max(kRounding<S>, kRounding<T>);
    for (std::uint32_t i = 0; i < cube.model.free_count; ++i) {
        const Mat r = cube.rotations.rotation(i);
        const Vec expected = back ? Vec(r.transpose() * v.get(i)) : Vec(r * v.get(i));
        Vec found = out.get(i);
        if (back) found = Vec(packed[3 * i], packed[3 * i + 1], packed[3 * i + 2]);
        EXPECT_LE((found - expected).norm(), tolerance) << i;
        EXPECT_LE((field.get(i) - expected).norm(), kRounding<S>) << i;
        EXPECT_EQ(field.data()[4 * i + 3], 0);
        EXPECT_EQ(out.data()[4 * i + 3], 0);
    }
    // Behind the free nodes: their own, or zero.
    for (std::size_t k = 4 * cube.model.free_count; k < field.size(); ++k) {
        EXPECT_TRUE(field.data()[k] == 0 || field.data()[k] == v.data()[k]);
        EXPECT_EQ(out.data()[k], 0);
    }
}

TYPED_TEST(NodeRotationsOf, bent_matter_turn_vectors_there_and_back_in_every_form) {
    using S = TypeParam;
    this->for_all([](BentCube<S>& cube) {
        cube.bend();
        cube.rotations.update(cube.elements, 1);
        const NodeField<S> v = random_field<S>(cube.model.rest_m.size());
        for (const bool back : {false, true}) {
            expect_turned<S, float>(cube, v, back);
            expect_turned<S, double>(cube, v, back);
        }
    });
}

}  // namespace
}  // namespace knead::test
