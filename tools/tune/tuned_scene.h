// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "evaluate/cell.h"
#include "evaluate/evaluation.h"
#include "evaluate/prepared_scene.h"
#include "evaluate/runtime_side.h"
#include "evaluate/speed.h"
#include "tune/memo.h"
#include "tune/recipe.h"

namespace knead::tools {

/// A mesh that levels may have.
struct TunedMesh {
    PreparedMesh prepared;  ///< its source says what it was made from
    bool is_fine = false;
    bool is_the_scenes = false;  ///< one of the scene's levels has it
    [[nodiscard]] std::size_t tetrahedra() const { return prepared.level.mesh.tetrahedra.size(); }
};

/// A level of one seed: its mesh (the method's own, or the tuned one) and elasticities.
struct MadeLevel {
    std::shared_ptr<const PreparedMesh> mesh;
    Material material;
};

/// What one load says of a level.
struct LoadAnswer {
    bool converged = false;
    std::string problem;            ///< why not, or empty
    double force_error = 0;         ///< signed; infinite when not converged
    double displacement_error = 0;  ///< as in knead-evaluate
};

/// The loads of a search: those of the scene's tools first.
struct LoadNames {
    std::vector<std::string> required;  ///< an object that has no place for one is refused
    std::vector<std::string> optional;  ///< left out, with a note, where the object has no place for it
};

/// A scene with its candidate meshes, asked for the error of any recipe on any of them.
///
/// What was computed is kept in the cache of knead-evaluate. @thread-safety const members: any threads
class TunedScene {
  public:
    /// @param levels names of the scene's levels or numbers of tetrahedra; empty: the scene's coarse meshes
    /// and
    ///     a range of generated ones
    /// @throws ToolError as knead-evaluate
    TunedScene(const std::filesystem::path& file, const LoadNames& loads,
               const std::vector<std::string>& levels, FileReader read, const ResultCache& cache);

    [[nodiscard]] const Scene& scene() const { return prepared_.scene; }
    [[nodiscard]] const std::vector<TunedMesh>& meshes() const { return meshes_; }  ///< the fine one last
    [[nodiscard]] const std::vector<std::string>& loads() const { return loads_; }
    [[nodiscard]] const std::vector<std::string>& notes() const { return notes_; }
    [[nodiscard]] std::size_t reference_tetrahedra() const {
        return prepared_.fine.level.mesh.tetrahedra.size();
    }
    /// Whether other seeds give other materials.
    [[nodiscard]] bool draws() const { return draws_material(prepared_.scene); }
    /// The seed that the scene itself bakes with.
    [[nodiscard]] std::uint64_t own_seed() const;

    [[nodiscard]] std::shared_ptr<const MadeLevel> make(std::size_t mesh, const Recipe& recipe,
                                                        std::uint64_t seed) const;
    [[nodiscard]] LoadAnswer answer(std::size_t mesh, const Recipe& recipe, std::uint64_t seed,
                                    std::size_t load) const;
    /// Step times of the level's asset: the lowest of each over `repeats` runs, because what else runs on the
    /// machine only ever adds.
    [[nodiscard]] StepTimes time(std::size_t mesh, const Recipe& recipe, int steps, int repeats) const;
    /// Relative difference of the runtime from the reference solver under the scene's first tool.
    [[nodiscard]] double runtime_disagreement(std::size_t mesh, const Recipe& recipe) const;
    [[nodiscard]] Asset asset(const MadeLevel& level) const;
    /// Of these numbers of bins, those that sort the scene's own elasticities in another way than one before.
    [[nodiscard]] std::vector<std::uint32_t> different_bins(const std::vector<std::uint32_t>& bins) const;

  private:
    void add_meshes(const std::vector<std::string>& levels);
    void add_mesh(const MeshSource& source, bool is_the_scenes, const std::string& name);
    void add_loads(PreparedMesh& mesh) const;
    [[nodiscard]] MeshLoad load_on(const PreparedMesh& mesh, const std::string& name) const;
    [[nodiscard]] std::shared_ptr<const EvaluatedObject> object(std::uint64_t seed) const;
    [[nodiscard]] std::shared_ptr<const StaticAnswer> reference(std::uint64_t seed, std::size_t load) const;
    [[nodiscard]] MadeLevel make_anew(std::size_t mesh, const Recipe& recipe, std::uint64_t seed) const;
    [[nodiscard]] Material papers_material(const MaterialObject& fine, const PreparedMesh& mesh,
                                           const Recipe& recipe, std::uint64_t seed) const;
    [[nodiscard]] Material calibrated_material(const EvaluatedObject& object, const PreparedMesh& mesh) const;

    FileReader read_;
    const ResultCache& cache_;
    PreparedScene prepared_;
    std::vector<std::string> scene_loads_;  // of the scene's tools; first among loads_
    std::vector<std::string> loads_;
    std::vector<TunedMesh> meshes_;
    std::vector<std::string> notes_;
    mutable Memo<std::uint64_t, EvaluatedObject> objects_;
    mutable Memo<std::pair<std::uint64_t, std::size_t>, StaticAnswer> references_;
    mutable Memo<std::string, Material> aggregated_;
    mutable Memo<std::string, MadeLevel> made_;
};

}  // namespace knead::tools
