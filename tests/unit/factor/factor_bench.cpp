// SPDX-License-Identifier: Apache-2.0
// Figures of SupernodalFactor on the cubes of the design; run by hand, not a test.
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>

#include "bake/node_order.h"
#include "core/factor/contact_correction.h"
#include "support/kuhn_cube.h"

namespace {

using namespace knead;
using namespace knead::core;
using Clock = std::chrono::steady_clock;

double since_us(Clock::time_point start) {
    return std::chrono::duration<double, std::micro>(Clock::now() - start).count();
}

/// A cube whose bottom and top are held, the free nodes first, in METIS order.
Asset cube_asset(std::uint32_t n, double contrast, double nu) {
    const TetMesh mesh = test::kuhn_cube(n);
    std::vector<bool> free(mesh.nodes_m.size());
    for (std::size_t i = 0; i < free.size(); ++i) {
        const double z = mesh.nodes_m[i][2];
        free[i] = z > 1e-9 && z < 0.1 - 1e-9;
    }
    std::vector<std::uint32_t> order = tools::nested_dissection_order(mesh.tetrahedra, free);
    Asset asset;
    asset.free_node_count = static_cast<std::uint32_t>(order.size());
    for (std::uint32_t i = 0; i < free.size(); ++i)
        if (!free[i]) order.push_back(i);
    std::vector<std::uint32_t> place(order.size());
    for (std::uint32_t p = 0; p < order.size(); ++p) {
        place[order[p]] = p;
        asset.nodes_m.push_back(mesh.nodes_m[order[p]]);
    }
    std::mt19937_64 engine(5);
    for (int k = 0; k < 2; ++k) {
        PaletteEntry entry;
        entry.youngs_modulus_pa = k == 0 ? 1e4 : 1e4 * contrast;
        entry.poissons_ratio = nu;
        entry.density_kg_per_m3 = 1000;
        asset.palette.push_back(entry);
    }
    for (const Tetrahedron& t : mesh.tetrahedra) {
        asset.tetrahedra.push_back({place[t[0]], place[t[1]], place[t[2]], place[t[3]]});
        asset.palette_index.push_back(engine() % 2);
    }
    return asset;
}

template <class Run>
void time_it(const char* what, int repeats, const Run& run) {
    std::vector<double> times;
    for (int k = 0; k < repeats; ++k) {
        const auto start = Clock::now();
        run();
        times.push_back(since_us(start));
    }
    std::sort(times.begin(), times.end());
    std::printf("    %-22s p50 %9.2f us   min %9.2f us\n", what, times[times.size() / 2], times[0]);
}

void measure(const Model& model, RestMatrix::Kind kind, FactorStorage storage, SimdTarget target, double dt) {
    const auto start = Clock::now();
    RestMatrix matrix(model, kind);
    matrix.set(dt, 1);
    const double assembled = since_us(start);
    SupernodalFactor factor(matrix.pattern(), matrix.block_size(), storage, target);
    const double analysed = since_us(start);
    if (!factor.factorise(matrix.values())) {
        std::printf("  refused\n");
        return;
    }
    const double done = since_us(start);
    std::size_t rows = 0;
    for (const auto& s : factor.symbolic().supernodes)
        rows += s.row_count;
    static const char* const kStorage[] = {"single", "fixed", "double"};
    static const char* const kTarget[] = {"portable", "avx2", "avx512"};
    std::printf(
        "  %s %s %s: load %.2f ms (assembly %.2f, analysis %.2f, numbers %.2f), panels %.0f kB, "
        "%zu supernodes, %zu rows, all %.1f MB\n",
        kind == RestMatrix::Kind::elastic ? "elastic" : "laplacian", kStorage[static_cast<int>(storage)],
        kTarget[static_cast<int>(target)], done / 1e3, assembled / 1e3, (analysed - assembled) / 1e3,
        (done - analysed) / 1e3, static_cast<double>(factor.panel_bytes()) / 1e3,
        factor.symbolic().supernodes.size(), rows, static_cast<double>(factor.bytes()) / 1e6);
    SupernodalFactor::Scratch scratch(factor);
    std::vector<float> rhs(9 * model.free_count, 1e-3F), x(rhs.size());
    std::vector<float> other(1 << 18, 1.0F);  // 1 MB: what else a step reads
    volatile float sink = 0;
    const int repeats = model.free_count > 3000 ? 200 : 4000;
    if (storage == FactorStorage::double_precision) return;
    time_it("solve", repeats, [&] { factor.solve(rhs.data(), x.data(), scratch); });
    {
        std::vector<double> times;
        for (int k = 0; k < repeats / 4; ++k) {
            float sum = 0;
            for (std::size_t i = 0; i < other.size(); i += 4)
                sum += other[i];
            sink = sink + sum;
            const auto begin = Clock::now();
            factor.solve(rhs.data(), x.data(), scratch);
            times.push_back(since_us(begin));
        }
        std::sort(times.begin(), times.end());
        std::printf("    %-22s p50 %9.2f us\n", "solve, 1 MB between", times[times.size() / 2]);
    }
    if (kind == RestMatrix::Kind::elastic)
        time_it("solve_three", repeats / 4, [&] { factor.solve_three(rhs.data(), x.data(), scratch); });
}

// ---- Contact ---------------------------------------------------------------------------------------------

using Vector = std::vector<double>;

double dot(const Vector& a, const Vector& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i)
        sum += a[i] * b[i];
    return sum;
}

Vector times(const RestMatrix& matrix, const Vector& x) {
    Vector y(x.size(), 0.0);
    const MatrixPattern& pattern = matrix.pattern();
    for (std::uint32_t j = 0; j < pattern.node_count; ++j)
        for (std::uint32_t k = pattern.column_begin[j]; k < pattern.column_begin[j + 1]; ++k) {
            const std::uint32_t i = pattern.row_nodes[k];
            const double* block = matrix.values() + std::size_t{9} * k;
            for (int c = 0; c < 3; ++c)
                for (int r = 0; r < 3; ++r) {
                    y[3 * i + r] += block[3 * c + r] * x[3 * j + c];
                    if (i != j) y[3 * j + c] += block[3 * c + r] * x[3 * i + r];
                }
        }
    return y;
}

/// Iterations of conjugate gradients to 1e-4 in the norm of the preconditioner, sticking nodes projected.
template <class Apply>
int iterations(const RestMatrix& matrix, const std::vector<std::uint32_t>& held, const Apply& apply) {
    const auto project = [&](Vector& v) {
        for (const std::uint32_t node : held)
            for (int d = 0; d < 3; ++d)
                v[3 * node + d] = 0;
    };
    Vector x(std::size_t{3} * matrix.pattern().node_count, 0.0), r(x.size());
    std::mt19937_64 engine(3);
    for (double& v : r)
        v = static_cast<double>(engine() >> 11U) * 0x1.0p-53 - 0.5;
    project(r);
    Vector z = apply(r);
    project(z);
    Vector p = z;
    double rz = dot(r, z);
    const double enough = 1e-8 * rz;
    int count = 0;
    for (; count < 500 && rz > enough; ++count) {
        Vector ap = times(matrix, p);
        project(ap);
        const double alpha = rz / dot(p, ap);
        for (std::size_t i = 0; i < x.size(); ++i) {
            x[i] += alpha * p[i];
            r[i] -= alpha * ap[i];
        }
        z = apply(r);
        project(z);
        const double next = dot(r, z);
        for (std::size_t i = 0; i < x.size(); ++i)
            p[i] = z[i] + next / rz * p[i];
        rz = next;
    }
    return count;
}

/// All elements turned, neighbours alike: the true matrix differs from the factor's.
std::vector<Mat> turned(const Model& model, double angle) {
    std::vector<Mat> rotations;
    for (const Element& element : model.elements) {
        const Vec x = model.rest_m[element.nodes[0]] / 0.1;
        const Vec axis = Vec(1, std::sin(3 * x[0]), std::cos(2 * x[2])).normalized();
        rotations.push_back(
            Eigen::AngleAxis<Real>(angle * std::sin(4 * x[1] + x[2]), axis).toRotationMatrix());
    }
    return rotations;
}

void measure_contact(std::uint32_t n, FactorStorage storage, double contrast, double nu, double dt) {
    const Model model = build_model(cube_asset(n, contrast, nu), {});
    std::vector<std::uint32_t> face;
    for (std::uint32_t i = 0; i < model.free_count; ++i)
        if (model.rest_m[i][0] < 1e-9) face.push_back(i);
    RestMatrix matrix(model, RestMatrix::Kind::elastic);
    matrix.set(dt, 1);
    SupernodalFactor factor(matrix.pattern(), 3, storage);
    if (!factor.factorise(matrix.values())) {
        std::printf("  refused\n");
        return;
    }
    ContactCorrection correction(factor, face, 1);
    auto start = Clock::now();
    correction.build();
    std::printf("n %u, contrast %g, nu %g, dt %g ms, %s: %zu touchable, table %.1f MB in %.1f ms\n", n,
                contrast, nu, dt * 1e3, storage == FactorStorage::single_precision ? "single" : "fixed",
                face.size(), static_cast<double>(correction.bytes()) / 1e6, since_us(start) / 1e3);
    ContactCorrection second(factor, face, 1, 0);
    second.build();
    ContactCorrection::Scratch scratch(correction), second_scratch(second);
    RestMatrix rotated(model, RestMatrix::Kind::elastic);
    rotated.rotate(model, turned(model, 0.3).data());
    rotated.set(dt, 1);
    const Mat still = Mat::Zero();
    const Vec nothing = Vec::Zero();
    for (const std::size_t count : {0, 1, 10, 50, 121}) {
        if (count > face.size()) break;
        std::vector<HeldNode> held(count);
        std::vector<std::uint32_t> nodes;
        for (std::size_t k = 0; k < count; ++k)
            nodes.push_back(held[k].node = face[k]);
        start = Clock::now();
        correction.update(held.data(), count, &still, count);
        const double entering = since_us(start);
        second.update(held.data(), count, &still, count);
        std::vector<float> rhs(3 * model.free_count, 1e-3F), x(rhs.size());
        Vec tool;
        double best[2] = {1e9, 1e9};
        for (int repeat = 0; repeat < 600; ++repeat) {
            start = Clock::now();
            correction.apply(rhs.data(), &nothing, x.data(), &tool, scratch);
            best[0] = std::min(best[0], since_us(start));
            start = Clock::now();
            second.apply(rhs.data(), &nothing, x.data(), &tool, second_scratch);
            best[1] = std::min(best[1], since_us(start));
        }
        double leaving = 0;
        if (count > 1) {
            start = Clock::now();
            correction.update(held.data() + 1, count - 1, &still, 0);
            leaving = since_us(start);
            correction.update(held.data(), count, &still, 1);
        }
        // Iterations: corrected, plainly projected, with a factor made for the set (held rows replaced).
        const auto corrected = [&](const Vector& r) {
            std::vector<float> f(r.begin(), r.end()), z(f.size());
            correction.apply(f.data(), &nothing, z.data(), &tool, scratch);
            return Vector(z.begin(), z.end());
        };
        SupernodalFactor::Scratch solve(factor);
        const auto plain = [&](const Vector& r) {
            std::vector<float> z(r.begin(), r.end());
            factor.solve(z.data(), z.data(), solve);
            return Vector(z.begin(), z.end());
        };
        Vector values(matrix.values(), matrix.values() + matrix.pattern().row_nodes.size() * 9);
        for (const std::uint32_t node : nodes)
            for (int d = 0; d < 3; ++d)
                values[std::size_t{9} * matrix.pattern().column_begin[node] + 4 * d] *= 1e12;
        SupernodalFactor exact(matrix.pattern(), 3, FactorStorage::double_precision);
        exact.factorise(values.data());
        SupernodalFactor::Scratch exact_scratch(exact);
        const auto made_for_it = [&](const Vector& r) {
            Vector z(r.size());
            exact.solve(r.data(), z.data(), exact_scratch);
            return z;
        };
        std::printf(
            "  %3zu held: columns or best %.1f us, second solve %.1f us, all enter %.0f us, one leaves %.1f "
            "us; "
            "iterations %d, plain %d, factor of the set in double %d\n",
            count, best[0], best[1], entering, leaving, iterations(rotated, nodes, corrected),
            iterations(rotated, nodes, plain), iterations(rotated, nodes, made_for_it));
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc > 1 && std::string(argv[1]) == "contact") {
        for (const std::uint32_t n : {6U, 10U})
            for (const auto storage : {FactorStorage::single_precision, FactorStorage::fixed_point_16}) {
                measure_contact(n, storage, 10, 0.3, 1e-3);
                measure_contact(n, storage, 10, 0.49, 10e-3);
                measure_contact(n, storage, 1e6, 0.3, 1e-3);
                measure_contact(n, storage, 1e6, 0.49, 10e-3);
            }
        return 0;
    }
    const bool all = argc > 1 && std::string(argv[1]) == "all";
    for (const std::uint32_t n : {6U, 8U, 10U, 20U}) {
        const Model model = build_model(cube_asset(n, 10, 0.3), {});
        std::printf("n %u: %zu tetrahedra, %u unknown nodes\n", n, model.elements.size(), model.free_count);
        for (const SimdTarget target : {SimdTarget::portable, SimdTarget::avx2, SimdTarget::avx512}) {
            if (!has_simd_target(target) || (!all && target != best_simd_target())) continue;
            for (const RestMatrix::Kind kind : {RestMatrix::Kind::elastic, RestMatrix::Kind::laplacian}) {
                if (n == 20 && kind == RestMatrix::Kind::elastic && !all) continue;
                measure(model, kind, FactorStorage::single_precision, target, 1e-3);
                measure(model, kind, FactorStorage::fixed_point_16, target, 1e-3);
            }
        }
    }
    return 0;
}
