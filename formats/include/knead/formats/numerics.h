// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>

#include "knead/formats/asset.h"

namespace knead {

/// Numbers of the element pass and of the conjugate gradients.
enum class Precision : std::uint8_t { float32 = 0, float64 = 1 };

/// What the conjugate gradients of a step are preconditioned with.
enum class Preconditioner : std::uint8_t {
    factor = 0,       ///< factor of the rest-state matrix, 3x3 blocks
    laplacian = 1,    ///< factor of the scalar Laplacian weighted by 2 mu + lambda: a ninth of the memory
    block_jacobi = 2  ///< inverted 3x3 diagonal blocks
};

/// How the numbers of a factor are kept. Without a factor (block_jacobi) it says nothing.
enum class FactorStorage : std::uint8_t { half = 0, float32 = 1, float64 = 2 };

/// Why a choice was made.
enum class NumericsReason : std::uint8_t {
    low_contrast = 0,           ///< the elasticities are near enough to each other
    high_contrast = 1,          ///< the elasticities are too far apart for less
    nearly_incompressible = 2,  ///< a Poisson's ratio is too near 0.5 for less
    few_tetrahedra = 3,
    many_tetrahedra = 4
};

/// How the runtime solves an asset: told when baking, not stored, chosen again from the same data when
/// loading.
struct Numerics {
    Precision arithmetic = Precision::float32;
    Preconditioner preconditioner = Preconditioner::factor;
    FactorStorage factor_storage = FactorStorage::half;
    NumericsReason arithmetic_reason = NumericsReason::low_contrast;
    NumericsReason preconditioner_reason = NumericsReason::few_tetrahedra;
    NumericsReason storage_reason = NumericsReason::low_contrast;
    double contrast = 1;            ///< largest over smallest Young's modulus of the tetrahedra
    double max_poissons_ratio = 0;  ///< of the tetrahedra
    std::uint64_t tetrahedra = 0;
};

// Where one choice ends and the next begins.
/// Stiff islands in soft matter: all in float32 the force is right to 1e-3 at 1e4 and wrong by 0.18 at 1e6.
inline constexpr double kFloat32MaxContrast = 1e4;
/// Half precision holds 65,504: entries of the factor span the contrast, and overflow (NaN) is seen at 1e6.
inline constexpr double kHalfFactorMaxContrast = 100;
/// Near 0.5 the factor's entries span 1 / (1 - 2 nu) beside the contrast, and 11 bits lose iterations.
inline constexpr double kHalfFactorMaxPoissonsRatio = 0.45;
/// A float32 factor only preconditions, so it may be worse than the arithmetic; at 1e9 it no longer helps.
inline constexpr double kFloat32FactorMaxContrast = 1e7;
/// Beyond this the factor outgrows the cache of a core, and reading it costs more than the iterations it
/// saves.
inline constexpr std::uint64_t kFactorMaxTetrahedra = 16'000;
/// The scalar Laplacian knows the stiffness but not its directions: 20 iterations at nu 0.49 against 4 at
/// 0.3.
inline constexpr double kLaplacianMaxPoissonsRatio = 0.45;  ///< excluded
inline constexpr double kLaplacianMaxContrast = 1e3;

/// Chooses how to solve `asset`, from its elasticities and its size. Depends on nothing else; allocates
/// nothing. Precondition: validate(asset).ok().
[[nodiscard]] inline Numerics choose_numerics(const Asset& asset) noexcept {
    Numerics chosen;
    double softest = asset.palette[asset.palette_index[0]].youngs_modulus_pa;
    double stiffest = softest;
    chosen.max_poissons_ratio = asset.palette[asset.palette_index[0]].poissons_ratio;
    for (const std::uint32_t index : asset.palette_index) {  // the palette may hold more than is used
        softest = std::min(softest, asset.palette[index].youngs_modulus_pa);
        stiffest = std::max(stiffest, asset.palette[index].youngs_modulus_pa);
        chosen.max_poissons_ratio = std::max(chosen.max_poissons_ratio, asset.palette[index].poissons_ratio);
    }
    chosen.contrast = stiffest / softest;
    chosen.tetrahedra = asset.tetrahedra.size();

    if (chosen.contrast > kFloat32MaxContrast) {
        chosen.arithmetic = Precision::float64;
        chosen.arithmetic_reason = NumericsReason::high_contrast;
    }
    if (chosen.contrast > kHalfFactorMaxContrast) {
        const bool extreme = chosen.contrast > kFloat32FactorMaxContrast;
        chosen.factor_storage = extreme ? FactorStorage::float64 : FactorStorage::float32;
        chosen.storage_reason = NumericsReason::high_contrast;
    } else if (chosen.max_poissons_ratio > kHalfFactorMaxPoissonsRatio) {
        chosen.factor_storage = FactorStorage::float32;
        chosen.storage_reason = NumericsReason::nearly_incompressible;
    }
    if (chosen.tetrahedra > kFactorMaxTetrahedra) {
        chosen.preconditioner = Preconditioner::block_jacobi;
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

// Names, as reports spell them: "float32", "block_jacobi", "high_contrast".
[[nodiscard]] const char* to_string(Precision precision) noexcept;
[[nodiscard]] const char* to_string(Preconditioner preconditioner) noexcept;
[[nodiscard]] const char* to_string(FactorStorage storage) noexcept;
[[nodiscard]] const char* to_string(NumericsReason reason) noexcept;

/// One sentence without its full stop: "contrast 10, ..., 1296 tetrahedra: solved in float32 (low
/// contrast), preconditioned by ...".
[[nodiscard]] std::string to_text(const Numerics& numerics);

}  // namespace knead
