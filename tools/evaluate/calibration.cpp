// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/calibration.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "common/error.h"
#include "evaluate/loads.h"
#include "evaluate/methods.h"
#include "reference/free_system.h"
#include "reference/newton.h"

namespace knead::tools {
namespace {

Eigen::Map<const Eigen::VectorXd> vector_of(const std::vector<double>& values) {
    return {values.data(), static_cast<Eigen::Index>(values.size())};
}

/// Unknowns of the held nodes, and of further ones.
std::vector<bool> unknowns_of(const std::vector<bool>& nodes) {
    std::vector<bool> unknowns;
    for (const bool is_set : nodes)
        unknowns.insert(unknowns.end(), 3, is_set);
    return unknowns;
}

/// The part of a face of the box between shares of its two sides, `slab` deep.
SurfaceRegion pad(const Box& object, std::size_t axis, bool high, const std::array<double, 4>& shares) {
    constexpr double kSlab = 0.1;
    const Point size = object.size_m();
    SurfaceRegion region;
    region.facing[axis] = high ? 1 : -1;
    const double face = high ? object.high_m[axis] : object.low_m[axis];
    region.within.low_m[axis] = face - (high ? kSlab : 1) * size[axis];
    region.within.high_m[axis] = face + (high ? 1 : kSlab) * size[axis];
    const std::array<std::size_t, 2> across{axis == 0 ? 1U : 0U, axis == 2 ? 1U : 2U};
    for (std::size_t k = 0; k < 2; ++k) {
        region.within.low_m[across[k]] = object.low_m[across[k]] + shares[2 * k] * size[across[k]];
        region.within.high_m[across[k]] = object.low_m[across[k]] + shares[2 * k + 1] * size[across[k]];
    }
    return region;
}

void add_grid(std::vector<SurfaceRegion>& pads, const Box& object, std::size_t axis, bool high, int cells) {
    for (int i = 0; i < cells; ++i)
        for (int j = 0; j < cells; ++j)
            pads.push_back(pad(object, axis, high,
                               {static_cast<double>(i) / cells, static_cast<double>(i + 1) / cells,
                                static_cast<double>(j) / cells, static_cast<double>(j + 1) / cells}));
}

std::vector<SurfaceRegion> probe_pads(const Box& object) {
    std::vector<SurfaceRegion> pads;
    add_grid(pads, object, 2, true, 3);
    add_grid(pads, object, 2, true, 4);
    for (const std::size_t axis : {std::size_t{0}, std::size_t{1}})
        for (const bool high : {false, true})
            add_grid(pads, object, axis, high, 3);
    return pads;
}

/// One newton into the object, evenly over the region. Empty when the region is held, or none.
std::vector<double> push_of(const MeshedRegion& region, const Point& facing, const TetMesh& mesh) {
    std::vector<double> push(3 * mesh.nodes_m.size(), 0);
    for (std::size_t k = 0; k < region.nodes.size(); ++k)
        for (std::size_t axis = 0; axis < 3; ++axis)
            push[3 * std::size_t{region.nodes[k]} + axis] -=
                facing[axis] * region.areas_m2[k] / region.area_m2;
    return push;
}

/// Twice the energy of a field in each tetrahedron, many fields at once: stiffnesses are made once.
class Energies {
  public:
    explicit Energies(const ElasticBody& body) : body_(body) {
        for (std::size_t t = 0; t < body.tetrahedron_count(); ++t)
            stiffness_.push_back(
                body.stiffness_n_per_m(t, body.rest_positions_m(), Curvature::rotation_frozen));
    }
    [[nodiscard]] std::vector<double> of(const Eigen::VectorXd& displacement) const {
        std::vector<double> energies;
        energies.reserve(stiffness_.size());
        for (std::size_t t = 0; t < stiffness_.size(); ++t) {
            Eigen::Matrix<double, 12, 1> local;
            for (int a = 0; a < 4; ++a)
                local.segment<3>(3 * a) =
                    displacement.segment<3>(first_unknown(body_.nodes_of(t)[static_cast<std::size_t>(a)]));
            energies.push_back(local.dot(stiffness_[t] * local));
        }
        return energies;
    }

  private:
    const ElasticBody& body_;
    std::vector<Matrix12d> stiffness_;
};

double sum_of(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values)
        sum += value;
    return sum;
}

}  // namespace

Probes::Probes(const TetMesh& mesh, const std::vector<bool>& is_held, const Box& object)
    : mesh_(mesh), is_held_(unknowns_of(is_held)) {
    const MeshedRegion top = mesh_region(mesh, named_load("press10", object).region);
    std::vector<bool> is_tool = is_held;
    const Point pivot{(object.low_m[0] + object.high_m[0]) / 2, (object.low_m[1] + object.high_m[1]) / 2,
                      object.high_m[2]};
    for (std::size_t k = 0; k < top.nodes.size(); ++k)
        if (top.is_inside[k]) is_tool[top.nodes[k]] = true;
    is_held_or_tool_ = unknowns_of(is_tool);
    for (std::size_t axis = 0; axis < 6; ++axis) {
        std::vector<double> motion(3 * mesh.nodes_m.size(), 0);
        for (std::size_t k = 0; k < top.nodes.size(); ++k) {
            if (!top.is_inside[k] || is_held[top.nodes[k]]) continue;
            const Point& p = mesh.nodes_m[top.nodes[k]];
            const std::array<double, 3> arm{p[0] - pivot[0], p[1] - pivot[1], p[2] - pivot[2]};
            double* const u = &motion[3 * std::size_t{top.nodes[k]}];
            if (axis < 3) {
                u[axis] = 1;
            } else {  // a turn about axis - 3
                const std::size_t a = (axis - 2) % 3;
                const std::size_t b = (axis - 1) % 3;
                u[a] = -arm[b];
                u[b] = arm[a];
            }
        }
        motions_.push_back(std::move(motion));
    }
    for (const SurfaceRegion& region : probe_pads(object)) {
        const MeshedRegion meshed = mesh_region(mesh, region);
        if (meshed.nodes.empty())
            fail_result("calibration: the object has no surface where a probe should push");
        pushes_.push_back(push_of(meshed, region.facing, mesh));
    }
}

Probes::Answers Probes::ask(const Material& material, bool with_shares) const {
    const ElasticBody body(mesh_, material);
    const Energies energies(body);
    Answers answers;
    const auto add = [&](const Eigen::VectorXd& field, double sign) {
        std::vector<double> parts = energies.of(field);
        const double whole = sum_of(parts);
        answers.values_j.push_back(whole);
        if (!with_shares) return;
        for (double& part : parts)
            part *= sign / whole;
        answers.shares.push_back(std::move(parts));
    };
    const auto factor = [&](FreeSystem& system) {
        if (!system.factorise(body.rest_positions_m(), Curvature::rotation_frozen, {}))
            fail_result("calibration: the object is not held");
    };
    FreeSystem under_tool(body, is_held_or_tool_);
    factor(under_tool);
    for (const std::vector<double>& motion : motions_) {
        const Eigen::VectorXd given = vector_of(motion);
        const Eigen::VectorXd force =
            stiffness_times(body, body.rest_positions_m(), Curvature::rotation_frozen, given);
        add(given + under_tool.solve(-force), 1);
    }
    FreeSystem held(body, is_held_);
    factor(held);
    for (const std::vector<double>& push : pushes_)
        add(held.solve(vector_of(push)), -1);
    return answers;
}

Calibration calibrate(const MaterialObject& fine, const std::vector<bool>& fine_is_held,
                      const LevelMesh& level, const std::vector<bool>& level_is_held,
                      const CalibrationOptions& options) {
    Calibration result;
    result.material = mean_material(MethodKind::voigt, fine, level);
    if (level.is_fine) return result;
    const Box object = bounding_box(fine.mesh.nodes_m);
    const std::vector<double> wanted =
        Probes(fine.mesh, fine_is_held, object).ask(fine.material, false).values_j;
    const Probes probes(level.mesh, level_is_held, object);
    const auto [softest, stiffest] =
        std::minmax_element(fine.material.youngs_modulus_pa.begin(), fine.material.youngs_modulus_pa.end());
    const double low = options.lowest * *softest;
    const double high = options.highest * *stiffest;
    const auto count = static_cast<Eigen::Index>(probes.count());
    const auto elements = static_cast<Eigen::Index>(level.mesh.tetrahedra.size());
    for (int iteration = 0;; ++iteration) {
        const bool last = iteration == options.iterations;
        const Probes::Answers answers = probes.ask(result.material, !last);
        Eigen::VectorXd missing(count);
        for (Eigen::Index k = 0; k < count; ++k)
            missing[k] =
                std::log(wanted[static_cast<std::size_t>(k)] / answers.values_j[static_cast<std::size_t>(k)]);
        if (iteration == 0) result.worst_before = missing.cwiseAbs().maxCoeff();
        result.worst_after = missing.cwiseAbs().maxCoeff();
        result.root_mean_square_after = std::sqrt(missing.squaredNorm() / static_cast<double>(count));
        if (last) return result;
        Eigen::MatrixXd shares(count, elements);
        for (Eigen::Index k = 0; k < count; ++k)
            shares.row(k) = vector_of(answers.shares[static_cast<std::size_t>(k)]);
        Eigen::MatrixXd normal = shares * shares.transpose();
        normal.diagonal().array() += options.regularisation * normal.trace() / static_cast<double>(count);
        const Eigen::VectorXd change = shares.transpose() * normal.ldlt().solve(missing);
        for (Eigen::Index e = 0; e < elements; ++e) {
            double& modulus = result.material.youngs_modulus_pa[static_cast<std::size_t>(e)];
            modulus = std::clamp(modulus * std::exp(std::clamp(change[e], -1.0, 1.0)), low, high);
        }
    }
}

bool is_probed(const std::string& load) {
    static const std::array<const char*, 5> kProbed{"press10", "press20", "shear", "twist", "combined"};
    return std::any_of(kProbed.begin(), kProbed.end(), [&](const char* name) { return load == name; });
}

}  // namespace knead::tools
