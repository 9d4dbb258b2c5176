// SPDX-License-Identifier: GPL-3.0-or-later
#include "knead/options.h"

namespace knead::tools {

void declare_options(CLI::App& app, BuildOptionsGiven& options) {
    app.require_subcommand(1);
    CLI::App* build = app.add_subcommand("build", "run the tools that a scene needs, from mesh to assets");
    build->fallthrough();
    build->add_option("SCENE", options.scene, "scene file (TOML)")->required();
    build->add_option("-o,--output", options.folder, "folder for everything that is made; created if missing")
        ->required();
    build->add_option("-l,--level", options.levels, "only this level; may be given again [all]")
        ->type_name("NAME");
    build->add_option("--asset", options.asset, "also put the asset here (with exactly one level)")
        ->type_name("FILE");
    build->add_flag("--force", options.force, "run every tool, also where its output is up to date");
    build->add_flag("--strict", options.strict, "exit with 1, and leave --asset as it is, with a warning");
    auto* check =
        build->add_flag("--check", options.check,
                        "compare each level's force with the fine object's [those just made, if the fine "
                        "object has up to 4000 tetrahedra]");
    build->add_flag("--no-check", options.no_check, "compare none")->excludes(check);
    build->add_flag("--dry-run", options.dry_run, "print the commands of the tools and run none");
}

}  // namespace knead::tools
