// SPDX-License-Identifier: Apache-2.0
#include "knead/formats/material.h"

#include <algorithm>

#include "failure.h"
#include "mesh_checks.h"
#include "offenders.h"

namespace knead {
namespace {

const std::string kGroup = "/knead/material";

void check_values(const std::vector<double>& values, std::size_t expected, bool (*is_valid)(double),
                  const char* what, const std::string& where) {
    if (values.size() != expected)
        fail(ErrorCode::invalid_data,
             std::to_string(values.size()) + " values for " + std::to_string(expected) + " tetrahedra",
             where);
    Offenders bad;
    for (std::size_t i = 0; i < values.size(); ++i)
        if (!is_valid(values[i])) bad.add(i);
    if (bad.any()) fail(ErrorCode::invalid_data, bad.text(values.size(), what, "elements"), where);
}

/// Tetrahedra of one bin must share one E, nu and density: compares each with the first of its bin.
void check_bins(const Material& material, std::size_t tetrahedron_count) {
    const auto& bin = material.bin_of_tetrahedron;
    const std::string where = kGroup + "/bin_of_tetrahedron";
    if (bin.empty()) return;
    if (bin.size() != tetrahedron_count)
        fail(ErrorCode::invalid_data,
             std::to_string(bin.size()) + " entries for " + std::to_string(tetrahedron_count) + " tetrahedra",
             where);
    const std::size_t bin_count = std::size_t{*std::max_element(bin.begin(), bin.end())} + 1;
    if (bin_count > tetrahedron_count)
        fail(ErrorCode::invalid_data,
             "bin " + std::to_string(bin_count - 1) + " in a mesh of " + std::to_string(tetrahedron_count) +
                 " tetrahedra: bins are numbered from 0",
             where);
    constexpr std::size_t kNone = static_cast<std::size_t>(-1);
    std::vector<std::size_t> first(bin_count, kNone);
    Offenders bad;
    for (std::size_t i = 0; i < bin.size(); ++i) {
        std::size_t& f = first[bin[i]];
        if (f == kNone) f = i;
        if (material.youngs_modulus_pa[i] != material.youngs_modulus_pa[f] ||
            material.poissons_ratio[i] != material.poissons_ratio[f] ||
            material.density_kg_per_m3[i] != material.density_kg_per_m3[f])
            bad.add(i);
    }
    if (bad.any())
        fail(ErrorCode::invalid_data,
             bad.text(bin.size(), "tetrahedra differ from the first of their bin", "elements"), where);
}

}  // namespace

Status validate(const Material& material, std::size_t tetrahedron_count) {
    return guarded(kGroup, [&] {
        check_values(material.youngs_modulus_pa, tetrahedron_count, is_positive, kNotPositive,
                     kGroup + "/youngs_modulus_pa");
        check_values(material.poissons_ratio, tetrahedron_count, is_poissons_ratio, kNotPoissonsRatio,
                     kGroup + "/poissons_ratio");
        check_values(material.density_kg_per_m3, tetrahedron_count, is_positive, kNotPositive,
                     kGroup + "/density_kg_per_m3");
        check_bins(material, tetrahedron_count);
        return Unit{};
    });
}

}  // namespace knead
