// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>

#include "knead/formats/asset.h"
#include "knead/formats/press_contrast.h"

namespace knead {

/// Numbers of the element pass and of the conjugate gradients.
enum class Precision : std::uint8_t {
    float32 = 0,
    float64 = 1,
    mixed = 2  ///< the state and the element pass in float64, the conjugate gradients in float32
};

/// What the conjugate gradients of a step are preconditioned with. Where dt is so short that mass outweighs
/// stiffness, the runtime takes the sparse inverse in any case.
enum class Preconditioner : std::uint8_t {
    factor = 0,         ///< factor of the rest-state matrix, 3x3 blocks
    laplacian = 1,      ///< factor of the scalar Laplacian weighted by 2 mu + lambda: a ninth of the memory
    sparse_inverse = 2  ///< G^T G, G as sparse as the matrix: reaches to the neighbours
};

/// How the numbers of a factor are kept. Without a factor (sparse_inverse) it says nothing.
enum class FactorStorage : std::uint8_t {
    fixed16 = 0,  ///< whole numbers of 16 bits, one float32 as the unit of each column
    float32 = 1,
    float64 = 2
};

/// Why a choice was made.
enum class NumericsReason : std::uint8_t {
    low_contrast = 0,           ///< the elasticities are near enough to each other
    high_contrast = 1,          ///< the elasticities are too far apart for less
    nearly_incompressible = 2,  ///< a Poisson's ratio is too near 0.5 for less
    few_tetrahedra = 3,
    many_tetrahedra = 4,
    stiff_path = 5,      ///< far apart, but what is stiff reaches from the tools to what holds the object
    stiff_and_loose = 6  ///< nothing holds it, and it is as stiff as metal
};

/// How the runtime solves an asset: told when baking, not stored, chosen again from the same data when
/// loading.
struct Numerics {
    Precision arithmetic = Precision::float32;
    Preconditioner preconditioner = Preconditioner::factor;
    FactorStorage factor_storage = FactorStorage::fixed16;
    NumericsReason arithmetic_reason = NumericsReason::low_contrast;
    NumericsReason preconditioner_reason = NumericsReason::few_tetrahedra;
    NumericsReason storage_reason = NumericsReason::low_contrast;
    double contrast = 1;            ///< largest over smallest Young's modulus of the tetrahedra
    double press_contrast = 1;      ///< largest over that of the path of the force, path_youngs_modulus_pa()
    double max_poissons_ratio = 0;  ///< of the tetrahedra
    std::uint64_t tetrahedra = 0;
};

// Where one choice ends and the next begins.
/// Press contrast. The force is as small as the path is soft, the rounding of the stiff rows as large as they
/// are stiff: with stiff islands in soft matter all in float32 the force is right to 1e-3 at 1e4 and wrong by
/// 0.18 at 1e6. With a stiff phase from tool to support float32 holds at any contrast (measured up to 1e9).
inline constexpr double kFloat32MaxPressContrast = 1e4;
/// Press contrast. With the state in float64 what is left is the rounding of the conjugate gradients, which
/// grows with the contrast: of the force 3e-5 at 1e6, 3e-4 at 1e7 and 3e-3 at 1e8 (islands, nu 0.49, dt 10
/// ms).
inline constexpr double kMixedMaxPressContrast = 1e6;
/// And as nu comes near 0.5: 1e-4 at 0.495, 1e-2 at 0.499 (islands of 1e6, dt 10 ms).
inline constexpr double kMixedMaxPoissonsRatio = 0.495;
/// sqrt(E / density) of an object that nothing holds: it goes away from where it rests, and displacements in
/// float32 round its strains to 1e-6. That is the energy of a slow flight at 1e4 m/s (grown 11 times), and
/// nothing at 3e3 m/s (384 tetrahedra, 1 s at 0.5 m/s).
inline constexpr double kFloat32MaxLooseWaveSpeed_m_per_s = 4e3;
/// Contrast. A column of the factor in 16 bits keeps 1 / 32,768 of its largest entry. That costs hardly any
/// iterations up to 1e6 (44 against 43 with a double factor, nu 0.49, dt 10 ms), and it is read in half the
/// time.
inline constexpr double kFixed16FactorMaxContrast = 1e6;
/// Near 0.5 the factor's entries span 1 / (1 - 2 nu) beside the contrast. Measured up to 0.49.
inline constexpr double kFixed16FactorMaxPoissonsRatio = 0.495;
/// Press contrast. A float32 factor only preconditions, so it may be worse than the arithmetic. Measured up
/// to 1e9: with islands it takes as many iterations as one in double, each of them cheaper.
inline constexpr double kFloat32FactorMaxPressContrast = 1e9;
/// Where dt^2 times stiffness over mass, node for node, is below this on average, the inverse hardly reaches
/// beyond the neighbours: one iteration with the sparse inverse leaves less than a tenth of the error, for a
/// fraction of the work of a factor.
inline constexpr double kSparseInverseMaxStiffness = 5;
/// Beyond this the factor outgrows the cache of a core, and reading it costs more than the iterations it
/// saves.
inline constexpr std::uint64_t kFactorMaxTetrahedra = 16'000;
/// The scalar Laplacian knows the stiffness but not its directions: 20 iterations at nu 0.49 against 4 at
/// 0.3.
inline constexpr double kLaplacianMaxPoissonsRatio = 0.45;  ///< excluded
inline constexpr double kLaplacianMaxContrast = 1e3;

/// Chooses how to solve `asset`, from its elasticities, where they are, and its size. Depends on nothing
/// else. Precondition: validate(asset).ok().
[[nodiscard]] inline Numerics choose_numerics(const Asset& asset) {
    Numerics chosen;
    double softest = asset.palette[asset.palette_index[0]].youngs_modulus_pa;
    double stiffest = softest;
    double wave_speed_squared = 0;
    chosen.max_poissons_ratio = asset.palette[asset.palette_index[0]].poissons_ratio;
    for (const std::uint32_t index : asset.palette_index) {  // the palette may hold more than is used
        softest = std::min(softest, asset.palette[index].youngs_modulus_pa);
        stiffest = std::max(stiffest, asset.palette[index].youngs_modulus_pa);
        wave_speed_squared = std::max(wave_speed_squared, asset.palette[index].youngs_modulus_pa /
                                                              asset.palette[index].density_kg_per_m3);
        chosen.max_poissons_ratio = std::max(chosen.max_poissons_ratio, asset.palette[index].poissons_ratio);
    }
    chosen.contrast = stiffest / softest;
    chosen.press_contrast = stiffest / path_youngs_modulus_pa(asset);
    chosen.tetrahedra = asset.tetrahedra.size();

    const bool loose = asset.free_node_count == asset.nodes_m.size();
    if (loose && std::sqrt(wave_speed_squared) > kFloat32MaxLooseWaveSpeed_m_per_s) {
        chosen.arithmetic = Precision::float64;
        chosen.arithmetic_reason = NumericsReason::stiff_and_loose;
    } else if (chosen.press_contrast > kFloat32MaxPressContrast) {
        // Measured with a factor only.
        const bool mixed = chosen.tetrahedra <= kFactorMaxTetrahedra &&
                           chosen.press_contrast <= kMixedMaxPressContrast &&
                           chosen.max_poissons_ratio <= kMixedMaxPoissonsRatio;
        chosen.arithmetic = mixed ? Precision::mixed : Precision::float64;
        chosen.arithmetic_reason = NumericsReason::high_contrast;
    } else if (chosen.contrast > kFloat32MaxPressContrast) {
        chosen.arithmetic_reason = NumericsReason::stiff_path;
    }
    if (chosen.contrast > kFixed16FactorMaxContrast) {
        const bool extreme = chosen.press_contrast > kFloat32FactorMaxPressContrast;
        chosen.factor_storage = extreme ? FactorStorage::float64 : FactorStorage::float32;
        chosen.storage_reason = NumericsReason::high_contrast;
    } else if (chosen.max_poissons_ratio > kFixed16FactorMaxPoissonsRatio) {
        chosen.factor_storage = FactorStorage::float32;
        chosen.storage_reason = NumericsReason::nearly_incompressible;
    }
    if (chosen.tetrahedra > kFactorMaxTetrahedra) {
        chosen.preconditioner = Preconditioner::sparse_inverse;
        if (chosen.contrast > kLaplacianMaxContrast) {
            chosen.preconditioner_reason = NumericsReason::high_contrast;
        } else if (!(chosen.max_poissons_ratio < kLaplacianMaxPoissonsRatio)) {
            chosen.preconditioner_reason = NumericsReason::nearly_incompressible;
        } else {
            chosen.preconditioner = Preconditioner::laplacian;
            chosen.preconditioner_reason = NumericsReason::many_tetrahedra;
        }
    }
    return chosen;
}

// Names, as reports spell them: "float32", "sparse_inverse", "high_contrast".
[[nodiscard]] const char* to_string(Precision precision) noexcept;
[[nodiscard]] const char* to_string(Preconditioner preconditioner) noexcept;
[[nodiscard]] const char* to_string(FactorStorage storage) noexcept;
[[nodiscard]] const char* to_string(NumericsReason reason) noexcept;

/// One sentence without its full stop: "contrast 10, ..., 1296 tetrahedra: solved in float32 (contrast up to
/// 1e+04), preconditioned by ...". Where the path of the force is stiffer than the softest tetrahedron:
/// "contrast 1e+06 (20 against the path from tool to support), ...".
[[nodiscard]] std::string to_text(const Numerics& numerics);

}  // namespace knead
