// SPDX-License-Identifier: Apache-2.0
#include "knead/formats/numerics.h"

#include <algorithm>
#include <array>
#include <charconv>

namespace knead {
namespace {

constexpr std::array<const char*, 3> kPrecisions{"float32", "float64", "mixed"};
constexpr std::array<const char*, 3> kPreconditioners{"factor", "laplacian", "sparse_inverse"};
constexpr std::array<const char*, 3> kStorages{"fixed16", "float32", "float64"};
constexpr std::array<const char*, 7> kReasons{"low_contrast",   "high_contrast",   "nearly_incompressible",
                                              "few_tetrahedra", "many_tetrahedra", "stiff_path",
                                              "stiff_and_loose"};

/// Four digits are enough for people; independent of the locale.
std::string short_number(double number) {
    char buffer[32];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, number, std::chars_format::general, 4).ptr};
}

/// @param most_contrast what counts as low for the choice: not the same for each of them
std::string words(NumericsReason reason, double most_contrast) {
    if (reason == NumericsReason::low_contrast) return "contrast up to " + short_number(most_contrast);
    std::string text = to_string(reason);
    std::replace(text.begin(), text.end(), '_', ' ');
    return text;
}

}  // namespace

const char* to_string(Precision precision) noexcept {
    return kPrecisions[static_cast<std::size_t>(precision)];
}

const char* to_string(Preconditioner preconditioner) noexcept {
    return kPreconditioners[static_cast<std::size_t>(preconditioner)];
}

const char* to_string(FactorStorage storage) noexcept {
    return kStorages[static_cast<std::size_t>(storage)];
}

const char* to_string(NumericsReason reason) noexcept {
    return kReasons[static_cast<std::size_t>(reason)];
}

std::string to_text(const Numerics& numerics) {
    static constexpr std::array<const char*, 3> kBy{
        "the factor of the rest state", "the factor of the scalar Laplacian", "a sparse approximate inverse"};
    std::string text =
        "contrast " + short_number(numerics.contrast) +
        (numerics.press_contrast != numerics.contrast
             ? " (" + short_number(numerics.press_contrast) + " against the path from tool to support)"
             : std::string()) +
        ", Poisson's ratio up to " + short_number(numerics.max_poissons_ratio) + ", " +
        std::to_string(numerics.tetrahedra) + " tetrahedra: solved in " + to_string(numerics.arithmetic) +
        " (" + words(numerics.arithmetic_reason, kFloat32MaxPressContrast) + "), preconditioned by " +
        kBy[static_cast<std::size_t>(numerics.preconditioner)] + " (" +
        words(numerics.preconditioner_reason, kLaplacianMaxContrast) + ")";
    if (numerics.preconditioner == Preconditioner::sparse_inverse) return text;
    return text + " kept in " + to_string(numerics.factor_storage) + " (" +
           words(numerics.storage_reason, kFixed16FactorMaxContrast) + ")";
}

}  // namespace knead
