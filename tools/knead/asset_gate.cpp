// SPDX-License-Identifier: GPL-3.0-or-later
#include "knead/asset_gate.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <optional>

#include "bake/bake.h"
#include "common/error.h"
#include "knead/formats/read.h"

namespace knead::tools {
namespace {

/// The fine object, read and baked when it is first asked for.
class FineObject {
  public:
    FineObject(const Scene& scene, const Plan& plan) : scene_(scene), plan_(plan) {
        scene_.embedding.reset();  // what is only drawn plays no part
        scene_.needs_surface = false;
    }

    [[nodiscard]] std::size_t tetrahedra() { return object().mesh.tetrahedra.size(); }

    LevelCheck& check() {
        if (!check_) check_.emplace(bake(scene_, Level{}, object()));
        return *check_;
    }

  private:
    const MaterialObject& object() {
        if (!object_) object_ = value_or_throw(read_material(plan_.fine_object));
        return *object_;
    }

    Scene scene_;
    const Plan& plan_;
    std::optional<MaterialObject> object_;
    std::optional<LevelCheck> check_;
};

/// @param presses filled where there is something to compare
Findings compare_with_fine(FineObject& fine, WhenToCheck check, const Asset& asset,
                           const PlannedAsset& planned, std::vector<PressComparison>& presses) {
    const auto unchecked = [&](const std::string& why, const char* advice) {
        return Findings{
            {false, "level-unchecked", static_cast<double>(fine.tetrahedra()), "tetrahedra",
             fmt::format("level {} was not compared with the fine object: {}", planned.level, why), advice}};
    };
    if (check == WhenToCheck::automatic && fine.tetrahedra() > kCheckedByItself)
        return unchecked(
            fmt::format("it has {} tetrahedra, more than {}", fine.tetrahedra(), kCheckedByItself),
            "knead build --check compares them all the same");
    try {
        presses = fine.check().compare(asset);
        return findings_of(presses, fine.check().fine(), planned.level);
    } catch (const ToolError& error) {  // the fine mesh has no node where the scene holds or touches
        return unchecked(error.what(), "use knead-evaluate");
    }
}

}  // namespace

std::size_t GatedAsset::warning_count() const {
    return static_cast<std::size_t>(
        std::count_if(findings.begin(), findings.end(), [](const Finding& f) { return f.warning; }));
}

std::vector<GatedAsset> gate_assets(const Scene& scene, const Plan& plan, WhenToCheck check,
                                    const std::function<bool(const PlannedAsset&)>& wants_check) {
    std::vector<GatedAsset> gated;
    FineObject fine(scene, plan);
    for (const PlannedAsset& planned : plan.assets) {
        const Asset asset = value_or_throw(read_asset(planned.file));
        GatedAsset result;
        result.asset = &planned;
        result.report = examine(asset);
        result.findings = result.report.findings;
        const bool is_fine = planned.object == plan.fine_object;
        if (check != WhenToCheck::never && !is_fine && wants_check(planned)) {
            const Findings compared = compare_with_fine(fine, check, asset, planned, result.presses);
            result.findings.insert(result.findings.end(), compared.begin(), compared.end());
        }
        gated.push_back(std::move(result));
    }
    return gated;
}

}  // namespace knead::tools
