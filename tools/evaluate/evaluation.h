// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "evaluate/methods.h"
#include "evaluate/pictures.h"
#include "evaluate/runtime_side.h"
#include "evaluate/scene_object.h"
#include "evaluate/speed.h"

namespace knead::tools {

/// The just noticeable difference of forces [HHC*08].
inline constexpr double kJndOfForce = 0.1;
/// How far the runtime may be from the reference solver on the same mesh and material.
inline constexpr double kRuntimeAgreement = 1e-3;

/// What errors are relative to.
enum class ReferenceKind : std::uint8_t {
    fine,  ///< the raw elasticities on the scene's fine mesh, as in the paper
    finer  ///< the same field with every tetrahedron cut in eight
};
[[nodiscard]] const char* name_of(ReferenceKind kind);

/// What to evaluate. Names are valid (options.h checks them).
struct EvaluationRequest {
    std::vector<std::filesystem::path> scenes;
    std::vector<Method> methods;
    /// Coarse meshes: names of the scene's levels, "fine", or numbers of tetrahedra. Empty: the different
    /// meshes of the scene's levels, the fine one only if there is no other.
    std::vector<std::string> levels;
    /// Names of loads; "scene" is the first tool of the scene, "scene:NAME" another one.
    std::vector<std::string> loads;
    std::uint32_t seeds = 1;
    std::uint64_t seed_base = 1;
    ReferenceKind reference = ReferenceKind::fine;
    int timed_steps = 2000;  ///< of each asset; 0: no timing
    bool with_curves = false;
    bool with_baseline = false;  ///< also time the plain baseline on the fine and the coarse meshes
    bool with_states = false;    ///< the object's states and what is in its asset, for the page
    unsigned threads = 1;
};

/// One cell: one method on one mesh under one load, against the reference.
struct CellResult {
    Method method;
    std::uint64_t tetrahedra = 0;
    std::uint64_t seed = 0;
    std::string load;
    bool fitted = false;  ///< the method saw this load when it was made
    bool converged = false;
    std::string problem;     ///< why it did not, or empty
    bool applicable = true;  ///< false: the method has nothing to say about it; left out of the report
    double force_n = 0;
    double reference_force_n = 0;
    double force_error = 0;         ///< signed, relative to the reference
    double displacement_error = 0;  ///< RMS over the surface nodes, relative to the RMS displacement
    std::optional<double> runtime_force_n;
    std::optional<StepTimes> step;
    std::optional<double> load_ms;
    std::optional<std::uint64_t> asset_bytes;

    [[nodiscard]] bool within_jnd() const;
    /// Relative difference of the runtime from the reference solver; 0 when it was not asked.
    [[nodiscard]] double runtime_disagreement() const;
};

/// A force over time; method "reference" has no bins.
struct CurveResult {
    std::string method;
    std::uint32_t bins = 0, clusters = 0;
    std::uint64_t tetrahedra = 0, seed = 0;
    std::string load;
    ForceCurve curve;
};

struct SceneResult {
    std::string name;
    std::uint64_t reference_tetrahedra = 0;
    ReferenceKind reference = ReferenceKind::fine;
    std::vector<CellResult> cells;
    std::vector<CurveResult> curves;
    std::vector<SpeedResult> speed;  ///< runtime and plain baseline, of the first seed
    std::vector<ObjectState> states;
    std::vector<AssetGroup> asset;
    std::vector<std::string> notes;  ///< what was left out, and why
};

/// Keeps what was computed, by the hash of all it depends on. Safe against being killed at any moment.
class ResultCache {
  public:
    /// @param folder empty: nothing is kept
    /// @param salt part of every key: the program that computes
    ResultCache(std::filesystem::path folder, std::string salt);

    /// @param key everything that the content depends on
    [[nodiscard]] std::optional<std::string> find(const std::string& key) const;
    void keep(const std::string& key, const std::string& content) const;

  private:
    [[nodiscard]] std::filesystem::path file_of(const std::string& key) const;
    std::filesystem::path folder_;
    std::string salt_;
};

/// Told from one thread at a time.
struct EvaluationListener {
    std::function<void(std::size_t done, std::size_t total, std::string_view what)> progress;
    std::function<void(std::string_view)> note;
};

/// Evaluates everything that was asked for; what the cache knows is not computed again.
///
/// Results are in the order scenes, loads, meshes, methods, seeds, and apart from the times the same for any
/// number of threads. A cell that does not converge says so and is not an error.
/// @throws ToolError for scenes and loads that make no sense
[[nodiscard]] std::vector<SceneResult> evaluate(const EvaluationRequest& request, const ResultCache& cache,
                                                const FileReader& read, const EvaluationListener& listener);

}  // namespace knead::tools
