// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>

namespace knead::tools {

/// The kinds of file that knead-mesh imports.
enum class FileFormat { step, brep, stl_text, stl_binary, ply, msh, medit, vtk, veg };

/// "a STEP file", as it stands in messages.
[[nodiscard]] const char* description(FileFormat format);

/// True for the formats whose coordinates have no unit, all but STEP.
[[nodiscard]] bool needs_length_unit(FileFormat format);

/// Tells by its content which format a file has, whatever its name. Only content recognised here is ever
/// shown to gmsh: gmsh runs whatever it does not recognise as a script, shell commands included.
///
/// Looks at the opening of the file, and for the two that gmsh reads by itself (MSH, STEP) at the whole
/// outline: MSH must be a sequence of $Section ... $EndSection with nothing between them.
/// Throws ToolError bad_input for anything else; the message says what the content looks like.
[[nodiscard]] FileFormat recognise(std::string_view content);

/// Refuses a file whose extension promises another format than its content holds (bad_input): one of the two
/// is a mistake. Unknown extensions and names without one are fine.
/// @param extension lower or upper case, with the dot: ".msh"
void require_matching_extension(FileFormat format, const std::string& extension);

}  // namespace knead::tools
