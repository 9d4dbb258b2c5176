// SPDX-License-Identifier: GPL-3.0-or-later
#include "evaluate/calibration.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>

#include "bake/surface.h"
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

struct PadSize {
    int width = 0, height = 0;  // tenths of the face
};
constexpr PadSize kPadSizes[] = {{2, 3}, {3, 2}};
constexpr int kTenths = 10;
constexpr int kEvery = 2;  // of all columns one in so many, in turns for the two sizes

void add_pads(std::vector<Load>& pads, const Box& object, std::size_t axis, bool high) {
    int offset = 0;
    for (const PadSize& size : kPadSizes) {
        for (int i = 0; i + size.width <= kTenths; ++i)
            for (int j = 0; j + size.height <= kTenths; ++j) {
                if (i % kEvery != offset) continue;
                Load load;
                load.name = "probe";
                load.region = pad(object, axis, high,
                                  {i / 10.0, (i + size.width) / 10.0, j / 10.0, (j + size.height) / 10.0});
                load.motion.translation_m[axis] = high ? -1 : 1;
                load.felt_translation = load.motion.translation_m;
                pads.push_back(load);
            }
        ++offset;
    }
}

/// Which of five faces a pad is on.
std::size_t face_of(const Load& pad) {
    for (std::size_t axis = 0; axis < 3; ++axis)
        if (pad.region.facing[axis] != 0) return 2 * axis + (pad.region.facing[axis] > 0 ? 1 : 0);
    return 0;
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

/// What unit forces at the nodes of a face do to the whole body; from it, what a pad bonded on average does:
/// constraints rows * u = motion, so u = S rows^T (rows S rows^T)^-1 motion with S the responses.
class FaceResponses {
  public:
    FaceResponses(const FreeSystem& held, const std::vector<std::uint32_t>& nodes)
        : nodes_(nodes), responses_(held.unit_force_responses(nodes)) {}

    template <class Row>
    [[nodiscard]] Eigen::VectorXd field_under(const std::vector<Row>& rows) const {
        const auto count = static_cast<Eigen::Index>(3 * rows.size());
        Eigen::MatrixXd moved = Eigen::MatrixXd::Zero(responses_.rows(), count);  // S rows^T
        for (std::size_t r = 0; r < rows.size(); ++r)
            for (const auto& [node, weight] : rows[r].nodes)
                moved.middleCols<3>(static_cast<Eigen::Index>(3 * r)) +=
                    weight * responses_.middleCols<3>(column_of(node));
        Eigen::MatrixXd compliance = Eigen::MatrixXd::Zero(count, count);
        Eigen::VectorXd motion(count);
        for (std::size_t r = 0; r < rows.size(); ++r) {
            const auto at = static_cast<Eigen::Index>(3 * r);
            for (const auto& [node, weight] : rows[r].nodes)
                compliance.middleRows<3>(at) += weight * moved.middleRows<3>(first_unknown(node));
            for (Eigen::Index axis = 0; axis < 3; ++axis)
                motion[at + axis] = rows[r].motion_m[static_cast<std::size_t>(axis)];
        }
        return moved * compliance.ldlt().solve(motion);
    }

  private:
    [[nodiscard]] Eigen::Index column_of(std::uint32_t node) const {
        return 3 * (std::lower_bound(nodes_.begin(), nodes_.end(), node) - nodes_.begin());
    }
    const std::vector<std::uint32_t>& nodes_;
    Eigen::MatrixXd responses_;
};

double sum_of(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values)
        sum += value;
    return sum;
}

}  // namespace

Probes::Probes(const TetMesh& mesh, const std::vector<bool>& is_held, const Box& object,
               const std::vector<Load>& pads)
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
    faces_.resize(6);
    const std::vector<Triangle> outer = boundary_triangles(mesh.tetrahedra);
    for (const Load& load : pads) {
        const AppliedLoad applied = apply_load(load, mesh_region(mesh, outer, load.region), mesh, is_held);
        Pad pad{face_of(load), {}};
        const PrescribedMotion& motion = applied.motion;
        for (std::size_t k = applied.held_count; k < motion.nodes.size(); ++k)
            pad.rows.push_back({{{motion.nodes[k], 1.0}}, motion.displacement_m[k]});
        for (const TiedNode& tie : motion.ties) {
            Row row{{{tie.node, 1.0}}, tie.displacement_m};
            for (const auto& [master, weight] : tie.masters)
                if (!is_held[master]) row.nodes.emplace_back(master, -weight);
            pad.rows.push_back(std::move(row));
        }
        for (const Row& row : pad.rows)
            for (const auto& [node, weight] : row.nodes)
                faces_[pad.face].push_back(node);
        pads_.push_back(std::move(pad));
    }
    for (std::vector<std::uint32_t>& face : faces_) {
        std::sort(face.begin(), face.end());
        face.erase(std::unique(face.begin(), face.end()), face.end());
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
    for (std::size_t face = 0; face < faces_.size(); ++face) {
        if (faces_[face].empty()) continue;
        const FaceResponses responses(held, faces_[face]);
        for (const Pad& pad : pads_)
            if (pad.face == face) add(responses.field_under(pad.rows), 1);
    }
    return answers;
}

std::vector<Load> probe_pads(const Box& object) {
    std::vector<Load> pads;
    // In the order of the faces.
    add_pads(pads, object, 0, false);
    add_pads(pads, object, 0, true);
    add_pads(pads, object, 1, false);
    add_pads(pads, object, 1, true);
    add_pads(pads, object, 2, true);
    return pads;
}

std::vector<bool> askable_pads(const std::vector<Load>& pads, const TetMesh& mesh,
                               const std::vector<bool>& is_held) {
    std::vector<bool> askable;
    const std::vector<Triangle> outer = boundary_triangles(mesh.tetrahedra);
    for (const Load& pad : pads) {
        const MeshedRegion region = mesh_region(mesh, outer, pad.region);
        askable.push_back(!region.nodes.empty() &&
                          std::none_of(region.nodes.begin(), region.nodes.end(),
                                       [&](std::uint32_t node) { return is_held[node]; }));
    }
    return askable;
}

namespace {

std::vector<Load> common_pads(const Box& object, const TetMesh& fine, const std::vector<bool>& fine_is_held,
                              const TetMesh& level, const std::vector<bool>& level_is_held) {
    std::vector<Load> pads;
    const std::vector<Load> all = probe_pads(object);
    const std::vector<bool> on_fine = askable_pads(all, fine, fine_is_held);
    const std::vector<bool> on_level = askable_pads(all, level, level_is_held);
    for (std::size_t k = 0; k < all.size(); ++k)
        if (on_fine[k] && on_level[k]) pads.push_back(all[k]);
    return pads;
}

}  // namespace

Calibration calibrate(const MaterialObject& fine, const std::vector<bool>& fine_is_held,
                      const LevelMesh& level, const std::vector<bool>& level_is_held,
                      const CalibrationOptions& options) {
    Calibration result;
    result.material = mean_material(MethodKind::voigt, fine, level);
    if (level.is_fine) return result;
    const Box object = bounding_box(fine.mesh.nodes_m);
    const std::vector<Load> pads = common_pads(object, fine.mesh, fine_is_held, level.mesh, level_is_held);
    const std::vector<double> wanted =
        Probes(fine.mesh, fine_is_held, object, pads).ask(fine.material, false).values_j;
    const Probes probes(level.mesh, level_is_held, object, pads);
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
        // The six motions of the whole top weigh as much as all pads together.
        const double weight = std::sqrt(static_cast<double>(count - 6) / 6);
        shares.topRows(6) *= weight;
        missing.head(6) *= weight;
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
